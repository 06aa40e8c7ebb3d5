//! TIFF (6.0, and BigTIFF): the first page, in grey or colour, of samples of up to 16 bits or of floating-point numbers.
//!
//! What is refused is named in the words of the format, not in those of the decoder.

use std::io::{Cursor, ErrorKind};
use std::ops::RangeInclusive;

use ::tiff::TiffError;
use ::tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use ::tiff::tags::{IfdPointer, Tag};

use super::tiff_directory;
use super::{ALPHA, Image, Pixels, check_memory, check_sides, colours_of, decoder_error};
use crate::error::{FormatError, Position};

/// How a BigTIFF begins.
pub(super) const BIG_MAGICS: [[u8; 4]; 2] = [*b"II+\0", *b"MM\0+"];

/// Values of the tag `PhotometricInterpretation`.
const WHITE_IS_ZERO: u16 = 0;
const BLACK_IS_ZERO: u16 = 1;
const RGB: u16 = 2;
/// Values of `SampleFormat`.
const UNSIGNED: u16 = 1;
const FLOAT: u16 = 3;
/// Values of `Compression` that are read, and how many bytes one can become at most: none; LZW, whose codes of at least 9 bits
/// stand for fewer than 4096 bytes; Deflate by either of its numbers (258 bytes of two bits); `PackBits` (128 of two).
const COMPRESSIONS: [(u16, u64); 5] = [(1, 1), (5, 4096), (8, 1032), (0x80B2, 1032), (0x8005, 64)];
/// Values of `ExtraSamples` that are alphas: of colours that it is multiplied into, and of others.
const ALPHAS: RangeInclusive<u16> = 1..=2;
/// Values of `Orientation` of which the first row of the file is not the top one or does not begin on the left.
const TURNED: RangeInclusive<u16> = 2..=8;
/// Bits of `NewSubfileType`: what is told of another page at another resolution, or masks it.
const REDUCED: u32 = 1;
const MASK: u32 = 4;
/// A mip map of the widest picture has 15 further pages, and masks may go with each: a longer chain, or one that loops, is not
/// followed to its end.
const MOST_PAGES: usize = 64;

const EXPECTED: &str = "a TIFF in grey or red, green and blue, of unsigned samples of 1, 2, 4 (grey), 8 or 16 bits or \
                        floating-point ones of 16 or 32, not compressed or by LZW, Deflate or PackBits";
const PAGES: &str = "it has more than one page, of which the first is taken";
const ORIENTATION: &str =
    "it is to be turned or mirrored by its tag Orientation, and is taken as its rows are stored";
const FURTHER_SAMPLES: &str =
    "it has samples beside those of its colour that are no alpha, and they are dropped";

/// What the tags of a page say of its samples.
struct Form {
    bits: u16,
    is_float: bool,
    /// Of grey or of colour.
    channels: usize,
    /// How many samples a texel has in what is decoded.
    samples: usize,
    /// The same of a row in the file.
    encoded: usize,
    /// Whether the first sample behind the colour is an alpha.
    has_alpha: bool,
    /// Whether there are others.
    has_further: bool,
    /// How many bytes of samples a byte of the file can hold at most.
    growth: u64,
}

pub(super) fn decode(file: &[u8], most_bytes: u64) -> Result<Image, FormatError> {
    if !tiff_directory::is_held(file, MOST_PAGES + 1) {
        return Err(cut_off());
    }
    let mut decoder = Decoder::new(Cursor::new(file)).map_err(complaint)?;
    let (width, height) = decoder.dimensions().map_err(complaint)?;
    check_sides(width.into(), height.into())?;
    let form = Form::read(&mut decoder)?;
    let layout = decoder.image_buffer_layout().map_err(complaint)?;
    let decoded = usize::from(decoder.colortype().map_err(complaint)?.num_samples());
    if layout.planes == 1 && decoded != form.samples {
        return Err(refused(format!("{decoded} samples a texel of which its tags tell of {}", form.samples)));
    }
    let texels = u64::from(width) * u64::from(height);
    let held = layout.complete_len as u64;
    // The decoder keeps a row of a strip or tile besides, with all samples: a file has at least one.
    let row = form.encoded_row(decoder.chunk_dimensions().0);
    if held.max(row) > form.growth.saturating_mul(file.len() as u64) {
        return Err(cut_off());
    }
    let copies = texels.saturating_mul(form.copied_bytes(layout.planes));
    check_memory(held.saturating_add(row).saturating_add(copies), most_bytes)?;

    let mut limits = Limits::unlimited();
    limits.decoding_buffer_size = usize::try_from(held).unwrap_or(usize::MAX);
    let is_turned = TURNED.contains(&first(&mut decoder, Tag::Orientation, 1)?);
    let is_paged = has_other_pages(&mut decoder);
    let mut decoder = decoder.with_limits(limits);
    let mut samples = DecodingResult::U8(vec![]);
    decoder.read_image_to_buffer(&mut samples).map_err(complaint)?;

    let shape = Shape { width: width as usize, texels: texels as usize, is_planar: layout.planes > 1 };
    let mut is_opaque = true;
    let pixels = match samples {
        DecodingResult::U8(v) if form.bits < 8 => Pixels::U8(unpacked(&v, form.bits, &shape)),
        DecodingResult::U8(v) => Pixels::U8(form.colours(v, &shape, u8::MAX, &mut is_opaque)),
        DecodingResult::U16(v) => Pixels::U16(form.colours(v, &shape, u16::MAX, &mut is_opaque)),
        DecodingResult::F32(v) => Pixels::F32(form.colours(v, &shape, 1.0, &mut is_opaque)),
        DecodingResult::F16(v) => {
            let values: Vec<f32> = v.iter().map(|value| value.to_f32()).collect();
            Pixels::F32(form.colours(values, &shape, 1.0, &mut is_opaque))
        }
        _ => return Err(refused("samples of another kind")),
    };
    let notes = [
        (is_paged, PAGES),
        (is_turned, ORIENTATION),
        (!is_opaque, ALPHA),
        (form.has_further, FURTHER_SAMPLES),
    ];
    let notes = notes.into_iter().filter(|(is_so, _)| *is_so).map(|(_, note)| note).collect();
    Ok(Image { width, height, channels: form.channels as u8, pixels, primaries: None, notes })
}

