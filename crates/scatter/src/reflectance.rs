//! A reflectance: a spectrum, or an image map.

use crate::materials::{MaterialContext, MaterialResources};
use indigo_decl::Node;
use indigo_math::Vec2;
use indigo_spectrum::rgb::RgbTable;
use indigo_spectrum::{SampledSpectrum, Spectrum, read};
use indigo_texture::TextureId;

/// The gamma that colours picked on a screen are freed of, and the largest albedo that they may have then.
const COLOUR_GAMMA: f64 = 2.2;
const COLOUR_LIMIT: f64 = 0.9;

/// The fraction of light that is scattered, by wavelength.
#[derive(Clone, Debug)]
pub enum Reflectance {
    /// The same all over the surface.
    Spectrum(Spectrum),
    /// From an image map: its linear RGB, clamped to [0, 1], upsampled by a table.
    Texture(TextureId, &'static RgbTable),
}

impl Reflectance {
    /// From the elements of a material: the texture first, then the spectrum, then the colour; black
    /// where there is none of them. What is overridden is marked as used.
    pub fn build(
        node: &Node,
        [texture, spectrum]: [&str; 2],
        colour: Option<&str>,
        resources: &mut dyn MaterialResources,
    ) -> Self {
        let map = node.node(texture).map(|t| resources.fractions(t));
        if let Some(id) = map {
            std::iter::once(spectrum).chain(colour).for_each(|field| node.disregard_field(field));
            return Self::Texture(id, RgbTable::get());
        }
        if let Some(s) = node.node(spectrum) {
            if let Some(field) = colour {
                node.disregard_field(field);
            }
            return Self::Spectrum(read::reflectance(s, resources.sink()));
        }
        // tidy: load-time mathematics
        let rgb = colour.and_then(|field| node.opt_vec3(field)).map_or([0.0; 3], |v| v.value);
        let linear = rgb.map(|v| v.powf(COLOUR_GAMMA).min(COLOUR_LIMIT));
        Self::Spectrum(Spectrum::rgb_reflectance(linear))
    }

    /// The values at a point of the surface.
    #[inline]
    pub fn eval(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> SampledSpectrum {
        match self {
            Self::Spectrum(s) => s.eval(context.lambda),
            Self::Texture(id, table) => {
                let texture = &context.textures[*id as usize];
                table.lookup(texture.rgb(uv(texture.uv_set))).eval(context.lambda)
            }
        }
    }
}
