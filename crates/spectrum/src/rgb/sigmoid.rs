//! A smooth curve in three numbers (Jakob & Hanika 2019, "A Low-Dimensional Function Space
//! for Efficient Spectral Upsampling", eq. 1–2).

use indigo_math::{Float, Real};

use crate::grid::{FIRST_NM, LAST_NM};
use crate::lanes::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;

/// S(λ) = 1/2 + x / (2 √(1 + x²)) with x = c0 t² + c1 t + c2 and t = (λ − 360 nm) / 470 nm: always
/// within [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SigmoidCoeffs(pub [Real; 3]);

impl SigmoidCoeffs {
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
        let t = (lambda_nm - FIRST_NM) / (LAST_NM - FIRST_NM);
        sigmoid((c0 * t + c1) * t + c2)
    }
}

/// 1/2 + x / (2 √(1 + x²)), written so that nothing cancels near 0: with r = √(1 + x²) the smaller of S and
/// 1 − S is 1 / (2 r (r + |x|)).
#[inline(always)]
fn sigmoid<T: Float>(x: T) -> T {
    let half = T::from_f64(0.5);
    let root = (T::ONE + x * x).sqrt();
    let small = half / (root * (root + x.abs()));
    if x < T::ZERO { small } else { T::ONE - small }
}
