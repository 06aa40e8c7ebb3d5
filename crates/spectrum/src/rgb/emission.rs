//! Emission of an RGB triple: D65 coloured by a reflectance.

use indigo_math::{Float, Real};

use super::{Reflectance, SigmoidCoeffs};
use crate::grid;
use crate::illuminant;
use crate::lanes::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;

/// e(λ) = scale · S(λ) · D65(λ), with D65 scaled to the luminance of the uniform spectrum 1 and
/// scale twice the largest component: S has the triple's colour at a largest component of 1/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// The shape that gives the colour.
    pub coeffs: SigmoidCoeffs,
    /// What multiplies it, W m^-3 sr^-1.
    pub scale: Real,
}

impl Emission {
    /// Nothing.
    pub const BLACK: Self = Self { coeffs: SigmoidCoeffs([0.0; 3]), scale: 0.0 };

    /// The emission of this linear Rec. 709 triple, W m^-3 sr^-1. Negative components and NaN count
    /// as 0; a triple with an infinity radiates nothing.
    pub fn fit(rgb: [f64; 3]) -> Self {
        let rgb = rgb.map(|v| v.max(0.0));
        let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        if scale > 0.0 && scale.is_finite() {
            let shape = Reflectance::fit(rgb.map(|v| v / scale));
            Self { coeffs: shape.coeffs, scale: scale as Real }
        } else {
            Self::BLACK
        }
    }

    /// The radiance at these wavelengths, W m^-3 sr^-1.
    #[inline]
    pub fn eval(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.coeffs.eval(wavelengths) * illuminant::d65(wavelengths) * self.scale
    }

    /// The radiance at the grid point nearest to a wavelength in nm, in double precision.
    pub(crate) fn at(&self, lambda_nm: f64) -> f64 {
        let nearest = (lambda_nm - grid::FIRST_NM).round().clamp(0.0, (grid::COUNT - 1) as f64) as usize;
        self.coeffs.at(lambda_nm) * illuminant::D65[nearest] * self.scale.to_f64()
    }
}
