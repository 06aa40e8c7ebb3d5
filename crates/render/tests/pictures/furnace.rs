//! A closed room whose walls all emit E and reflect ρ has the radiance E/(1-ρ) everywhere, whatever
//! its shape: a test of every cosine, density and weight along paths of any length at once.

use super::common::judge::{NITS_PER_UNIFORM, assert_is};
use super::common::shapes::{Mesh, mesh_light};
use super::common::text::{background, flat_camera, grey, scene_file, settings, uniform};
use super::common::{MODES, Measured, luminance_in_mode, measure, scene};
use indigo_scene::Scene;

/// Spectral radiance of the walls, W m^-3 sr^-1; far from 1 so that no unit cancels.
const EMITTED: f64 = 3.0e4;

fn room(mesh: &Mesh, albedo: f64, more_settings: &str) -> Scene {
    scene(&scene_file(&[
        settings(16, more_settings),
        flat_camera([0.13, -0.21, 0.08], [0.3, 1.0, -0.2], 1.0),
        grey("wall", albedo),
        mesh.clone().inside_out().text("room", "wall"),
        mesh_light("room", &uniform(EMITTED), [0.0; 3], 1.0, ""),
    ]))
}

fn assert_luminance(what: &str, measured: &Measured, over_emitted: f64) {
    assert_is(what, measured.luminance(), EMITTED * NITS_PER_UNIFORM * over_emitted, 1e-3);
}

#[test]
fn a_ball_of_albedo_one_half_is_twice_as_bright_as_its_walls_emit() {
    let measured = measure(&room(&Mesh::ball(2), 0.5, ""), 16, 208);
    assert_luminance("ball, albedo 0.5", &measured, 1.0 / (1.0 - 0.5));
}

#[test]
fn a_grey_ball_of_albedo_four_fifths_is_five_times_as_bright() {
    let measured = measure(&room(&Mesh::ball(2), 0.8, ""), 24, 768);
    assert_luminance("ball, albedo 0.8", &measured, 1.0 / (1.0 - 0.8));
}

/// Paths of a hundred events on average, and of ten times as many now and then, in every mode: nothing overflows, and
/// none of the light is lost.
#[test]
fn a_highly_reflective_room_is_a_hundred_times_as_bright_in_every_mode() {
    let mut scene = room(&Mesh::cube(1.0), 0.99, "<max_depth>10000</max_depth>");
    for mode in MODES {
        let measured = luminance_in_mode(&mut scene, mode, 6, 32);
        assert_is(&mode.to_string(), &measured, EMITTED * NITS_PER_UNIFORM * 100.0, 3e-2);
    }
}

#[test]
fn max_depth_cuts_the_series_after_that_many_scattering_events() {
    let mut scene = room(&Mesh::cube(1.0), 0.5, "");
    let mut expected = 0.0;
    for depth in 0..4 {
        scene.transport.max_depth = depth;
        expected += 0.5f64.powi(depth as i32);
        assert_luminance(&format!("depth {depth}"), &measure(&scene, 16, 160), expected);
    }
}

#[test]
fn max_depth_is_read_from_the_settings() {
    let measured = measure(&room(&Mesh::cube(1.0), 0.5, "<max_depth>2</max_depth>"), 16, 160);
    assert_luminance("max_depth 2", &measured, 1.0 + 0.5 + 0.25);
}

/// Objects in light that is the same from everywhere: an object that a ray cannot leave twice shows
/// its albedo, and the surroundings show themselves.
#[test]
fn a_convex_object_in_uniform_light_shows_its_albedo() {
    let objects = [
        (
            "sphere",
            "<sphere><center>0 4 0</center><radius>1</radius><material_name>m</material_name></sphere>"
                .to_owned(),
        ),
        ("smoothed mesh", smooth_ball()),
    ];
    for (name, object) in objects {
        let scene = scene(&scene_file(&[
            settings(16, ""),
            flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.1),
            grey("m", 0.35),
            object,
            background(&uniform(EMITTED)),
        ]));
        let measured = measure(&scene, 16, 160);
        assert_luminance(name, &measured, 0.35);
        assert_is("alpha", &measured.xyza[3], 1.0, 1e-6);
    }
}

/// A ball so fine that what its shading normals lose below the geometric horizon, δ²/4 of the light
/// where they lean by δ, is below 1e-4.
fn smooth_ball() -> String {
    let text = Mesh::ball(5).text("ball", "m").replace("<normal_smoothing>false", "<normal_smoothing>true");
    text + "<model><pos>0 4 0</pos><scale>1</scale><mesh_name>ball</mesh_name></model>"
}

#[test]
fn uniform_surroundings_have_their_own_luminance() {
    let scene = scene(&scene_file(&[
        settings(8, ""),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 1.0),
        background(&uniform(EMITTED)),
    ]));
    let measured = measure(&scene, 8, 256);
    assert_luminance("background", &measured, 1.0);
    assert_eq!(measured.xyza[3].mean(), 0.0, "the surroundings are not in the foreground");
}
