//! What decoding a picture takes is known before: a picture that is let in under a bound holds no more than that, as an
//! allocator that counts sees it, and is refused by a lower one.

use exr::prelude::{Compression, Encoding, SpecificChannels, Vec2, WritableImage, f16};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, Rgba};
use indigo_formats::image::{Pixels, decode_within};
use indigo_testkit::allocation::{Counting, peak_of};
use std::io::Cursor;
use tiff::encoder::colortype::{ColorType, RGB8, RGB32Float, RGBA32Float};
use tiff::encoder::{TiffEncoder, TiffValue};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Large enough for the texels to outweigh all else.
const SIDE: u32 = 1024;
/// Some rows, tables of codes, and what the thread keeps.
const ALLOWANCE: usize = 1 << 20;
/// Copies of the file.
const COPIES: usize = 2;

fn encode(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, format).expect("a picture");
    bytes.into_inner()
}

fn flat<P: image::Pixel>(texel: P) -> ImageBuffer<P, Vec<P::Subpixel>> {
    ImageBuffer::from_pixel(SIDE, SIDE, texel)
}

fn tiff_of<C: ColorType>(value: C::Inner) -> Vec<u8>
where
    C::Inner: Copy,
    [C::Inner]: TiffValue,
{
    let samples = vec![value; (SIDE * SIDE) as usize * C::BITS_PER_SAMPLE.len()];
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("a file");
    encoder.write_image::<C>(SIDE, SIDE, &samples).expect("a picture");
    bytes.into_inner()
}

/// A black JPEG of three components, progressive or with a scan for each of them: every code is of one bit, 0.
fn jpeg(is_progressive: bool) -> Vec<u8> {
    let segment = |marker: u8, content: &[u8]| {
        let length = (content.len() as u16 + 2).to_be_bytes();
        [&[0xFF, marker], length.as_slice(), content].concat()
    };
    let [high, low] = (SIDE as u16).to_be_bytes();
    let components = [1, 2, 3].map(|id| [id, 0x11, 0]).concat();
    // One code of one bit, for "no difference" or "no more coefficients".
    let codes = |class: u8| [vec![class << 4, 1], vec![0; 15], vec![0]].concat();
    let blocks = (SIDE * SIDE / 64) as usize;
    let mut file = vec![0xFF, 0xD8];
    file.extend(segment(0xDB, &[vec![0], vec![1; 64]].concat()));
    let frame = if is_progressive { 0xC2 } else { 0xC0 };
    file.extend(segment(frame, &[&[8, high, low, high, low, 3], components.as_slice()].concat()));
    file.extend(segment(0xC4, &codes(0)));
    file.extend(segment(0xC4, &codes(1)));
    if is_progressive {
        file.extend(segment(0xDA, &[3, 1, 0, 2, 0, 3, 0, 0, 0, 0]));
        file.extend(vec![0; 3 * blocks / 8]);
    } else {
        for id in 1..=3 {
            file.extend(segment(0xDA, &[1, id, 0, 0, 63, 0]));
            file.extend(vec![0; 2 * blocks / 8]);
        }
    }
    file.extend([0xFF, 0xD9]);
    file
}

/// Indices of eight bits into a palette of one colour.
fn tga_with_a_palette() -> Vec<u8> {
    let [low, high] = (SIDE as u16).to_le_bytes();
    let header = [0, 1, 1, 0, 0, 1, 0, 24, 0, 0, 0, 0, low, high, low, high, 8, 0];
    [header.as_slice(), &[3, 2, 1], &vec![0; (SIDE * SIDE) as usize]].concat()
}

/// One tile as large as the picture.
fn exr_tile(compression: Compression, is_half: bool) -> Vec<u8> {
    let side = SIDE as usize;
    let encoding = Encoding {
        compression,
        blocks: exr::image::Blocks::Tiles(Vec2(side, side)),
        line_order: exr::prelude::LineOrder::Increasing,
    };
    let mut bytes = Cursor::new(Vec::new());
    let noise = |at: Vec2<usize>| (at.0 * 7919 % 101 + at.1 * 104_729 % 103) as f32;
    macro_rules! write {
        ($value:expr) => {{
            let channels = SpecificChannels::rgb(|at: Vec2<usize>| ($value(at), $value(at), $value(at)));
            let layer = exr::prelude::Layer::new((side, side), Default::default(), encoding, channels);
            let image = exr::prelude::Image::from_layer(layer);
            image.write().non_parallel().to_buffered(&mut bytes).expect("a picture");
        }};
    }
    if is_half {
        write!(|at| f16::from_f32(noise(at)));
    } else {
        write!(noise);
    }
    bytes.into_inner()
}

