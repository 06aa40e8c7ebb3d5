//! How much faster two threads render than one: samples per second on the Cornell box in each mode, in turns, so that
//! all see the same machine; medians, and the medians of the rounds' ratios.
//! The aim is a ratio of at least 1.85 on a machine that is otherwise idle.
//!
//! Two sessions of one thread each, side by side, share nothing but the machine: what they reach is what it has to give
//! (processors of rented machines are seldom one's own), and what two threads of one session lose to them is ours.

#[path = "transport/modes.rs"]
mod modes;

use indigo_render::disk::DiskResolver;
use indigo_render::{Options, Session};
use indigo_scene::{LoadOptions, Scene, load};
use modes::{MODES, Mode};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Rounds of turns, one of each contestant.
const ROUNDS: usize = 24;
/// Sessions and their threads: one thread, two threads, two sessions apart.
const CONTESTANTS: [&[usize]; 3] = [&[1], &[2], &[1, 1]];
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

/// Paused sessions that never halt by themselves.
fn sessions(scene: &Arc<Scene>, threads: &[usize]) -> Vec<Session> {
    let start = |(seed, &threads): (u64, &usize)| {
        let options = Options { threads, seed, ..Options::default() };
        let mut session = Session::start(Arc::clone(scene), &options).expect("threads");
        // Chains look for their starts at first.
        session.wait(START);
        session.pause();
        rest(&mut session);
        session
    };
    (1..).zip(threads).map(start).collect()
}

fn rest(session: &mut Session) {
    while !session.is_resting() {
        session.wait(Duration::from_millis(1));
    }
}

/// Samples per second of a turn of some sessions together, until all their threads have handed over.
fn rate(sessions: &mut [Session]) -> f64 {
    let before = samples(sessions);
    let start = Instant::now();
    sessions.iter_mut().for_each(Session::resume);
    std::thread::sleep(TURN);
    sessions.iter_mut().for_each(Session::pause);
    sessions.iter_mut().for_each(rest);
    (samples(sessions) - before) as f64 / start.elapsed().as_secs_f64()
}

fn samples(sessions: &mut [Session]) -> u64 {
    sessions.iter_mut().map(|session| session.progress().samples).sum()
}

/// The quartiles of some values.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|k| values[values.len() * k / 4])
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
    let mut contestants = CONTESTANTS.map(|threads| sessions(&scene, threads));
    let mut rounds: Vec<[f64; 3]> = vec![];
    for round in 0..ROUNDS {
        let mut rates = [0.0; 3];
        // The order turns from round to round, so that a drift of the machine favours none.
        for k in (0..3).map(|k| (round + k) % 3) {
            rates[k] = rate(&mut contestants[k]);
        }
        rounds.push(rates);
    }
    let of = |value: fn(&[f64; 3]) -> f64| quartiles(rounds.iter().map(value).collect());
    let [low, ratio, high] = of(|[one, two, _]| two / one);
    println!(
        "{:<25} one thread {:>8.0} samples/s; two {ratio:.3} times as many ({low:.3} to {high:.3}; aim: 1.85), \
         two sessions apart {:.3} times; two threads reach {:.3} of those",
        mode.name,
        of(|[one, ..]| *one)[1],
        of(|[one, _, apart]| apart / one)[1],
        of(|[_, two, apart]| two / apart)[1],
    );
}
