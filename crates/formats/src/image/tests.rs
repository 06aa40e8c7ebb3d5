use std::io::{Cursor, Write};

use ::image::{DynamicImage, GrayImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, RgbImage, Rgba};
use exr::prelude::{SpecificChannels, Vec2, WritableImage, f16};

use super::*;

const WIDTH: u32 = 3;
const HEIGHT: u32 = 2;

/// A value that differs at every texel and channel.
fn value(x: u32, y: u32, channel: u32) -> u32 {
    1 + 40 * x + 100 * y + 7 * channel
}

fn encode(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// All values, rows from the top.
fn values(channels: u32) -> Vec<u32> {
    let texels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    texels.flat_map(|(x, y)| (0..channels).map(move |c| value(x, y, c))).collect()
}

fn rgb8() -> DynamicImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| Rgb([0, 1, 2].map(|c| value(x, y, c) as u8))).into()
}

fn check(name: &str, bytes: &[u8], channels: u8, pixels: &Pixels) {
    let image = decode(name, bytes).unwrap();
    assert_eq!((image.width, image.height, image.channels), (WIDTH, HEIGHT, channels), "{name}");
    assert_eq!(&image.pixels, pixels, "{name}");
}

#[test]
fn lossless_kinds_of_eight_bits() {
    let expected = Pixels::U8(values(3).into_iter().map(|v| v as u8).collect());
    for (name, format) in
        [("a.png", ImageFormat::Png), ("a.tga", ImageFormat::Tga), ("a.bmp", ImageFormat::Bmp)]
    {
        let bytes = encode(&rgb8(), format);
        check(name, &bytes, 3, &expected);
        if format != ImageFormat::Tga {
            check("no extension", &bytes, 3, &expected);
        }
    }
}

#[test]
fn alpha_is_dropped_and_grey_stays_grey() {
    let rgba = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| {
        let [r, g, b] = [0, 1, 2].map(|c| value(x, y, c) as u8);
        Rgba([r, g, b, 9])
    });
    let rgb = Pixels::U8(values(3).into_iter().map(|v| v as u8).collect());
    check("a.png", &encode(&rgba.into(), ImageFormat::Png), 3, &rgb);
    let grey_alpha = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| LumaA([value(x, y, 0) as u8, 9]));
    let grey = Pixels::U8(values(1).into_iter().map(|v| v as u8).collect());
    check("a.png", &encode(&grey_alpha.into(), ImageFormat::Png), 1, &grey);
    let plain = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([value(x, y, 0) as u8]));
    check("a.png", &encode(&plain.into(), ImageFormat::Png), 1, &grey);
}

/// An alpha that says nothing is dropped in silence.
#[test]
fn alpha_is_told_where_it_is_not_opaque() {
    let notes = |name, bytes: &[u8]| decode(name, bytes).unwrap().notes;
    for (last, expected) in [(u8::MAX, vec![]), (254, vec![ALPHA])] {
        let alpha = |x, y| if (x, y) == (WIDTH - 1, HEIGHT - 1) { last } else { u8::MAX };
        let rgba = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| Rgba([1, 2, 3, alpha(x, y)]));
        for (name, format) in [("a.png", ImageFormat::Png), ("a.tga", ImageFormat::Tga)] {
            assert_eq!(notes(name, &encode(&rgba.clone().into(), format)), expected, "{name}");
        }
        let wide = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| LumaA([7_u16, u16::from(alpha(x, y)) * 257]));
        let wide = encode(&DynamicImage::ImageLumaA16(wide), ImageFormat::Png);
        assert_eq!(notes("a.png", &wide), expected);
        let alpha = |p: Vec2<usize>| f32::from(alpha(p.x() as u32, p.y() as u32)) / 255.0;
        let channels = SpecificChannels::rgba(|p: Vec2<usize>| (1.0_f32, 2.0_f32, 3.0_f32, alpha(p)));
        let mut exr = Cursor::new(Vec::new());
        let image = exr::prelude::Image::from_channels((WIDTH as usize, HEIGHT as usize), channels);
        image.write().non_parallel().to_buffered(&mut exr).unwrap();
        assert_eq!(notes("a.exr", exr.get_ref()), expected);
    }
}

