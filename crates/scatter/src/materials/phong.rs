//! `phong`: a glossy coat over a diffuse ground, or a metal.
//!
//! The gloss is one bounce from `Microfacets` of the exponent's width: f = F D G / (4 cos cos), with the exact
//! reflectance F of the coat's index or of the metal's complex index at each wavelength, or Schlick's. What the
//! facets do not reflect, 1 − E by the directional albedo E of an `AlbedoRow`, goes on:
//!
//! - under a **coat** it reaches the ground and comes back as base · (1 − E(μo)) (1 − E(μi)) / (π (1 − Ē)), so that
//!   the albedo is E + base (1 − E) ≤ 1, and a white ground loses nothing under a coat that is denser than what lies
//!   outside (Kelemen & Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model"). In a medium denser
//!   than the coat E has a kink at the angle of total reflection, and a row that is nowhere below it takes its place: a
//!   white ground loses up to 0.15 % of even light there, and none is made. The ground's reflectance is as it is seen
//!   through the coat, the light thrown back from below the coat included;
//! - on a **metal** E is that of white facets, and the same function, coloured by the further bounces, gives back
//!   what is lost among facets (Kulla & Conty 2017, "Revisiting Physically Based Shading at Imageworks"): a
//!   white metal has albedo 1 at any exponent.
//!
//! Indices of coats and metals are against vacuum. What is reflected depends on their quotient by the index of what lies
//! outside, so that rows are kept for each medium of the scene.
//!
//! `docs/theory/gloss.md` has a table of E.

mod declare;

pub use declare::BLOCK;
pub(super) use declare::FAST_SSS_FIELDS;

use super::fields::disregard_exponents;
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::directional_albedo::{AlbedoRow, LaneRows};
use crate::fresnel::{conductor, dielectric, diffuse_average, schlick};
use crate::immersion::{self, ByIndex};
use crate::media::Medium;
use crate::microfacet::Microfacets;
use crate::reflectance::Reflectance;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Node, codes};
use indigo_diag::{Diagnostic, Sink};
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum, Spectrum};
use indigo_texture::TextureId;

/// A glossy surface.
#[derive(Clone, Debug)]
pub struct Phong {
    kind: Kind,
    gloss: Gloss,
    /// What multiplies the reflectance, at most 1.
    fresnel_scale: Real,
    /// Albedo of the facets, of the coat or of white facets: a row, or one for each width of a map.
    rows: ByIndex<Box<[AlbedoRow]>>,
}

/// What the facets are of.
#[derive(Clone, Debug)]
enum Kind {
    /// A dielectric of an index of refraction over a diffuse ground. Where the ground's reflectance is as it is without
    /// the coat, the part of its light that the coat lets out; it is as it is seen through the coat otherwise.
    Coat { eta: Real, ground: Reflectance, lets_out: Option<ByIndex<Real>> },
    /// A metal of a complex index n + ik, with its average reflectance.
    Measured { n: Spectrum, k: Spectrum, average: ByIndex<Spectrum> },
    /// A metal of a reflectance along its normal, whatever lies outside.
    Schlick { r0: Reflectance },
}

/// How smooth the surface is.
#[derive(Clone, Copy, Debug)]
enum Gloss {
    Uniform(Microfacets),
    /// By a map of exponents.
    Exponents(TextureId),
    /// By a map of widths.
    Widths(TextureId),
}

/// The fields of a metal's reflectivity: its map and its spectrum.
const METAL: [&str; 2] = ["specular_reflectivity_texture", "specular_reflectivity_spectrum"];

/// Rows for maps of exponents or widths, at equal steps of the fourth root of the width from 0 to 1: between two of them albedos are
/// linear to 3e-4 at exponents up to 10,000.
const MAP_ROWS: usize = 97;

