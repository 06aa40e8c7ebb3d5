//! The basis of Mallett & Yuksel 2019 ("Spectral Primary Decomposition for Rendering with sRGB
//! Reflectance"): three smooth, non-negative curves that sum to one.

use indigo_math::Real;

use crate::kinds::Table;
use crate::lanes::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;

/// Number of published values.
const COUNT: usize = 81;
/// Wavelength of the first, nm.
const FIRST_NM: f64 = 380.0;
/// Step between them, nm.
const STEP_NM: f64 = 5.0;

/// Values of the three curves, red, green, blue.
static BASIS: [[f64; 3]; COUNT] = include!("../../data/mallett_yuksel_2019_5nm.in");

/// r R(λ) + g G(λ) + b B(λ), as a table; the values at 380 and 780 nm are held beyond.
pub(crate) fn table(rgb: [f64; 3]) -> Table {
    let mix = |curves: &[f64; 3]| curves[0] * rgb[0] + curves[1] * rgb[1] + curves[2] * rgb[2];
    Table::of(FIRST_NM, STEP_NM, BASIS.iter().map(mix))
}

/// The red, green and blue curve at these wavelengths: a coefficient from a texture is the sum of
/// its components times these.
#[inline]
pub fn curves(wavelengths: &SampledWavelengths) -> [SampledSpectrum; 3] {
    let mut curves = [SampledSpectrum::ZERO; 3];
    for (lane, lambda) in wavelengths.lambda.into_iter().enumerate() {
        let x = ((lambda - FIRST_NM as Real) / STEP_NM as Real).max(0.0).min((COUNT - 1) as Real);
        let cell = (x as usize).min(COUNT - 2);
        let s = x - cell as Real;
        for (c, curve) in curves.iter_mut().enumerate() {
            let (a, b) = (BASIS[cell][c] as Real, BASIS[cell + 1][c] as Real);
            curve[lane] = a + s * (b - a);
        }
    }
    curves
}
