//! What portals are worth: the error of a room that light enters by one window, at equal samples and at equal
//! time, in path tracing and bidirectionally. Runs take turns; times are sums over them.

#[path = "../tests/common/mod.rs"]
mod common;

use common::scene;
use common::window::{luminances, rel_mse, room};
use std::time::Instant;

const SEEDS: u64 = 8;
const PASSES: u64 = 256;
/// Samples of a pixel in the picture that the others are compared with.
const TRUTH: u64 = 1 << 15;

fn main() {
    // `cargo test --benches` passes no such flag and wants no numbers.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    let mut scenes = [true, false].map(|has_portal| scene(&room(has_portal)));
    let truth = luminances(&scenes[0], 1000, TRUTH);
    for bidirectional in [false, true] {
        let (mut errors, mut seconds) = ([0.0; 2], [0.0; 2]);
        for seed in 1..=SEEDS {
            for (i, scene) in scenes.iter_mut().enumerate() {
                scene.transport.bidirectional = bidirectional;
                let start = Instant::now();
                errors[i] += rel_mse(scene, &truth, seed..seed + 1, PASSES) / SEEDS as f64;
                seconds[i] += start.elapsed().as_secs_f64();
            }
        }
        let (gain, time) = (errors[1] / errors[0], seconds[0] / seconds[1]);
        println!(
            "bidirectional {bidirectional}: relMSE {:.2e} with portals, {:.2e} without: {gain:.1} times less at equal \
             samples; time {time:.2} times as long; at equal time {:.1} times less (aim: 4)",
            errors[0],
            errors[1],
            gain / time
        );
    }
}
