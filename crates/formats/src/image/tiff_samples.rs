//! Which numbers the samples of a TIFF are (TIFF 6.0, sections 4 to 6 and 19).
//!
//! The crate `image` (0.25.10) takes samples of 32 bits for numbers of single precision where the file does not say what
//! they are: whole numbers by the standard. What it does not take at all it names in its own words, not in those of the format.

use std::io::Cursor;

use ::tiff::decoder::Decoder;
use ::tiff::tags::Tag;

use super::decoder_error;
use crate::error::{FormatError, Position};

/// Values of the tags.
const UNSIGNED: u16 = 1;
const FLOAT: u16 = 3;
const PALETTE: u16 = 3;

/// Refuses samples that are not decoded for what they are.
pub(super) fn check(file: &[u8]) -> Result<(), FormatError> {
    let complaint = |error: ::tiff::TiffError| decoder_error("TIFF", &error);
    let mut decoder = Decoder::new(Cursor::new(file)).map_err(complaint)?;
    let mut stated = |tag: Tag| decoder.find_tag_unsigned_vec::<u16>(tag).map_err(complaint);
    let kind = stated(Tag::PhotometricInterpretation)?.and_then(|kind| kind.first().copied());
    // What a file does not say is so by the standard.
    let bits = stated(Tag::BitsPerSample)?.unwrap_or_else(|| vec![1]);
    let formats = stated(Tag::SampleFormat)?.unwrap_or_else(|| vec![UNSIGNED]);
    let all = |format: u16, widths: std::ops::RangeInclusive<u16>| {
        formats.iter().all(|&f| f == format) && bits.iter().all(|b| widths.contains(b))
    };
    let found = if kind == Some(PALETTE) {
        "colours from a palette".to_owned()
    } else if all(UNSIGNED, 1..=16) || all(FLOAT, 32..=32) {
        return Ok(());
    } else {
        let widest = bits.iter().max().copied().unwrap_or_default();
        let format = match formats.first().copied() {
            Some(UNSIGNED) => "unsigned",
            Some(FLOAT) => "floating-point",
            _ => "signed or other",
        };
        format!("{format} samples of {widest} bits")
    };
    let expected = "a TIFF of unsigned samples of 8 or 16 bits, or of single precision, in grey or colour";
    Err(FormatError::new(Position::Byte(0), expected, found))
}
