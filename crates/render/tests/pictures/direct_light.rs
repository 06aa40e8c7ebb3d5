//! Direct light against closed forms: luminance of the lamp, and of a diffuse floor under it.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near};
use super::common::shapes::{
    Mesh, Point, add, cross, disc_irradiance, dot, length, mesh_light, model, rotation, sub, unit,
};
use super::common::text::{flat_camera, grey, scene_file, settings, uniform};
use super::common::{measure, scene};
use std::f64::consts::PI;

/// Albedo of the floor.
const ALBEDO: f64 = 0.5;
/// How exactly the luminances must come out.
const TOLERANCE: f64 = 2e-3;
/// Half the width of the patch that is looked at is this fraction of its distance: the irradiance's
/// curvature over it is then far below the tolerance.
const NARROW: f64 = 2e-3;

/// The lamp of the manual's example: 100 W at 17.5 lm/W.
fn manual_lamp() -> String {
    "<rectanglelight><pos>0 0 1.9</pos><width>0.2</width><height>0.2</height><spectrum><peak><peak_min>300</peak_min>\
     <peak_width>550</peak_width><base_value>0</base_value><peak_value>200</peak_value></peak></spectrum>\
     <efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy>\
     </efficacy_scale></rectanglelight>"
        .to_owned()
}

/// A scene of lamps over a floor, looked at from `eye` towards `target`.
fn over_floor(lamps: &str, eye: Point, target: Point) -> String {
    over_floor_with("", lamps, eye, target)
}

/// The same with more settings.
fn over_floor_with(more: &str, lamps: &str, eye: Point, target: Point) -> String {
    scene_file(&[
        settings(8, more),
        flat_camera(eye, sub(target, eye), NARROW),
        grey("floor", ALBEDO),
        Mesh::square(20.0, 0.0).text("ground", "floor"),
        model("ground"),
        lamps.to_owned(),
    ])
}

/// Where a point of the floor is looked at from.
fn eye_of(target: Point) -> Point {
    [target[0] + 3.0, target[1] + 1.0, target[2] + 1.2]
}

/// Says that the floor at `target` has the luminance of an illuminance in lx, as 16 renders of some
/// passes tell.
#[track_caller]
fn assert_lit(what: &str, lamps: &str, target: Point, illuminance: f64, passes: u64) {
    let measured = measure(&scene(&over_floor(lamps, eye_of(target), target)), 16, passes);
    assert_is(what, measured.luminance(), ALBEDO * illuminance / PI, TOLERANCE);
}

