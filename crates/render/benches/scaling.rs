//! How much faster two threads render than one: samples per second on the Cornell box, in runs that
//! take turns so that both see the same machine; medians, and the median of the pairs' ratios.
//! The aim is a ratio of at least 1.85 on a machine that is otherwise idle.

use indigo_geom::NoStore;
use indigo_igs::Limits;
use indigo_render::disk::DiskResolver;
use indigo_render::{Event, Halt, Options, Session};
use indigo_scene::{LoadOptions, Scene, load};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Pairs of runs.
const PAIRS: usize = 9;
/// How long each run lasts.
const RUN: Duration = Duration::from_secs(4);

fn cornell_box() -> Arc<Scene> {
    let options = LoadOptions {
        resolver: &DiskResolver::new(vec![]),
        trees: &NoStore,
        inifile: None,
        overrides: &[],
        limits: Limits::default(),
        check_only: false,
    };
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/cornell_box.igs");
    Arc::new(load(path, &options).scene.expect("a scene of ours without errors"))
}

/// Samples per second of one run, from its start until all threads have handed over.
fn rate(scene: &Arc<Scene>, threads: usize, seed: u64) -> f64 {
    let options =
        Options { threads, seed, halt: Halt { time: Some(RUN), ..Halt::default() }, ..Options::default() };
    let start = Instant::now();
    let mut session = Session::start(Arc::clone(scene), &options).expect("threads");
    loop {
        if let Event::Halted(_, progress) = session.wait(RUN) {
            return progress.samples as f64 / start.elapsed().as_secs_f64();
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    // `cargo test --benches` passes no such flag and wants no numbers.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    let scene = cornell_box();
    rate(&scene, 2, 0);
    let (mut one, mut two, mut ratios) = (vec![], vec![], vec![]);
    for pair in 0..PAIRS as u64 {
        // The order turns from pair to pair, so that a drift of the machine favours neither.
        let (a, b) = if pair % 2 == 0 {
            let a = rate(&scene, 1, pair);
            (a, rate(&scene, 2, pair))
        } else {
            let b = rate(&scene, 2, pair);
            (rate(&scene, 1, pair), b)
        };
        println!("pair {pair}: {a:.0} and {b:.0} samples/s, ratio {:.3}", b / a);
        one.push(a);
        two.push(b);
        ratios.push(b / a);
    }
    println!("one thread   {:>9.0} samples/s", median(one));
    println!("two threads  {:>9.0} samples/s", median(two));
    println!("ratio        {:>9.3} (aim: at least 1.85)", median(ratios));
}
