//! A thousand short renders have the right mean: neither how few samples there are, nor how a chain starts, may
//! shift it.
//!
//! Every test allows three standard errors, which chance exceeds once in 370 times; seeds are fixed.

mod common;

use common::again::replay;
use common::judge::NITS_PER_UNIFORM;
use common::shapes::{Mesh, mesh_light, model};
use common::text::{ONE_PIXEL, background, flat_camera, grey, scene_file, settings, uniform};
use common::{film, scene};
use indigo_scene::{MetropolisSettings, Scene};
use indigo_testkit::stats::Moments;

/// Independent renders.
const RENDERS: u64 = 1000;
/// Side of most pictures. The block that is looked at is the middle third of rows and columns.
const SIDE: u32 = 6;

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
    let side = scene.film.size.width() as usize;
    let rows = side / 3..2 * side / 3;
    let pixels = rows.clone().flat_map(|y| rows.clone().map(move |x| y * side + x));
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

/// An even background, and in the middle a small lamp: what part of the film it fills, and how many times as bright
/// it is. The exact mean luminance of the block, in which all of the lamp is.
fn lamp_in_view(share: f64, times: f64, background_value: f64) -> (Scene, f64) {
    let half = 0.5 * share.sqrt();
    let corners = vec![[-half, 1.0, -half], [half, 1.0, -half], [half, 1.0, half], [-half, 1.0, half]];
    let lamp = Mesh::polygon(corners);
    let value = 1e4;
    let parts = [
        settings(WIDE_SIDE, ONE_PIXEL),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.5),
        grey("black", 0.0),
        lamp.text("lamp", "black") + &mesh_light("lamp", &uniform(times * value), [0.0; 3], 1.0, ""),
        background(&uniform(background_value * value)),
    ];
    let block = 1.0 / 9.0;
    let mean = (background_value * (block - share) + times * share) / block;
    (scene(&scene_file(&parts)), mean * value * NITS_PER_UNIFORM)
}

const PATH_METROPOLIS: Mode = Mode { bidirectional: false, metropolis: true };

/// A side that makes chains start from as many seeds as those of small pictures do.
const WIDE_SIDE: u32 = 120;

/// Samples per pixel that are a unit of each of 64 chains.
const HALF_OF_ALL_CHAINS: u64 = 64 * 2048 / (WIDE_SIDE * WIDE_SIDE) as u64 + 1;

/// A few bright seeds among many dim ones: where chains start is half of what the picture shows. Drawn among a thousand
/// seeds each, as if the brightness were those seeds' own, starts would lose five percent of the lamp.
#[test]
fn chains_start_as_often_in_bright_light_as_there_is_of_it() {
    let (mut scene, expected) = lamp_in_view(1.0 / 200.0, 200.0, 1.0);
    set(&mut scene, PATH_METROPOLIS);
    let renders = Moments::of((0..150).map(|i| block(&scene, 30_000 + i, HALF_OF_ALL_CHAINS)));
    assert_within_three_errors(&renders, expected, 0.0);
}

/// Light that one sample in 50,000 finds, of which most starts see nothing: chains that still look for it show nothing,
/// and must not count as if they had seen that there is none.
#[test]
fn light_that_few_samples_find_is_as_bright_as_it_is() {
    let (mut scene, expected) = lamp_in_view(1.0 / 50_000.0, 1e4, 0.0);
    set(&mut scene, PATH_METROPOLIS);
    let renders = Moments::of((0..200).map(|i| block(&scene, 40_000 + i, HALF_OF_ALL_CHAINS)));
    let (off, error) = (renders.mean() / expected - 1.0, renders.std_error() / expected);
    assert!(off.abs() < 3.0 * error && error < 0.1, "off by {off} ± {error}; again: {}", replay());
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
