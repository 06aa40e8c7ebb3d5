//! A band: one value inside, another outside.

/// `peak` within `[min_nm, max_nm)`, `base` elsewhere. The edges are exact: nothing is smeared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Start of the band, nm, included.
    pub min_nm: f64,
    /// End of the band, nm, excluded.
    pub max_nm: f64,
    /// Value outside the band.
    pub base: f64,
    /// Value within the band.
    pub peak: f64,
}

impl Peak {
    /// The value at a wavelength in nm.
    #[inline(always)]
    pub fn at(&self, lambda_nm: f64) -> f64 {
        if lambda_nm >= self.min_nm && lambda_nm < self.max_nm { self.peak } else { self.base }
    }
}
