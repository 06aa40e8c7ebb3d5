//! A smooth reflectance in three numbers (Jakob & Hanika 2019, "A Low-Dimensional Function Space
//! for Efficient Spectral Upsampling", eq. 1–2).

use indigo_math::{Float, Real};

use crate::grid::{FIRST_NM, LAST_NM};
use crate::lanes::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;

/// S(λ) = 1/2 + x / (2 √(1 + x²)) with x = c0 t² + c1 t + c2 and t = (λ − 360 nm) / 470 nm: always
/// within [0, 1]. `c2` is infinite, with the others 0, for black and for white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SigmoidCoeffs(pub [Real; 3]);

impl SigmoidCoeffs {
    /// The flat reflectance `v`, clamped to [0, 1].
    #[inline]
    pub fn grey(v: Real) -> Self {
        let v = v.max(0.0).min(1.0);
        Self([0.0, 0.0, (v - 0.5) / (v * (1.0 - v)).sqrt()])
    }

    /// The values at these wavelengths.
    #[inline(always)]
    pub fn eval(&self, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let [c0, c1, c2] = self.0;
        SampledSpectrum(wavelengths.lambda.map(|lambda| {
            let t = (lambda - FIRST_NM as Real) * (1.0 / (LAST_NM - FIRST_NM)) as Real;
            sigmoid((c0 * t + c1) * t + c2)
        }))
    }

    /// The value at a wavelength in nm, in double precision.
    pub fn at(&self, lambda_nm: f64) -> f64 {
        let [c0, c1, c2] = self.0.map(Float::to_f64);
        let t = position(lambda_nm);
        sigmoid((c0 * t + c1) * t + c2)
    }
}

/// Where a wavelength in nm lies in the visible range: 0 at 360 nm, 1 at 830 nm.
pub(crate) fn position(lambda_nm: f64) -> f64 {
    (lambda_nm - FIRST_NM) / (LAST_NM - FIRST_NM)
}

/// 1/2 + x / (2 √(1 + x²)), written so that nothing cancels near 0 and that infinities are fine:
/// with r = √(1 + x²) the smaller of S and 1 − S is 1 / (2 r (r + |x|)).
#[inline(always)]
fn sigmoid<T: Float>(x: T) -> T {
    let half = T::from_f64(0.5);
    let root = (T::ONE + x * x).sqrt();
    let small = half / (root * (root + x.abs()));
    if x < T::ZERO { small } else { T::ONE - small }
}
