//! `diffuse_transmitter`: a thin sheet that scatters all light to its other side.

use super::fields::{
    ALBEDO, ALBEDO_TEXTURE, BASE_EMISSION, BASE_EMISSION_PARAMETER, COLOUR_DEPRECATED, EMISSION,
    EMISSION_PARAMETER, EMISSION_TEXTURE, LATER, LAYER,
};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::reflectance::Reflectance;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Field, Group, Kind, Node, Presence, Range};
use indigo_math::warp::{INV_PI, cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// The declaration of `diffuse_transmitter`.
pub static BLOCK: Block = Block::new(
    "diffuse_transmitter",
    "A thin sheet that scatters light to its other side, with a cosine-weighted distribution: the limit \
     of many scatterings in a thin layer. For curtains and lampshades made of single-layer geometry; it \
     has no medium inside. Blend it with `diffuse` to have light scattered back as well.",
    &[
        Field::new(
            "albedo_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "The fraction of light that is let through, at least 0. Values above 1 are silently clamped.",
        ),
        Field::new(
            "colour",
            Kind::Vec3,
            Presence::Optional,
            "The fraction let through as red, green and blue as picked on a screen: each is raised to the \
             power 2.2 and then clamped to [0, 0.9]. Has no effect beside `albedo_spectrum`.",
        )
        .range(Range::AtLeast(0.0))
        .deprecated(COLOUR_DEPRECATED),
        ALBEDO_TEXTURE,
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
.with_parameters(&[BASE_EMISSION_PARAMETER, EMISSION_PARAMETER, ALBEDO])
.with_later(LATER)
.with_example(
    "<diffuse_transmitter>
    <albedo_spectrum>
        <uniform><value>0.4</value></uniform>
    </albedo_spectrum>
</diffuse_transmitter>",
);

/// A sheet that scatters what it does not absorb to its other side.
#[derive(Clone, Debug)]
pub struct DiffuseTransmitter {
    albedo: Reflectance,
}

impl DiffuseTransmitter {
    /// Of a fraction that is let through.
    pub(super) fn new(albedo: Reflectance) -> Self {
        Self { albedo }
    }

    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        Self {
            albedo: Reflectance::build(
                node,
                ["albedo_texture", "albedo_spectrum"],
                Some("colour"),
                resources,
            ),
        }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> DiffuseTransmitterLeaf {
        DiffuseTransmitterLeaf { f: self.albedo.eval(context, uv) * INV_PI }
    }
}

impl SurfaceKind for DiffuseTransmitter {
    fn may_transmit(&self) -> bool {
        true
    }
}

/// Constant BSDF, for directions on different sides of the surface.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmitterLeaf {
    /// Albedo / π.
    f: SampledSpectrum,
}

impl Scatter for DiffuseTransmitterLeaf {
    #[inline]
    fn is_matt(&self) -> bool {
        true
    }

    #[inline]
    fn f(&self, _wo: Vec3, _wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        if crossing == Crossing::Reflect { SampledSpectrum::ZERO } else { self.f }
    }

    #[inline]
    fn pdf(&self, _wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
        let density = if crossing == Crossing::Reflect { 0.0 } else { cosine_hemisphere_pdf(wi.z.abs()) };
        LanePdf::splat(density)
    }

    #[inline]
    fn sample(&self, _wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        let d = cosine_hemisphere(Vec2::new(u[0], u[1]));
        Some(LocalSample::smooth(Vec3::new(d.x, d.y, -d.z), Crossing::Down))
    }

    #[inline]
    fn lets_through(&self) -> bool {
        true
    }
}
