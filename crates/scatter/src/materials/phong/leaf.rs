//! `phong` at a point: facets, and what they do not reflect at once.

use super::body::passage;
use crate::directional_albedo::LaneRows;
use crate::fresnel::{Dielectric, conductor, dielectric, schlick};
use crate::microfacet::Microfacets;
use crate::scatter::{Crossing, LocalSample, Scatter};
use crate::thin_film;
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// How much a facet reflects.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fresnel {
    Coat {
        eta: SampledSpectrum,
    },
    Conductor {
        n: SampledSpectrum,
        k: SampledSpectrum,
    },
    /// A conductor under a film of an index, over that of what lies outside; see [`thin_film::reflectance`].
    Film {
        n: SampledSpectrum,
        k: SampledSpectrum,
        film: SampledSpectrum,
        turns: SampledSpectrum,
    },
    Schlick {
        r0: SampledSpectrum,
    },
}

impl Fresnel {
    /// What a facet reflects, scaled: all of it but total reflection, beyond which no light goes on.
    #[inline]
    fn eval(&self, cos: Real, scale: Real) -> SampledSpectrum {
        match self {
            Self::Coat { eta } => {
                let of = |eta: Real| scaled(dielectric(cos, eta), scale);
                // Mostly the same at all wavelengths.
                let hero = of(eta.hero());
                eta.map(|lane| if lane == eta.hero() { hero } else { of(lane) })
            }
            Self::Conductor { n, k } => {
                SampledSpectrum::from_fn(|lane| scale * conductor(cos, n[lane], k[lane]))
            }
            Self::Film { n, k, film, turns } => SampledSpectrum::from_fn(|lane| {
                scale * thin_film::reflectance(cos, film[lane], [n[lane], k[lane]], turns[lane])
            }),
            Self::Schlick { r0 } => r0.map(|r0| scale * schlick(cos, r0)),
        }
    }
}

/// A scaled reflectance; total reflection stays as it is.
#[inline]
pub(super) fn scaled(light: Dielectric, scale: Real) -> Real {
    if light.cos_transmitted > 0.0 { light.reflectance * scale } else { light.reflectance }
}

/// Facets, and what they do not reflect at once: in a coat it reaches the ground, on a metal other facets.
///
/// Either is drawn with the share that it has of the light seen from `wo`, in each lane by itself.
#[derive(Clone, Copy, Debug)]
pub struct PhongLeaf {
    pub(super) facets: Microfacets,
    pub(super) fresnel: Fresnel,
    /// What multiplies the reflectance.
    pub(super) fresnel_scale: Real,
    /// The share of the light not reflected at once that is scattered in the end.
    pub(super) base: SampledSpectrum,
    /// The optical depth of a coat along its normal.
    pub(super) veil: SampledSpectrum,
    /// Albedo of the facets: of the coat, or of white facets.
    pub(super) rows: LaneRows,
}

impl PhongLeaf {
    /// What colours the row of the facets' albedo, roughly; the row of a coat has it in.
    #[inline]
    fn tint(&self, cos: Real) -> SampledSpectrum {
        match self.fresnel {
            Fresnel::Coat { .. } => SampledSpectrum::ONE,
            _ => self.fresnel.eval(cos, self.fresnel_scale),
        }
    }

    /// What a coat leaves of light on its way to the ground and back, or on one way alone.
    #[inline]
    fn passage(&self, cosines: &[Real]) -> SampledSpectrum {
        match self.fresnel {
            Fresnel::Coat { eta } if !self.veil.is_black() => passage(eta, self.veil, cosines),
            _ => SampledSpectrum::ONE,
        }
    }

    /// The share of draws that the facets get.
    #[inline]
    fn gloss_share(&self, wo: Vec3) -> LanePdf {
        let albedo = self.rows.at(wo.z);
        let tint = self.tint(wo.z);
        let below = self.base * self.passage(&[wo.z]);
        LanePdf::from_fn(|lane| {
            let (gloss, base) = (tint[lane] * albedo[lane], below[lane] * (1.0 - albedo[lane]));
            if base > 0.0 { gloss / (gloss + base) } else { 1.0 }
        })
    }
}

impl Scatter for PhongLeaf {
    #[inline]
    fn is_matt(&self) -> bool {
        matches!(self.fresnel, Fresnel::Coat { .. })
    }

    #[inline]
    fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        let Some(h) = (wo + wi).try_normalized().filter(|_| crossing == Crossing::Reflect) else {
            return SampledSpectrum::ZERO;
        };
        let gloss = self.facets.density(h) * self.facets.shared_over_cosines(wo, wi);
        self.fresnel.eval(wo.dot(h), self.fresnel_scale) * gloss
            + self.base * self.rows.complement(wo.z, wi.z) * self.passage(&[wo.z, wi.z])
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
        let Some(h) = (wo + wi).try_normalized().filter(|_| crossing == Crossing::Reflect) else {
            return LanePdf::ZERO;
        };
        let share = self.gloss_share(wo);
        let (gloss, base) = (0.25 * self.facets.pdf_over_dot(wo, h), cosine_hemisphere_pdf(wi.z));
        LanePdf::from_fn(|lane| share[lane] * gloss + (1.0 - share[lane]) * base)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        if u[2] >= self.gloss_share(wo).hero() {
            return Some(LocalSample::smooth(cosine_hemisphere(Vec2::new(u[0], u[1])), Crossing::Reflect));
        }
        let h = self.facets.sample(wo, [u[0], u[1]]);
        let wi = h * (2.0 * wo.dot(h)) - wo;
        // A facet that sends light into the surface: lost here, and given back by the row's complement.
        (wi.z > 0.0).then(|| LocalSample::smooth(wi, Crossing::Reflect))
    }
}