/// Whole numbers of an EXR are numbers, not shares of the largest; that is told.
#[test]
fn whole_numbers_of_an_exr_are_taken_as_they_are() {
    let channels = SpecificChannels::build().with_channel("Y").with_pixel_fn(|_: Vec2<usize>| (3_u32,));
    let mut exr = Cursor::new(Vec::new());
    let image = exr::prelude::Image::from_channels((1, 1), channels);
    image.write().non_parallel().to_buffered(&mut exr).unwrap();
    let image = decode("a.exr", exr.get_ref()).unwrap();
    assert_eq!(image.pixels, Pixels::F32(vec![3.0]));
    assert!(image.notes[0].contains("whole numbers"), "{:?}", image.notes);
}

#[test]
fn sixteen_bits_stay() {
    let rgb = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| Rgb([0, 1, 2].map(|c| 200 * value(x, y, c) as u16)));
    let expected = Pixels::U16(values(3).into_iter().map(|v| 200 * v as u16).collect());
    check("a.png", &encode(&DynamicImage::ImageRgb16(rgb), ImageFormat::Png), 3, &expected);
    let grey = ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| Luma([200 * value(x, y, 0) as u16]));
    let expected = Pixels::U16(values(1).into_iter().map(|v| 200 * v as u16).collect());
    check("a.png", &encode(&DynamicImage::ImageLuma16(grey), ImageFormat::Png), 1, &expected);
}

#[test]
fn a_palette_is_expanded() {
    // A BMP of 2 x 1 texels of 8 bits with a palette of two colours (blue, green, red, 0).
    let mut bmp = b"BM".to_vec();
    for word in [66_u32, 0, 62, 40, 2, 1] {
        bmp.write_all(&word.to_le_bytes()).unwrap();
    }
    bmp.write_all(&[1, 0, 8, 0]).unwrap();
    for word in [0_u32, 4, 0, 0, 2, 0] {
        bmp.write_all(&word.to_le_bytes()).unwrap();
    }
    bmp.write_all(&[30, 20, 10, 0, 60, 50, 40, 0, 1, 0, 0, 0]).unwrap();
    let image = decode("a.bmp", &bmp).unwrap();
    assert_eq!((image.width, image.height, image.channels), (2, 1, 3));
    assert_eq!(image.pixels, Pixels::U8(vec![40, 50, 60, 10, 20, 30]));
}

#[test]
fn a_jpeg_keeps_a_flat_colour() {
    let flat = RgbImage::from_pixel(16, 8, Rgb([200, 100, 50]));
    let image = decode("a.jpg", &encode(&flat.into(), ImageFormat::Jpeg)).unwrap();
    assert_eq!((image.width, image.height, image.channels), (16, 8, 3));
    let Pixels::U8(values) = image.pixels else { panic!("eight bits") };
    // Quantisation of the mean: a few steps of 255.
    for (i, value) in values.iter().enumerate() {
        assert!(value.abs_diff([200, 100, 50][i % 3]) <= 3, "{value} at {i}");
    }
}

/// A decoder makes grey of what is missing.
#[test]
fn a_jpeg_that_is_cut_off_is_refused() {
    let noise =
        RgbImage::from_fn(64, 64, |x, y| Rgb([0, 1, 2].map(|c| ((x * 37) ^ (y * 101) ^ (c * 59)) as u8)));
    let whole = encode(&noise.into(), ImageFormat::Jpeg);
    decode("a.jpg", &whole).unwrap();
    for end in [whole.len() / 2, whole.len() * 9 / 10, whole.len() - 1] {
        let error = decode("a.jpg", &whole[..end]).unwrap_err();
        assert!(error.expected.contains("whole JPEG"), "{error}");
    }
}

#[test]
fn radiance_hdr_keeps_values_beyond_one() {
    let bright = ImageBuffer::from_pixel(16, 8, Rgb([64.0_f32, 2.0, 0.5]));
    let image = decode("a.hdr", &encode(&DynamicImage::ImageRgb32F(bright), ImageFormat::Hdr)).unwrap();
    let Pixels::F32(values) = image.pixels else { panic!("floats") };
    assert_eq!(values.len(), 16 * 8 * 3);
    // RGBE shares one exponent: steps of 64 / 128 here.
    for (i, value) in values.iter().enumerate() {
        assert!((value - [64.0, 2.0, 0.5][i % 3]).abs() <= 0.5, "{value} at {i}");
    }
}

/// Two rows of three texels with one exponent each, not compressed: value 128 and exponent 129 are 1.
fn hdr(header: &str, sides: &str) -> Vec<u8> {
    let mut bytes = format!("{header}\n{sides}\n").into_bytes();
    bytes.extend((0..6u8).flat_map(|i| [16 * i, 128, 64, 129]));
    bytes
}

