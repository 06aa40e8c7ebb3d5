//! Distant light on a level surface against closed forms and tables, and how it is drawn.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near};
use super::common::noise::{luminances, rel_mse};
use super::common::shapes::{Mesh, model, sub};
use super::common::small_sun::under_small_sun;
use super::common::starved::{SKY, closed_room, floodlight, lamp_over_ground};
use super::common::text::{background, flat_camera, grey, scene_file, settings, uniform};
use super::common::{Measured, measure, scene_with};
use indigo_imaging::{LinearImage, Metadata, exr};
use indigo_scene::Scene;
use std::f64::consts::{PI, TAU};

/// Albedo of the surface.
const ALBEDO: f64 = 0.5;

/// A level surface under some light, looked at from aside.
fn lit(light: &str, file: (&str, Vec<u8>)) -> Scene {
    let eye = [3.0, 1.0, 1.2];
    let text = scene_file(&[
        settings(8, ""),
        flat_camera(eye, sub([0.0; 3], eye), 2e-3),
        grey("ground", ALBEDO),
        Mesh::square(4.0, 0.0).text("ground", "ground"),
        model("ground"),
        light.to_owned(),
    ]);
    scene_with(&text, [file])
}

/// Says that a surface in some light has the luminance of an illuminance in lx, by both techniques.
#[track_caller]
fn assert_lit(what: &str, mut scene: Scene, illuminance: f64, passes: u64, tolerance: f64) {
    for bidirectional in [false, true] {
        scene.transport.bidirectional = bidirectional;
        let measured: Measured = measure(&scene, 16, passes);
        let what = format!("{what}, bidirectional {bidirectional}");
        assert_near(&what, measured.luminance(), ALBEDO * illuminance / PI, tolerance);
    }
}

/// Value of the one bright texel of a map, and the gain on it.
const BRIGHT: f32 = 1024.0;
const GAIN: f64 = 3e3;

/// Texels of a map, rows from the top, all black but one.
fn one_texel(width: usize, height: usize, [column, row]: [usize; 2]) -> impl Iterator<Item = [f32; 3]> {
    (0..width * height).map(move |i| if i == row * width + column { [BRIGHT; 3] } else { [0.0; 3] })
}

/// Illuminance (lx) of a level surface by the texel in the middle of a solid angle (sr) whose height has a sine. The
/// texel's light is shared out between its neighbours' middles, which leaves both integral and middle; over 1.4°
/// the cosine bends by less than 1e-4.
fn illuminance(solid_angle: f64, sine: f64) -> f64 {
    GAIN * f64::from(BRIGHT) * NITS_PER_UNIFORM * solid_angle * sine
}

#[test]
fn one_texel_by_latitude_and_longitude_lights_by_its_solid_angle() {
    const SIZE: [usize; 2] = [256, 128];
    let [column, row] = [40, 31];
    let texels = one_texel(SIZE[0], SIZE[1], [column, row]).map(|[r, g, b]| [r, g, b, 1.0]);
    let image = LinearImage { width: 256, height: 128, pixels: texels.collect() };
    let file = exr::encode(&image, &Metadata::default()).expect("a picture");
    let light = format!("<env_map><lat_long><path>map.exr</path><gain>{GAIN}</gain></lat_long></env_map>");
    let [above, middle, below] = [0.0, 0.5, 1.0].map(|part| PI * (row as f64 + part) / SIZE[1] as f64);
    let solid_angle = TAU / SIZE[0] as f64 * (above.cos() - below.cos());
    let expected = illuminance(solid_angle, middle.cos());
    assert_lit("latitude and longitude", lit(&light, ("map.exr", file)), expected, 512, 5e-3);
}

