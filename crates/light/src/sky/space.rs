//! Sunlight outside the atmosphere: ASTM G173-03, the mean over the year.

use super::SunDisc;
use indigo_spectrum::Spectrum;

/// Irradiance across the light, W m^-2 nm^-1, from 360 to 830 nm at 1 nm.
static IRRADIANCE: [f64; 471] = include!("../../data/astm_g173_extraterrestrial_1nm.in");

/// The sun's disc, even over a solid angle in sr.
pub fn sun(solid_angle: f64) -> SunDisc {
    let values: Vec<f64> = IRRADIANCE.iter().map(|e| e * 1e9 / solid_angle).collect();
    let radiance = Spectrum::regular_tabulated(360e-9, 830e-9, &values)
        .unwrap_or_else(|e| unreachable!("numbers of the table: {e}"));
    SunDisc { radiance, limb: None }
}