fn hdr_values(header: &str, sides: &str) -> (u32, u32, Vec<f32>) {
    let image = decode("a.hdr", &hdr(header, sides)).unwrap();
    let Pixels::F32(values) = image.pixels else { panic!("floats") };
    (image.width, image.height, values)
}

/// Values are divided by all exposures and corrections, which makes them radiance again.
#[test]
fn radiance_exposures_are_taken_back() {
    let sides = "-Y 2 +X 3";
    let (_, _, plain) = hdr_values("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", sides);
    assert_eq!(plain[3..6], [0.125, 1.0, 0.5]);
    for head in
        ["#?RGBE\n", "#?AUTOPANO\r\n# by hand\r\npcomp\r\n\tEXPOSURE=9\r\n\r", "#?RADIANCE\nEXPOSURE=1\n"]
    {
        assert_eq!(hdr_values(head, sides).2, plain, "{head}");
    }
    let head =
        "#?RADIANCE\nEXPOSURE=2\nCOLORCORR= 1 0.5 4\nEXPOSURE = 7\nEXPOSURE= 2.0 \nCOLORCORR=1 1 0.25\n";
    assert_eq!(hdr_values(head, sides).2[3..6], [0.125 / 4.0, 0.5, 0.125]);
}

/// Whichever way the scanlines run, the picture stands upright. Reds are 0 to 5 eighths in the order of the file.
#[test]
fn radiance_pictures_lie_in_any_direction() {
    for (sides, size, order) in [
        ("-Y 2 +X 3", [3, 2], [0, 1, 2, 3, 4, 5]),
        ("+Y 2 +X 3", [3, 2], [3, 4, 5, 0, 1, 2]),
        ("-Y 2 -X 3", [3, 2], [2, 1, 0, 5, 4, 3]),
        ("+Y 2 -X 3", [3, 2], [5, 4, 3, 2, 1, 0]),
        ("+X 2 -Y 3", [2, 3], [0, 3, 1, 4, 2, 5]),
        ("+X 2 +Y 3", [2, 3], [2, 5, 1, 4, 0, 3]),
        ("-X 2 -Y 3", [2, 3], [3, 0, 4, 1, 5, 2]),
        ("-X 2 +Y 3", [2, 3], [5, 2, 4, 1, 3, 0]),
    ] {
        let (width, height, values) = hdr_values("#?RADIANCE\n", sides);
        let reds: Vec<u32> = values.iter().step_by(3).map(|v| (v * 8.0) as u32).collect();
        assert_eq!(([width, height], reds), (size, order.to_vec()), "{sides}");
    }
}

#[test]
fn what_is_wrong_in_a_radiance_header_is_named_with_its_line() {
    let refused = |header: &str, sides: &str, message: &str| {
        let error = decode("a.hdr", &hdr(header, sides)).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    };
    let sides = "-Y 2 +X 3";
    refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n", sides, "2:1: expected FORMAT=32-bit_rle_rgbe");
    for exposure in ["0", "-1", "nan", "inf", "", "1 2", "1e-40"] {
        refused(&format!("#?RADIANCE\n\tx\nEXPOSURE={exposure}\n"), sides, "3:1: expected EXPOSURE=");
    }
    refused("#?RADIANCE\nEXPOSURE=1e20\nEXPOSURE=1e20\n", sides, "3:1: expected exposures");
    refused("#?RADIANCE\nCOLORCORR=1 2\n", sides, "2:1: expected COLORCORR=");
    refused("#?RADIANCE\nPRIMARIES=1 2\n", sides, "2:1: expected PRIMARIES=");
    for sides in ["", "-Y 2", "2 3", "-Z 2 +X 3", "-Y 2 +Y 3", "+X 2 +X 3", "-Y -2 +X 3", "-Y 2 +X 3 4"] {
        refused("#?RADIANCE\n", sides, "3:1: expected the sides");
    }
    refused("#?RADIANCE\n", "-Y 2 +X 40000", "byte 0: expected a picture of 1 to 32768 texels");
    refused("#?RADIANCE\n", "-Y 3 +X 3", "byte 0: expected a sound HDR file");
    let error = decode("a.hdr", b"#?RADIANCE\nEXPOSURE=1\n").unwrap_err().to_string();
    assert_eq!(error, "3:1: expected an empty line after the header, found the end of it");
}

