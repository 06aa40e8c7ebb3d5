//! PNG: the picture as it is shown, with its metadata.

use crate::srgb::{self, Encoder8, encode16};
use crate::{ImagingError, Metadata, Picture};
use indigo_math::rng::{self, Rng};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, SrgbRenderingIntent};
use rayon::prelude::*;
use std::io::Cursor;

/// Bits per component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 8 bits.
    #[default]
    Eight,
    /// 16 bits.
    Sixteen,
}

/// The most bytes of compressed text that [`read_metadata`] unpacks from one entry.
const TEXT_LIMIT: usize = 1 << 20;

/// How a PNG holds its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Format {
    /// Bits per component.
    pub depth: Depth,
    /// Whether codes are dithered: each is one of the two nearest, by chance, so that they are right on average and
    /// no bands appear in smooth gradients. Otherwise the nearest.
    pub dithered: bool,
}

impl From<Depth> for Format {
    fn from(depth: Depth) -> Self {
        Self { depth, dithered: false }
    }
}

/// Encodes a picture as sRGB, with its metadata as uncompressed text sorted by key before the
/// pixels. A value beyond Latin-1 becomes UTF-8 text (iTXt). Errors: metadata that cannot be
/// stored, a picture without pixels.
pub fn encode(
    picture: &Picture,
    metadata: &Metadata,
    format: impl Into<Format>,
) -> Result<Vec<u8>, ImagingError> {
    let format = format.into();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    for (key, value) in metadata.sorted()? {
        let (key, value) = (key.to_owned(), value.to_owned());
        if value.chars().all(|c| u32::from(c) < 256) {
            encoder.add_text_chunk(key, value).map_err(failure)?;
        } else {
            encoder.add_itxt_chunk(key, value).map_err(failure)?;
        }
    }
    let data = match format.depth {
        Depth::Eight => {
            encoder.set_depth(BitDepth::Eight);
            if format.dithered { dithered(picture, 255.0, |code| [code as u8]) } else { codes8(picture) }
        }
        Depth::Sixteen => {
            encoder.set_depth(BitDepth::Sixteen);
            if format.dithered {
                dithered(picture, 65535.0, |code| (code as u16).to_be_bytes())
            } else {
                codes16(picture)
            }
        }
    };
    let mut writer = encoder.write_header().map_err(failure)?;
    writer.write_image_data(&data).map_err(failure)?;
    writer.finish().map_err(failure)?;
    Ok(bytes)
}

/// Encodes a square of grey codes, rows from the top, as they are. Errors: not a square of at least one.
pub fn encode_grey(side: u32, codes: &[u8]) -> Result<Vec<u8>, ImagingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side, side);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(failure)?;
    writer.write_image_data(codes).map_err(failure)?;
    writer.finish().map_err(failure)?;
    Ok(bytes)
}

/// The text entries of a PNG, in the order of their chunks' kinds: Latin-1 (plain, then
/// compressed), then UTF-8. Errors: not a PNG, or a damaged one.
pub fn read_metadata(bytes: &[u8]) -> Result<Vec<(String, String)>, ImagingError> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_ignore_text_chunk(false);
    let mut reader = decoder.read_info().map_err(failure)?;
    // Text may follow the pixels.
    reader.finish().map_err(failure)?;
    let info = reader.info();
    let mut entries: Vec<_> =
        info.uncompressed_latin1_text.iter().map(|t| (t.keyword.clone(), t.text.clone())).collect();
    for mut text in info.compressed_latin1_text.iter().cloned() {
        text.decompress_text_with_limit(TEXT_LIMIT).map_err(failure)?;
        entries.push((text.keyword.clone(), text.get_text().map_err(failure)?));
    }
    for mut text in info.utf8_text.iter().cloned() {
        text.decompress_text_with_limit(TEXT_LIMIT).map_err(failure)?;
        entries.push((text.keyword.clone(), text.get_text().map_err(failure)?));
    }
    Ok(entries)
}

fn codes8(picture: &Picture) -> Vec<u8> {
    let encoder = Encoder8::new();
    picture.pixels.par_iter().flat_map_iter(|[r, g, b, _]| [*r, *g, *b].map(|v| encoder.encode(v))).collect()
}

fn codes16(picture: &Picture) -> Vec<u8> {
    let code = |v: &f32| encode16(*v).to_be_bytes();
    picture.pixels.par_iter().flat_map_iter(|p| p[..3].iter().flat_map(code)).collect()
}

/// Codes up to `largest`, each rounded up with the chance that its fraction tells. The same picture has always the
/// same codes.
fn dithered<const N: usize>(
    picture: &Picture,
    largest: f64,
    bytes: impl Fn(f64) -> [u8; N] + Sync,
) -> Vec<u8> {
    let code = |i: usize, c: usize, v: f32| {
        let u = Rng::new(rng::key(&[i as u64, c as u64])).next_f64();
        bytes((srgb::encode(f64::from(v)) * largest + u).floor().min(largest))
    };
    let pixels = picture.pixels.par_iter().enumerate();
    pixels.flat_map_iter(|(i, p)| [0, 1, 2].map(|c| code(i, c, p[c])).into_iter().flatten()).collect()
}

fn failure(error: impl std::fmt::Display) -> ImagingError {
    ImagingError::Png(error.to_string())
}
