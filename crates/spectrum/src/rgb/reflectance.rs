//! The reflectance of an RGB triple.

use indigo_math::{Float, Real};

use super::{SigmoidCoeffs, fit, unit};
use crate::lanes::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;

/// A smooth reflectance within [0, 1]: scale · S(λ), or 1 − |scale| · S(λ) where the scale is
/// negative (zero has a sign too: -0 is white), with a sigmoid S.
///
/// A sigmoid alone can only be dark and colourful, or bright and coloured, with a spike that
/// reaches 1 or a notch that reaches 0. So a colour whose largest component v is under 1/2 is 2v
/// times the sigmoid of one whose largest is 1/2, and darkening a colour darkens its spectrum in
/// proportion; and a colour whose smallest component is over 1/2 is the complement of a dark one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectance {
    /// The sigmoid.
    pub coeffs: SigmoidCoeffs,
    /// What multiplies it, within [-1, 1].
    pub scale: Real,
}

impl Reflectance {
    /// The flat reflectance `v`, clamped to [0, 1].
    #[inline]
    pub fn grey(v: Real) -> Self {
        // With coefficients of zero the sigmoid is 1/2.
        let v = unit(v);
        let scale = if v <= 0.5 { 2.0 * v } else { -2.0 * (1.0 - v) };
        Self { coeffs: SigmoidCoeffs([0.0; 3]), scale }
    }

    /// The reflectance whose colour under D65 is this linear Rec. 709 triple, each component
    /// clamped to [0, 1], NaN to 0. A grey is flat. The colour returns within 1e-6 inside the gamut and
    /// within 5e-4 on its surface, where no bounded sigmoid meets pure green exactly.
    pub fn fit(rgb: [f64; 3]) -> Self {
        match Split::of(rgb.map(unit)) {
            Split::Grey(v) => Self::grey(v as Real),
            Split::Colour { target, scale } => Self { coeffs: fit::sigmoid(target), scale: scale as Real },
        }
    }

    /// The values at these wavelengths.
    #[inline(always)]
    pub fn eval(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.coeffs.eval(wavelengths) * self.scale + self.base()
    }

    /// The value at a wavelength in nm, in double precision.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        self.coeffs.at(lambda_nm) * self.scale.to_f64() + self.base().to_f64()
    }

    /// What the scaled sigmoid is added to.
    #[inline(always)]
    fn base(&self) -> Real {
        if self.scale.is_sign_negative() { 1.0 } else { 0.0 }
    }
}

/// How a colour with components in [0, 1] is made of a sigmoid.
pub(super) enum Split<T> {
    /// No sigmoid is needed.
    Grey(T),
    /// The scaled sigmoid of another colour, whose largest component is at least 1/2.
    Colour { target: [T; 3], scale: T },
}

impl<T: Float> Split<T> {
    #[inline(always)]
    pub(super) fn of(rgb: [T; 3]) -> Self {
        let most = rgb[0].max(rgb[1]).max(rgb[2]);
        let least = rgb[0].min(rgb[1]).min(rgb[2]);
        let two = T::ONE + T::ONE;
        if most <= least {
            Self::Grey(most)
        } else if most + least <= T::ONE {
            let scale = (two * most).min(T::ONE);
            Self::Colour { target: rgb.map(|v| v / scale), scale }
        } else {
            let scale = (two * (T::ONE - least)).min(T::ONE);
            Self::Colour { target: rgb.map(|v| (T::ONE - v) / scale), scale: -scale }
        }
    }
}
