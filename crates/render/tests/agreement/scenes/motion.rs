//! Scenes in which something moves while the shutter is open.

use super::super::text::{basic, camera, henyey_greenstein, medium, scattering, specular, uniform};
use super::media::{cuboid, fog};
use super::{Written, block, build, common, lamp, room};

fn key(time: f64, pos: [f64; 3], angle: f64) -> String {
    let [x, y, z] = pos;
    format!(
        "<keyframe><time>{time}</time><pos>{x} {y} {z}</pos><rotation_quaternion><axis>0 0.6 0.8</axis><angle>{angle}</angle></rotation_quaternion></keyframe>"
    )
}

/// An element with keyframes in place of its `pos`.
fn moving(element: &str, pos: &str, keys: &str) -> String {
    let moved = element.replace(pos, keys);
    assert_ne!(moved, element);
    moved
}

/// A mesh whose model moves.
fn moving_model(parts: Vec<String>, keys: &str) -> Vec<String> {
    let [mesh, placed] = <[String; 2]>::try_from(parts).expect("a mesh and its model");
    vec![mesh, moving(&placed, "<pos>0 0 0</pos>", keys)]
}

fn moving_camera(to: [f64; 3], angle: f64) -> String {
    let lens = camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42, "");
    moving(&lens, "<pos>0 -3.6 0</pos>", &(key(0.0, [0.0, -3.6, 0.0], 0.0) + &key(1.0, to, angle)))
}

fn tumble() -> String {
    key(-1.0, [0.0; 3], 0.0) + &key(0.5, [-0.4, -0.2, 0.3], 0.8) + &key(1.0, [-0.2, 0.0, 0.8], -0.5)
}

/// A block that turns and moves, seen by a camera that does, too.
pub fn motion() -> Written {
    let lens = moving_camera([0.3, -3.4, 0.1], 0.1);
    build(&[common(lens), room(["white"; 4]), moving_model(block("grey"), &tumble()), lamp(0.3, 1e5)])
}

/// A camera that moves into fog, glass that scatters and tumbles, and other fog that comes over the lamp.
pub fn moving_media() -> Written {
    let milky = basic(1.3, &uniform(0.3), &scattering(&uniform(3.0), &henyey_greenstein(0.4)));
    let media = vec![
        fog("f", &uniform(0.05), &uniform(0.4), &henyey_greenstein(-0.3)),
        specular("in fog", "f"),
        medium("m", 20, &milky),
        specular("milky", "m"),
        fog("smoke", &uniform(0.5), &uniform(1.0), "<uniform/>"),
        specular("in smoke", "smoke"),
    ];
    // Its front is at y = -3.5.
    let bank = cuboid("bank", "in fog", [3.0, 1.1, 3.0], [0.0, -2.4, 0.0]);
    let glass = moving_model(cuboid("glass", "milky", [0.4, 0.3, 0.35], [0.0, 0.0, -0.4]), &tumble());
    let rising = key(0.0, [0.0, 0.1, -0.3], 0.0) + &key(1.0, [0.0, 0.1, 0.6], 0.0);
    let smoke = moving_model(cuboid("smoke", "in smoke", [0.8, 0.6, 0.6], [0.0; 3]), &rising);
    let lens = moving_camera([0.1, -3.2, 0.1], 0.05);
    build(&[common(lens), room(["white"; 4]), media, bank, glass, smoke, lamp(0.3, 1e5)])
}