fn hdr(sides: &str) -> Vec<u8> {
    let texels = [9, 128, 64, 129].repeat((SIDE * SIDE) as usize);
    [format!("#?RADIANCE\n\n{sides}\n").as_bytes(), &texels].concat()
}

fn pictures() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    vec![
        ("grey", "a.png", encode(flat(Luma([9_u8])), ImageFormat::Png)),
        ("colours", "a.png", encode(flat(Rgb([9_u8; 3])), ImageFormat::Png)),
        ("colours and alpha", "a.png", encode(flat(Rgba([9_u8; 4])), ImageFormat::Png)),
        ("of sixteen bits", "a.png", encode(flat(Rgba([9_u16; 4])), ImageFormat::Png)),
        ("grey and alpha", "a.png", encode(flat(LumaA([9_u16; 2])), ImageFormat::Png)),
        ("colours and alpha", "a.bmp", encode(flat(Rgba([9_u8; 4])), ImageFormat::Bmp)),
        ("colours", "a.tga", encode(flat(Rgb([9_u8; 3])), ImageFormat::Tga)),
        ("a palette", "a.tga", tga_with_a_palette()),
        ("colours", "a.tif", tiff_of::<RGB8>(9)),
        ("floats", "a.tif", tiff_of::<RGB32Float>(9.0)),
        ("floats and alpha", "a.tif", tiff_of::<RGBA32Float>(9.0)),
        ("all at once", "a.jpg", encode(flat(Rgb([9_u8; 3])), ImageFormat::Jpeg)),
        ("progressive", "a.jpg", jpeg(true)),
        ("one component after the other", "a.jpg", jpeg(false)),
        ("upright", "a.hdr", hdr(&format!("-Y {SIDE} +X {SIDE}"))),
        ("turned", "a.hdr", hdr(&format!("+X {SIDE} +Y {SIDE}"))),
        ("not compressed", "a.exr", exr_tile(Compression::Uncompressed, false)),
        ("ZIP", "a.exr", exr_tile(Compression::ZIP16, false)),
        ("RLE", "a.exr", exr_tile(Compression::RLE, false)),
        ("PIZ", "a.exr", exr_tile(Compression::PIZ, false)),
        ("PXR24", "a.exr", exr_tile(Compression::PXR24, false)),
        ("B44", "a.exr", exr_tile(Compression::B44, true)),
        ("DWA", "a.exr", exr_tile(Compression::DWAA(None), true)),
    ]
}

/// The bytes that a refused picture would take.
fn foretold(name: &str, bytes: &[u8]) -> u64 {
    let too_little = u64::from(SIDE * SIDE) - 1;
    let error = decode_within(name, bytes, too_little).expect_err("a byte for each texel, at least");
    let number = error.found.split_whitespace().find_map(|word| word.parse().ok());
    number.unwrap_or_else(|| panic!("{name}: {error}"))
}

#[test]
fn decoding_holds_no_more_than_foretold() {
    for (what, name, bytes) in pictures() {
        let most = foretold(name, &bytes);
        assert!(decode_within(name, &bytes, most - 1).is_err(), "{name}, {what}");
        let (image, peak) = peak_of(|| decode_within(name, &bytes, most));
        let image = image.unwrap_or_else(|error| panic!("{name}, {what}: {error}"));
        assert_eq!((image.width, image.height), (SIDE, SIDE), "{name}, {what}");
        let bound = most as usize + COPIES * bytes.len() + ALLOWANCE;
        assert!(peak <= bound, "{name}, {what}: {peak} bytes, of {most} foretold");
        // And the foretelling is no excuse to refuse what would fit.
        assert!(most as usize <= 4 * peak, "{name}, {what}: {peak} bytes, of {most} foretold");
        let held = match &image.pixels {
            Pixels::U8(v) => v.capacity(),
            Pixels::U16(v) => 2 * v.capacity(),
            Pixels::F32(v) => 4 * v.capacity(),
        };
        let texels = (SIDE * SIDE) as usize * usize::from(image.channels);
        assert!(held <= 4 * texels && held >= texels, "{name}, {what}: {held} bytes for {texels} values");
    }
}
