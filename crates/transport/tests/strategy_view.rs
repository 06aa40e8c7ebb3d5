//! What is shown of the strategies: in a row all carry the same light, and weighted they add up to it.

#[path = "../../render/tests/common/mod.rs"]
mod common;

use common::again::replay;
use common::judge::assert_same;
use common::scene;
use common::shapes::{Mesh, mesh_light, model};
use common::text::{flat_camera, grey, scene_file, settings, uniform};
use indigo_math::Vec2;
use indigo_testkit::stats::Moments;
use indigo_transport::sampler::{Block, PrimarySample, SobolSample};
use indigo_transport::strategies::Strategies;
use indigo_transport::technique::{Events, Tracer};

const BATCHES: u64 = 12;

/// A floor under a lamp, with a wall beside it.
fn corner() -> indigo_scene::Scene {
    let wall = Mesh::polygon(vec![[-2.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 4.0], [-2.0, 2.0, 4.0]]);
    scene(&scene_file(&[
        settings(8, ""),
        flat_camera([0.0, -4.0, 2.0], [0.0, 1.0, -0.3], 0.4),
        grey("light", 0.7) + &grey("black", 0.0),
        Mesh::square(2.0, 0.0).text("floor", "light") + &model("floor"),
        wall.text("wall", "light") + &model("wall"),
        Mesh::disc(0.7, 12).text("lamp", "black")
            + &mesh_light("lamp", &uniform(1e5), [0.0, 0.3, 2.0], 1.0, ""),
    ]))
}

/// A lamp out of focus before a lens, and one that is larger than its blur.
fn lamps_in_the_lens() -> indigo_scene::Scene {
    let lens = flat_camera([0.0, -4.0, 2.0], [0.0, 1.0, 0.0], 0.4)
        .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.1</aperture_radius>");
    let square = |half: f64| {
        let at = |x: f64, z: f64| [half * x, 0.0, half * z];
        Mesh::polygon(vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)])
    };
    scene(&scene_file(&[
        settings(8, ""),
        lens,
        grey("black", 0.0),
        square(0.1).text("small", "black") + &mesh_light("small", &uniform(1e6), [-0.5, 0.0, 2.1], 1.0, ""),
        square(0.5).text("large", "black") + &mesh_light("large", &uniform(1e4), [0.6, 0.5, 1.9], 1.0, ""),
    ]))
}

/// What shines straight into the lens is found by the camera's ray and by light paths.
#[test]
fn both_strategies_of_one_edge_hold_one_light() {
    let scene = lamps_in_the_lens();
    let batches: Vec<Strategies> = (0..BATCHES).map(|seed| Strategies::gather(&scene, seed, 1)).collect();
    let whole = Moments::of((0..BATCHES).map(|seed| light_of(&scene, seed, 1)));
    assert!(whole.mean() > 0.0, "nothing is seen\nagain: {}", replay());
    let mean = |s: u32, kind: usize| Moments::of(batches.iter().map(|b| b.mean(s, 1)[kind][1]));
    let sum = Moments::of(batches.iter().map(|b| (0..2).map(|s| b.mean(s, 1)[1][1]).sum::<f64>()));
    assert_same("weighted", &sum, &whole);
    for s in 0..2 {
        assert_same(&format!("{s} vertices of the light"), &mean(s, 0), &whole);
        let share = mean(s, 1).mean() / whole.mean();
        assert!(share > 0.1, "{s} vertices of the light have {share} of the weight");
    }
}

#[test]
fn rows_hold_one_light_and_weights_add_up_to_it() {
    let scene = corner();
    let batches: Vec<Strategies> = (0..BATCHES).map(|seed| Strategies::gather(&scene, seed, 1)).collect();
    for edges in 2..=4u32 {
        let whole = Moments::of((0..BATCHES).map(|seed| light_of(&scene, seed, edges)));
        let weighted = |b: &Strategies| (0..=edges).map(|s| b.mean(s, edges)[1][1]).sum::<f64>();
        let sum = Moments::of(batches.iter().map(weighted));
        assert!(sum.mean() > 0.0, "{edges} edges: nothing is seen\nagain: {}", replay());
        assert_same(&format!("{edges} edges, weighted"), &sum, &whole);
        for s in 0..=edges {
            let alone = Moments::of(batches.iter().map(|b| b.mean(s, edges)[0][1]));
            assert_same(&format!("{edges} edges, {s} vertices of the light"), &alone, &whole);
        }
    }
}

/// Mean luminance of paths of so many edges, by path tracing.
fn light_of(scene: &indigo_scene::Scene, seed: u64, edges: u32) -> f64 {
    let mut tracer = Tracer::new(false, 1.0);
    let events = Events { least: edges - 1, most: edges - 1 };
    let samples = 10_000;
    let sum: f64 = (0..samples)
        .map(|i| {
            let mut numbers = SobolSample::new(1_000 + seed, 0, i);
            let [u, v, ..] = numbers.block(Block::FILM);
            let found = tracer.trace(scene, &mut numbers, Vec2::new(u, v), events, &mut ());
            f64::from(found.sensor.xyz(&found.path.radiance())[1])
        })
        .sum();
    sum / f64::from(samples)
}
