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

mod body;
mod declare;
mod leaf;

pub use declare::BLOCK;
pub(super) use declare::FAST_SSS_FIELDS;
pub use leaf::PhongLeaf;

use super::fields::{disregard_exponents, map_of_widths};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::directional_albedo::{AlbedoRow, LaneRows};
use crate::fresnel::{conductor, dielectric, diffuse_average};
use crate::immersion::{self, ByIndex};
use crate::media::Medium;
use crate::microfacet::Microfacets;
use crate::reflectance::Reflectance;
use crate::thin_film;
use body::Body;
use indigo_decl::{Node, codes};
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Float, Real, Vec2};
use indigo_spectrum::{SampledSpectrum, Spectrum};
use indigo_texture::TextureId;
use leaf::{Fresnel, scaled};

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
    /// the coat, what lies between them; it is as it is seen through the coat otherwise.
    Coat { eta: Real, ground: Reflectance, body: Option<Body> },
    /// A metal of a complex index n + ik, with its average reflectance, bare or under a film.
    Measured { n: Spectrum, k: Spectrum, film: Option<Film>, average: ByIndex<Spectrum> },
    /// A metal of a reflectance along its normal, whatever lies outside.
    Schlick { r0: Reflectance },
}

/// A clear film that is thin enough for light to interfere in it.
#[derive(Clone, Copy, Debug)]
struct Film {
    /// Its index of refraction against vacuum.
    index: Real,
    /// m.
    thickness: Real,
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
        let kind = if is_measured(node) {
            disregard(&coat);
            disregard(&METAL);
            let [n, k] = resources.complex_index(node, "nk_data");
            Kind::Measured {
                average: ByIndex::new(&[1.0], |_| average_of_metal(&n, &k, None, 1.0)),
                n,
                k,
                film: None,
            }
        } else if METAL.iter().any(|field| node.has(field)) {
            disregard(&coat);
            Kind::Schlick { r0: Reflectance::build(node, METAL, None, resources) }
        } else {
            let ground = ["albedo_texture", "diffuse_albedo_spectrum"];
            let ground = Reflectance::build(node, ground, Some("diffuse"), resources);
            let eta = Real::from_f64(index_of_coat(node, resources.sink()));
            Kind::Coat { eta, ground, body: None }
        };
        let gloss = Gloss::build(node, resources);
        Self::of(kind, gloss, scale_of(node))
    }

    /// A coat of an index, as rough as an element says, over a ground whose reflectance is as it is without the coat; with the
    /// optical depth of one that absorbs.
    pub(super) fn coat(
        node: &Node,
        eta: Real,
        depth: Option<Spectrum>,
        ground: Reflectance,
        resources: &mut dyn MaterialResources,
    ) -> Self {
        let gloss = match map_of_widths(node, resources.sink()) {
            Some(map) => Gloss::Widths(resources.shares(map)),
            // Smooth where it says nothing.
            None => Gloss::Uniform(Microfacets::of_width(Real::from_f64(
                node.opt_real("roughness").map_or(0.0, |width| width.value),
            ))),
        };
        let scale = scale_of(node);
        let body = Some(Body::new(eta, scale, depth, &[1.0]));
        Self::of(Kind::Coat { eta, ground, body }, gloss, scale)
    }

    /// The same measured metal under the film of an element, which follows its facets and scales what they reflect; `None` if it is not
    /// measured.
    pub(super) fn under_film(&self, node: &Node) -> Option<Self> {
        let Kind::Measured { n, k, .. } = &self.kind else { return None };
        let [index, thickness] = ["ior", "thickness"].map(|field| Real::from_f64(node.real(field)));
        let film = Film { index, thickness };
        let average = ByIndex::new(&[1.0], |_| average_of_metal(n, k, Some(film), 1.0));
        let kind = Kind::Measured { n: n.clone(), k: k.clone(), film: Some(film), average };
        Some(Self { kind, fresnel_scale: self.fresnel_scale * scale_of(node), ..self.clone() })
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
        let mut veil = SampledSpectrum::ZERO;
        let (fresnel, base) = match &self.kind {
            Kind::Coat { eta, ground, body } => {
                let mut base = ground.eval(context, uv);
                if let Some(body) = body {
                    (base, veil) = body.over(base, outside, lambda);
                }
                (Fresnel::Coat { eta: SampledSpectrum::splat(*eta) / outside }, base)
            }
            Kind::Measured { n, k, film, average } => {
                let (low, high, mix) = average.around(outside);
                let (low, high) = (low.eval(lambda), high.eval(lambda));
                let average = low + (high - low) * mix;
                let (n, k) = (n.eval(lambda) / outside, k.eval(lambda) / outside);
                let fresnel = match film {
                    None => Fresnel::Conductor { n, k },
                    Some(film) => Fresnel::Film {
                        n,
                        k,
                        film: SampledSpectrum::splat(film.index) / outside,
                        turns: SampledSpectrum::from_fn(|lane| {
                            film.turns(outside[lane], lambda.lambda[lane])
                        }),
                    },
                };
                (fresnel, between(average * scale, &rows))
            }
            Kind::Schlick { r0 } => {
                let r0 = r0.eval(context, uv);
                // 2 ∫ (1 - μ)⁵ μ dμ = 1/21.
                let average = r0 + (SampledSpectrum::ONE - r0) / 21.0;
                (Fresnel::Schlick { r0 }, between(average * scale, &rows))
            }
        };
        PhongLeaf { facets, fresnel, fresnel_scale: scale, base, veil, rows }
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

/// Whether an element is of a metal of measured indices.
pub(super) fn is_measured(node: &Node) -> bool {
    node.opt_text("nk_data").is_some_and(|path| !path.value.is_empty())
}

/// What multiplies a reflectance, at most 1.
fn scale_of(node: &Node) -> Real {
    Real::from_f64(node.real("fresnel_scale").min(1.0))
}

impl Film {
    /// Twice its thickness in wavelengths under an index outside, for a wavelength in vacuum in nm.
    #[inline]
    fn turns(self, outside: Real, nm: Real) -> Real {
        2e9 * self.thickness * outside / nm
    }
}

impl SurfaceKind for Phong {
    fn immerse(&mut self, media: &[Medium]) {
        let indices = immersion::indices(media);
        // Air alone is what it was built for.
        if indices.len() == 1 {
            return;
        }
        if let Kind::Measured { n, k, film, average } = &mut self.kind {
            *average = ByIndex::new(&indices, |outside| average_of_metal(n, k, *film, outside));
        }
        // Those of white facets are the same everywhere.
        if let Kind::Coat { eta, body, .. } = &mut self.kind {
            if let Some(body) = body {
                *body = body.immersed(*eta, self.fresnel_scale, &indices);
            }
            self.rows = self.kind.rows(self.gloss, self.fresnel_scale, &indices);
        }
    }
}

impl Gloss {
    fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        // What a later version brought counts before what it had from an earlier one.
        disregard_exponents(node, resources.sink());
        if let Some(map) = map_of_widths(node, resources.sink()) {
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
        let reflectance = |cos| scaled(dielectric(cos, eta / outside), fresnel_scale);
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
fn average_of_metal(n: &Spectrum, k: &Spectrum, film: Option<Film>, outside: Real) -> Spectrum {
    let values: Vec<f64> = (0..=94)
        .map(|i| {
            let lambda = 360.0 + 5.0 * f64::from(i);
            let metal = [n, k].map(|part| Real::from_f64(part.at(lambda)) / outside);
            diffuse_average(|cos| match film {
                None => conductor(cos, metal[0], metal[1]),
                Some(film) => match film.turns(outside, Real::from_f64(lambda)) {
                    // Fringes that steps of 5 nm follow.
                    turns if turns < 10.0 => thin_film::reflectance(cos, film.index / outside, metal, turns),
                    _ => thin_film::mean_reflectance(cos, film.index / outside, metal),
                },
            })
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
