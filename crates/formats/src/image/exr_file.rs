//! OpenEXR: half, float or integer channels R, G, B, or Y alone; the first layer that has them, at full resolution.

use std::io::Cursor;

use exr::meta::MetaData;
use exr::prelude::*;

use super::{ALPHA, Image, Pixels, Primaries, check_memory, check_sides, decoder_error};
use crate::error::{FormatError, Position};

/// The bytes that every EXR file starts with.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2F, 0x31, 0x01];

/// How often the decoder (`exr` 1.74.2) holds a block of the file at once: as it is stored, as its compression left it, and
/// as it is passed on.
const COPIES_OF_A_BLOCK: u64 = 4;

const WHOLE_NUMBERS: &str =
    "its channels are of whole numbers, which are taken as they are: 1 is white, not the largest";

/// Decodes the data window; where it lies in the display window is not told.
pub(super) fn decode(bytes: &[u8], most_bytes: u64) -> std::result::Result<Image, FormatError> {
    let complaint = |error: exr::error::Error| decoder_error("EXR", &error);
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(complaint)?;
    for header in &meta.headers {
        let Vec2(width, height) = header.layer_size;
        check_sides(width as u64, height as u64)?;
        // Ours are three floats a texel. A block may be a tile as large as the picture, or larger.
        let texels = 12 * width as u64 * height as u64;
        let Vec2(block_width, block_height) = header.max_block_pixel_size();
        let block = (block_width as u64)
            .saturating_mul(block_height as u64)
            .saturating_mul(header.channels.bytes_per_pixel as u64);
        check_memory(texels.saturating_add(block.saturating_mul(COPIES_OF_A_BLOCK)), most_bytes)?;
    }
    let has =
        |names: &[&str]| meta.headers.iter().any(|header| names.iter().all(|name| has_channel(header, name)));
    let of_whole_numbers = |names: &[&str]| {
        let mut channels = meta.headers.iter().flat_map(|header| &header.channels.list);
        channels.any(|channel| {
            channel.sample_type == SampleType::U32 && names.iter().any(|name| channel.name.eq(name))
        })
    };
    let noted = |mut image: Image, names: &[&str]| {
        image.notes.extend(of_whole_numbers(names).then_some(WHOLE_NUMBERS));
        image
    };
    if has(&["R", "G", "B"]) {
        let primaries = meta.headers.iter().find_map(|header| header.shared_attributes.chromaticities);
        let image = rgb(bytes).map_err(complaint)?;
        Ok(noted(Image { primaries: primaries.map(chromaticities), ..image }, &["R", "G", "B"]))
    } else if has(&["Y"]) {
        grey(bytes).map(|image| noted(image, &["Y"])).map_err(complaint)
    } else {
        let names: Vec<String> = meta
            .headers
            .iter()
            .flat_map(|header| &header.channels.list)
            .map(|channel| channel.name.to_string())
            .collect();
        Err(FormatError::new(
            Position::Byte(0),
            "an EXR file with channels R, G, B or Y",
            format!("the channels {}", names.join(", ")),
        ))
    }
}

fn chromaticities(of: exr::meta::attribute::Chromaticities) -> Primaries {
    [of.red, of.green, of.blue, of.white].map(|Vec2(x, y)| [x.into(), y.into()])
}

fn has_channel(header: &exr::meta::header::Header, name: &str) -> bool {
    header.channels.list.iter().any(|channel| channel.name.eq(name))
}

fn rgb(bytes: &[u8]) -> exr::error::Result<Image> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| Texels::<3>::new(size),
            |texels, at, (r, g, b, alpha): (f32, f32, f32, f32)| texels.set(at, [r, g, b], alpha),
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))?;
    Ok(image.layer_data.channel_data.pixels.into_image())
}

fn grey(bytes: &[u8]) -> exr::error::Result<Image> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("Y")
        .optional("A", 1.0)
        .collect_pixels(
            |size, _| Texels::<1>::new(size),
            |texels, at, (y, alpha): (f32, f32)| texels.set(at, [y], alpha),
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))?;
    Ok(image.layer_data.channel_data.pixels.into_image())
}

/// Texels of `N` channels as they are decoded, in whatever order.
struct Texels<const N: usize> {
    size: Vec2<usize>,
    values: Vec<[f32; N]>,
    is_opaque: bool,
}

impl<const N: usize> Texels<N> {
    fn new(size: Vec2<usize>) -> Self {
        Self { size, values: vec![[0.0; N]; size.area()], is_opaque: true }
    }

    fn set(&mut self, at: Vec2<usize>, texel: [f32; N], alpha: f32) {
        self.is_opaque &= alpha == 1.0;
        if let Some(slot) = self.values.get_mut(at.y() * self.size.width() + at.x()) {
            *slot = texel;
        }
    }

    fn into_image(self) -> Image {
        Image {
            width: self.size.width() as u32,
            height: self.size.height() as u32,
            channels: N as u8,
            pixels: Pixels::F32(self.values.into_flattened()),
            primaries: None,
            notes: if self.is_opaque { vec![] } else { vec![ALPHA] },
        }
    }
}
