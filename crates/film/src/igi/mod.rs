//! Indigo images (`.igi`): a film on disk, from which rendering goes on, which others are added to, and which
//! is developed again as often as one likes.
//!
//! All numbers are little-endian. A file that this program writes begins as version 1 of the format, which
//! other programs read, with the film developed to XYZ; what version 1 cannot hold follows it:
//!
//! | offset | what |
//! |---|---|
//! | 0 | i32 66613373, i32 1, f64 samples of the whole picture, u32 width, u32 height (internal pixels), u32 super-sampling factor, i32 0 (not compressed), i32 bytes of the image, u32 0 (XYZ) |
//! | 40 | 5000 bytes that version 1 leaves free: here `MARK`, u32 `SECTION_VERSION`, zeros |
//! | 5040 | the image: X, Y, Z as f32 per internal pixel, rows from top to bottom, each the radiance in cd/m² times the samples per output pixel |
//! | then | the film section: the record, then each layer with its sums and counts as f64, in blocks of bytes ordered by significance and compressed by LZ4 |
//! | last | 32 bytes: the BLAKE3 hash of all before |
//!
//! Without the mark a file is one of another program: versions 1, 7 and 8 are read as a picture that can be
//! developed, but not gone on with. Where half of the mark or more is there, and not all, the file is damaged.
//!
//! A *parcel* is a film on its way from a network slave to its master, and no file: the eight bytes of `PARCEL_MARK`, u32
//! `SECTION_VERSION`, u32 width, height (internal pixels) and super-sampling factor, then the film section, with sums as
//! f32. It has no hash: the encrypted connection by which it travels proves each of its bytes, and without a key it does not
//! leave the machine. Its numbers stand in blocks of 65,536, the last one shorter. A block of sums is of 16 pieces: of each of X,
//! Y, Z and alpha the lowest bytes of all pixels, then the next, to the highest. A piece is a u32, its length in bytes, and then as
//! many: where that is the number of pixels, the bytes as they are, else those compressed by LZ4. A block of counts is one piece of
//! f64, ordered in the same way, always compressed.
//!
//! Reading never panics. Its memory is bounded by the file's size: the image alone needs 12 bytes per
//! internal pixel, and no file has more than `MAX_LAYERS` layers.

mod blocks;
mod bytes;
mod foreign;
mod parcel;
mod read;
mod write;

use crate::FilmError;
use crate::mix::MOST_GROUPS;

pub use parcel::Parcel;
pub use read::{IgiFile, parcel_size, read, read_parcel};
pub use write::{write, write_parcel};

/// The first four bytes of every Indigo image.
const MAGIC: u32 = 66_613_373;
/// The version whose layout a file of ours begins with.
const VERSION: u32 = 1;
/// Where version 1 leaves room.
const PADDING: usize = 40;
/// Where the image of version 1 begins.
const IMAGE: usize = PADDING + 5000;
/// Says that a film section follows the image.
const MARK: [u8; 8] = *b"IndiFilm";
/// What a parcel begins with.
const PARCEL_MARK: [u8; 8] = *b"IndiPart";
/// To be raised with every change of the film section that older readers would misread.
const SECTION_VERSION: u32 = 2;
/// Bytes of the hash at the end.
const HASH: usize = 32;
/// The most layers of a film: for each group of lights as many as any mode of rendering has.
const MAX_LAYERS: usize = 6 * MOST_GROUPS;

/// Why an Indigo image could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IgiError {
    /// The first bytes are others.
    #[error("this is not an Indigo image (.igi), as save_igi saves")]
    NotIgi,
    /// The file ends early.
    #[error("the file ends within {0}")]
    Truncated(&'static str),
    /// The hash at the end is not that of the content.
    #[error("the file is damaged: its checksum is wrong")]
    Checksum,
    /// A version whose layout is not known.
    #[error("version {0} of Indigo images is not known; 1, 7 and 8 are")]
    Version(u32),
    /// A film section of a later program.
    #[error("the film was written by another version of the program (section version {0})")]
    Section(u32),
    /// A value that cannot be.
    #[error("the file is damaged: {0}")]
    Malformed(&'static str),
    /// An impossible size.
    #[error(transparent)]
    Size(#[from] FilmError),
}