#[test]
fn the_closed_forms_agree_with_each_other() {
    let up = [0.0, 0.0, 1.0];
    let disc = Mesh::disc(0.3, 2000).placed(IDENTITY, 1.0, [0.0, 0.0, 1.1]);
    assert!((disc.irradiance([0.0; 3], up) / disc_irradiance(0.3, 1.1) - 1.0).abs() < 1e-5);
    // The manual's lamp: 13926.0575 cd/m² give 153.7376 lx below it and 63.9058 lx at (1, 1).
    let lamp = Mesh::square(0.1, 1.9).inside_out();
    assert!((lamp.irradiance([0.0; 3], up) * 13_926.057_5 - 153.737_6).abs() < 1e-3);
    assert!((lamp.irradiance([1.0, 1.0, 0.0], up) * 13_926.057_5 - 63.905_8).abs() < 1e-3);
    // A far ball: π (R/d)² cos θ.
    let ball = Mesh::ball(5).placed(IDENTITY, 0.1, [3.0, 0.0, 4.0]);
    assert!((ball.irradiance([0.0; 3], up) / (PI * 0.01 / 25.0 * 0.8) - 1.0).abs() < 2e-3);
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn the_manuals_lamp_has_the_luminance_of_its_power() {
    let text = scene_file(&[settings(8, ""), flat_camera([0.0; 3], [0.0, 0.0, 1.0], 0.02), manual_lamp()]);
    assert_is("lamp", measure(&scene(&text), 16, 64).luminance(), 13_926.057_5, 1e-3);
}

#[test]
fn the_manuals_lamp_lights_the_floor_by_the_closed_form() {
    assert_lit("below", &manual_lamp(), [0.0; 3], 153.737_6, 96);
    assert_lit("at (1, 1)", &manual_lamp(), [1.0, 1.0, 0.0], 63.905_8, 96);
}

/// A lamp just above the camera has small coordinates, and rays to it are rounded by the lengths of ray and lamp all the same:
/// without a nudge, too, none meets the lamp before its end.
#[test]
fn a_lamp_near_the_camera_does_not_shade_itself() {
    let radiance = 5.0e7;
    let lamp = format!(
        "<rectanglelight><pos>0 0 0.45</pos><width>2</width><height>1</height><spectrum>{}</spectrum></rectanglelight>",
        uniform(radiance)
    );
    let size = [1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0];
    let shape = Mesh::square(1.0, 0.0).inside_out().placed(size, 1.0, [0.0, 0.0, 0.45]);
    let illuminance = shape.irradiance([0.0; 3], [0.0, 0.0, 1.0]) * radiance * NITS_PER_UNIFORM;
    let exact = "<ray_origin_nudge_distance>0</ray_origin_nudge_distance>";
    let text = over_floor_with(exact, &lamp, [1.5, 0.5, 0.4], [0.0; 3]);
    let measured = measure(&scene(&text), 16, 256);
    assert_is("floor", measured.luminance(), ALBEDO * illuminance / PI, TOLERANCE);
}

/// Irradiance for radiance 1 by the closed forms, evaluated by another program to nine digits.
#[test]
fn lamps_of_every_shape_light_the_floor_by_the_table() {
    let radiance = 5.0e7;
    let spectrum = uniform(radiance);
    let check = |what: &str, lamp: &str, target: Point, ratio: f64, passes: u64| {
        let measured = measure(&scene(&over_floor(lamp, eye_of(target), target)), 16, passes);
        let luminance = ALBEDO * ratio * radiance * NITS_PER_UNIFORM / PI;
        // The table's is a point's irradiance; over the patch that is seen it bends by some 1e-4.
        assert_near(what, measured.luminance(), luminance, TOLERANCE);
    };
    // Width, height and height above the floor; the place there.
    for (size, [x, y], ratio) in [
        ([0.2, 0.2, 1.9], [0.5, 0.0], 0.009_664_626),
        ([1.0, 1.0, 1.0], [0.0, 0.0], 0.752_274_688),
        ([2.0, 1.0, 0.5], [0.3, 0.2], 1.930_985_953),
        ([2.0, 1.0, 0.5], [2.0, 0.0], 0.056_117_802),
    ] {
        let [width, height, above] = size;
        let lamp = format!(
            "<rectanglelight><pos>0 0 {above}</pos><width>{width}</width><height>{height}</height><spectrum>{spectrum}</spectrum></rectanglelight>"
        );
        check(&format!("rectangle {size:?} at ({x}, {y})"), &lamp, [x, y, 0.0], ratio, 96);
    }
    // Radius and height; distance from the axis. 400 corners leave out 4e-5 of the disc.
    for (radius, above, aside, ratio) in [
        (0.5, 1.0, 0.0, 0.628_318_531),
        (0.1, 2.0, 0.0, 0.007_834_396),
        (0.5, 1.0, 0.5, 0.460_075_592),
        (1.0, 1.0, 2.0, 0.165_833_381),
    ] {
        let disc = Mesh::disc(radius, 400).text("disc", "lamp");
        let lamp = grey("lamp", 0.0) + &disc + &mesh_light("disc", &spectrum, [0.0, 0.0, above], 1.0, "");
        check(&format!("disc {radius} at {aside}"), &lamp, [0.0, aside, 0.0], ratio, 384);
    }
}

#[test]
fn a_rectangle_is_black_from_behind_and_does_not_light_upwards() {
    let seen =
        scene_file(&[settings(4, ""), flat_camera([0.0, 0.0, 3.0], [0.0, 0.0, -1.0], 0.02), manual_lamp()]);
    assert_eq!(measure(&scene(&seen), 2, 16).luminance().mean(), 0.0);
    let sunk = manual_lamp().replace("0 0 1.9", "0 0 -1.9");
    for eye in [[3.0, 1.0, 1.2], [3.0, 1.0, -1.2]] {
        let floor_above_it = over_floor(&sunk, eye, [0.0; 3]);
        assert_eq!(measure(&scene(&floor_above_it), 2, 16).luminance().mean(), 0.0);
    }
}

/// A quarter of a turn about x, then a fifth about z: no axis stays where it was.
fn turned() -> [f64; 9] {
    let (s, c) = 0.6f64.sin_cos();
    let (t, d) = 0.9f64.sin_cos();
    [d, -t * c, t * s, t, d * c, -d * s, 0.0, s, c]
}

#[test]
fn a_mesh_light_lights_the_floor_however_it_is_placed() {
    let radiance = 5.0e7;
    let disc = Mesh::disc(0.4, 24);
    let mirrored = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0];
    let cases = [
        ("disc", disc.clone(), IDENTITY, 1.0, 96),
        ("disc turned and shrunk", disc.clone(), turned(), 0.5, 96),
        ("disc mirrored in x", disc.clone(), [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], 1.3, 96),
        ("disc facing up, mirrored in z", disc.inside_out(), mirrored, 0.7, 96),
        ("ball sheared", Mesh::ball(2), [1.0, 0.4, 0.0, 0.0, 0.7, 0.2, 0.0, 0.0, 1.2], 0.3, 1024),
    ];
    for (what, mesh, m, scale, passes) in cases {
        let pos = [0.3, -0.2, 1.5];
        // A point of the mesh's outside stays outside under a reflection.
        let irradiance = mesh.placed(m, scale, pos).irradiance([0.0; 3], [0.0, 0.0, 1.0]);
        assert!(irradiance > 1e-3, "{what} does not light the floor");
        let lamps = [
            grey("lamp", 0.0),
            mesh.text("shade", "lamp"),
            mesh_light("shade", &uniform(radiance), pos, scale, &rotation(m)),
        ];
        assert_lit(what, &lamps.concat(), [0.0; 3], irradiance * radiance * NITS_PER_UNIFORM, passes);
    }
}

