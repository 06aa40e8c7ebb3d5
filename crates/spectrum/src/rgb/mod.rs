//! Spectra from linear Rec. 709 triples. What an RGB triple means depends on where it stands:
//!
//! | kind | used for | law | spectrum |
//! |---|---|---|---|
//! | reflectance | albedos, textures | in [0, 1], the same RGB when lit by D65, clamped silently | sigmoid of a quadratic (Jakob & Hanika 2019), scaled where it is dark: [`Reflectance`], [`RgbTable`] |
//! | emission | lights, backgrounds, environment maps | chromaticity of the triple, grey v has the luminance of `uniform` v | scale x sigmoid x D65: [`Emission`] |
//! | coefficient | absorption, scattering, mean cosine | linear in the triple at any magnitude, grey stays flat | basis of Mallett & Yuksel 2019: [`basis`] |

pub mod basis;
mod emission;
pub mod fit;
mod nodes;
mod reflectance;
mod sigmoid;
mod table;

use indigo_math::Float;

pub use emission::Emission;
pub use reflectance::Reflectance;
pub use sigmoid::SigmoidCoeffs;
pub use table::RgbTable;

/// A number limited to [0, 1], NaN to 0.
#[inline(always)]
pub(crate) fn unit<T: Float>(v: T) -> T {
    if v > T::ZERO { v.min(T::ONE) } else { T::ZERO }
}
