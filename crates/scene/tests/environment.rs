//! Distant lights as a scene gives them: what comes from which direction, and what is wrong with files.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::Severity;
use indigo_math::{Real, Vec3};
use indigo_scene::{LoadOptions, Loaded, load};
use indigo_spectrum::SampledWavelengths;
use std::fmt::Write;

/// A scene and the pictures beside it.
struct Memory(String);

/// 8 by 2 texels of a Radiance file, not compressed: each red, green and blue with one exponent (128: halves).
fn hdr() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n".to_vec();
    for i in 0..16u8 {
        // The left half is dark; the upper right is 1, 1/2, 1/4, and the lower right half of it.
        let brightness = if i % 8 < 4 { 0 } else { 129 - i / 8 };
        bytes.extend([128, 64, 32, brightness]);
    }
    bytes
}

/// A Radiance file all of one colour, with something in its header.
fn even_hdr(header: &str) -> Vec<u8> {
    let mut bytes = format!("#?RGBE\nFORMAT=32-bit_rle_rgbe\n{header}\n\n-Y 2 +X 4\n").into_bytes();
    bytes.extend([128, 77, 51, 128].repeat(8));
    bytes
}

/// The same colour from Rec. 2020 in Rec. 709, by the matrix of ITU-R BT.2087.
fn converted() -> Vec<u8> {
    let [r, g, b] = [128.0, 77.0, 51.0].map(|v| v / 256.0);
    let rows = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]];
    let texel = rows.map(|m| (m[0] * r + m[1] * g + m[2] * b) as f32);
    (0..16).flat_map(|_| texel).flat_map(f32::to_le_bytes).collect()
}

/// 4 by 4 texels: the upper half is 3, and one of the lower ones negative, one no number.
fn float() -> Vec<u8> {
    let value = |i: usize| match i {
        0..8 => 3.0,
        10 => -1.0,
        13 => f32::NAN,
        _ => 0.25,
    };
    (0..16).flat_map(|i| [value(i); 3]).flat_map(f32::to_le_bytes).collect()
}

/// 4 by 4 texels: a yellow beyond the gamut's edge, and an infinite one at the third of the second row.
fn odd(blue: f32, bright: f32) -> Vec<u8> {
    let value = |i: usize| if i == 6 { [bright; 3] } else { [1.0, 1.0, blue] };
    (0..16).flat_map(value).flat_map(f32::to_le_bytes).collect()
}

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let bytes = match path {
            "scene.igs" => self.0.clone().into_bytes(),
            "map.hdr" => hdr(),
            "probe.float" => float(),
            "odd.float" => odd(-0.01, f32::INFINITY),
            "plain.hdr" => even_hdr("# nothing"),
            "exposed.hdr" => even_hdr("EXPOSURE=4\nCOLORCORR=0.5 0.5 0.5"),
            "wide.hdr" => even_hdr("PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290"),
            "no_primaries.hdr" => even_hdr("PRIMARIES=0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3"),
            "bad.hdr" => even_hdr("EXPOSURE=no"),
            "converted.float" => converted(),
            "even.float" => odd(0.0, 1.0),
            // A PNG's first bytes do: it is refused whatever follows.
            "map.bmp" => b"BM".to_vec(),
            _ => return Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

const HEAD: &str = "<scene><renderer_settings><aperture_diffraction>false</aperture_diffraction><bidirectional>false</bidirectional><metropolis>false</metropolis></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<camera><pos>0 -2 1</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>
";

fn loaded(light: &str) -> Loaded {
    let resolver = Memory(format!("{HEAD}{light}</scene>"));
    load("scene.igs", &LoadOptions::new(&resolver))
}

/// Codes of everything found.
fn codes(l: &Loaded) -> Vec<&'static str> {
    l.sink.diagnostics().iter().map(|d| d.code).collect()
}

/// Mean radiance of the wavelengths of many paths from a direction.
#[track_caller]
fn radiance(l: &Loaded, towards: [f64; 3]) -> f64 {
    let mut found = String::new();
    l.sink.diagnostics().iter().for_each(|d| {
        let _ = write!(found, "{} {}; ", d.code, d.message);
    });
    let scene = l.scene.as_ref().unwrap_or_else(|| panic!("a scene: {found}"));
    let d: Vec3 = indigo_math::Vec3d::from(towards).normalized().cast();
    let n = 512;
    let at = |i| SampledWavelengths::sample((f64::from(i) / f64::from(n)) as Real);
    let mean = |i| scene.lights.environment(d, &at(i)).map_or(0.0, |r| r.mean() as f64);
    (0..n).map(mean).sum::<f64>() / f64::from(n)
}

