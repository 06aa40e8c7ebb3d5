//! Pictures that scenes name.

use indigo_imaging::{LinearImage, Metadata, exr, png};

/// An EXR file of columns and rows, whose linear values are given by the texel's number, rows from the top.
pub fn rgb([width, height]: [u32; 2], value: impl Fn(usize) -> [f32; 3]) -> Vec<u8> {
    let texel = |i: usize| {
        let [r, g, b] = value(i);
        [r, g, b, 1.0]
    };
    let pixels = (0..(width * height) as usize).map(texel).collect();
    exr::encode(&LinearImage { width, height, pixels }, &Metadata::default()).expect("a picture")
}

/// A square PNG file of grey codes.
pub fn grey(side: u32, codes: &[u8]) -> Vec<u8> {
    png::encode_grey(side, codes).expect("a picture")
}
