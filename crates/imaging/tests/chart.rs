//! Tone mappings and white balances against an independent calculation, and files read by other programs.
//!
//! `chart.txt` is what `chart.py` prints: a chart of colours developed by colour-science and NumPy. `cargo xtask
//! test` runs that program again, so that the table is known to be its work.

use indigo_film::{FilmSize, FilmState, FirstHit, LayerKind};
use indigo_imaging::{
    CameraFacts, Content, Exposure, LinearImage, Metadata, PictureSettings, Response, ToneMapping,
    WhiteBalance, develop, exr, layers,
};
use indigo_math::Vec3d;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;

/// The bound on any component in [0, 1].
const TOLERANCE: f64 = 1e-4;

/// A colour and how it is shown.
struct Patch {
    xyz: [f64; 3],
    rgb: [f64; 3],
}

/// Patches by white, its chromaticity and tone mapping.
fn chart() -> BTreeMap<(String, String), ([f64; 2], Vec<Patch>)> {
    let mut groups = BTreeMap::new();
    for line in include_str!("chart.txt").lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let number = |i: usize| words[i].parse::<f64>().expect("a number");
        let (_, patches) = groups
            .entry((words[0].to_owned(), words[3].to_owned()))
            .or_insert_with(|| ([number(1), number(2)], vec![]));
        patches.push(Patch { xyz: [4, 5, 6].map(number), rgb: [7, 8, 9].map(number) });
    }
    groups
}

/// The response curves that the chart was made with.
fn response() -> Response {
    let points: Vec<f32> = (0..256u16).map(|i| f32::from(i) / 255.0).collect();
    let curves = [1.0 / 2.2, 1.0 / 1.8, 0.7]
        .map(|g: f64| points.iter().map(|&v| f64::from(v).powf(g) as f32).collect::<Vec<_>>());
    Response::new([0, 1, 2].map(|c: usize| (&*points, &*curves[c]))).expect("curves")
}

fn tone_mapping(name: &str) -> ToneMapping {
    match name {
        "linear" => ToneMapping::Linear { scale: 0.2 },
        "reinhard" => ToneMapping::Reinhard { pre_scale: 1.5, post_scale: 0.9, burn: 6.0 },
        "camera" => ToneMapping::Camera { response: Arc::new(response()), ev_adjust: 0.5, film_iso: 20.0 },
        other => panic!("{other}"),
    }
}

#[test]
fn every_tone_mapping_and_white_balance_is_exact() {
    let groups = chart();
    assert_eq!(groups.len(), 15);
    for ((white, mapping), (xy, patches)) in &groups {
        let size = FilmSize::new(patches.len() as u32, 1, 1).expect("a size");
        let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
        for (i, patch) in patches.iter().enumerate() {
            let [x, y, z] = patch.xyz;
            film.layers[0].sums[i] = [3.0 * x, 3.0 * y, 3.0 * z, 3.0];
            film.layers[0].counts[i] = 3.0;
        }
        // Area / d² · t = 2.
        let exposure = Exposure { aperture_area: 1e-4, lens_sensor_dist: 0.02, duration: 8.0 };
        let settings = PictureSettings {
            white_balance: WhiteBalance::from_white(*xy).expect("a white"),
            ..PictureSettings::plain(tone_mapping(mapping), exposure)
        };
        let mut lit = 0;
        for (patch, shown) in patches.iter().zip(develop(&film, &settings).pixels) {
            for (got, want) in shown.into_iter().zip(patch.rgb) {
                assert!(
                    (f64::from(got) - want).abs() <= TOLERANCE,
                    "{white}, {mapping}, XYZ {:?}: {shown:?} instead of {:?}",
                    patch.xyz,
                    patch.rgb
                );
                lit += usize::from(want > 0.01 && want < 0.99);
            }
        }
        assert!(lit > 20, "{white}, {mapping}: the chart shows too little");
        let named = indigo_spectrum::illuminant::white_point(white).expect("a named white");
        assert!(named.iter().zip(xy).all(|(a, b)| (a - b).abs() < 2e-4), "{white}: {named:?}");
    }
}

/// The Python that has the packages of the tests; `None` outside of `cargo xtask test`.
fn python(script: &str, arguments: &[&str]) -> Option<String> {
    let python = std::env::var_os("INDIGO_TEST_PYTHON")?;
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/");
    let ran = Command::new(python).arg(format!("{folder}{script}")).args(arguments).output().expect("Python");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    Some(String::from_utf8(ran.stdout).expect("text"))
}

#[test]
fn the_chart_is_what_the_program_prints() {
    let Some(printed) = python("chart.py", &[]) else { return };
    let numbers =
        |text: &str| -> Vec<f64> { text.split_whitespace().filter_map(|word| word.parse().ok()).collect() };
    let (printed, kept) = (numbers(&printed), numbers(include_str!("chart.txt")));
    assert_eq!(printed.len(), kept.len());
    // Nine decimals, the last of which may round otherwise on another machine.
    assert!(printed.iter().zip(&kept).all(|(a, b)| (a - b).abs() < 1e-8));
}

/// A file of its own for this test process.
fn scratch(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("indigo-imaging-{}-{name}", std::process::id()))
}