impl Phong {
    /// From its element: a measured metal before one of a given reflectivity, and that before a coat.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let coat = ["ior", "diffuse_albedo_spectrum", "diffuse", "albedo_texture"];
        let disregard = |fields: &[&str]| fields.iter().for_each(|field| node.disregard_field(field));
        let measured = node.opt_text("nk_data").is_some_and(|path| !path.value.is_empty());
        let kind = if measured {
            disregard(&coat);
            disregard(&METAL);
            let [n, k] = resources.complex_index(node, "nk_data");
            Kind::Measured { average: ByIndex::new(&[1.0], |_| average_of_metal(&n, &k, 1.0)), n, k }
        } else if METAL.iter().any(|field| node.has(field)) {
            disregard(&coat);
            Kind::Schlick { r0: Reflectance::build(node, METAL, None, resources) }
        } else {
            let ground = ["albedo_texture", "diffuse_albedo_spectrum"];
            let ground = Reflectance::build(node, ground, Some("diffuse"), resources);
            let eta = Real::from_f64(index_of_coat(node, resources.sink()));
            Kind::Coat { eta, ground, lets_out: None }
        };
        let gloss = Gloss::build(node, resources);
        Self::of(kind, gloss, scale_of(node))
    }

    /// A coat of an index, as rough as an element says, over a ground whose reflectance is as it is without the coat.
    pub(super) fn coat(
        node: &Node,
        eta: Real,
        ground: Reflectance,
        resources: &mut dyn MaterialResources,
    ) -> Self {
        let gloss = match node.node("roughness_map") {
            Some(map) => {
                node.disregard_field("roughness");
                Gloss::Widths(resources.shares(map))
            }
            // Smooth where it says nothing.
            None => Gloss::Uniform(Microfacets::of_width(Real::from_f64(
                node.opt_real("roughness").map_or(0.0, |width| width.value),
            ))),
        };
        let scale = scale_of(node);
        let lets_out = ByIndex::new(&[1.0], |outside| let_out(eta / outside, scale));
        Self::of(Kind::Coat { eta, ground, lets_out: Some(lets_out) }, gloss, scale)
    }

    fn of(kind: Kind, gloss: Gloss, fresnel_scale: Real) -> Self {
        Self { rows: kind.rows(gloss, fresnel_scale, &[1.0]), kind, gloss, fresnel_scale }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> PhongLeaf {
        let facets = match self.gloss {
            Gloss::Uniform(facets) => facets,
            Gloss::Exponents(id) => {
                let map = &context.textures[id as usize];
                Microfacets::of_exponent(map.scalar(uv(map.uv_set)))
            }
            Gloss::Widths(id) => {
                let map = &context.textures[id as usize];
                Microfacets::of_width(map.scalar(uv(map.uv_set)))
            }
        };
        let (lambda, outside, scale) = (context.lambda, context.interface.above, self.fresnel_scale);
        let rows = self.rows_at(facets, outside);
        let (fresnel, base) = match &self.kind {
            Kind::Coat { eta, ground, lets_out } => {
                let mut base = ground.eval(context, uv);
                if let Some(lets_out) = lets_out {
                    let (low, high, mix) = lets_out.around(outside);
                    let part = SampledSpectrum::splat(*low) + mix * (high - low);
                    base = base * part / (SampledSpectrum::ONE - base + base * part);
                }
                (Fresnel::Coat { eta: SampledSpectrum::splat(*eta) / outside }, base)
            }
            Kind::Measured { n, k, average } => {
                let (low, high, mix) = average.around(outside);
                let (low, high) = (low.eval(lambda), high.eval(lambda));
                let fresnel = Fresnel::Conductor { n: n.eval(lambda) / outside, k: k.eval(lambda) / outside };
                (fresnel, between((low + (high - low) * mix) * scale, &rows))
            }
            Kind::Schlick { r0 } => {
                let r0 = r0.eval(context, uv);
                // 2 ∫ (1 - μ)⁵ μ dμ = 1/21.
                let average = r0 + (SampledSpectrum::ONE - r0) / 21.0;
                (Fresnel::Schlick { r0 }, between(average * scale, &rows))
            }
        };
        PhongLeaf { facets, fresnel, fresnel_scale: scale, base, rows }
    }

    /// The rows of facets for the indices of what lies outside.
    #[inline]
    fn rows_at(&self, facets: Microfacets, outside: SampledSpectrum) -> LaneRows {
        let (low, high, mix) = self.rows.around(outside);
        let row = |rows: &[AlbedoRow]| match rows {
            [row] => *row,
            rows => AlbedoRow::between(rows, facets.width().sqrt().sqrt()),
        };
        match self.kind {
            // What reflects least lies between both, so that every lane's albedo is below that of one end or the other.
            Kind::Coat { eta, .. } if outside.max_lane() > eta => LaneRows::above(row(low), row(high)),
            _ => LaneRows::between(row(low), row(high), mix),
        }
    }
}