/// Files tell which colours their channels are.
#[test]
fn primaries_are_told() {
    let wide = [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], [0.3127, 0.3290]];
    let head = "#?RADIANCE\nPRIMARIES= .708 .292 .170 .797\t.131 .046 .3127 .3290\n";
    assert_eq!(decode("a.hdr", &hdr(head, "-Y 2 +X 3")).unwrap().primaries, Some(wide));
    assert_eq!(decode("a.hdr", &hdr("#?RADIANCE\n", "-Y 2 +X 3")).unwrap().primaries, None);
    let channels = SpecificChannels::rgb(|_: Vec2<usize>| (1.0f32, 0.0f32, 0.0f32));
    let mut image = exr::prelude::Image::from_channels((2, 1), channels);
    let [red, green, blue, white] = wide.map(|[x, y]| Vec2(x as f32, y as f32));
    image.attributes.chromaticities = Some(exr::meta::attribute::Chromaticities { red, green, blue, white });
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    let told = decode("a.exr", bytes.get_ref()).unwrap().primaries.unwrap();
    assert!(told.iter().flatten().zip(wide.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-7), "{told:?}");
}

#[test]
fn exr_of_half_or_float_with_or_without_colour() {
    let size = Vec2(WIDTH as usize, HEIGHT as usize);
    let at = |p: Vec2<usize>, c: u32| value(p.x() as u32, p.y() as u32, c) as f32;
    let mut float = Cursor::new(Vec::new());
    let channels = SpecificChannels::rgb(|p: Vec2<usize>| (at(p, 0), at(p, 1), at(p, 2)));
    exr::prelude::Image::from_channels(size, channels)
        .write()
        .non_parallel()
        .to_buffered(&mut float)
        .unwrap();
    let rgb = Pixels::F32(values(3).into_iter().map(|v| v as f32).collect());
    check("a.exr", float.get_ref(), 3, &rgb);
    let mut half = Cursor::new(Vec::new());
    let channels = SpecificChannels::rgba(|p: Vec2<usize>| {
        (f16::from_f32(at(p, 0)), f16::from_f32(at(p, 1)), f16::from_f32(at(p, 2)), f16::ONE)
    });
    exr::prelude::Image::from_channels(size, channels).write().non_parallel().to_buffered(&mut half).unwrap();
    check("named wrongly.png", half.get_ref(), 3, &rgb);
    let mut grey = Cursor::new(Vec::new());
    let channels = SpecificChannels::build().with_channel("Y").with_pixel_fn(|p: Vec2<usize>| (at(p, 0),));
    exr::prelude::Image::from_channels(size, channels).write().non_parallel().to_buffered(&mut grey).unwrap();
    check("a.exr", grey.get_ref(), 1, &Pixels::F32(values(1).into_iter().map(|v| v as f32).collect()));
    let mut depth = Cursor::new(Vec::new());
    let channels = SpecificChannels::build().with_channel("Z").with_pixel_fn(|p: Vec2<usize>| (at(p, 0),));
    exr::prelude::Image::from_channels(size, channels)
        .write()
        .non_parallel()
        .to_buffered(&mut depth)
        .unwrap();
    assert!(decode("a.exr", depth.get_ref()).unwrap_err().found.contains("channels Z"));
}

#[test]
fn what_is_no_picture_or_too_large_is_refused() {
    let error = decode("a.gif", b"GIF89a").unwrap_err().to_string();
    assert!(error.contains("PNG, JPEG, TGA, BMP, TIFF, HDR, EXR"), "{error}");
    assert!(decode("a.png", &encode(&rgb8(), ImageFormat::Png)[..40]).is_err());
    // The width of a PNG stands at bytes 16 to 19; the checksum after the header is bytes 29 to 32.
    let mut wide = encode(&rgb8(), ImageFormat::Png);
    for width in [0, 32_769, 1_000_000_000, i32::MAX as u32, u32::MAX] {
        wide[16..20].copy_from_slice(&width.to_be_bytes());
        let error = decode("a.png", &wide).unwrap_err();
        assert!(error.expected.contains("1 to 32768 texels"), "{error}");
        assert_eq!(error.found, format!("{width} x {HEIGHT} texels"));
    }
    // A TGA header of 32,767 x 32,767 texels of 24 bits without data; 65,535 is beyond the limit.
    for side in [32_767_u16, 65_535] {
        let mut tga = vec![0; 18];
        tga[2] = 2;
        tga[12..14].copy_from_slice(&side.to_le_bytes());
        tga[14..16].copy_from_slice(&side.to_le_bytes());
        tga[16] = 24;
        assert!(decode("a.tga", &tga).is_err());
    }
    assert!(check_sides(32_768, 32_768).is_ok());
    assert!(check_sides(0, 5).is_err());
    assert!(check_sides(32_769, 1).is_err());
}
