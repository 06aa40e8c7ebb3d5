//! Pictures as plain texels: PNG, JPEG, TGA, BMP, Radiance HDR (by the crate `image`), TIFF (by `tiff`) and EXR (by
//! `exr`).

use std::panic::{UnwindSafe, catch_unwind};

use crate::error::{FormatError, Position};

mod exr_file;
mod jpeg_frame;
mod radiance;
mod raster;
mod tiff_directory;
mod tiff_file;

/// The widest and highest picture that is read.
const MAX_SIDE: u32 = 32_768;
/// The most memory that decoding may take, in bytes: a picture, and what its decoder holds beside it.
const MAX_BYTES: u64 = 4 << 30;

/// Chromaticities (x, y) by CIE 1931 of red, green, blue and white.
pub type Primaries = [[f64; 2]; 4];

/// A picture: rows from the top, texels from the left, channels of a texel together. Values are as stored: no gamma is
/// removed, no colour space converted. Only an exposure that the file states is taken back.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 (grey) or 3 (red, green, blue). Alpha is dropped, palettes are expanded.
    pub channels: u8,
    /// `width · height · channels` values.
    pub pixels: Pixels,
    /// Which colours the channels are, where an EXR or Radiance file says so.
    pub primaries: Option<Primaries>,
    /// What of the file is not in the picture, or not as one may expect: sentences about the file, "it".
    pub notes: Vec<&'static str>,
}

/// The note of a picture that was not opaque throughout.
const ALPHA: &str = "its alpha is dropped: it is taken as opaque throughout";

/// Values of a picture in the precision of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// 0 to 255.
    U8(Vec<u8>),
    /// 0 to 65 535.
    U16(Vec<u16>),
    /// Unbounded; finite or not as in the file.
    F32(Vec<f32>),
}

/// Decodes a picture. The content decides the kind where it carries a mark of one; TGA has none, so there the name's
/// extension does.
///
/// # Errors
/// For a kind that is not known, for damaged files, for headers that are not as they must be and for pictures wider or
/// higher than 32,768 texels or of which decoding takes more than 4 GiB. Positions are lines of a Radiance file's header,
/// or else the file's start: the decoders do not tell more.
pub fn decode(file_name: &str, bytes: &[u8]) -> Result<Image, FormatError> {
    decode_within(file_name, bytes, MAX_BYTES)
}

/// The same with another bound on the memory that decoding takes: the texels, what a decoder keeps of the whole picture
/// beside them and the copies that it makes. Some rows, tables and copies of the file itself do not count.
///
/// # Errors
/// As those of [`decode`].
pub fn decode_within(file_name: &str, bytes: &[u8], most_bytes: u64) -> Result<Image, FormatError> {
    if bytes.starts_with(&exr_file::MAGIC) {
        return guarded("EXR", || exr_file::decode(bytes, most_bytes));
    }
    if bytes.starts_with(radiance::MAGIC) {
        return guarded("HDR", || radiance::decode(bytes, most_bytes));
    }
    let by_content = if tiff_file::BIG_MAGICS.iter().any(|magic| bytes.starts_with(magic)) {
        Some(::image::ImageFormat::Tiff)
    } else {
        ::image::guess_format(bytes).ok()
    };
    let by_name = || ::image::ImageFormat::from_path(file_name).ok();
    match by_content.or_else(by_name) {
        Some(::image::ImageFormat::Tiff) => guarded("TIFF", || tiff_file::decode(bytes, most_bytes)),
        Some(format) if raster::is_known(format) => {
            guarded(raster::name(format), || raster::decode(format, bytes, most_bytes))
        }
        _ => Err(FormatError::new(
            Position::Byte(0),
            "a picture of a known type (PNG, JPEG, TGA, BMP, TIFF, HDR, EXR)",
            format!("'{file_name}', whose name and content are of none of them"),
        )),
    }
}

/// Turns a decoder's panic into an error. The decoders are others' work and not free of panics on damaged files (`exr`
/// 1.74.2 overflows in its B44 codec where overflow checks are on); they keep no state that could be left broken.
fn guarded(
    kind: &str,
    decode: impl FnOnce() -> Result<Image, FormatError> + UnwindSafe,
) -> Result<Image, FormatError> {
    catch_unwind(decode).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref().copied()).unwrap_or("it gave up");
        Err(decoder_error(kind, &said))
    })
}

/// Refuses sides beyond the limits; called before anything is allocated for them.
fn check_sides(width: u64, height: u64) -> Result<(), FormatError> {
    let side = 1..=u64::from(MAX_SIDE);
    if side.contains(&width) && side.contains(&height) {
        return Ok(());
    }
    Err(FormatError::new(
        Position::Byte(0),
        format!("a picture of 1 to {MAX_SIDE} texels each way"),
        format!("{width} x {height} texels"),
    ))
}

/// Refuses what takes more memory than it may; called before that is allocated.
fn check_memory(bytes: u64, most_bytes: u64) -> Result<(), FormatError> {
    if bytes <= most_bytes {
        return Ok(());
    }
    Err(FormatError::new(
        Position::Byte(0),
        format!("a picture that takes at most {most_bytes} bytes to decode"),
        format!("one that takes {bytes} bytes"),
    ))
}

/// The colours of texels, which come first among their samples, in the same place: a copy would be as large as the picture.
/// Clears `is_opaque` where the sample behind the colours is an alpha, for which `opaque` is given, and is not that.
fn colours_of<T: Copy + PartialEq>(
    mut values: Vec<T>,
    samples: usize,
    colours: usize,
    opaque: Option<T>,
    is_opaque: &mut bool,
) -> Vec<T> {
    if samples == colours {
        return values;
    }
    if let Some(opaque) = opaque {
        *is_opaque &= values.iter().skip(colours).step_by(samples).all(|alpha| *alpha == opaque);
    }
    let texels = values.len() / samples;
    for texel in 1..texels {
        let from = texel * samples;
        values.copy_within(from..from + colours, texel * colours);
    }
    values.truncate(texels * colours);
    values.shrink_to_fit();
    values
}

/// What a decoder says, as an error of ours.
fn decoder_error(kind: &str, error: &dyn std::fmt::Display) -> FormatError {
    FormatError::new(
        Position::Byte(0),
        format!("a sound {kind} file"),
        format!("a decoder's complaint: {error}"),
    )
}

#[cfg(test)]
mod tests;