/// What multiplies a reflectance, at most 1.
fn scale_of(node: &Node) -> Real {
    Real::from_f64(node.real("fresnel_scale").min(1.0))
}

/// The part of a diffuse ground's light that a coat of a relative index lets out at once, at most 1; the rest is thrown back to
/// the ground. By reciprocity it is (1 − R̄) / η² for a coat that reflects R̄ of even light from outside.
fn let_out(eta: Real, scale: Real) -> Real {
    let outside = diffuse_average(|cos| dielectric(cos, eta).reflectance * scale);
    Real::from_f64(((1.0 - outside) / (eta * eta).to_f64()).min(1.0))
}

impl SurfaceKind for Phong {
    fn immerse(&mut self, media: &[Medium]) {
        let indices = immersion::indices(media);
        // Air alone is what it was built for.
        if indices.len() == 1 {
            return;
        }
        if let Kind::Measured { n, k, average } = &mut self.kind {
            *average = ByIndex::new(&indices, |outside| average_of_metal(n, k, outside));
        }
        // Those of white facets are the same everywhere.
        if let Kind::Coat { eta, lets_out, .. } = &mut self.kind {
            let (eta, scale) = (*eta, self.fresnel_scale);
            if let Some(lets_out) = lets_out {
                *lets_out = ByIndex::new(&indices, |outside| let_out(eta / outside, scale));
            }
            self.rows = self.kind.rows(self.gloss, self.fresnel_scale, &indices);
        }
    }
}

impl Gloss {
    fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        // What a later version brought counts before what it had from an earlier one.
        disregard_exponents(node, resources.sink());
        if let Some(map) = node.node("roughness_map") {
            return Self::Widths(resources.shares(map));
        }
        if let Some(width) = node.opt_real("roughness") {
            return Self::Uniform(Microfacets::of_width(Real::from_f64(width.value)));
        }
        if let Some(map) = node.node("exponent_map") {
            node.disregard_field("exponent");
            return Self::Exponents(resources.exponents(map));
        }
        // The stand-in is for a phong that lacks both, which has been reported, and for a `fast_sss` that says nothing.
        let exponent = node.opt_real("exponent").map(|n| Microfacets::of_exponent(Real::from_f64(n.value)));
        Self::Uniform(exponent.unwrap_or_else(|| Microfacets::of_width(0.3)))
    }
}

impl Kind {
    /// The rows of the facets' albedo for some indices outside.
    fn rows(&self, gloss: Gloss, fresnel_scale: Real, outside: &[Real]) -> ByIndex<Box<[AlbedoRow]>> {
        let width = |i: usize| (i as Real / (MAP_ROWS - 1) as Real).powi(4);
        ByIndex::new(outside, |outside| match gloss {
            Gloss::Uniform(facets) => vec![self.row(facets, fresnel_scale, outside)].into_boxed_slice(),
            Gloss::Exponents(_) | Gloss::Widths(_) => (0..MAP_ROWS)
                .map(|i| self.row(Microfacets::of_width(width(i)), fresnel_scale, outside))
                .collect(),
        })
    }

    fn row(&self, facets: Microfacets, fresnel_scale: Real, outside: Real) -> AlbedoRow {
        let Self::Coat { eta, .. } = self else {
            // Of white facets: what metals lack is given back in white, and coloured by the way.
            return AlbedoRow::of_facets(facets, |_| 1.0);
        };
        let reflectance = |cos| dielectric(cos, eta / outside).reflectance * fresnel_scale;
        if outside > *eta {
            AlbedoRow::above_facets(facets, critical_cosine(eta / outside), reflectance)
        } else {
            AlbedoRow::of_facets(facets, reflectance)
        }
    }
}

/// The cosine of the angle of total reflection for a relative index below 1; that of indices that are all but equal is
/// kept from 0.
fn critical_cosine(eta: Real) -> Real {
    (1.0 - eta * eta).max(1e-6).sqrt()
}

