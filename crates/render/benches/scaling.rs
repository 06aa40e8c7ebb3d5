//! How much faster two threads render than one: samples per second on the Cornell box in each mode, in turns of two
//! sessions, that both see the same machine; medians, and the median of the pairs' ratios.
//! The aim is a ratio of at least 1.85 on a machine that is otherwise idle.

#[path = "transport/modes.rs"]
mod modes;

use indigo_render::disk::DiskResolver;
use indigo_render::{Options, Session};
use indigo_scene::{LoadOptions, Scene, load};
use modes::{MODES, Mode};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Pairs of turns.
const PAIRS: usize = 24;
/// How long each turn lasts: long for the units of work in it, short for the moods of a machine.
const TURN: Duration = Duration::from_millis(700);
/// How long a session runs before it is timed.
const START: Duration = Duration::from_secs(3);

fn cornell_box() -> Scene {
    let resolver = DiskResolver::new(vec![]);
    let options = LoadOptions::new(&resolver);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/cornell_box.igs");
    load(path, &options).scene.expect("a scene of ours without errors")
}

/// A paused session that never halts by itself.
fn session(scene: &Arc<Scene>, threads: usize) -> Session {
    let options = Options { threads, ..Options::default() };
    let mut session = Session::start(Arc::clone(scene), &options).expect("threads");
    // Chains look for their starts at first.
    session.wait(START);
    session.pause();
    rest(&mut session);
    session
}

fn rest(session: &mut Session) {
    while !session.is_resting() {
        session.wait(Duration::from_millis(1));
    }
}

/// Samples per second of a turn, until all threads have handed over.
fn rate(session: &mut Session) -> f64 {
    let before = session.progress().samples;
    let start = Instant::now();
    session.resume();
    std::thread::sleep(TURN);
    session.pause();
    rest(session);
    (session.progress().samples - before) as f64 / start.elapsed().as_secs_f64()
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
    for mode in MODES {
        race(mode);
    }
}

fn race(mode: &Mode) {
    let scene = Arc::new(mode.of(cornell_box()));
    let mut sessions = [1, 2].map(|threads| session(&scene, threads));
    let (mut rates, mut ratios) = ([vec![], vec![]], vec![]);
    for pair in 0..PAIRS {
        let mut pair_rates = [0.0; 2];
        // The order turns from pair to pair, so that a drift of the machine favours neither.
        for k in [pair % 2, 1 - pair % 2] {
            pair_rates[k] = rate(&mut sessions[k]);
            rates[k].push(pair_rates[k]);
        }
        ratios.push(pair_rates[1] / pair_rates[0]);
    }
    let [one, two] = rates;
    ratios.sort_by(f64::total_cmp);
    println!(
        "{:<25} one thread {:>9.0} samples/s, two {:>9.0}: ratio {:.3} (half of them {:.3} to {:.3}; aim: at least 1.85)",
        mode.name,
        median(one),
        median(two),
        median(ratios.clone()),
        ratios[PAIRS / 4],
        ratios[PAIRS * 3 / 4],
    );
}
