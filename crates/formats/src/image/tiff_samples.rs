//! Which numbers the samples of a TIFF are (TIFF 6.0, section 19).
//!
//! The crate `image` (0.25.10) takes samples of 32 bits for numbers of single precision where the file does not say what
//! they are: whole numbers by the standard.

use std::io::Cursor;

use ::image::ColorType;
use ::tiff::decoder::Decoder;
use ::tiff::tags::Tag;

use super::decoder_error;
use crate::error::{FormatError, Position};

/// Values of the tag.
const UNSIGNED: u16 = 1;
const FLOAT: u16 = 3;

/// Refuses samples that are not what a decoder of texels of some type would take them for.
pub(super) fn check(file: &[u8], texel: ColorType) -> Result<(), FormatError> {
    let complaint = |error: ::tiff::TiffError| decoder_error("TIFF", &error);
    let mut decoder = Decoder::new(Cursor::new(file)).map_err(complaint)?;
    let stated: Option<Vec<u16>> = decoder.find_tag_unsigned_vec(Tag::SampleFormat).map_err(complaint)?;
    let needed = if matches!(texel, ColorType::Rgb32F | ColorType::Rgba32F) { FLOAT } else { UNSIGNED };
    // Files that say nothing have unsigned ones.
    let stated = stated.unwrap_or_else(|| vec![UNSIGNED]);
    if stated.iter().all(|&format| format == needed) {
        return Ok(());
    }
    Err(FormatError::new(
        Position::Byte(0),
        "a TIFF of unsigned samples of 8 or 16 bits, or of single precision",
        "samples of another kind",
    ))
}