fn lat_long(gain: f64) -> String {
    format!("<env_map><latlong><path>map.hdr</path><gain>{gain}</gain></latlong></env_map>")
}

#[test]
fn a_map_by_latitude_and_longitude_lies_as_documented() {
    let map = loaded(&lat_long(1.0));
    assert_eq!(codes(&map), [""; 0]);
    // Right of +y is +x, and above is brighter than below by two.
    let (right, left) = ([1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]);
    let bright = radiance(&map, right);
    assert!(bright > 0.1);
    assert_eq!(radiance(&map, left), 0.0);
    let below = radiance(&map, [1.0, 0.0, -2.0]);
    assert!((below / bright - 0.5).abs() < 1e-3, "{below} {bright}");
    let gained = radiance(&loaded(&lat_long(8.0)), right);
    assert!((gained / bright - 8.0).abs() < 1e-4);
}

#[test]
fn an_angular_map_lies_as_documented() {
    let text =
        "<env_map><spherical><path>probe.float</path><width>4</width><gain>2</gain></spherical></env_map>";
    let map = loaded(text);
    assert_eq!(codes(&map), ["W0308"]);
    let message = &map.sink.diagnostics()[0].message;
    assert!(message.contains("2 texels are"), "{message}");
    // The middles of the third texels of the first and of the last row.
    let (x, y, z) = (0.193370935, -0.791250159, 0.580112806);
    let (above, below) = (radiance(&map, [x, y, z]), radiance(&map, [x, y, -z]));
    assert!((below / above - 0.25 / 3.0).abs() < 1e-4, "{above} {below}");
    assert_eq!(codes(&loaded(&text.replace(">4<", ">5<"))), ["E0303"]);
}

/// What is wrong by itself has one message, and none about the file.
#[test]
fn a_map_without_width_or_path_has_one_message() {
    let map = |more: &str| loaded(&format!("<env_map><spherical><gain>2</gain>{more}</spherical></env_map>"));
    let path = "<path>probe.float</path>";
    assert_eq!(codes(&map(&format!("{path}<width>4</width>"))), ["W0308"]);
    for width in ["", "<width/>", "<width>0</width>", "<width>-1</width>", "<width>16 16</width>"] {
        let l = map(&format!("{path}{width}"));
        assert!(codes(&l).len() == 1 && codes(&l)[0].starts_with("E02"), "{width}: {:?}", codes(&l));
    }
    for path in ["", "<path></path>"] {
        let l = map(&format!("{path}<width>4</width>"));
        assert!(codes(&l).len() == 1 && codes(&l)[0].starts_with("E02"), "{path}: {:?}", codes(&l));
    }
}

/// A component that cannot be takes nothing else away: it is the nearest that can.
#[test]
fn texels_beyond_the_gamut_or_the_range_keep_their_light() {
    let map = |file: &str| {
        loaded(&format!(
            "<env_map><spherical><path>{file}</path><width>4</width><gain>2</gain></spherical></env_map>"
        ))
    };
    let (odd, even) = (map("odd.float"), map("even.float"));
    assert_eq!((codes(&odd), codes(&even)), (vec!["W0308"], vec![]));
    assert!(odd.sink.diagnostics()[0].message.contains("16 texels are"));
    // The middles of the third texel of the first and of the second row.
    for d in [[0.193370935, -0.791250159, 0.580112806], [0.633_539, 0.444_145, 0.633_539]] {
        let found = [&odd, &even].map(|map| radiance(map, d));
        assert!(found[0] > 0.5 && (found[0] / found[1] - 1.0).abs() < 1e-4, "{d:?}: {found:?}");
    }
}

#[test]
fn maps_that_cannot_be_light_are_refused() {
    let map = |path: &str| lat_long(1.0).replace("map.hdr", path);
    assert_eq!(codes(&loaded(&map("nothing.exr"))), ["E0302"]);
    assert_eq!(codes(&loaded(&map("map.bmp"))), ["E0303"]);
    assert_eq!(codes(&loaded(&map("probe.float"))), ["E0303"]);
}

