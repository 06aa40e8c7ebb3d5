//! Pictures that scenes name.

use exr::prelude::{Image, SpecificChannels, WritableImage};

/// An EXR file of columns and rows, whose linear values are given by the texel's number, rows from the top.
pub fn rgb([width, height]: [usize; 2], value: impl Fn(usize) -> [f32; 3] + Sync) -> Vec<u8> {
    let texel = |at: exr::math::Vec2<usize>| {
        let [r, g, b] = value(at.y() * width + at.x());
        (r, g, b)
    };
    let image = Image::from_channels((width, height), SpecificChannels::rgb(texel));
    let mut bytes = std::io::Cursor::new(vec![]);
    image.write().to_buffered(&mut bytes).expect("memory takes every byte");
    bytes.into_inner()
}

/// A square PNG file of grey codes.
pub fn grey(side: u32, codes: &[u8]) -> Vec<u8> {
    let mut bytes = vec![];
    let mut encoder = png::Encoder::new(&mut bytes, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(codes));
    written.expect("memory takes every byte");
    bytes
}
