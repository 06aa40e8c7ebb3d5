//! Spectra from linear Rec. 709 triples. What an RGB triple means depends on where it stands:
//!
//! | kind | used for | law | spectrum |
//! |---|---|---|---|
//! | reflectance | albedos, textures | in [0, 1], the same RGB when lit by D65, clamped silently | sigmoid of a quadratic (Jakob & Hanika 2019): [`fit`], [`RgbTable`] |
//! | emission | lights, backgrounds, environment maps | chromaticity of the triple, grey v has the luminance of `uniform` v | scale x sigmoid x D65: [`Emission`] |
//! | coefficient | absorption, scattering, mean cosine | linear in the triple at any magnitude, grey stays flat | basis of Mallett & Yuksel 2019: [`basis`] |

pub mod basis;
mod emission;
pub mod fit;
mod sigmoid;

pub use emission::Emission;
pub use sigmoid::SigmoidCoeffs;

/// Each component limited to [0, 1], NaN to 0.
pub(crate) fn clamp_unit(rgb: [f64; 3]) -> [f64; 3] {
    rgb.map(|v| v.max(0.0).min(1.0))
}