/// Exposures that a file states are taken back, and its colours are those that it states.
#[test]
fn headers_of_maps_count() {
    let at = |path: &str| {
        let map = loaded(&lat_long(2.0).replace("map.hdr", path));
        assert_eq!(codes(&map), [""; 0], "{path}");
        radiance(&map, [0.3, -0.4, 0.2])
    };
    let plain = at("plain.hdr");
    assert!((at("exposed.hdr") / plain - 0.5).abs() < 1e-5);
    let spherical = "<env_map><spherical><path>converted.float</path><width>4</width><gain>2</gain></spherical></env_map>";
    let expected = radiance(&loaded(spherical), [0.3, -0.4, 0.2]);
    let wide = at("wide.hdr");
    assert!(
        (wide / expected - 1.0).abs() < 1e-3 && (wide / plain - 1.0).abs() > 0.02,
        "{wide} {expected} {plain}"
    );
    let message = |path: &str| {
        let l = loaded(&lat_long(1.0).replace("map.hdr", path));
        (codes(&l), l.sink.diagnostics()[0].message.clone())
    };
    assert_eq!(message("bad.hdr"), (vec!["E0303"], "bad.hdr:3:1: bad environment map".to_owned()));
    assert_eq!(
        message("no_primaries.hdr"),
        (vec!["E0303"], "no_primaries.hdr: bad environment map".to_owned())
    );
}

fn sky(more: &str) -> String {
    format!("<skylight><sundir>0 3 4</sundir>{more}</skylight>")
}

#[test]
fn every_part_of_a_skylight_counts() {
    let (zenith, sun, low) = ([0.1, 0.0, 1.0], [0.0, 0.6, 0.8], [0.0, 0.0, -1.0]);
    let plain = loaded(&sky("<turbidity>3</turbidity>"));
    assert_eq!(codes(&plain), [""; 0]);
    let (blue, white) = (radiance(&plain, zenith), radiance(&plain, sun));
    assert!(blue > 1e6 && white > 1e3 * blue && radiance(&plain, low) == 0.0);
    // Half a degree beside the sun there is the sky alone.
    assert!(radiance(&plain, [0.0, 0.607, 0.7947]) < 1e-3 * white);
    let differs = |more: &str, factor: std::ops::Range<f64>| {
        let other = radiance(&loaded(&sky(more)), zenith) / blue;
        assert!(factor.contains(&other), "{more}: {other}");
    };
    differs("<turbidity>6</turbidity>", 1.2..3.0);
    differs("<turbidity>3</turbidity><model>preetham</model>", 1.5..4.0);
    differs("<turbidity>3</turbidity><model>hosek</model>", 0.999_999..1.000_001);
    let space = loaded(&sky("<turbidity>3</turbidity><extra_atmospheric>true</extra_atmospheric>"));
    assert_eq!((radiance(&space, zenith), space.scene.as_ref().map(|s| s.lights.len())), (0.0, Some(1)));
    assert!(radiance(&space, sun) > 1.2 * white);
}

#[test]
fn suns_and_skies_that_cannot_be_are_named() {
    assert_eq!(codes(&loaded(&sky("<turbidity>3</turbidity>").replace("0 3 4", "0 3 0"))), ["E0203"]);
    assert_eq!(codes(&loaded(&sky("<turbidity>30</turbidity>"))), ["W0309"]);
    assert_eq!(codes(&loaded(&sky("<turbidity>1.2</turbidity>"))), [""; 0]);
    assert_eq!(codes(&loaded(&sky("<turbidity>1.2</turbidity><model>preetham</model>"))), ["W0309"]);
}

/// Several distant lights add.
#[test]
fn a_map_and_a_background_add() {
    let background = "<background><spectrum><uniform><value>5</value></uniform></spectrum></background>";
    let both = loaded(&format!("{background}{}", lat_long(1.0)));
    assert!(both.sink.diagnostics().iter().all(|d| d.severity != Severity::Error));
    let map = loaded(&lat_long(1.0));
    for d in [[1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]] {
        assert!((radiance(&both, d) - radiance(&map, d) - 5.0).abs() < 1e-5);
    }
    assert_eq!(both.scene.unwrap().lights.len(), 2);
}
