//! `phong`: a glossy coat over a diffuse ground, or a metal.
//!
//! The gloss is one bounce from `Microfacets` of the exponent's width: f = F D G / (4 cos cos), with the exact
//! reflectance F of the coat's index or of the metal's complex index at each wavelength, or Schlick's. What the
//! facets do not reflect, 1 − E by the directional albedo E of an `AlbedoRow`, goes on:
//!
//! - under a **coat** it reaches the ground and comes back as base · (1 − E(μo)) (1 − E(μi)) / (π (1 − Ē)), so that
//!   the albedo is E + base (1 − E) ≤ 1, and a white ground under any coat loses nothing (Kelemen & Szirmay-Kalos
//!   2001, "A Microfacet Based Coupled Specular-Matte BRDF Model"). The ground's reflectance is as it is seen
//!   through the coat, the light thrown back from below the coat included;
//! - on a **metal** E is that of white facets, and the same function, coloured by the further bounces, gives back
//!   what is lost among facets (Kulla & Conty 2017, "Revisiting Physically Based Shading at Imageworks"): a
//!   white metal has albedo 1 at any exponent.

use super::fields::{ALBEDO_TEXTURE, BUMP_MAP, COLOUR_DEPRECATED, LATER, bump_map};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::directional_albedo::AlbedoRow;
use crate::fresnel::{conductor, dielectric, diffuse_average, schlick};
use crate::microfacet::Microfacets;
use crate::reflectance::Reflectance;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Field, Group, Kind as FieldKind, Node, Presence, Range, codes};
use indigo_diag::{Diagnostic, Sink};
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::{LanePdf, SampledSpectrum, Spectrum, read};
use indigo_texture::TextureId;
use indigo_texture::declare::TEXTURE;

/// The declaration of `phong`.
pub static BLOCK: Block = Block::new(
    "phong",
    "A glossy surface with a Phong lobe: by default a dielectric coat of index `ior` over a diffuse \
     ground. With `nk_data` it is a metal of measured complex index; with \
     `specular_reflectivity_spectrum` a metal of the given reflectivity. Where several are given, \
     `nk_data` counts before `specular_reflectivity_spectrum`, and that before `ior` and the diffuse ground.",
    &[
        Field::new(
            "diffuse_albedo_spectrum",
            FieldKind::OneOf(&SPECTRUM),
            Presence::Optional,
            "The reflectance of the diffuse ground, at least 0; black where it is missing. Values above 1 are \
             silently clamped. Has no effect on a metal.",
        ),
        Field::new(
            "diffuse",
            FieldKind::Vec3,
            Presence::Optional,
            "The reflectance of the ground as red, green and blue as picked on a screen: each is raised to \
             the power 2.2 and then clamped to [0, 0.9]. Has no effect beside `diffuse_albedo_spectrum`.",
        )
        .deprecated(COLOUR_DEPRECATED),
        Field::new(
            "ior",
            FieldKind::Real,
            Presence::Optional,
            "Index of refraction of the coat. Needed unless the surface is a metal.",
        )
        .range(Range::AtLeast(1.0)),
        Field::new(
            "exponent",
            FieldKind::Real,
            Presence::Optional,
            "Exponent of the Phong lobe of the normals of small facets, from about 1 (broad highlights) to \
             10000 and more (nearly a mirror). Needed unless there is an `exponent_map`.",
        )
        .range(Range::Above(0.0)),
        Field::new(
            "nk_data",
            FieldKind::Path,
            Presence::Optional,
            "A file of measured complex indices of refraction, such as `nkdata/au.nk`, beside the scene or in \
             the resource directory. Empty means none.",
        ),
        Field::new(
            "specular_reflectivity_spectrum",
            FieldKind::OneOf(&SPECTRUM),
            Presence::Optional,
            "Reflectivity of a metal at normal incidence; towards grazing angles it rises to 1 by Schlick's \
             law. At least 0; values above 1 are silently clamped.",
        ),
        ALBEDO_TEXTURE,
        BUMP_MAP,
        Field::new(
            "exponent_map",
            FieldKind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that takes the place of the exponent.",
        ),
    ],
)
.with_needs(&[
    Group::any(&["ior", "nk_data", "specular_reflectivity_spectrum"]),
    Group::any(&["exponent", "exponent_map"]),
])
.with_later(LATER)
.with_example(
    "<phong>
    <exponent>300</exponent>
    <specular_reflectivity_spectrum>
        <rgb><rgb>0.8 0.3 0.6</rgb><gamma>1</gamma></rgb>
    </specular_reflectivity_spectrum>
</phong>",
);

