//! Media whose coefficients vary over the wavelengths, against closed forms in X, Y and Z: a wrong wavelength in one
//! place of a path has the right luminance in grey light, and shows here.

use super::common::judge::assert_is;
use super::common::shapes::{Mesh, model};
use super::common::text::{basic, medium, scattering, specular, sphere, uniform};
use super::common::{MODES, Mode, xyz_in_mode};
use super::media::{AROUND, in_uniform_light};
use indigo_scene::Scene;
use indigo_spectrum::Spectrum;

/// Says that a picture has the mean X, Y and Z of a spectrum times that of the surroundings.
#[track_caller]
fn assert_shows(what: &str, scene: &mut Scene, mode: Mode, passes: u64, share: [f64; 3], tolerance: f64) {
    let measured = xyz_in_mode(scene, mode, 16, passes);
    for (c, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        let expected = AROUND * share[c];
        assert_is(&format!("{what}, {mode}, {name}"), &measured[c], expected, tolerance);
    }
}

/// X, Y and Z of radiance 1 at all wavelengths.
fn white() -> [f64; 3] {
    Spectrum::uniform(1.0).xyz()
}

fn rgb(values: &str) -> String {
    format!("<rgb><rgb>{values}</rgb><gamma>1</gamma></rgb>")
}

/// Fog that scatters each colour with a coefficient and a mean cosine of its own, and absorbs none.
#[test]
fn coloured_fog_in_even_light_is_invisible() {
    let phase =
        format!("<henyey_greenstein><g_spectrum>{}</g_spectrum></henyey_greenstein>", rgb("0.8 0.2 -0.5"));
    for ior in [1.0, 1.3] {
        let fog = medium("m", 10, &basic(ior, &uniform(0.0), &scattering(&rgb("0.2 3 30"), &phase)));
        let parts = [fog, specular("surface", "m"), sphere([0.0; 3], 0.5, "surface")];
        let mut scene = in_uniform_light([0.0, -5.0, 0.0], 0.05, &parts);
        // Bidirectional paths are far noisier here; the grid of agreement compares them with these.
        assert_shows(&format!("index {ior}"), &mut scene, MODES[0], 128, white(), 1e-2);
    }
}

/// Beer and Lambert, with a band of wavelengths that is absorbed more strongly: e^(-σ(λ) d).
#[test]
fn each_wavelength_is_absorbed_by_its_own_coefficient() {
    let peak = "<peak><peak_min>480</peak_min><peak_width>90</peak_width><base_value>3</base_value><peak_value>25</peak_value></peak>";
    let parts = [
        medium("m", 10, &basic(1.0, peak, "")),
        specular("surface", "m"),
        Mesh::cube(0.05).text("cube", "surface") + &model("cube"),
    ];
    let mut scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &parts);
    let [base, band] = [3.0, 25.0].map(|sigma: f64| (-sigma * 0.1).exp());
    // Half at the edges themselves, so that the ramps between the table's points have the edges in their middle.
    let value = |nm: f64| {
        if nm > 480.0 && nm < 570.0 { 1.0 } else { f64::from(u8::from(nm == 480.0 || nm == 570.0)) * 0.5 }
    };
    let table: Vec<f64> = (0..=940).map(|i| value(360.0 + 0.5 * f64::from(i))).collect();
    let inside = Spectrum::regular_tabulated(360e-9, 830e-9, &table).expect("a table").xyz();
    let all = white();
    let share = [0, 1, 2].map(|c| base * all[c] + (band - base) * inside[c]);
    for mode in &MODES[..2] {
        assert_shows("a band", &mut scene, *mode, 256, share, 4e-3);
    }
}

/// Glass of which every wavelength goes its own way: what a wavelength loses at one surface it gains at another.
#[test]
fn dispersive_glass_in_even_light_is_invisible() {
    let glass =
        basic(1.4, &uniform(0.0), "").replace("</ior>", "</ior><cauchy_b_coeff>0.03</cauchy_b_coeff>");
    let parts = [medium("m", 10, &glass), specular("surface", "m"), sphere([0.0; 3], 1.0, "surface")];
    let mut scene = in_uniform_light([0.0, -5.0, 0.0], 0.21, &parts);
    for mode in &MODES[..2] {
        assert_shows("a ball", &mut scene, *mode, 256, white(), 1e-2);
    }
}
