//! Photometric scales of lights: from watts, lumens and candelas to spectral radiance.

use std::f64::consts::PI;

use crate::kinds::Spectrum;

/// Luminance, cd/m^2, of a one-sided Lambertian emitter of this area (m^2) and luminous flux (lm):
/// flux / (π area).
pub fn lambertian_luminance(flux_lm: f64, area_m2: f64) -> f64 {
    flux_lm / (PI * area_m2)
}

/// The spectrum scaled to a luminance in cd/m^2, its shape kept; `None` where it has no luminance
/// to scale, or the scale is not finite.
pub fn with_luminance(spectrum: &Spectrum, luminance: f64) -> Option<Spectrum> {
    let scale = luminance / spectrum.luminance();
    scale.is_finite().then(|| spectrum.scaled(scale))
}

/// The spectrum scaled so that a one-sided Lambertian emitter of this area (m^2) has the flux of a
/// lamp that draws `power_w` watts at an overall luminous efficacy in lm/W. `None` where
/// that cannot be: no luminance to scale, or no area.
pub fn with_efficacy(spectrum: &Spectrum, power_w: f64, efficacy: f64, area_m2: f64) -> Option<Spectrum> {
    with_luminance(spectrum, lambertian_luminance(power_w * efficacy, area_m2))
}

/// Luminous efficacy of the radiation, lm/W, within 360 to 830 nm; `None` where it carries no power.
pub fn efficacy_of_radiation(spectrum: &Spectrum) -> Option<f64> {
    let power = spectrum.integral_nm() * 1e-9;
    (power > 0.0).then(|| spectrum.luminance() / power)
}