/// A glossy surface.
#[derive(Clone, Debug)]
pub struct Phong {
    kind: Kind,
    gloss: Gloss,
    bump: Option<TextureId>,
}

/// What the facets are of.
#[derive(Clone, Debug)]
enum Kind {
    /// A dielectric of an index of refraction over a diffuse ground.
    Coat { eta: Real, ground: Reflectance },
    /// A metal of a complex index n + ik, with its average reflectance.
    Measured { n: Spectrum, k: Spectrum, average: Spectrum },
    /// A metal of a reflectance along its normal.
    Schlick { r0: Spectrum },
}

/// How smooth the surface is, with the albedo of its facets.
#[derive(Clone, Debug)]
enum Gloss {
    Uniform(Microfacets, AlbedoRow),
    /// By a map of exponents; rows for widths at equal steps of their fourth root from 0 to 1.
    Map(TextureId, Box<[AlbedoRow]>),
}

/// Rows for exponent maps: between two of them albedos are linear to 3e-4 at exponents up to 10,000.
const MAP_ROWS: usize = 97;

impl Phong {
    /// From its element: a measured metal before one of a given reflectivity, and that before a coat.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let coat = ["ior", "diffuse_albedo_spectrum", "diffuse", "albedo_texture"];
        let disregard = |fields: &[&str]| fields.iter().for_each(|field| node.disregard_field(field));
        let measured = node.opt_text("nk_data").is_some_and(|path| !path.value.is_empty());
        let kind = if measured {
            disregard(&coat);
            disregard(&["specular_reflectivity_spectrum"]);
            let [n, k] = resources.complex_index(node, "nk_data");
            Kind::Measured { average: average_of_metal(&n, &k), n, k }
        } else if let Some(spectrum) = node.node("specular_reflectivity_spectrum") {
            disregard(&coat);
            Kind::Schlick { r0: read::reflectance(spectrum, resources.sink()) }
        } else {
            let ground = ["albedo_texture", "diffuse_albedo_spectrum"];
            let ground = Reflectance::build(node, ground, Some("diffuse"), resources);
            Kind::Coat { eta: Real::from_f64(index_of_coat(node, resources.sink())), ground }
        };
        let gloss = kind.gloss(node, resources);
        Self { kind, gloss, bump: bump_map(node, resources) }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> PhongLeaf {
        let (facets, row) = match &self.gloss {
            Gloss::Uniform(facets, row) => (*facets, *row),
            Gloss::Map(id, rows) => {
                let map = &context.textures[*id as usize];
                let facets = Microfacets::of_exponent(map.scalar(uv(map.uv_set)));
                (facets, AlbedoRow::between(rows, facets.width().sqrt().sqrt()))
            }
        };
        let lambda = context.lambda;
        let (fresnel, base) = match &self.kind {
            Kind::Coat { eta, ground } => (Fresnel::Coat { eta: *eta }, ground.eval(context, uv)),
            Kind::Measured { n, k, average } => (
                Fresnel::Conductor { n: n.eval(lambda), k: k.eval(lambda) },
                between(average.eval(lambda), &row),
            ),
            Kind::Schlick { r0 } => {
                let r0 = r0.eval(lambda);
                // 2 ∫ (1 - μ)⁵ μ dμ = 1/21.
                (Fresnel::Schlick { r0 }, between(r0 + (SampledSpectrum::ONE - r0) / 21.0, &row))
            }
        };
        PhongLeaf { facets, fresnel, base, row }
    }
}

impl SurfaceKind for Phong {
    fn bump_map(&self) -> Option<TextureId> {
        self.bump
    }
}

