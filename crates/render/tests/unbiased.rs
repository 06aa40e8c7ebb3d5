//! A thousand short renders have the right mean: neither how few samples there are, nor how a chain starts, may
//! shift it.
//!
//! Every test allows three standard errors, which chance exceeds once in 370 times; seeds are fixed.

mod common;

use common::judge::{NITS_PER_UNIFORM, replay};
use common::shapes::{Mesh, mesh_light, model};
use common::text::{flat_camera, grey, scene_file, settings, uniform};
use common::{film, scene};
use indigo_scene::{MetropolisSettings, Scene};
use indigo_testkit::stats::Moments;

/// Independent renders.
const RENDERS: u64 = 1000;
/// Side of the pictures, and first and last (excluded) row and column of the block that is looked at.
const SIDE: u32 = 6;
const BLOCK: [usize; 2] = [2, 4];

/// A technique under a driver.
#[derive(Clone, Copy)]
struct Mode {
    bidirectional: bool,
    metropolis: bool,
}

fn set(scene: &mut Scene, mode: Mode) {
    scene.transport.bidirectional = mode.bidirectional;
    scene.transport.hybrid = false;
    scene.transport.metropolis = mode.metropolis.then_some(MetropolisSettings {
        large_mutation_prob: 0.4,
        max_change: 0.01,
        max_consecutive_rejections: i64::MAX,
    });
}

/// A closed box whose walls shine evenly and reflect half of what they get: by the geometric series it is filled
/// with an even radiance of 1 / (1 − 1/2) of theirs.
fn furnace() -> (Scene, f64) {
    let mut inwards = Mesh::cube(1.0);
    for t in &mut inwards.triangles {
        t.swap(1, 2);
    }
    let box_of_light = inwards.text("box", "half") + &mesh_light("box", &uniform(1e5), [0.0; 3], 1.0, "");
    let camera = flat_camera([0.1, -0.5, 0.2], [0.0, 1.0, 0.1], 0.5);
    let text = scene_file(&[settings(SIDE, ""), camera, grey("half", 0.5), box_of_light]);
    (scene(&text), 2e5 * NITS_PER_UNIFORM)
}

/// A lamp over a floor, with light that gets there by a mirror of walls: nothing is even.
fn lit_corner() -> Scene {
    let wall = Mesh::polygon(vec![[-2.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 4.0], [-2.0, 2.0, 4.0]]);
    let lamp = Mesh::disc(0.4, 12);
    let parts = [
        settings(SIDE, ""),
        flat_camera([0.0, -3.0, 1.5], [0.0, 1.0, -0.3], 0.5),
        grey("light", 0.8) + &grey("black", 0.0),
        Mesh::square(2.0, 0.0).text("floor", "light") + &model("floor"),
        wall.text("wall", "light") + &model("wall"),
        lamp.text("lamp", "black") + &mesh_light("lamp", &uniform(1e6), [0.3, 0.5, 2.5], 1.0, ""),
    ];
    scene(&scene_file(&parts))
}

/// Mean luminance of the block.
fn block(scene: &Scene, seed: u64, passes: u64) -> f64 {
    let picture = film(scene, seed, passes).develop();
    let rows = BLOCK[0]..BLOCK[1];
    let pixels = rows.clone().flat_map(|y| rows.clone().map(move |x| y * SIDE as usize + x));
    let n = rows.len().pow(2) as f64;
    pixels.map(|i| f64::from(picture.pixels[i][1])).sum::<f64>() / n
}

#[track_caller]
fn assert_within_three_errors(renders: &Moments, expected: f64, error: f64) {
    let allowed = 3.0 * renders.std_error().hypot(error);
    let off = renders.mean() - expected;
    assert!(
        off.abs() <= allowed,
        "the mean of {} renders is {} instead of {expected}: off by {off}, more than three standard errors, {allowed}\n\
         again: {}",
        renders.count(),
        renders.mean(),
        replay()
    );
    // A scatter as large as the light itself could hide anything.
    assert!(allowed < 0.05 * expected, "{allowed} of {expected}");
}

fn check(mode: Mode) {
    let (mut scene, expected) = furnace();
    set(&mut scene, mode);
    let renders = Moments::of((0..RENDERS).map(|i| block(&scene, 10_000 + i, 1)));
    assert_within_three_errors(&renders, expected, 0.0);

    let mut scene = lit_corner();
    let long = Moments::of((0..20).map(|seed| block(&scene, seed, 2048)));
    set(&mut scene, mode);
    let renders = Moments::of((0..RENDERS).map(|i| block(&scene, 20_000 + i, 1)));
    assert_within_three_errors(&renders, long.mean(), long.std_error());
}

#[test]
fn path_tracing() {
    check(Mode { bidirectional: false, metropolis: false });
}

#[test]
fn bidirectional() {
    check(Mode { bidirectional: true, metropolis: false });
}

#[test]
fn path_tracing_under_metropolis() {
    check(Mode { bidirectional: false, metropolis: true });
}

#[test]
fn bidirectional_under_metropolis() {
    check(Mode { bidirectional: true, metropolis: true });
}