/// The `ior`, which an empty `nk_data` does not make up for.
fn index_of_coat(node: &Node, sink: &mut Sink) -> f64 {
    if let Some(ior) = node.opt_real("ior") {
        return ior.value;
    }
    if node.has("nk_data") {
        sink.push(
            Diagnostic::error(codes::MISSING_ELEMENT, node.span, "<phong> has no <ior>, and its <nk_data> is empty")
                .expected("expected <ior> inside, the path of a file in <nk_data>, or a <specular_reflectivity_spectrum>"),
        );
    }
    1.5
}

/// The average reflectance of a metal under an index outside, at 5 nm.
fn average_of_metal(n: &Spectrum, k: &Spectrum, outside: Real) -> Spectrum {
    let values: Vec<f64> = (0..=94)
        .map(|i| {
            let lambda = 360.0 + 5.0 * f64::from(i);
            let (n, k) = (Real::from_f64(n.at(lambda)), Real::from_f64(k.at(lambda)));
            diffuse_average(|cos| conductor(cos, n / outside, k / outside))
        })
        .collect();
    Spectrum::regular_tabulated(360e-9, 830e-9, &values).unwrap_or(Spectrum::uniform(1.0))
}

/// The factor of light that is scattered on between facets of an average reflectance: each bounce costs that
/// much, and the share of the row gets out after each (Kulla & Conty 2017, section "Adding color").
#[inline]
fn between(average: SampledSpectrum, rows: &LaneRows) -> SampledSpectrum {
    let out = rows.average();
    SampledSpectrum::from_fn(|lane| {
        let f = average[lane];
        f * f * out[lane] / (1.0 - f * (1.0 - out[lane]))
    })
}

/// How much a facet reflects.
#[derive(Clone, Copy, Debug)]
enum Fresnel {
    Coat { eta: SampledSpectrum },
    Conductor { n: SampledSpectrum, k: SampledSpectrum },
    Schlick { r0: SampledSpectrum },
}

impl Fresnel {
    #[inline]
    fn eval(&self, cos: Real) -> SampledSpectrum {
        match self {
            Self::Coat { eta } => {
                let of = |eta: Real| dielectric(cos, eta).reflectance;
                // Mostly the same at all wavelengths.
                let hero = of(eta.hero());
                eta.map(|lane| if lane == eta.hero() { hero } else { of(lane) })
            }
            Self::Conductor { n, k } => SampledSpectrum::from_fn(|lane| conductor(cos, n[lane], k[lane])),
            Self::Schlick { r0 } => r0.map(|r0| schlick(cos, r0)),
        }
    }
}

/// Facets, and what they do not reflect at once: in a coat it reaches the ground, on a metal other facets.
///
/// Either is drawn with the share that it has of the light seen from `wo`, in each lane by itself.
#[derive(Clone, Copy, Debug)]
pub struct PhongLeaf {
    facets: Microfacets,
    fresnel: Fresnel,
    /// What multiplies the reflectance.
    fresnel_scale: Real,
    /// The share of the light not reflected at once that is scattered in the end.
    base: SampledSpectrum,
    /// Albedo of the facets: of the coat, or of white facets.
    rows: LaneRows,
}

impl PhongLeaf {
    /// What colours the row of the facets' albedo, roughly; the row of a coat has it in.
    #[inline]
    fn tint(&self, cos: Real) -> SampledSpectrum {
        match self.fresnel {
            Fresnel::Coat { .. } => SampledSpectrum::ONE,
            _ => self.fresnel.eval(cos) * self.fresnel_scale,
        }
    }

    /// The share of draws that the facets get.
    #[inline]
    fn gloss_share(&self, wo: Vec3) -> LanePdf {
        let albedo = self.rows.at(wo.z);
        let tint = self.tint(wo.z);
        LanePdf::from_fn(|lane| {
            let (gloss, base) = (tint[lane] * albedo[lane], self.base[lane] * (1.0 - albedo[lane]));
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
        self.fresnel.eval(wo.dot(h)) * (self.fresnel_scale * gloss)
            + self.base * self.rows.complement(wo.z, wi.z)
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