impl Kind {
    fn gloss(&self, node: &Node, resources: &mut dyn MaterialResources) -> Gloss {
        let row = |width: Real| {
            AlbedoRow::of_facets(Microfacets::of_width(width), |cos| match self {
                Self::Coat { eta, .. } => dielectric(cos, *eta).reflectance,
                // Of white facets: what metals lack is given back in white, and coloured by the way.
                _ => 1.0,
            })
        };
        if let Some(map) = node.node("exponent_map") {
            node.disregard_field("exponent");
            let width = |i: usize| (i as Real / (MAP_ROWS - 1) as Real).powi(4);
            return Gloss::Map(resources.texture(map), (0..MAP_ROWS).map(|i| row(width(i))).collect());
        }
        // The stand-in is for scenes that lack both, which has been reported.
        let exponent = node.opt_real("exponent").map_or(1.0, |n| n.value);
        let facets = Microfacets::of_exponent(Real::from_f64(exponent));
        Gloss::Uniform(facets, row(facets.width()))
    }
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

/// The average reflectance of a metal, at 5 nm.
fn average_of_metal(n: &Spectrum, k: &Spectrum) -> Spectrum {
    let values: Vec<f64> = (0..=94)
        .map(|i| {
            let lambda = 360.0 + 5.0 * f64::from(i);
            let (n, k) = (Real::from_f64(n.at(lambda)), Real::from_f64(k.at(lambda)));
            diffuse_average(|cos| conductor(cos, n, k))
        })
        .collect();
    Spectrum::regular_tabulated(360e-9, 830e-9, &values).unwrap_or(Spectrum::uniform(1.0))
}

/// The factor of light that is scattered on between facets of an average reflectance: each bounce costs that
/// much, and the share of the row gets out after each (Kulla & Conty 2017, section "Adding color").
#[inline]
fn between(average: SampledSpectrum, row: &AlbedoRow) -> SampledSpectrum {
    average.map(|f| f * f * row.average() / (1.0 - f * (1.0 - row.average())))
}

/// How much a facet reflects.
#[derive(Clone, Copy, Debug)]
enum Fresnel {
    Coat { eta: Real },
    Conductor { n: SampledSpectrum, k: SampledSpectrum },
    Schlick { r0: SampledSpectrum },
}

impl Fresnel {
    #[inline]
    fn eval(&self, cos: Real) -> SampledSpectrum {
        match self {
            Self::Coat { eta } => SampledSpectrum::splat(dielectric(cos, *eta).reflectance),
            Self::Conductor { n, k } => SampledSpectrum::from_fn(|lane| conductor(cos, n[lane], k[lane])),
            Self::Schlick { r0 } => r0.map(|r0| schlick(cos, r0)),
        }
    }

    /// What colours the row of the facets' albedo, roughly; the row of a coat has it in.
    #[inline]
    fn tint(&self, cos: Real) -> SampledSpectrum {
        match self {
            Self::Coat { .. } => SampledSpectrum::ONE,
            _ => self.eval(cos),
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
    /// The share of the light not reflected at once that is scattered in the end.
    base: SampledSpectrum,
    /// Albedo of the facets: of the coat, or of white facets.
    row: AlbedoRow,
}

impl PhongLeaf {
    /// The share of draws that the facets get.
    #[inline]
    fn gloss_share(&self, wo: Vec3) -> LanePdf {
        let albedo = self.row.at(wo.z);
        let tint = self.fresnel.tint(wo.z);
        LanePdf::from_fn(|lane| {
            let (gloss, base) = (tint[lane] * albedo, self.base[lane] * (1.0 - albedo));
            if base > 0.0 { gloss / (gloss + base) } else { 1.0 }
        })
    }
}

impl Scatter for PhongLeaf {
    #[inline]
    fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        let Some(h) = (wo + wi).try_normalized().filter(|_| crossing == Crossing::Reflect) else {
            return SampledSpectrum::ZERO;
        };
        let gloss = self.facets.density(h) * self.facets.shared_over_cosines(wo, wi);
        self.fresnel.eval(wo.dot(h)) * gloss + self.base * self.row.complement(wo.z, wi.z)
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
