//! Colours from end to end.

use super::common::judge::{assert_agrees, assert_is};
use super::common::text::{background, diffuse, flat_camera, scene_file, settings, uniform};
use super::common::{film, measure, scene};
use indigo_imaging::{ToneMapping, develop_image};
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;

fn rgb(colour: [f64; 3]) -> String {
    format!("<rgb><rgb>{} {} {}</rgb></rgb>", colour[0], colour[1], colour[2])
}

/// A scene that shows one radiance everywhere, or, with a material, that material lit by it.
fn plain(light: &str, white_balance: &str, material: Option<&str>) -> Scene {
    let white = format!("<white_balance>{white_balance}</white_balance><aperture_radius>");
    let object = material.map_or(String::new(), |m| {
        diffuse("m", m)
            + "<sphere><center>0 4 0</center><radius>1</radius><material_name>m</material_name></sphere>"
    });
    scene(&scene_file(&[
        settings(8, ""),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.1).replace("<aperture_radius>", &white),
        background(light),
        object,
    ]))
}

/// Mean red, green and blue of the picture, tone-mapped so that white light of 1e5 comes out near 0.5,
/// in independent renders.
fn developed(mut scene: Scene) -> [Moments; 3] {
    let exposure = scene.picture.exposure.lux_seconds_per_nit();
    scene.picture.tone_mapping = ToneMapping::Linear { scale: 0.5 / (1e5 * 7.298e-5 * exposure) };
    let mut moments = [Moments::default(); 3];
    for seed in 0..8 {
        let picture = develop_image(&film(&scene, seed, 256).develop(), &scene.picture);
        for (channel, m) in moments.iter_mut().enumerate() {
            m.add(Moments::of(picture.pixels.iter().map(|p| f64::from(p[channel]))).mean());
        }
    }
    moments
}

#[track_caller]
fn assert_rgb(what: &str, scene: Scene, expected: [f64; 3]) {
    for (channel, (m, e)) in ["red", "green", "blue"].iter().zip(developed(scene).iter().zip(expected)) {
        assert_is(&format!("{what}, {channel}"), m, e, 2e-3);
    }
}

#[test]
fn light_of_the_named_white_comes_out_white() {
    assert_rgb("rgb white under D65", plain(&rgb([1e5; 3]), "D65", None), [0.5; 3]);
    assert_rgb("equal energy under E", plain(&uniform(1e5), "E", None), [0.5; 3]);
}

#[test]
fn emission_and_reflectance_have_the_colours_that_were_asked_for() {
    let colour = [0.9, 0.5, 0.3];
    assert_rgb("emission", plain(&rgb(colour.map(|v| v * 1e5)), "D65", None), colour.map(|v| 0.5 * v));
    let lit = plain(&rgb([1e5; 3]), "D65", Some(&rgb(colour)));
    assert_rgb("reflectance under D65", lit, colour.map(|v| 0.5 * v));
}

/// Planck's law and the observer: CIE 1931 chromaticities and luminances by quadrature, 360 to 830 nm.
#[test]
fn black_bodies_have_their_chromaticity_and_luminance() {
    for (temperature, luminance, x, y) in [
        (2000.0, 463_765.0, 0.526_68, 0.413_30),
        (2856.0, 1.974_98e7, 0.447_54, 0.407_43),
        (4000.0, 2.528_07e8, 0.380_44, 0.376_75),
        (6500.0, 3.072_53e9, 0.313_53, 0.323_63),
        (20_000.0, 6.254_62e10, 0.256_46, 0.257_63),
    ] {
        let light = format!("<blackbody><temperature>{temperature}</temperature><gain>1</gain></blackbody>");
        let measured = measure(&plain(&light, "D65", None), 12, 512);
        let what = format!("{temperature} K");
        // The table gives six digits of luminance and five of chromaticity.
        assert_is(&what, measured.luminance(), luminance, 1e-3);
        let [big_x, big_y, big_z, _] = measured.xyza.map(|m| m.mean());
        let sum = big_x + big_y + big_z;
        let (got_x, got_y) = (big_x / sum, big_y / sum);
        assert!((got_x - x).abs() < 2e-4 && (got_y - y).abs() < 2e-4, "{what}: {got_x} {got_y}");
    }
}

/// Monochromatic light at 555 nm has 683 lm/W: a band of 1 nm is close to it.
#[test]
fn a_narrow_band_at_555_nm_has_683_lumens_per_watt() {
    let band = "<peak><peak_min>554.5</peak_min><peak_width>1</peak_width><base_value>0</base_value><peak_value>1e9</peak_value></peak>";
    let measured = measure(&plain(band, "D65", None), 16, 4096);
    // 1e9 W m^-3 sr^-1 over 1 nm are 1 W m^-2 sr^-1.
    assert_is("555 nm", measured.luminance(), 683.0, 5e-3);
    assert_agrees("alpha", &measured.xyza[3], 0.0);
}
