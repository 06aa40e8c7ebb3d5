//! What drawing distant light well is worth: the error of a room that light enters by one window, with and without
//! a portal, and of a map with a small sun, drawn by luminance and evenly; at equal samples and at equal time, in path
//! tracing and bidirectionally. Runs take turns; times are the thread's own, summed over them.

#[path = "../tests/common/mod.rs"]
mod common;

use common::noise::{luminances, rel_mse};
use common::scene;
use common::small_sun::under_small_sun;
use common::window::room;
use cpu_time::ThreadTime;
use indigo_scene::Scene;

const SEEDS: u64 = 8;
const PASSES: u64 = 256;
/// Samples of a pixel in the picture that the others are compared with.
const TRUTH: u64 = 1 << 15;

/// Errors and times of a scene whose light is drawn well, and of the same drawn otherwise.
fn compare(name: &str, mut scenes: [Scene; 2], aim: &str) {
    let truth = luminances(&scenes[0], 1000, TRUTH);
    for bidirectional in [false, true] {
        let (mut errors, mut seconds) = ([0.0; 2], [0.0; 2]);
        for seed in 1..=SEEDS {
            for (i, scene) in scenes.iter_mut().enumerate() {
                scene.transport.bidirectional = bidirectional;
                let start = ThreadTime::now();
                errors[i] += rel_mse(scene, &truth, seed..seed + 1, PASSES) / SEEDS as f64;
                seconds[i] += start.elapsed().as_secs_f64();
            }
        }
        let (gain, time) = (errors[1] / errors[0], seconds[0] / seconds[1]);
        println!(
            "{name}, bidirectional {bidirectional}: relMSE {:.2e} and {:.2e}: {gain:.1} times less at equal samples; \
             time {time:.2} times as long; at equal time {:.1} times less{aim}",
            errors[0],
            errors[1],
            gain / time
        );
    }
}

fn main() {
    // `cargo test --benches` passes no such flag and wants no numbers.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    let rooms = [true, false].map(|has_portal| scene(&room(has_portal)));
    compare("a portal in a window against none", rooms, " (aim: 4)");
    let suns = [true, false].map(under_small_sun);
    compare("a small sun in a map, drawn by luminance against evenly", suns, "");
}
