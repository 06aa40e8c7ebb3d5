//! What can go wrong between film and file.

/// Why a picture could not be made, written or read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImagingError {
    /// A white point that no light could have: a chromaticity outside the human gamut's range, or
    /// one to which a cone does not answer.
    #[error("({x}, {y}) is not the chromaticity of a white")]
    NotAWhite {
        /// CIE 1931 x.
        x: f64,
        /// CIE 1931 y.
        y: f64,
    },
    /// A region that is empty or does not lie within the picture.
    #[error("the region x {x1}..{x2}, y {y1}..{y2} is empty or leaves the {width} x {height} picture")]
    Region {
        /// First column.
        x1: u32,
        /// First row.
        y1: u32,
        /// Column after the last.
        x2: u32,
        /// Row after the last.
        y2: u32,
        /// Width of the picture.
        width: u32,
        /// Height of the picture.
        height: u32,
    },
    /// A key that PNG or EXR cannot hold: empty, over 79 characters, not ASCII, or with a space at
    /// an end; or a value that holds a NUL.
    #[error("metadata {0:?} has a key or value that cannot be stored")]
    Metadata(String),
    /// The PNG encoder or decoder failed; its own words.
    #[error("PNG: {0}")]
    Png(String),
    /// The EXR encoder failed; its own words.
    #[error("EXR: {0}")]
    Exr(String),
}
