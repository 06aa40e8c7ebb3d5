//! PNG and EXR files, read back by other code than wrote them.

use exr::prelude::*;
use indigo_imaging::png::{Depth, Format, encode, read_metadata};
use indigo_imaging::{ImagingError, LinearImage, Metadata, Picture, RenderFacts};
use std::io::Cursor;

const EIGHT: Format = Format { depth: Depth::Eight, dithered: false };
const SIXTEEN: Format = Format { depth: Depth::Sixteen, dithered: false };

fn picture(width: u32, height: u32) -> Picture {
    let n = width * height;
    let pixels = (0..n).map(|i| {
        let v = (i as f32 + 0.5) / n as f32;
        [v, 1.0 - v, v * v, 1.0]
    });
    Picture { width, height, pixels: pixels.collect() }
}

/// IEC 61966-2-1, written out again.
fn srgb(linear: f32) -> f64 {
    let v = f64::from(linear);
    if v <= 0.0031308 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

fn decode(bytes: &[u8]) -> (png::OutputInfo, Vec<u8>, Option<png::SrgbRenderingIntent>) {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    (info, data, reader.info().srgb)
}

#[test]
fn png_holds_the_pixels_as_srgb() {
    for (width, height) in [(1, 1), (1, 9), (9, 1), (64, 31)] {
        let picture = picture(width, height);
        let (info, data, intent) = decode(&encode(&picture, &Metadata::default(), EIGHT).unwrap());
        assert_eq!((info.width, info.height, info.bit_depth), (width, height, png::BitDepth::Eight));
        assert_eq!(intent, Some(png::SrgbRenderingIntent::Perceptual));
        let want = picture.pixels.iter().flat_map(|p| &p[..3]);
        assert_eq!(data.len(), want.clone().count());
        for (&got, &want) in data.iter().zip(want) {
            assert!((f64::from(got) - 255.0 * srgb(want)).abs() <= 0.5 + 1e-4);
        }
    }
}

#[test]
fn png_of_16_bits() {
    let picture = picture(17, 5);
    let (info, data, _) = decode(&encode(&picture, &Metadata::default(), SIXTEEN).unwrap());
    assert_eq!((info.bit_depth, info.color_type), (png::BitDepth::Sixteen, png::ColorType::Rgb));
    let want = picture.pixels.iter().flat_map(|p| &p[..3]);
    for (got, &want) in data.chunks_exact(2).zip(want) {
        let got = f64::from(u16::from_be_bytes([got[0], got[1]]));
        assert!((got - 65535.0 * srgb(want)).abs() <= 0.5 + 1e-3);
    }
}

/// Light between two codes: without dithering always the nearest, with it either, in the proportion that leaves the
/// mean right to 4.5 standard deviations (false alarm 7e-6 each, fixed seed). Black and white stay.
#[test]
fn dithering_keeps_the_mean_and_leaves_black_and_white_alone() {
    let n = 128 * 128;
    for (light, depth, largest) in
        [(0.2, Depth::Eight, 255.0), (0.7, Depth::Eight, 255.0), (0.3, Depth::Sixteen, 65535.0)]
    {
        let pixels = vec![[light, 0.0, 1.0, 1.0]; n];
        let picture = Picture { width: 128, height: 128, pixels };
        let codes = |dithered| -> Vec<[f64; 3]> {
            let (_, data, _) =
                decode(&encode(&picture, &Metadata::default(), Format { depth, dithered }).unwrap());
            let bytes = if depth == Depth::Eight { 1 } else { 2 };
            let code = |b: &[u8]| b.iter().fold(0.0, |sum, &v| 256.0 * sum + f64::from(v));
            data.chunks(3 * bytes).map(|p| [0, 1, 2].map(|c| code(&p[c * bytes..(c + 1) * bytes]))).collect()
        };
        let exact = srgb(light) * largest;
        let (plain, dithered) = (codes(false), codes(true));
        assert!(plain.iter().all(|c| c[0] == exact.round()));
        assert!(
            dithered
                .iter()
                .all(|c| (c[0] == exact.floor() || c[0] == exact.ceil()) && c[1] == 0.0 && c[2] == largest)
        );
        let mean = dithered.iter().map(|c| c[0]).sum::<f64>() / n as f64;
        let fraction = exact.fract();
        let deviation = (fraction * (1.0 - fraction) / n as f64).sqrt();
        assert!((mean - exact).abs() < 4.5 * deviation, "{mean} instead of {exact}, deviation {deviation}");
        assert_eq!(codes(true), dithered);
    }
}

fn facts() -> RenderFacts {
    RenderFacts {
        version: "Indigo 0.1.0".into(),
        scene_path: "scenes/box.igs".into(),
        width: 40,
        height: 30,
        super_sample_factor: 2,
        bidirectional: true,
        metropolis: false,
        hybrid: false,
        large_mutation_prob: 0.4,
        max_change: 0.01,
        max_num_consec_rejections: 1000,
        max_depth: 10000,
        num_threads: 2,
        num_samples: 76_800.0,
        elapsed_s: 1.5,
    }
}

#[test]
fn png_metadata_has_the_familiar_keys_sorted() {
    let bytes = encode(&picture(4, 4), &facts().metadata(), EIGHT).unwrap();
    let want = [
        ("Indigo version used", "Indigo 0.1.0"),
        ("bidirectional", "1"),
        ("height", "30"),
        ("hybrid", "0"),
        ("large_mutation_prob", "0.40000"),
        ("max_change", "0.01000"),
        ("max_num_consec_rejections", "1000"),
        ("maxdepth", "10000"),
        ("metropolis", "0"),
        ("num_samples", "76800"),
        ("num_threads", "2"),
        ("render time elapsed", "1.50000"),
        ("samples_per_pixel", "64.00000"),
        ("samples_per_sec", "51200.00000"),
        ("scene_file_path", "scenes/box.igs"),
        ("super_sample_factor", "2"),
        ("width", "40"),
    ];
    let got = read_metadata(&bytes).unwrap();
    assert_eq!(got, want.map(|(k, v)| (k.to_owned(), v.to_owned())));
    // Text comes before the pixels, so that a reader need not go through them.
    let position = |name: &[u8]| bytes.windows(4).position(|w| w == name).unwrap();
    assert!(position(b"sRGB") < position(b"IDAT") && position(b"tEXt") < position(b"IDAT"));
}

#[test]
fn png_metadata_in_any_script() {
    let mut metadata = Metadata::default();
    for (key, value) in [("latin", "Büro.igs"), ("greek", "σκηνή.igs"), ("empty", "")] {
        metadata.set(key, value);
    }
    metadata.set("latin", "Grün.igs");
    assert_eq!(metadata.get("latin"), Some("Grün.igs"));
    let mut got = read_metadata(&encode(&picture(2, 2), &metadata, EIGHT).unwrap()).unwrap();
    got.sort();
    let want = [("empty", ""), ("greek", "σκηνή.igs"), ("latin", "Grün.igs")];
    assert_eq!(got, want.map(|(k, v)| (k.to_owned(), v.to_owned())));
}

#[test]
fn metadata_that_no_file_can_hold_is_an_error() {
    for (key, value) in [("", "x"), (" a", "x"), ("a  b", "x"), ("ключ", "x"), ("a", "x\0y")] {
        let mut metadata = Metadata::default();
        metadata.set(key, value);
        let error = Err(ImagingError::Metadata(key.to_owned()));
        assert_eq!(encode(&picture(2, 2), &metadata, EIGHT), error);
    }
}

#[test]
fn damaged_pngs_are_errors() {
    let bytes = encode(&picture(40, 40), &facts().metadata(), EIGHT).unwrap();
    assert!(read_metadata(b"").is_err());
    assert!(read_metadata(b"not a picture at all").is_err());
    assert!(read_metadata(&bytes[..60]).is_err());
    // Whatever byte is damaged: an answer or an error, no panic.
    for i in 0..bytes.len().min(1200) {
        let mut damaged = bytes.clone();
        damaged[i] ^= 0x5a;
        drop(read_metadata(&damaged));
    }
}

#[test]
fn exr_holds_candelas_and_says_so() {
    let (width, height) = (5, 3);
    let pixels: Vec<[f32; 4]> = (0..15).map(|i| [i as f32 * 1e4, -0.5, 1e-6 * i as f32, 1.0]).collect();
    let image = LinearImage { width, height, pixels: pixels.clone() };
    let mut metadata = facts().metadata();
    metadata.set("scene_file_path", "σκηνή.igs");
    let bytes = indigo_imaging::exr::encode(&image, &metadata).unwrap();

    let file = read_first_flat_layer_from_memory(&bytes);
    let attributes = &file.layer_data.attributes;
    assert_eq!(attributes.white_luminance, Some(1.0));
    let chromaticities = file.attributes.chromaticities.unwrap();
    assert_eq!(chromaticities.green, Vec2(0.30, 0.60));
    assert_eq!(chromaticities.white, Vec2(0.3127, 0.3290));
    let text = |key: &str| match attributes.other.get(&Text::from(key)) {
        Some(AttributeValue::Text(text)) => String::from_utf8(text.as_slice().to_vec()).unwrap(),
        other => panic!("{key} is {other:?}"),
    };
    assert_eq!(text("indigo.samples_per_pixel"), "64.00000");
    assert_eq!(text("indigo.scene_file_path"), "σκηνή.igs");

    let display = indigo_imaging::exr::encode_display_linear(&image, &metadata).unwrap();
    let display = read_first_flat_layer_from_memory(&display);
    assert_eq!(
        display.layer_data.attributes.white_luminance, None,
        "a display's white is of no known luminance"
    );

    assert_eq!(file.layer_data.size, Vec2(5, 3));
    assert_eq!(file.layer_data.encoding.compression, Compression::ZIP16);
    for (component, name) in ["R", "G", "B"].iter().enumerate() {
        let channel = file.layer_data.channel_data.list.iter().find(|c| c.name.eq(name)).unwrap();
        let FlatSamples::F32(samples) = &channel.sample_data else { panic!("{name} is no 32-bit float") };
        assert!(samples.iter().zip(&pixels).all(|(s, p)| *s == p[component]));
    }
    assert_eq!(file.layer_data.channel_data.list.len(), 3);
}

fn read_first_flat_layer_from_memory(bytes: &[u8]) -> FlatImageOfOneLayer {
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .unwrap()
}

type FlatImageOfOneLayer = Image<Layer<AnyChannels<FlatSamples>>>;

#[test]
fn exr_of_nothing_is_an_error() {
    let image = LinearImage { width: 0, height: 0, pixels: Vec::new() };
    assert!(matches!(indigo_imaging::exr::encode(&image, &Metadata::default()), Err(ImagingError::Exr(_))));
}
