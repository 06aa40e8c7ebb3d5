//! A sample that is told again is the one that went onto the film.

#[path = "../../render/tests/common/mod.rs"]
mod common;

use common::scene;
use common::shapes::{Mesh, mesh_light, model};
use common::text::{ONE_PIXEL, camera, grey, scene_file, settings, uniform};
use indigo_film::FilmState;
use indigo_math::Real;
use indigo_scene::{MetropolisSettings, Scene};
use indigo_transport::driver::Driver;
use indigo_transport::replay::{Replay, replay};

const SEED: u64 = 5;
/// Side of the picture, all of which is in unit 0.
const SIDE: u32 = 4;
/// What sums of some dozen numbers in single precision may be off by.
const ROUNDING: f64 = 1e-5;

/// A floor under a lamp that the camera sees, too.
fn floor() -> Scene {
    scene(&scene_file(&[
        settings(SIDE, ONE_PIXEL),
        camera([0.0, -4.0, 2.0], [0.0, 1.0, -0.3], 0.6, ""),
        grey("light", 0.7) + &grey("black", 0.0),
        Mesh::square(2.0, 0.0).text("floor", "light") + &model("floor"),
        Mesh::disc(0.7, 12).text("lamp", "black")
            + &mesh_light("lamp", &uniform(1e5), [0.0, 0.3, 2.5], 1.0, ""),
    ]))
}

/// What unit `unit` alone puts on the film, after those that it needs.
fn film_of(scene: &Scene, unit: u64) -> FilmState {
    let driver = Driver::new(scene, SEED);
    let mut film = FilmState::new(scene.film.size, driver.layers());
    let (mut delta, mut tracer) = (film.delta(), driver.tracer());
    for before in driver.units_before(unit) {
        driver.render_unit(scene, before, &mut tracer, &mut delta);
    }
    delta.clear();
    driver.render_unit(scene, unit, &mut tracer, &mut delta);
    film.merge(&delta).expect("made by this film");
    film
}

/// Luminance of what was found for the camera ray's own pixel, or elsewhere.
fn luminance(replay: &Replay, is_splat: bool) -> f64 {
    let found = replay.contributions().iter().filter(|c| c.at.is_some() == is_splat);
    found.map(|c| f64::from(c.weighted_xyz()[1])).sum()
}

fn assert_near(what: &str, told: f64, on_film: f64) {
    assert!((told - on_film).abs() <= ROUNDING * on_film.abs(), "{what}: {told} told, {on_film} on the film");
}

#[test]
fn each_sample_is_what_its_pixel_got() {
    for bidirectional in [false, true] {
        let mut scene = floor();
        scene.transport.bidirectional = bidirectional;
        let film = film_of(&scene, 0);
        let (mut splats, mut lit) = (0.0, 0);
        for index in 0..u64::from(SIDE * SIDE) {
            let told = replay(&scene, SEED, 0, index).expect("one for each pixel");
            let at = told.position();
            let pixel = |x: Real| (x * SIDE as Real) as u64;
            assert_eq!(pixel(at.y) * u64::from(SIDE) + pixel(at.x), index, "row by row");
            assert_near("a pixel", luminance(&told, false), film.layers[0].sums[index as usize][1]);
            splats += luminance(&told, true);
            lit += u32::from(luminance(&told, false) > 0.0);
            assert!(told.to_string().contains("film position"));
        }
        assert!(lit > 4, "{lit} pixels with light are few");
        if bidirectional {
            let sum: f64 = film.layers[1].sums.iter().map(|xyz| xyz[1]).sum();
            assert!(sum > 0.0, "no light path met the lens");
            // Each splat is spread over a film of so many pixels.
            assert_near("all splats", splats, sum);
        }
        let all = u64::from(SIDE * SIDE);
        assert_eq!(replay(&scene, SEED, 0, all).err(), Some(all), "there are no more");
    }
}

/// Of a chain's unit with large mutations alone every target counts in the brightness constant: X, Y and Z over 3.
#[test]
fn a_mutation_is_the_one_of_the_chain() {
    let mut scene = floor();
    scene.transport.metropolis = Some(MetropolisSettings {
        large_mutation_prob: 1.0,
        max_change: 0.01,
        max_consecutive_rejections: i64::MAX,
    });
    // The second unit of chain 3.
    let unit = 128 + 3;
    let film = film_of(&scene, unit);
    let driver = Driver::new(&scene, SEED);
    let (mut delta, mut tracer) = (film.delta(), driver.tracer());
    for before in driver.units_before(unit) {
        driver.render_unit(&scene, before, &mut tracer, &mut delta);
    }
    let mut all = Targets::default();
    driver.render_unit_recorded(&scene, unit, &mut tracer, &mut delta, &mut all);
    let sum: f64 = all.targets.iter().sum();
    assert_near("all targets", sum, film.layers[0].totals.b_sum);
    for index in [0, 1, 77] {
        let told = replay(&scene, SEED, unit, index).expect("one of 2048");
        let target = |c: &indigo_transport::replay::Contribution| {
            c.weighted_xyz().iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0
        };
        let target: f64 = told.contributions().iter().map(target).sum();
        assert_near(&format!("mutation {index}"), target, all.targets[index as usize]);
    }
    assert_eq!(all.targets.len(), 2048);
}

/// In a hybrid, units of the two kinds take turns.
#[test]
fn a_sample_says_what_its_unit_is() {
    let mut scene = floor();
    scene.transport.hybrid = true;
    scene.transport.metropolis = Some(MetropolisSettings {
        large_mutation_prob: 0.5,
        max_change: 0.01,
        max_consecutive_rejections: i64::MAX,
    });
    for (unit, expected) in [
        (0, format!("sample 2 of unit 0, which has {} low-discrepancy samples\n", SIDE * SIDE)),
        (1, "sample 2 of unit 1, which has 2048 mutations of a chain\n".to_owned()),
    ] {
        let told = replay(&scene, SEED, unit, 2).expect("a third").to_string();
        assert!(told.starts_with(&expected), "{told}");
    }
}

/// The targets of all samples.
#[derive(Default)]
struct Targets {
    sensor: Option<indigo_film::Sensor>,
    targets: Vec<f64>,
}

impl indigo_transport::technique::Record for Targets {
    fn begin(&mut self, _: indigo_math::Vec2, lambda: &indigo_spectrum::SampledWavelengths) {
        self.sensor = Some(indigo_film::Sensor::new(lambda));
        self.targets.push(0.0);
    }

    fn contribution(
        &mut self,
        _: (u32, u32),
        _: Option<indigo_math::Vec2>,
        value: indigo_spectrum::SampledSpectrum,
        weight: Real,
        _: indigo_light::Sender,
    ) {
        let xyz = self.sensor.as_ref().expect("begun").xyz(&(value * weight));
        *self.targets.last_mut().expect("begun") += xyz.iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0;
    }
}
