//! What the crate `image` decodes whole.

use std::io::Cursor;

use ::image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::{Image, MAX_BYTES, MAX_SIDE, Pixels, check_size, decoder_error};
use crate::error::FormatError;

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

pub(super) fn decode(format: ImageFormat, bytes: Cursor<&[u8]>) -> Result<Image, FormatError> {
    let complaint = |error: ::image::ImageError| decoder_error(name(format), &error);
    let mut reader = ImageReader::with_format(bytes, format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(complaint)?;
    let (width, height) = decoder.dimensions();
    check_size(width.into(), height.into(), decoder.color_type().bytes_per_pixel().into())?;
    let picture = DynamicImage::from_decoder(decoder).map_err(complaint)?;
    let (channels, pixels) = texels(picture);
    Ok(Image { width, height, channels, pixels, primaries: None })
}

/// One or three channels in the precision of the picture.
fn texels(picture: DynamicImage) -> (u8, Pixels) {
    use DynamicImage::{
        ImageLuma8, ImageLuma16, ImageLumaA8, ImageLumaA16, ImageRgb8, ImageRgb16, ImageRgb32F, ImageRgba8,
        ImageRgba16,
    };
    match picture {
        ImageLuma8(texels) => (1, Pixels::U8(texels.into_raw())),
        ImageLuma16(texels) => (1, Pixels::U16(texels.into_raw())),
        ImageLumaA8(_) => (1, Pixels::U8(picture.into_luma8().into_raw())),
        ImageLumaA16(_) => (1, Pixels::U16(picture.into_luma16().into_raw())),
        ImageRgb8(texels) => (3, Pixels::U8(texels.into_raw())),
        ImageRgba8(_) => (3, Pixels::U8(picture.into_rgb8().into_raw())),
        ImageRgb16(texels) => (3, Pixels::U16(texels.into_raw())),
        ImageRgba16(_) => (3, Pixels::U16(picture.into_rgb16().into_raw())),
        ImageRgb32F(texels) => (3, Pixels::F32(texels.into_raw())),
        other => (3, Pixels::F32(other.into_rgb32f().into_raw())),
    }
}
