//! OpenEXR: the linear picture, for measuring and for tone mapping elsewhere.

use crate::layers::{Channel, rgb_channels};
use crate::{ImagingError, LinearImage, Metadata};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::meta::header::LayerAttributes;
use std::io::Cursor;

/// Before each of our own attribute names, so that none is taken for one of the standard's.
const PREFIX: &str = "indigo.";

/// Encodes linear Rec. 709 in cd/m² as 32-bit floats, losslessly compressed (ZIP), with the
/// attributes `whiteLuminance` = 1 and `chromaticities`, and each fact of the metadata as a string
/// attribute (UTF-8) whose name is its key after `indigo.`. Errors: metadata that cannot be
/// stored, a picture without pixels.
pub fn encode(image: &LinearImage, metadata: &Metadata) -> Result<Vec<u8>, ImagingError> {
    encode_scaled(image, metadata, Some(1.0))
}

/// The same of display-linear values, whose 1 is the display's white: the file has no `whiteLuminance`, since
/// that depends on the display.
pub fn encode_display_linear(image: &LinearImage, metadata: &Metadata) -> Result<Vec<u8>, ImagingError> {
    encode_scaled(image, metadata, None)
}

fn encode_scaled(
    image: &LinearImage,
    metadata: &Metadata,
    white_luminance: Option<f32>,
) -> Result<Vec<u8>, ImagingError> {
    encode_channels([image.width, image.height], rgb_channels(image), metadata, white_luminance)
}

/// Encodes channels of any names, in cd/m² where they are light, as [`encode`] does. Errors: as there.
pub fn encode_layers(
    size: [u32; 2],
    channels: Vec<Channel>,
    metadata: &Metadata,
) -> Result<Vec<u8>, ImagingError> {
    encode_channels(size, channels, metadata, Some(1.0))
}

fn encode_channels(
    [width, height]: [u32; 2],
    channels: Vec<Channel>,
    metadata: &Metadata,
    white_luminance: Option<f32>,
) -> Result<Vec<u8>, ImagingError> {
    let size = (width as usize, height as usize);
    for channel in &channels {
        check_pixels(size.0 * size.1, channel.values.len())?;
    }
    let channels = channels.into_iter().map(|c| AnyChannel::new(c.name, FlatSamples::F32(c.values)));
    let channels = AnyChannels::sort(channels.collect());
    let layer = Layer::new(size, attributes(metadata, white_luminance)?, encoding(), channels);
    let mut file = Image::from_layer(layer);
    file.attributes.chromaticities = Some(rec709());
    let mut bytes = Cursor::new(Vec::new());
    let written = file.write().non_parallel().to_buffered(&mut bytes);
    written.map(|()| bytes.into_inner()).map_err(|error| ImagingError::Exr(error.to_string()))
}

fn check_pixels(expected: usize, there: usize) -> Result<(), ImagingError> {
    if expected != there || there == 0 {
        return Err(ImagingError::Exr("the picture has no pixels, or not as many as its size says".into()));
    }
    Ok(())
}

fn attributes(metadata: &Metadata, white_luminance: Option<f32>) -> Result<LayerAttributes, ImagingError> {
    let mut attributes = LayerAttributes { white_luminance, ..LayerAttributes::default() };
    for (key, value) in metadata.sorted()? {
        let name = Text::from_slice_unchecked(format!("{PREFIX}{key}").as_bytes());
        let value = Text::from_slice_unchecked(value.as_bytes());
        attributes.other.insert(name, AttributeValue::Text(value));
    }
    Ok(attributes)
}

fn encoding() -> Encoding {
    Encoding { compression: exr::compression::Compression::ZIP16, ..Encoding::FAST_LOSSLESS }
}

/// Primaries and white of ITU-R BT.709.
fn rec709() -> Chromaticities {
    Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    }
}
