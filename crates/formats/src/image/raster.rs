//! What the crate `image` decodes whole.

use std::io::Cursor;

use ::image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::{Image, Pixels, check_memory, check_sides, decoder_error, jpeg_frame, tiff_samples};
use crate::error::{FormatError, Position};

pub(super) fn is_known(format: ImageFormat) -> bool {
    use ImageFormat::{Bmp, Jpeg, Png, Tga, Tiff};
    matches!(format, Png | Jpeg | Tga | Bmp | Tiff)
}

/// What the kind is called in messages.
pub(super) fn name(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Tga => "TGA",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Tiff => "TIFF",
        _ => "picture",
    }
}

pub(super) fn decode(format: ImageFormat, bytes: &[u8], most_bytes: u64) -> Result<Image, FormatError> {
    let complaint = |error: ::image::ImageError| decoder_error(name(format), &error);
    if format == ImageFormat::Tiff {
        tiff_samples::check(bytes)?;
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
    let stored_bits = decoder.original_color_type().bits_per_pixel();
    let besides = bytes_beside_a_texel(format, bytes, texel_bytes, stored_bits.into());
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
    let (channels, pixels) =
        texels(picture).ok_or_else(|| decoder_error(name(format), &"texels of a kind that is not known"))?;
    Ok(Image { width, height, channels, pixels, primaries: None })
}

/// What the crate `image` (0.25.10) holds for each texel beside the texel itself, of which there is one throughout.
fn bytes_beside_a_texel(format: ImageFormat, file: &[u8], texel_bytes: u64, stored_bits: u64) -> u64 {
    match format {
        ImageFormat::Jpeg => jpeg_frame::coefficient_bytes(file),
        // A copy of what is stored, which may be an index into a palette and takes no more than a texel.
        ImageFormat::Tga => texel_bytes,
        // The same, of CMYK four channels.
        ImageFormat::Tiff => texel_bytes.max(stored_bits.div_ceil(8)),
        _ => 0,
    }
}

/// One or three channels in the precision of the picture; `None` of a kind that this does not know.
fn texels(picture: DynamicImage) -> Option<(u8, Pixels)> {
    use DynamicImage::{
        ImageLuma8, ImageLuma16, ImageLumaA8, ImageLumaA16, ImageRgb8, ImageRgb16, ImageRgb32F, ImageRgba8,
        ImageRgba16, ImageRgba32F,
    };
    Some(match picture {
        ImageLuma8(texels) => (1, Pixels::U8(texels.into_raw())),
        ImageLuma16(texels) => (1, Pixels::U16(texels.into_raw())),
        ImageLumaA8(texels) => (1, Pixels::U8(without_alpha(texels.into_raw(), 1))),
        ImageLumaA16(texels) => (1, Pixels::U16(without_alpha(texels.into_raw(), 1))),
        ImageRgb8(texels) => (3, Pixels::U8(texels.into_raw())),
        ImageRgba8(texels) => (3, Pixels::U8(without_alpha(texels.into_raw(), 3))),
        ImageRgb16(texels) => (3, Pixels::U16(texels.into_raw())),
        ImageRgba16(texels) => (3, Pixels::U16(without_alpha(texels.into_raw(), 3))),
        ImageRgb32F(texels) => (3, Pixels::F32(texels.into_raw())),
        ImageRgba32F(texels) => (3, Pixels::F32(without_alpha(texels.into_raw(), 3))),
        _ => return None,
    })
}

/// The colours of texels that have an alpha behind theirs, in the same place: a copy would be as large as the picture.
fn without_alpha<T: Copy>(mut values: Vec<T>, colours: usize) -> Vec<T> {
    let texels = values.len() / (colours + 1);
    for texel in 1..texels {
        let from = texel * (colours + 1);
        values.copy_within(from..from + colours, texel * colours);
    }
    values.truncate(texels * colours);
    values.shrink_to_fit();
    values
}
