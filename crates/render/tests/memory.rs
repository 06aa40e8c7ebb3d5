//! What rendering takes of the heap: nothing for a sample, and for a thread little more than a film.
//!
//! An allocator counts, per thread, how often it is called and what is held.

mod common;

use common::scene;
use common::shapes::{Mesh, mesh_light, model};
use common::text::{
    basic, camera, grey, henyey_greenstein, medium, scattering, scene_file, settings, specular, sphere,
    uniform,
};
use indigo_film::FilmState;
use indigo_scene::{MetropolisSettings, Scene};
use indigo_testkit::allocation::{Counting, calls, held};
use indigo_transport::driver::Driver;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A room with a ball of glass, one of fog and a lamp: paths of every kind.
fn room(side: u32) -> Scene {
    let mut inwards = Mesh::cube(1.0);
    for t in &mut inwards.triangles {
        t.swap(1, 2);
    }
    let fog = basic(1.0, &uniform(0.1), &scattering(&uniform(5.0), &henyey_greenstein(0.5)));
    let parts = [
        settings(side, ""),
        camera([0.0, -0.9, 0.0], [0.0, 1.0, 0.0], 1.0, ""),
        grey("white", 0.4) + &grey("black", 0.0),
        medium("glass", 10, &basic(1.5, &uniform(0.2), "")) + &medium("fog", 5, &fog),
        specular("glass", "glass") + &specular("fog", "fog"),
        inwards.text("walls", "white") + &model("walls"),
        sphere([0.4, 0.3, -0.4], 0.3, "glass") + &sphere([-0.4, 0.3, -0.3], 0.4, "fog"),
        Mesh::disc(0.3, 8).text("lamp", "black")
            + &mesh_light("lamp", &uniform(1e6), [0.0, 0.0, 0.9], 1.0, ""),
    ];
    scene(&scene_file(&parts))
}

fn modes(mut scene: Scene, mut look: impl FnMut(&str, &Scene)) {
    let settings = MetropolisSettings {
        large_mutation_prob: 0.4,
        max_change: 0.01,
        max_consecutive_rejections: i64::MAX,
    };
    for (name, bidirectional, metropolis, hybrid) in [
        ("path", false, false, false),
        ("bidirectional", true, false, false),
        ("path, Metropolis", false, true, false),
        ("bidirectional, Metropolis", true, true, false),
        ("path, hybrid", false, true, true),
        ("bidirectional, hybrid", true, true, true),
    ] {
        scene.transport.bidirectional = bidirectional;
        scene.transport.metropolis = metropolis.then_some(settings);
        scene.transport.hybrid = hybrid;
        look(name, &scene);
    }
}

/// Units that let the memory of a worker and of all chains grow to its size: every chain's own grows in its first
/// unit, there are 128 chains, and a hybrid takes every other unit of them.
const FIRST_UNITS: u64 = 300;
/// Units whose samples are watched.
const WATCHED_UNITS: u64 = 30;

#[test]
fn no_sample_allocates() {
    modes(room(16), |mode, scene| {
        let driver = Driver::new(scene, 5);
        let film = FilmState::new(scene.film.size, driver.layers());
        let (mut delta, mut tracer) = (film.delta(), driver.tracer());
        for unit in 0..FIRST_UNITS {
            driver.render_unit(scene, unit, &mut tracer, &mut delta);
        }
        let before = calls();
        let units = FIRST_UNITS..FIRST_UNITS + WATCHED_UNITS;
        let samples: u64 = units.map(|unit| driver.render_unit(scene, unit, &mut tracer, &mut delta)).sum();
        let made = calls() - before;
        assert!(samples > 5_000, "{mode}: {samples} samples are not many");
        assert!(made == 0, "{mode}: {made} allocations in {samples} samples");
    });
}

/// A worker holds a film of single precision, and its paths.
#[test]
fn a_thread_takes_less_than_a_film_and_a_quarter() {
    modes(room(128), |mode, scene| {
        let driver = Driver::new(scene, 5);
        let film = FilmState::new(scene.film.size, driver.layers());
        let size = film.memory_bytes() as isize;
        let before = held();
        let (mut delta, mut tracer) = (film.delta(), driver.tracer());
        for unit in 0..driver.units(1) {
            driver.render_unit(scene, unit, &mut tracer, &mut delta);
        }
        // Metropolis chains are shared by all threads: what is still held without the worker is theirs.
        let all = held() - before;
        drop((delta, tracer));
        let own = all - (held() - before);
        assert!(own > size / 20, "{mode}: {own} bytes beside {size} are too few to be true");
        assert!(4 * own < 5 * size, "{mode}: {own} bytes for a thread beside {size} for the film");
    });
}
