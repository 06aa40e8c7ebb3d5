//! OpenEXR: the linear picture, for measuring and for tone mapping elsewhere.

use crate::{ImagingError, LinearImage, Metadata};
use exr::image::write::WritableImage;
use exr::image::{Encoding, Image, Layer, SpecificChannels};
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
    let (width, height) = (image.width as usize, image.height as usize);
    if width * height != image.pixels.len() || image.pixels.is_empty() {
        return Err(ImagingError::Exr("the picture has no pixels, or not as many as its size says".into()));
    }
    let mut attributes = LayerAttributes { white_luminance, ..LayerAttributes::default() };
    for (key, value) in metadata.sorted()? {
        let name = Text::from_slice_unchecked(format!("{PREFIX}{key}").as_bytes());
        let value = Text::from_slice_unchecked(value.as_bytes());
        attributes.other.insert(name, AttributeValue::Text(value));
    }
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b, _] = image.pixels[at.y() * width + at.x()];
        (r, g, b)
    });
    let encoding = Encoding { compression: exr::compression::Compression::ZIP16, ..Encoding::FAST_LOSSLESS };
    let layer = Layer::new((width, height), attributes, encoding, channels);
    let mut file = Image::from_layer(layer);
    file.attributes.chromaticities = Some(rec709());
    let mut bytes = Cursor::new(Vec::new());
    file.write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| ImagingError::Exr(error.to_string()))?;
    Ok(bytes.into_inner())
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