/// The values of a tag; what a file does not say is so by the standard.
fn stated(decoder: &mut Decoder<Cursor<&[u8]>>, tag: Tag, default: u16) -> Result<Vec<u16>, FormatError> {
    let values = decoder.find_tag_unsigned_vec::<u16>(tag).map_err(complaint)?;
    Ok(values.filter(|values| !values.is_empty()).unwrap_or_else(|| vec![default]))
}

/// The first, or only, of these values.
fn first(decoder: &mut Decoder<Cursor<&[u8]>>, tag: Tag, default: u16) -> Result<u16, FormatError> {
    stated(decoder, tag, default).map(|values| values.first().copied().unwrap_or(default))
}

/// Whether a file has pages behind the first that are pictures of their own: neither the first in fewer texels, as mip maps
/// are kept, nor masks. What cannot be read is taken for one.
fn has_other_pages(decoder: &mut Decoder<Cursor<&[u8]>>) -> bool {
    let mut next = decoder.image_ifd().directory().next();
    for _ in 0..MOST_PAGES {
        let Some(page) = next else { return false };
        match page_behind(decoder, page) {
            Ok((kind, following)) if kind & (REDUCED | MASK) != 0 => next = following,
            _ => return true,
        }
    }
    next.is_some()
}

/// What a page tells that it is, and where the one behind it is.
fn page_behind(
    decoder: &mut Decoder<Cursor<&[u8]>>,
    page: IfdPointer,
) -> Result<(u32, Option<IfdPointer>), TiffError> {
    let directory = decoder.read_directory(page)?;
    let kind = decoder.read_directory_tags(&directory).find_tag_unsigned(Tag::NewSubfileType)?;
    Ok((kind.unwrap_or_default(), directory.next()))
}

/// How samples lie in what is decoded.
struct Shape {
    width: usize,
    texels: usize,
    /// Whether all of one channel come before those of the next.
    is_planar: bool,
}

impl Form {
    fn read(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<Self, FormatError> {
        // Of what has no such tag the decoder does not know what it is, and says so before.
        let kind = decoder.get_tag_unsigned(Tag::PhotometricInterpretation).map_err(complaint)?;
        let mut one = |tag: Tag, default: u16| first(decoder, tag, default);
        let samples = one(Tag::SamplesPerPixel, 1)?;
        let compression = one(Tag::Compression, 1)?;
        let predictor = one(Tag::Predictor, 1)?;
        let is_chunky = one(Tag::PlanarConfiguration, 1)? == 1;
        let bits = stated(decoder, Tag::BitsPerSample, 1)?;
        let formats = stated(decoder, Tag::SampleFormat, UNSIGNED)?;
        let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).map_err(complaint)?;
        let extra = extra.unwrap_or_default();

        let channels = match kind {
            WHITE_IS_ZERO | BLACK_IS_ZERO => 1,
            RGB => 3,
            other => return Err(refused(name_of(other))),
        };
        let Some(&(_, growth)) = COMPRESSIONS.iter().find(|(number, _)| *number == compression) else {
            return Err(refused(format!("compression {}", name_of_compression(compression))));
        };
        let is_float = formats.iter().all(|&format| format == FLOAT);
        let widths: &[u16] = match (is_float, formats.iter().all(|&format| format == UNSIGNED)) {
            (true, _) => &[16, 32],
            (_, true) if samples == 1 => &[1, 2, 4, 8, 16],
            (_, true) => &[8, 16],
            _ => &[],
        };
        let widest = bits.iter().max().copied().unwrap_or_default();
        if !bits.iter().all(|width| *width == widest) || !widths.contains(&widest) {
            let format = match formats.first().copied() {
                Some(UNSIGNED) => "unsigned",
                Some(FLOAT) => "floating-point",
                _ => "signed or other",
            };
            return Err(refused(format!("{samples} {format} samples of {widest} bits")));
        }
        if kind == WHITE_IS_ZERO && (samples > 1 || is_float && widest == 16) {
            return Err(refused("grey whose 0 is white, of halves or with further samples"));
        }
        let samples = usize::from(samples);
        if samples < channels {
            return Err(refused(format!("{samples} samples a texel for red, green and blue")));
        }
        // A fourth sample of which nothing is said the decoder takes for an alpha, as nearly all programs do.
        let has_alpha = match extra.first() {
            Some(first) => ALPHAS.contains(first),
            None => kind == RGB && samples == 4,
        };
        let decoded = if kind == RGB { channels + usize::from(has_alpha) } else { samples };
        // The decoder (`tiff` 0.11.3) would add up differences of samples after it has left out some of them, and writes over
        // the texels beside a tile.
        let is_tiled = decoder.get_chunk_type() == ChunkType::Tile;
        if decoded < samples && is_chunky && (predictor != 1 || is_tiled) {
            return Err(refused("tiles, or a predictor, with samples that are neither colour nor alpha"));
        }
        let has_further = samples > channels + usize::from(has_alpha);
        let encoded = if is_chunky { samples } else { 1 };
        Ok(Self {
            bits: widest,
            is_float,
            channels,
            samples: decoded,
            encoded,
            has_alpha,
            has_further,
            growth,
        })
    }

