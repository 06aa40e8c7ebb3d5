//! OpenEXR: the linear picture, for measuring and for tone mapping elsewhere.

use crate::camera_facts::Matrix;
use crate::layers::{Channel, rgb_channels};
use crate::{CameraFacts, Content, ImagingError, LinearImage, Metadata};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, LineOrder, Text};
use exr::meta::header::LayerAttributes;
use std::io::Cursor;

/// Before each of our own attribute names, so that none is taken for one of the standard's.
const PREFIX: &str = "indigo.";

/// Encodes linear Rec. 709 in cd/m² as 32-bit floats, losslessly compressed (ZIP), with the
/// attributes `whiteLuminance` = 1 and `chromaticities`, those that the standard has for cameras and dates, and each fact
/// of the metadata as a string attribute (UTF-8) whose name is its key after `indigo.`, with underscores for blanks. Errors: metadata
/// that cannot be stored, a picture without pixels.
pub fn encode(image: &LinearImage, metadata: &Metadata) -> Result<Vec<u8>, ImagingError> {
    encode_scaled(image, metadata, Some(1.0))
}

/// The same of display-linear values, whose 1 is the display's white, and of coverage: the file has no `whiteLuminance`,
/// since that depends on the display, or there is no light.
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

/// Encodes channels of any names as [`encode`] does; `content` says what R, G and B are. Errors: as there.
pub fn encode_layers(
    size: [u32; 2],
    channels: Vec<Channel>,
    metadata: &Metadata,
    content: Content,
) -> Result<Vec<u8>, ImagingError> {
    let white_luminance = (content == Content::Luminances).then_some(1.0);
    encode_channels(size, channels, metadata, white_luminance)
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
    let channels = channels.into_iter().map(|c| AnyChannel::new(&*c.name, FlatSamples::F32(c.values)));
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
    if let Some(captured) = &metadata.captured {
        attributes.capture_date = Some(Text::from_slice_unchecked(captured.as_bytes()));
        attributes.utc_offset = Some(0.0);
    }
    if let Some(camera) = &metadata.camera {
        add_camera(&mut attributes, camera);
    }
    for (key, value) in metadata.sorted()? {
        let name = Text::from_slice_unchecked(format!("{PREFIX}{}", key.replace(' ', "_")).as_bytes());
        let value = Text::from_slice_unchecked(value.as_bytes());
        attributes.other.insert(name, AttributeValue::Text(value));
    }
    Ok(attributes)
}

/// The attributes that the standard has for cameras (OpenEXR, `ImfStandardAttributes.h`).
fn add_camera(attributes: &mut LayerAttributes, camera: &CameraFacts) {
    let single = |v: f64| v as f32;
    let flat = |m: Matrix| std::array::from_fn(|i| m[i / 4][i % 4] as f32);
    attributes.world_to_camera = Some(flat(camera.world_to_camera()));
    attributes.world_to_normalized_device = camera.world_to_ndc().map(flat);
    attributes.exposure = Some(single(camera.exposure_duration));
    attributes.aperture = camera.f_number().map(single);
    attributes.focus = camera.focus_distance.map(single);
    attributes.iso_speed = camera.film_iso.map(single);
}

/// Rows from top to bottom, which every program reads.
fn encoding() -> Encoding {
    Encoding {
        compression: exr::compression::Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    }
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
