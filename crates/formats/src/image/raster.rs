//! What the crate `image` decodes whole.

use std::io::Cursor;

use ::image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::{ALPHA, Image, Pixels, check_memory, check_sides, colours_of, decoder_error, jpeg_frame};
use crate::error::{FormatError, Position};

pub(super) fn is_known(format: ImageFormat) -> bool {
    use ImageFormat::{Bmp, Jpeg, Png, Tga};
    matches!(format, Png | Jpeg | Tga | Bmp)
}

/// What the kind is called in messages.
pub(super) fn name(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Tga => "TGA",
        ImageFormat::Bmp => "BMP",
        _ => "picture",
    }
}

pub(super) fn decode(format: ImageFormat, bytes: &[u8], most_bytes: u64) -> Result<Image, FormatError> {
    let complaint = |error: ::image::ImageError| decoder_error(name(format), &error);
    if format == ImageFormat::Png
        && let Some([width, height]) = sides_of_png(bytes)
    {
        check_sides(width.into(), height.into())?;
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    // Sides are checked by us, who tell what they may be.
    limits.max_alloc = Some(most_bytes);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(complaint)?;
    let (width, height) = decoder.dimensions();
    check_sides(width.into(), height.into())?;
    let texel_bytes = u64::from(decoder.color_type().bytes_per_pixel());
    let besides = bytes_beside_a_texel(format, bytes, texel_bytes);
    check_memory(u64::from(width) * u64::from(height) * (texel_bytes + besides), most_bytes)?;
    // The decoder makes grey of what is missing.
    if format == ImageFormat::Jpeg && !jpeg_frame::has_end(bytes) {
        return Err(FormatError::new(
            Position::Byte(bytes.len()),
            "a whole JPEG file, with the mark of its end",
            "the end of the file",
        ));
    }
    let picture = DynamicImage::from_decoder(decoder).map_err(complaint)?;
    let (channels, pixels, is_opaque) =
        texels(picture).ok_or_else(|| decoder_error(name(format), &"texels of a kind that is not known"))?;
    let notes = if is_opaque { vec![] } else { vec![ALPHA] };
    Ok(Image { width, height, channels, pixels, primaries: None, notes })
}

/// The sides of a PNG, whose header comes first: of impossible ones the decoder does not say what they are.
fn sides_of_png(file: &[u8]) -> Option<[u32; 2]> {
    let sides = file.strip_prefix(b"\x89PNG\r\n\x1a\n")?.get(8..16)?.as_chunks::<4>().0;
    Some([u32::from_be_bytes(*sides.first()?), u32::from_be_bytes(*sides.last()?)])
}

/// What the crate `image` (0.25.10) holds for each texel beside the texel itself, of which there is one throughout.
fn bytes_beside_a_texel(format: ImageFormat, file: &[u8], texel_bytes: u64) -> u64 {
    match format {
        ImageFormat::Jpeg => jpeg_frame::coefficient_bytes(file),
        // A copy of what is stored, which may be an index into a palette and takes no more than a texel.
        ImageFormat::Tga => texel_bytes,
        _ => 0,
    }
}

/// One or three channels in the precision of the picture, and whether it is opaque; `None` of a kind that this does not know.
fn texels(picture: DynamicImage) -> Option<(u8, Pixels, bool)> {
    use DynamicImage::{
        ImageLuma8, ImageLuma16, ImageLumaA8, ImageLumaA16, ImageRgb8, ImageRgb16, ImageRgba8, ImageRgba16,
    };
    let mut is_opaque = true;
    let (channels, pixels) = match picture {
        ImageLuma8(texels) => (1, Pixels::U8(texels.into_raw())),
        ImageLuma16(texels) => (1, Pixels::U16(texels.into_raw())),
        ImageRgb8(texels) => (3, Pixels::U8(texels.into_raw())),
        ImageRgb16(texels) => (3, Pixels::U16(texels.into_raw())),
        ImageLumaA8(texels) => (1, of_8(texels.into_raw(), 1, &mut is_opaque)),
        ImageRgba8(texels) => (3, of_8(texels.into_raw(), 3, &mut is_opaque)),
        ImageLumaA16(texels) => (1, of_16(texels.into_raw(), 1, &mut is_opaque)),
        ImageRgba16(texels) => (3, of_16(texels.into_raw(), 3, &mut is_opaque)),
        _ => return None,
    };
    Some((channels, pixels, is_opaque))
}

fn of_8(values: Vec<u8>, colours: usize, is_opaque: &mut bool) -> Pixels {
    Pixels::U8(colours_of(values, colours + 1, colours, Some(u8::MAX), is_opaque))
}

fn of_16(values: Vec<u16>, colours: usize, is_opaque: &mut bool) -> Pixels {
    Pixels::U16(colours_of(values, colours + 1, colours, Some(u16::MAX), is_opaque))
}
