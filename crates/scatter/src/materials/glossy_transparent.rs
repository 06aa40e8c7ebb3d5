//! `glossy_transparent`: a rough surface of a dielectric.
//!
//! One reflection or refraction at `Microfacets` of the exponent's width, after Walter et al. 2007, equations 20
//! and 21, with exact reflectances for the indices of the media on both sides at each wavelength. Normals are
//! drawn as they are seen, and then reflection or refraction by the reflectance, so that every draw has the
//! weight of the masking alone. Refraction depends on the wavelength: the drawn direction is the hero's, and each
//! lane has its own density of it.
//!
//! Light that meets a second facet is lost. How much that is, by exponent, angle and index, is told in
//! `docs/theory/rough-glass.md`, whose tables a test of this file computes anew.

use super::fields::{
    BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP, EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE,
    INTERNAL_MEDIUM_NAME, LATER, LAYER, ROUGHNESS, ROUGHNESS_PARAMETER, disregard_exponents,
};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::fresnel::{dielectric, reflectance};
use crate::media::MediumId;
use crate::microfacet::Microfacets;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Field, Group, Kind, Node, Parameter, Presence, Range, StandIn};
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// The declaration of `glossy_transparent`.
pub static BLOCK: Block = Block::new(
    "glossy_transparent",
    "A rough surface of a transparent dielectric, such as frosted glass or skin.",
    &[
        INTERNAL_MEDIUM_NAME,
        Field::new(
            "exponent",
            Kind::Real,
            Presence::Optional,
            "Exponent of the normals of small facets, which spreads reflection and transmission (their distribution \
             is that of Trowbridge and Reitz with the peak of a Phong lobe of this exponent): \
             from about 1 (broad) to 10000 and more (nearly smooth). Needed unless there is a `roughness`.",
        )
        .range(Range::Above(0.0)),
        ROUGHNESS,
        BUMP_MAP,
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_needs(&[Group::any(&["exponent", "roughness"])])
.with_parameters(&[BASE_EMISSION_PARAMETER, EMISSION_PARAMETER,
    Parameter {
        name: "exponent",
        since: "1.1",
        constant: "exponent",
        texture: "",
        stand_in: StandIn::Text("1000"),
    },
    Parameter { texture: "", ..ROUGHNESS_PARAMETER },
    BUMP,
])
.with_later(LATER)
.with_example(
    "<glossy_transparent>
    <internal_medium_name>glass</internal_medium_name>
    <exponent>1000</exponent>
</glossy_transparent>",
);

/// A rough interface between its medium and another.
#[derive(Clone, Debug)]
pub struct GlossyTransparent {
    medium: MediumId,
    facets: Microfacets,
}

impl GlossyTransparent {
    /// The surface of a medium, of some facets.
    pub(super) fn new(medium: MediumId, facets: Microfacets) -> Self {
        Self { medium, facets }
    }

    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let medium = resources.medium(node, INTERNAL_MEDIUM_NAME.name);
        disregard_exponents(node, resources.sink());
        let facets = match node.opt_real(ROUGHNESS.name) {
            Some(width) => Microfacets::of_width(Real::from_f64(width.value)),
            // The stand-in is for scenes that lack both, which has been reported.
            None => {
                Microfacets::of_exponent(Real::from_f64(node.opt_real("exponent").map_or(1.0, |n| n.value)))
            }
        };
        Self { medium, facets }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, _uv: impl Fn(u32) -> Vec2) -> GlossyTransparentLeaf {
        GlossyTransparentLeaf { facets: self.facets, eta: context.interface.eta() }
    }
}

impl SurfaceKind for GlossyTransparent {
    fn internal_medium(&self) -> Option<MediumId> {
        Some(self.medium)
    }
}

/// Reflection and refraction at the facets of an interface.
#[derive(Clone, Copy, Debug)]
pub struct GlossyTransparentLeaf {
    facets: Microfacets,
    /// The index below over that above.
    eta: SampledSpectrum,
}

/// Light through a facet, in one lane.
struct Refraction {
    /// The facet's normal, above.
    h: Vec3,
    /// Its cosine to the direction above.
    cos_o: Real,
    /// Its cosine to the direction below, not negative.
    cos_i: Real,
    /// Squared, (o·h) + η (i·h).
    divisor: Real,
}

impl Refraction {
    /// The facet that refracts between `o` above and `i` below; `None` where none does.
    #[inline]
    fn between(o: Vec3, i: Vec3, eta: Real) -> Option<Self> {
        let sum = (o + i * eta).try_normalized()?;
        let h = if sum.z < 0.0 { -sum } else { sum };
        let (cos_o, cos_i) = (o.dot(h), -i.dot(h));
        if cos_o <= 0.0 || cos_i <= 0.0 {
            return None;
        }
        let root = cos_o - eta * cos_i;
        let divisor = root * root;
        (divisor > 0.0).then_some(Self { h, cos_o, cos_i, divisor })
    }
}

impl GlossyTransparentLeaf {
    #[inline]
    fn transmitted(&self, o: Vec3, i: Vec3, eta: Real) -> Real {
        let Some(r) = Refraction::between(o, i, eta) else { return 0.0 };
        // What is high is seen from above and hidden from below: Smith's two factors on their own.
        let seen = self.facets.seen_over_cos(o) * self.facets.seen_over_cos(-i);
        let through = 1.0 - reflectance(r.cos_o, r.cos_i, eta);
        r.cos_o * r.cos_i * eta * through * self.facets.density(r.h) * seen / r.divisor
    }

    /// Density of `i` below for a view `o` above.
    #[inline]
    fn pdf_transmitted(&self, o: Vec3, i: Vec3, eta: Real) -> Real {
        let Some(r) = Refraction::between(o, i, eta) else { return 0.0 };
        let through = 1.0 - reflectance(r.cos_o, r.cos_i, eta);
        through * self.facets.pdf_over_dot(o, r.h) * r.cos_o * eta * eta * r.cos_i / r.divisor
    }
}

impl Scatter for GlossyTransparentLeaf {
    #[inline]
    fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        match crossing {
            Crossing::Reflect => {
                let Some(h) = (wo + wi).try_normalized() else { return SampledSpectrum::ZERO };
                let gloss = self.facets.density(h) * self.facets.shared_over_cosines(wo, wi);
                self.eta.map(|eta| gloss * dielectric(wo.dot(h), eta).reflectance)
            }
            Crossing::Down => self.eta.map(|eta| self.transmitted(wo, wi, eta)),
            Crossing::Up => self.eta.map(|eta| self.transmitted(wi, wo, eta)),
        }
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
        match crossing {
            Crossing::Reflect => {
                let Some(h) = (wo + wi).try_normalized() else { return LanePdf::ZERO };
                let drawn = 0.25 * self.facets.pdf_over_dot(wo, h);
                LanePdf(self.eta.map(|eta| drawn * dielectric(wo.dot(h), eta).reflectance).0)
            }
            Crossing::Down => LanePdf(self.eta.map(|eta| self.pdf_transmitted(wo, wi, eta)).0),
            // The same from the other side.
            Crossing::Up => {
                let (o, i) = (turned(wo), turned(wi));
                LanePdf(self.eta.map(|eta| self.pdf_transmitted(o, i, 1.0 / eta)).0)
            }
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        let h = self.facets.sample(wo, [u[0], u[1]]);
        let (cos, eta) = (wo.dot(h), self.eta.hero());
        let at_facet = dielectric(cos, eta);
        // A direction on the wrong side has met a facet that sends it on to another: lost.
        if u[2] < at_facet.reflectance {
            let wi = h * (2.0 * cos) - wo;
            return (wi.z > 0.0).then(|| LocalSample::smooth(wi, Crossing::Reflect));
        }
        let wi = (h * (cos / eta - at_facet.cos_transmitted) - wo / eta).normalized();
        (wi.z < 0.0).then(|| LocalSample::smooth(wi, Crossing::Down))
    }

    #[inline]
    fn eta(&self) -> SampledSpectrum {
        self.eta
    }

    #[inline]
    fn lets_through(&self) -> bool {
        true
    }
}

/// A direction in the frame that has the other side above.
#[inline]
fn turned(d: Vec3) -> Vec3 {
    Vec3::new(d.x, d.y, -d.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_testkit::rng::Rng;

    /// The mean share of light that is not lost, over draws.
    fn kept(exponent: Real, degrees: f64, eta: Real) -> f64 {
        let leaf = GlossyTransparentLeaf {
            facets: Microfacets::of_exponent(exponent),
            eta: SampledSpectrum::splat(eta),
        };
        let (sin, cos) = degrees.to_radians().sin_cos();
        let o = Vec3::new(sin as Real, 0.0, cos as Real);
        let mut rng = Rng::new(3);
        let n = 60_000;
        let weight = |rng: &mut Rng| {
            let u = [0; 3].map(|_| rng.uniform_f32() as Real);
            let Some(s) = leaf.sample(o, u) else { return 0.0 };
            let f = leaf.f(o, s.wi, s.crossing).hero() * s.wi.z.abs();
            // Power: the symmetric f is the radiance's times η, and power is radiance times η².
            let power = if s.crossing == Crossing::Reflect { f } else { f * eta };
            (power / leaf.pdf(o, s.wi, s.crossing).hero()) as f64
        };
        (0..n).map(|_| weight(&mut rng)).sum::<f64>() / f64::from(n)
    }

    /// The rows of figures of the page's tables, of which a first cell is the exponent.
    fn stated(table: usize) -> Vec<Vec<f64>> {
        const PAGE: &str = include_str!("../../../../docs/theory/rough-glass.md");
        let after = PAGE.split("<!-- table -->").nth(table + 1).expect("as many tables");
        let cells = |line: &str| line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
        let rows =
            after.lines().map(cells).skip_while(Vec::is_empty).take_while(|row: &Vec<f64>| !row.is_empty());
        rows.collect()
    }

    /// Says that figures of two decimals for exponents, angles and indices are right, within what rounding and
    /// chance leave (three standard errors are below 0.004).
    #[track_caller]
    fn assert_stated(figures: &[[f64; 4]]) {
        let fault = |&[exponent, degrees, eta, stated]: &[f64; 4]| {
            let kept = kept(exponent as Real, degrees, eta as Real);
            let what = format!("exponent {exponent}, {degrees}°, index {eta}: {kept:.3}, and not {stated}");
            ((kept - stated).abs() > 0.009).then_some(what)
        };
        let faults: Vec<String> = figures.iter().filter_map(fault).collect();
        assert!(faults.is_empty(), "{faults:#?}");
    }

    #[test]
    fn losses_in_glass_are_as_stated() {
        let rows = stated(0);
        assert!(rows.len() == 6, "{rows:?}");
        let views = [(0.0, 1.5), (60.0, 1.5), (80.0, 1.5), (0.0, 1.0 / 1.5), (30.0, 1.0 / 1.5)];
        assert_stated(&figures(&rows, &views));
    }

    #[test]
    fn losses_at_other_indices_are_as_stated() {
        let rows = stated(1);
        assert!(rows.len() == 3, "{rows:?}");
        let both = |eta: f64| [(0.0, eta), (0.0, 1.0 / eta)];
        assert_stated(&figures(&rows, &[1.1, 1.33, 2.0, 2.42].map(both).concat()));
    }

    /// The figures of rows whose columns are views, each an angle and an index.
    fn figures(rows: &[Vec<f64>], views: &[(f64, f64)]) -> Vec<[f64; 4]> {
        let row = |row: &Vec<f64>| {
            assert_eq!(row.len(), 1 + views.len(), "{row:?}");
            let cells = views.iter().zip(&row[1..]);
            cells.map(|(&(degrees, eta), &figure)| [row[0], degrees, eta, figure]).collect::<Vec<_>>()
        };
        rows.iter().flat_map(row).collect()
    }
}
