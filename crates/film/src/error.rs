//! What can be wrong with a film's size, its filter, or a film to be merged into it.

/// Why a film or filter could not be made, or two films not be merged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilmError {
    /// A side or the super-sampling factor is zero.
    #[error("a film needs at least one pixel: {width} x {height}, super-sampled {super_sample} times")]
    Empty {
        /// Width of the picture in pixels.
        width: u32,
        /// Height of the picture in pixels.
        height: u32,
        /// Internal pixels per output pixel along one axis.
        super_sample: u32,
    },
    /// More internal pixels than [`FilmSize::MAX_SIDE`](crate::FilmSize::MAX_SIDE) and
    /// [`FilmSize::MAX_PIXELS`](crate::FilmSize::MAX_PIXELS) allow.
    #[error("a film of {width} x {height} pixels, super-sampled {super_sample} times, is too large")]
    TooLarge {
        /// Width of the picture in pixels.
        width: u32,
        /// Height of the picture in pixels.
        height: u32,
        /// Internal pixels per output pixel along one axis.
        super_sample: u32,
    },
    /// There is not as much memory as the film's sums need.
    #[error(
        "the film of a picture of width {width} and height {height} with super_sample_factor {super_sample} needs \
         {} MiB of memory, which the system does not give",
        .bytes.div_ceil(1 << 20)
    )]
    OutOfMemory {
        /// Width of the picture in pixels.
        width: u32,
        /// Height of the picture in pixels.
        height: u32,
        /// Internal pixels per output pixel along one axis.
        super_sample: u32,
        /// Bytes of sums and counts.
        bytes: u64,
    },
    /// A Mitchell-Netravali parameter is not a number of reasonable size.
    #[error("the filter's blur {blur} and ring {ring} must lie between -10 and 10")]
    FilterParameters {
        /// The `B` parameter.
        blur: f64,
        /// The `C` parameter.
        ring: f64,
    },
    /// The films differ in resolution or super-sampling.
    #[error("films of different sizes cannot be merged: {0} and {1}")]
    SizeMismatch(crate::FilmSize, crate::FilmSize),
    /// The films differ in the number, kinds or names of their layers.
    #[error("films with different layers cannot be merged")]
    LayerMismatch,
    /// A film of another program does not say what its values are sums of.
    #[error("the film of another program can be developed, but not added to or gone on with")]
    Foreign,
}