/// Layers come back by their names: the library groups R, G, B, A but no X, Y, Z.
#[test]
fn the_reference_implementation_reads_our_layers() {
    let hits: Vec<FirstHit> = (0..35)
        .map(|i| FirstHit {
            albedo: [0.9505 * i as f32, i as f32, 1.089 * i as f32],
            normal: [0.1, -0.2, i as f32],
            coverage: 1.0,
            depth_m: 1e10,
            object: i,
            material: 1 << 24,
        })
        .collect();
    let pixels: Vec<[f32; 4]> = (0..35).map(|i| [1.0, 2.0, i as f32, 0.25]).collect();
    let image = LinearImage { width: 7, height: 5, pixels };
    let mut channels = layers::rgb_channels(&image);
    channels.extend(layers::foreground_channels(&image));
    channels.extend(layers::background_channels(&image));
    channels.extend(layers::first_hit_channels(&hits));
    let bytes = exr::encode_layers([7, 5], channels.clone(), &Metadata::default(), Content::Luminances)
        .expect("an EXR");
    let path = scratch("layers.exr");
    std::fs::write(&path, bytes).expect("a file");
    let printed = python("read_layers.py", &[path.to_str().expect("a path")]);
    std::fs::remove_file(path).expect("the file is there");
    let Some(printed) = printed else { return };
    let read: BTreeMap<&str, Vec<f32>> = printed
        .lines()
        .map(|line| {
            let (name, values) = line.split_once(' ').expect("a name and values");
            (name, values.split(' ').map(|v| v.parse().expect("a number")).collect())
        })
        .collect();
    assert_eq!(read.len(), 19);
    for channel in &channels {
        assert_eq!(read[&*channel.name], channel.values, "{}", channel.name);
    }
    // XYZ of D65 is grey in RGB.
    assert!(read["albedo.R"].iter().enumerate().all(|(i, v)| (v - i as f32).abs() < 1e-3 * i as f32 + 1e-6));
    assert_eq!(read["object_id.X"][34], 34.0);
    assert_eq!(read["material_id.X"][0], 16_777_216.0);
}

/// What the reference implementation reads in a picture: the white's luminance, then R, G and B of every pixel. `None`
/// without it.
fn read_back(bytes: Vec<u8>, name: &str) -> Option<(String, Vec<f32>)> {
    let path = scratch(name);
    std::fs::write(&path, bytes).expect("a file");
    let printed = python("read_exr.py", &[path.to_str().expect("a path")]);
    std::fs::remove_file(path).expect("the file is there");
    let printed = printed?;
    let mut lines = printed.lines();
    let white = lines.next().expect("a line").to_owned();
    assert_eq!(lines.next(), Some("chromaticities 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"));
    assert_eq!(lines.next(), Some("indigo.scene_file_path σκηνή.igs"));
    for expected in [
        "order LineOrder.INCREASING_Y scanlines",
        "date 2026:02:28 23:59:58 0",
        "exposure 0.01 4 400 2.5",
        "camera 2 1 5 1",
        "ndc 0.7 0.3 0.2",
        "size 7 5",
    ] {
        assert_eq!(lines.next(), Some(expected));
    }
    Some((white, lines.map(|line| line.parse().expect("a number")).collect()))
}

fn rgb(pixels: &[[f32; 4]]) -> Vec<f32> {
    pixels.iter().flat_map(|p| p[..3].to_vec()).collect()
}

fn metadata() -> Metadata {
    let mut metadata = Metadata::default();
    metadata.set("scene_file_path", "σκηνή.igs");
    metadata.captured = Some("2026:02:28 23:59:58".to_owned());
    metadata.camera = Some(CameraFacts {
        kind: indigo_camera::CameraKind::ThinLens,
        position: Vec3d::new(1.0, 2.0, 3.0),
        forwards: Vec3d::new(0.0, 1.0, 0.0),
        up: Vec3d::new(0.0, 0.0, 1.0),
        sensor_width: 0.04,
        sensor_height: 0.02,
        // The sensor is 2 cm behind a lens of 2 / (1 + 2 / 250) cm, whose opening is a quarter of that.
        aperture_radius: 0.02 / 1.008 / 8.0,
        lens_sensor_dist: 0.02,
        lens_shift: [0.0; 2],
        focus_distance: Some(2.5),
        exposure_duration: 0.01,
        film_iso: Some(400.0),
    });
    metadata
}

#[test]
fn the_reference_implementation_reads_our_exr() {
    let pixels: Vec<[f32; 4]> =
        (0..35).map(|i| [i as f32 * 1e3, -0.25 * i as f32, 1e-6 + i as f32, 1.0]).collect();
    let image = LinearImage { width: 7, height: 5, pixels: pixels.clone() };
    let bytes = exr::encode(&image, &metadata()).expect("an EXR");
    let Some((white, values)) = read_back(bytes, "read.exr") else { return };
    assert_eq!(white, "whiteLuminance 1");
    assert_eq!(values, rgb(&pixels));
}

/// The tone-mapped picture: what is shown, as it is, without a luminance, which is the display's.
#[test]
fn the_reference_implementation_reads_our_tone_mapped_exr() {
    let size = FilmSize::new(7, 5, 1).expect("a size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let layer = &mut film.layers[0];
    for (i, (sum, count)) in layer.sums.iter_mut().zip(&mut layer.counts).enumerate() {
        (*sum, *count) = ([i as f64, 0.9 * i as f64, 0.5 * i as f64, 1.0], 1.0);
    }
    let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
    let mapping = ToneMapping::Reinhard { pre_scale: 1.5, post_scale: 0.9, burn: 6.0 };
    let picture = develop(&film, &PictureSettings::plain(mapping, exposure));
    assert!(picture.pixels.iter().any(|p| p[1] > 0.2 && p[1] < 0.8));
    let image = LinearImage { width: 7, height: 5, pixels: picture.pixels.clone() };
    let bytes = exr::encode_display_linear(&image, &metadata()).expect("an EXR");
    let Some((white, values)) = read_back(bytes, "mapped.exr") else { return };
    assert_eq!(white, "whiteLuminance none");
    assert_eq!(values, rgb(&picture.pixels));
}