#[test]
fn efficacy_scale_gives_a_mesh_light_its_flux_at_any_size() {
    let efficacy = "<efficacy_scale><power_drawn>60</power_drawn><overall_luminous_efficacy>15</overall_luminous_efficacy></efficacy_scale>";
    let mesh = Mesh::ball(2);
    for (scale, gain) in [(0.05, 1.0), (0.4, 7e5)] {
        let lamps = [
            grey("lamp", 0.3),
            mesh.text("bulb", "lamp"),
            mesh_light("bulb", &uniform(gain), [0.0, 3.0, 0.0], scale, efficacy),
        ];
        let text = scene_file(&[
            settings(8, ""),
            flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.1 * scale),
            lamps.concat(),
        ]);
        let luminance = 60.0 * 15.0 / (PI * mesh.placed(IDENTITY, scale, [0.0; 3]).area());
        assert_is("bulb", measure(&scene(&text), 16, 64).luminance(), luminance, 1e-3);
    }
}

#[test]
fn two_lamps_add_up() {
    let second = manual_lamp().replace("0 0 1.9", "1 1 1.9");
    assert_lit("two lamps", &(manual_lamp() + &second), [1.0, 1.0, 0.0], 153.737_6 + 63.905_8, 96);
}

/// A small lamp in sight of the floor: E = L A cos θ cos θ' / d², times the part of it that nothing hides. A black sheet
/// stands just before it, from across the line of sight to beyond one side, or all over it.
#[test]
fn a_small_lamp_lights_by_inverse_squares_what_is_in_its_line_of_sight() {
    let (radiance, half): (f64, f64) = (1.0e11, 0.001);
    let (target, lamp_at) = ([0.2, 0.1, 0.0], [0.9, -0.6, 1.8]);
    let way = sub(target, lamp_at);
    let (distance, sight) = (length(way), unit(way));
    // Its front does not look straight at the floor's point.
    let front = unit(add(sight, [0.9, 0.4, 0.1]));
    let across = unit(cross(front, [0.0, 0.0, 1.0]));
    let along = cross(front, across);
    let rectangle = |middle: Point, [a0, a1]: [f64; 2], b: f64| {
        let corner = |a: f64, b: f64| add(middle, add(across.map(|x| x * a), along.map(|x| x * b)));
        Mesh::polygon(vec![corner(a0, -b), corner(a1, -b), corner(a1, b), corner(a0, b)])
    };
    let [cos_floor, cos_lamp] = [-sight[2], dot(front, sight)];
    assert!(cos_lamp > 0.5 && cos_lamp < 0.8);
    let free = radiance * NITS_PER_UNIFORM * (2.0 * half).powi(2) * cos_floor * cos_lamp / distance.powi(2);
    for (what, from, part) in [("free", 0.05, 1.0), ("half hidden", 0.0, 0.5), ("hidden", -0.05, 0.0)] {
        let before = add(lamp_at, sight.map(|x| x * 0.001));
        let parts = [
            grey("black", 0.0),
            rectangle(lamp_at, [-half, half], half).text("lamp", "black"),
            mesh_light("lamp", &uniform(radiance), [0.0; 3], 1.0, ""),
            rectangle(before, [from, 0.1], 0.1).text("sheet", "black"),
            model("sheet"),
        ];
        // Rays begin as near to the lamp as can be: a tenth of a millimetre before it they would pass the edge aside.
        let text = over_floor(&parts.concat(), eye_of(target), target);
        let exact = "<ray_origin_nudge_distance>1e-7</ray_origin_nudge_distance></renderer_settings>";
        let mut scene = scene(&text.replace("</renderer_settings>", exact));
        for bidirectional in [false, true] {
            scene.transport.bidirectional = bidirectional;
            let measured = measure(&scene, 16, 384);
            if part == 0.0 {
                assert_eq!(measured.luminance().mean(), 0.0);
            } else {
                let what = format!("{what}, bidirectional {bidirectional}");
                assert_is(&what, measured.luminance(), ALBEDO * part * free / PI, TOLERANCE);
            }
        }
    }
}
