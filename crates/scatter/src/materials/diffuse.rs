//! `diffuse`: a Lambertian surface.

use super::fields::{
    ALBEDO, ALBEDO_SPECTRUM, ALBEDO_TEXTURE, BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP,
    COLOUR_DEPRECATED, EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE, LATER, LAYER,
};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::reflectance::Reflectance;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Field, Group, Kind, Node, Presence, Range};
use indigo_math::warp::{INV_PI, cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum, Spectrum};

/// The declaration of `diffuse`.
pub static BLOCK: Block = Block::new(
    "diffuse",
    "A Lambertian surface: light leaves it in all directions with the same radiance.",
    &[
        ALBEDO_SPECTRUM,
        Field::new(
            "colour",
            Kind::Vec3,
            Presence::Optional,
            "The albedo as red, green and blue as picked on a screen: each is raised to the power 2.2 and \
             then clamped to [0, 0.9]. Has no effect beside `albedo_spectrum`.",
        )
        .range(Range::AtLeast(0.0))
        .deprecated(COLOUR_DEPRECATED),
        ALBEDO_TEXTURE,
        BUMP_MAP,
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_needs(&[Group::any(&[
    "albedo_spectrum",
    "colour",
    "albedo_texture",
    "base_emission",
    "emission",
    "emission_texture",
])])
.with_parameters(&[BASE_EMISSION_PARAMETER, EMISSION_PARAMETER, ALBEDO, BUMP])
.with_later(LATER)
.with_example(
    "<diffuse>
    <albedo_spectrum>
        <rgb><rgb>0.8 0.4 0.2</rgb><gamma>2.2</gamma></rgb>
    </albedo_spectrum>
</diffuse>",
);

/// A Lambertian surface.
#[derive(Clone, Debug)]
pub struct Diffuse {
    albedo: Reflectance,
}

impl Diffuse {
    /// A surface that scatters nothing.
    pub fn black() -> Self {
        Self { albedo: Reflectance::Spectrum(Spectrum::BLACK) }
    }

    /// A surface that scatters half of the light.
    pub fn grey() -> Self {
        Self { albedo: Reflectance::Spectrum(Spectrum::uniform(0.5)) }
    }

    /// A surface in a colour that is seen at a glance.
    pub fn magenta() -> Self {
        Self { albedo: Reflectance::Spectrum(Spectrum::rgb_reflectance([0.8, 0.0, 0.8])) }
    }

    /// The fraction of light that it scatters.
    pub(super) fn albedo(&self) -> &Reflectance {
        &self.albedo
    }

    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let albedo =
            Reflectance::build(node, ["albedo_texture", "albedo_spectrum"], Some("colour"), resources);
        Self { albedo }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> DiffuseLeaf {
        DiffuseLeaf { f: self.albedo.eval(context, uv) * INV_PI }
    }
}

impl SurfaceKind for Diffuse {}

/// Constant BSDF, for directions on one side of the surface.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseLeaf {
    /// Albedo / π.
    f: SampledSpectrum,
}

impl Scatter for DiffuseLeaf {
    #[inline]
    fn is_matt(&self) -> bool {
        true
    }

    #[inline]
    fn f(&self, _wo: Vec3, _wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        if crossing == Crossing::Reflect { self.f } else { SampledSpectrum::ZERO }
    }

    #[inline]
    fn pdf(&self, _wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
        let density = if crossing == Crossing::Reflect { cosine_hemisphere_pdf(wi.z) } else { 0.0 };
        LanePdf::splat(density)
    }

    #[inline]
    fn sample(&self, _wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        Some(LocalSample::smooth(cosine_hemisphere(Vec2::new(u[0], u[1])), Crossing::Reflect))
    }
}
