//! The sensor: from spectral radiance to CIE XYZ. Nowhere else does a spectrum become a colour.

use indigo_math::{Float, Real};
use indigo_spectrum::{LANES, SampledSpectrum, SampledWavelengths, observer};

/// The CIE 1931 observer at the wavelengths of one sample.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    weights: [[Real; LANES]; 3],
}

impl Sensor {
    /// The observer's weights at these wavelengths, divided by their density.
    #[inline]
    pub fn new(wavelengths: &SampledWavelengths) -> Self {
        Self { weights: observer::xyz_weights(wavelengths) }
    }

    /// An unbiased estimate of X, Y and Z in cd/m² of a spectral radiance (W m⁻³ sr⁻¹) known at
    /// these wavelengths: its mean over wavelength samples is 683.002 ∫ L x̄ dλ and so on.
    #[inline]
    pub fn xyz(&self, radiance: &SampledSpectrum) -> [f32; 3] {
        self.weights
            .map(|weights| weights.iter().zip(&radiance.0).map(|(w, l)| w * l).sum::<Real>().to_f64() as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_radiance_has_its_luminance() {
        // A uniform radiance v has 683.002 · 106.85692e-9 · v cd/m², and the equal-energy
        // spectrum's X and Z stand to its Y as 106.86547 and 106.89225 to 106.85692.
        let n = 20_000;
        let mut sum = [0.0f64; 3];
        for i in 0..n {
            let wavelengths = SampledWavelengths::sample((i as Real + 0.5) / n as Real);
            let xyz = Sensor::new(&wavelengths).xyz(&SampledSpectrum([2e9; LANES]));
            for (s, v) in sum.iter_mut().zip(xyz) {
                *s += f64::from(v) / f64::from(n);
            }
        }
        for (got, integral) in sum.into_iter().zip([106.86547, 106.85692, 106.89225]) {
            let want = 2e9 * 683.002e-9 * integral;
            assert!((got / want - 1.0).abs() < 1e-4, "{got} instead of {want}");
        }
    }
}
