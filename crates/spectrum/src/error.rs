//! What can be wrong with the numbers of a spectrum.

/// Why a spectrum cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// A table needs a value at both ends.
    #[error("a tabulated spectrum needs at least 2 values, found {count}")]
    TooFewValues {
        /// How many there are.
        count: usize,
    },
    /// The ends of a table do not span a range.
    #[error("a tabulated spectrum needs ascending wavelengths, found {start_nm} nm to {end_nm} nm")]
    BadRange {
        /// First wavelength, nm.
        start_nm: f64,
        /// Last wavelength, nm.
        end_nm: f64,
    },
    /// A value is NaN, infinite or too large for single precision.
    #[error("value {index} of a tabulated spectrum is out of range: {value}")]
    ValueOutOfRange {
        /// Its position, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
}