    /// Bytes of a row of a strip or tile as it is in the file.
    fn encoded_row(&self, width: u32) -> u64 {
        let bits = u64::from(width).saturating_mul(self.encoded as u64 * u64::from(self.bits));
        bits.div_ceil(8)
    }

    /// Bytes of a texel in what packed bits, halves and planes are copied into.
    fn copied_bytes(&self, planes: usize) -> u64 {
        let (is_planar, is_half) = (planes > 1, self.is_float && self.bits == 16);
        let halves = if is_half { 4 * if is_planar { planes } else { self.samples } } else { 0 };
        let value = if self.is_float { 4 } else { usize::from(self.bits.div_ceil(8)) };
        let shades = if self.bits < 8 || is_planar { self.channels * value } else { 0 };
        (halves + shades) as u64
    }

    /// The colours among samples. Clears `is_opaque` where an alpha says otherwise.
    fn colours<T: Copy + PartialEq>(
        &self,
        mut values: Vec<T>,
        shape: &Shape,
        opaque: T,
        is_opaque: &mut bool,
    ) -> Vec<T> {
        if !shape.is_planar {
            let alpha = self.has_alpha.then_some(opaque);
            return colours_of(values, self.samples, self.channels, alpha, is_opaque);
        }
        if self.has_alpha {
            let alphas = values.iter().skip(self.channels * shape.texels).take(shape.texels);
            *is_opaque &= alphas.copied().all(|alpha| alpha == opaque);
        }
        values.truncate(self.channels * shape.texels);
        if self.channels == 1 {
            values.shrink_to_fit();
            return values;
        }
        let (red, others) = values.split_at(shape.texels);
        let (green, blue) = others.split_at(shape.texels);
        let mut colours = Vec::with_capacity(values.len());
        for ((r, g), b) in red.iter().zip(green).zip(blue) {
            colours.extend([*r, *g, *b]);
        }
        colours
    }
}

/// Shades of grey of 1, 2 or 4 bits, of which rows begin with a byte, spread out to 0 to 255.
fn unpacked(bytes: &[u8], bits: u16, shape: &Shape) -> Vec<u8> {
    let per_byte = usize::from(8 / bits);
    let most = (1_u8 << bits) - 1;
    let mut shades = Vec::with_capacity(shape.texels);
    for row in bytes.chunks_exact(shape.width.div_ceil(per_byte)) {
        let of_byte = |byte: &u8| {
            let byte = *byte;
            (0..per_byte).rev().map(move |i| (byte >> (i * usize::from(bits)) & most) * (255 / most))
        };
        shades.extend(row.iter().flat_map(of_byte).take(shape.width));
    }
    shades
}

/// The kinds of colour that the decoder knows, and this does not read.
fn name_of(kind: u16) -> &'static str {
    match kind {
        3 => "colours from a palette",
        4 => "a mask",
        5 => "inks (CMYK)",
        6 => "luminance and differences of colour (YCbCr)",
        _ => "colours of L*a*b*",
    }
}

fn name_of_compression(number: u16) -> String {
    match number {
        2..=4 => "as of a fax".to_owned(),
        6 | 7 => "by JPEG".to_owned(),
        50_000 => "by Zstandard".to_owned(),
        50_001 => "by WebP".to_owned(),
        other => format!("number {other}"),
    }
}

fn refused(found: impl Into<String>) -> FormatError {
    FormatError::new(Position::Byte(0), EXPECTED, found)
}

fn cut_off() -> FormatError {
    FormatError::new(Position::Byte(0), "a whole TIFF file", "its end before that of its samples")
}

fn complaint(error: TiffError) -> FormatError {
    match error {
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => cut_off(),
        TiffError::UnsupportedError(what) => refused(what.to_string()),
        error => decoder_error("TIFF", &error),
    }
}

#[cfg(test)]
mod tests;
