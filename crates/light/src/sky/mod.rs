//! Models of the clear sky and of the sun seen through it.
//!
//! | model | sky | sun |
//! |---|---|---|
//! | [`hosek`] | L. Hosek and A. Wilkie 2012 | the same 2013, darker towards its limb |
//! | [`preetham`] | A. J. Preetham, P. Shirley and B. Smits 1999 | the same, an even disc |
//! | [`space`] | black | sunlight as it reaches the atmosphere (ASTM G173), an even disc |
//!
//! All are of radiance in W m^-3 sr^-1; turbidity, the haze of the air, has no unit.

pub mod hosek;
pub mod preetham;
pub mod space;

use indigo_spectrum::Spectrum;

/// What the sun's disc sends.
#[derive(Clone, Debug)]
pub struct SunDisc {
    /// Radiance of the middle of the disc, W m^-3 sr^-1.
    pub radiance: Spectrum,
    /// Coefficients of its darkening towards the limb.
    pub limb: Option<&'static hosek::Limb>,
}

impl SunDisc {
    /// The same with that many times the radiance.
    #[must_use]
    pub fn scaled(self, gain: f64) -> Self {
        Self { radiance: self.radiance.scaled(gain), ..self }
    }
}

/// A little-endian table of single-precision numbers that the program carries.
fn number(bytes: &[u8], i: usize) -> f64 {
    let at = 4 * i;
    f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}