#[test]
fn one_texel_of_an_angular_map_lights_by_its_solid_angle() {
    const SIDE: usize = 200;
    for at in [[120, 60], [30, 70]] {
        let bytes = one_texel(SIDE, SIDE, at).flatten().flat_map(f32::to_le_bytes).collect();
        let light = format!(
            "<env_map><spherical><path>map.float</path><width>{SIDE}</width><gain>{GAIN}</gain></spherical></env_map>"
        );
        // From the middle, over half the width, to the right and upwards.
        let [x, y] = at.map(|i| (i as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0);
        let r = x.hypot(y);
        // An area a in units of the half width is a / r · dr dφ, and sin(πr) π dr dφ of solid angle.
        let solid_angle = (PI * r).sin() * PI / r * (2.0 / SIDE as f64).powi(2);
        let expected = illuminance(solid_angle, (PI * r).sin() * -y / r);
        assert_lit(&format!("texel {at:?}"), lit(&light, ("map.float", bytes)), expected, 512, 5e-3);
    }
}

/// A background, which is found by scattering alone, and a map, which is drawn.
#[test]
fn even_surroundings_light_by_pi() {
    let scene = lit(&background(&uniform(1e6)), ("", vec![]));
    assert_lit("background", scene, PI * 1e6 * NITS_PER_UNIFORM, 64, 2e-3);
    let light = format!(
        "<env_map><spherical><path>map.float</path><width>16</width><gain>{GAIN}</gain></spherical></env_map>"
    );
    let bytes = [BRIGHT; 3 * 256].into_iter().flat_map(f32::to_le_bytes).collect();
    let scene = lit(&light, ("map.float", bytes));
    assert_lit("map", scene, PI * GAIN * f64::from(BRIGHT) * NITS_PER_UNIFORM, 512, 2e-3);
}

/// Elevation of the sun in degrees, turbidity, model; illuminance of a level surface by the sky and across the sun's
/// direction by the sun (lx): of the tables in `crates/light/tests/daylight.rs`, which are good to 5 digits.
const DAYLIGHT: [(f64, f64, &str, f64, f64); 6] = [
    (30.0, 2.0, "hosek", 11_667.0, 79_785.0),
    (45.0, 3.0, "hosek", 14_651.0, 84_422.0),
    (60.0, 5.0, "hosek", 22_375.0, 82_312.0),
    (30.0, 2.0, "preetham", 24_188.4, 81_928.0),
    (45.0, 4.0, "preetham", 35_219.7, 70_781.0),
    (60.0, 6.0, "preetham", 56_074.4, 62_921.0),
];

#[test]
fn sun_and_sky_light_the_ground_by_the_tables() {
    for (elevation, turbidity, model, sky, sun) in DAYLIGHT {
        let (s, c) = f64::to_radians(elevation).sin_cos();
        let light = format!(
            "<skylight><sundir>{} {} {s}</sundir><turbidity>{turbidity}</turbidity><model>{model}</model></skylight>",
            0.6 * c,
            -0.8 * c
        );
        let what = format!("{model}, sun {elevation} degrees high, turbidity {turbidity}");
        assert_lit(&what, lit(&light, ("", vec![])), sky + sun * s, 96, 5e-3);
    }
}

/// ASTM G173 has 133.1 klx in space.
#[test]
fn the_sun_in_space_lights_by_the_standard() {
    let light = "<skylight><sundir>0 3 4</sundir><turbidity>2</turbidity><extra_atmospheric>true</extra_atmospheric></skylight>";
    assert_lit("space", lit(light, ("", vec![])), 0.8 * 1.331e5, 64, 2e-3);
}

/// Elevation, turbidity and model; luminance of the zenith (cd/m²).
const ZENITH: [(f64, f64, &str, f64); 5] = [
    (30.0, 2.0, "hosek", 1760.3),
    (60.0, 3.0, "hosek", 3340.8),
    (45.0, 5.0, "hosek", 3507.4),
    (45.0, 4.0, "preetham", 10_004.69),
    (45.0, 6.0, "preetham", 14_893.33),
];

#[test]
fn the_zenith_has_the_luminance_of_the_tables() {
    for (elevation, turbidity, model, luminance) in ZENITH {
        let (s, c) = f64::to_radians(elevation).sin_cos();
        let text = scene_file(&[
            settings(8, ""),
            flat_camera([0.0; 3], [0.0, 0.0, 1.0], 2e-3),
            format!(
                "<skylight><sundir>{c} 0 {s}</sundir><turbidity>{turbidity}</turbidity><model>{model}</model></skylight>"
            ),
        ]);
        let seen = measure(&scene_with(&text, []), 16, 32);
        assert_is(&format!("{model}, {elevation}, {turbidity}"), seen.luminance(), luminance, 1e-3);
    }
}

/// The errors are sums over 1152 pixels with a ratio in the thousands, at fixed seeds.
#[test]
fn a_small_sun_is_found_by_its_light() {
    let [by_luminance, evenly] = [true, false].map(under_small_sun);
    let truth = luminances(&by_luminance, 100, 4096);
    let [by_luminance, evenly] = [by_luminance, evenly].map(|scene| rel_mse(&scene, &truth, 1..9, 16));
    assert!(evenly > 30.0 * by_luminance, "relMSE {evenly} evenly, {by_luminance} by luminance");
}

/// Errors of two scenes that look the same, the second of which gives the lamp half of the samples: 2 times that of the
/// first, or a little more, as half of a low-discrepancy sequence is none. Without its half it would be some thousand
/// times. Ratios of sums over 1152 pixels, at fixed seeds, in both techniques.
#[track_caller]
fn assert_not_starved(what: &str, mut scenes: [Scene; 2]) {
    let truth = luminances(&scenes[0], 100, 1024);
    for bidirectional in [false, true] {
        let [alone, beside] = scenes.each_mut().map(|scene| {
            scene.transport.bidirectional = bidirectional;
            rel_mse(scene, &truth, 1..9, 16)
        });
        assert!(beside < 4.0 * alone, "{what}, bidirectional {bidirectional}: relMSE {beside}, not {alone}");
    }
}

#[test]
fn a_sky_that_nothing_sees_takes_few_draws_from_a_lamp() {
    assert_not_starved("a closed room beside a sky", ["", SKY].map(closed_room));
}

/// By power alone the error would be some thousand times as large.
#[test]
fn a_floodlight_elsewhere_takes_few_draws_from_a_lamp() {
    assert_not_starved("a closed room beside a floodlight", ["", &floodlight()].map(closed_room));
}

#[test]
fn a_wide_ground_takes_few_draws_from_a_lamp() {
    assert_not_starved("a ground of 20 km, not 20 m", [10.0, 1e4].map(lamp_over_ground));
}
