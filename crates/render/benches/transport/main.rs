//! What each way of rendering reaches in equal time, on one thread: samples and rays per second, relMSE against a
//! long reference, and the time to a given error. `cargo xtask bench transport` runs it.
//!
//! The modes take turns of a fraction of a second, so that all see the same machine, and are timed by what the
//! thread itself used. Options: `--scene NAME|FILE.igs` (may be repeated; all of its own without it), `--mode NAME`
//! (likewise), `--seconds S` for each mode (20), `--target E` relMSE whose time is wanted (0.01),
//! `--reference S` seconds for a reference that is not kept yet (240), `--list`, `--export DIR` (writes its scenes as
//! files, for other renderers: `race_mitsuba.py` beside this file races one of them), `--figures` (tells each figure in a
//! line of its own as well, for programs: `figure`, series, name and value between tabs).
//!
//! References are kept in `bench-data/transport`, by the scene's name and a hash of its text. They are made by a mode
//! that suits the scene, in two halves, whose difference tells their noise.

#[path = "../../tests/common/mod.rs"]
mod common;
mod measure;
mod modes;
mod reference;
mod scenes;

use indigo_scene::Scene;
use measure::{Run, errors};
use modes::{MODES, Mode};
use reference::Reference;
use scenes::BenchScene;

/// A turn of a mode, seconds: many in a run, and many units of work in each.
const TURN: f64 = 0.5;
/// Parts of the time after which the relMSE of luminance is told.
const PARTS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

struct Arguments {
    scenes: Vec<String>,
    modes: Vec<String>,
    seconds: f64,
    target: f64,
    reference: f64,
    is_list: bool,
    export: Option<String>,
    figures: bool,
}

fn arguments() -> Arguments {
    let mut parsed = Arguments {
        scenes: vec![],
        modes: vec![],
        seconds: 20.0,
        target: 0.01,
        reference: 240.0,
        is_list: false,
        export: None,
        figures: false,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        let number = |text: String| text.parse().unwrap_or_else(|_| panic!("{text} is no number"));
        match word.as_str() {
            "--scene" => parsed.scenes.push(value()),
            "--mode" => parsed.modes.push(value()),
            "--seconds" => parsed.seconds = number(value()),
            "--target" => parsed.target = number(value()),
            "--reference" => parsed.reference = number(value()),
            "--list" => parsed.is_list = true,
            "--figures" => parsed.figures = true,
            "--export" => parsed.export = Some(value()),
            // Cargo adds it.
            "--bench" => {}
            _ => panic!("unknown option {word}"),
        }
    }
    parsed
}

fn main() {
    // `cargo test --benches` passes no such flag and wants no numbers.
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    let arguments = arguments();
    let own = scenes::all();
    if arguments.is_list {
        for scene in own {
            println!("{}", scene.name);
        }
        return;
    }
    if let Some(folder) = arguments.export {
        std::fs::create_dir_all(&folder).expect("a folder");
        for scene in own {
            std::fs::write(format!("{folder}/{}.igs", scene.name), scene.text).expect("room for a scene");
        }
        return;
    }
    let chosen: Vec<BenchScene> = if arguments.scenes.is_empty() {
        own
    } else {
        arguments.scenes.iter().map(|name| scenes::named(name)).collect()
    };
    let modes: Vec<&Mode> = MODES
        .iter()
        .filter(|m| arguments.modes.is_empty() || arguments.modes.iter().any(|name| name == m.name))
        .collect();
    for scene in chosen {
        race(&scene, &modes, &arguments);
    }
}

/// All modes on a scene, in turns.
fn race(bench: &BenchScene, modes: &[&Mode], arguments: &Arguments) {
    let reference = Reference::of(bench, arguments.reference);
    let scenes: Vec<Scene> = modes.iter().map(|mode| mode.of(bench.load())).collect();
    let mut runs: Vec<Run> = scenes.iter().map(|scene| Run::new(scene, 1)).collect();
    let turns = (arguments.seconds / TURN).ceil() as usize;
    for turn in 0..turns {
        for i in 0..runs.len() {
            // The order turns, too.
            let i = (i + turn) % runs.len();
            runs[i].go_on(TURN);
            let error = errors(&runs[i].picture(), &reference)[0];
            let seconds = runs[i].seconds;
            runs[i].history.push((seconds, error));
        }
    }
    println!(
        "\n{} ({:.0} s a mode; noise of the reference: {:.1e})",
        bench.name,
        turns as f64 * TURN,
        reference.noise[0]
    );
    print!("{:<26} {:>8} {:>11} {:>9}", "mode", "samples", "samples/s", "Mrays/s");
    for part in PARTS {
        print!(" {:>11}", format!("Y at {:.1} s", arguments.seconds * part));
    }
    println!(" {:>11} {:>16}", "XYZ at end", format!("s to {}", arguments.target));
    for (mode, run) in modes.iter().zip(&runs) {
        print!(
            "{:<26} {:>8.1} {:>11.0} {:>9.3}",
            mode.name,
            run.samples_per_pixel(),
            run.samples as f64 / run.seconds,
            run.rays() as f64 / run.seconds * 1e-6
        );
        for part in PARTS {
            // As if it were just that long after the start: error falls as 1 / time.
            let at = arguments.seconds * part;
            let reached = run.history.iter().find(|(s, _)| *s >= at);
            let (seconds, error) = reached.copied().unwrap_or((at, f64::NAN));
            print!(" {:>11.3e}", error * seconds / at);
        }
        let [_, xyz] = errors(&run.picture(), &reference).map(|e| e * run.seconds / arguments.seconds);
        println!(" {:>11.3e} {:>16}", xyz, time_to(&run.history, arguments.target));
        if arguments.figures {
            let figure = |what: &str, value: f64| {
                println!("figure\ttransport, {}\t{}: {what}\t{value}", bench.name, mode.name);
            };
            figure("samples per second", run.samples as f64 / run.seconds);
            figure("rays per second", run.rays() as f64 / run.seconds);
            figure(&format!("relMSE of XYZ after {} s", arguments.seconds), xyz);
        }
    }
}

/// When an error was reached for good, or an estimate (marked ~) by the law that it falls as 1 / time.
fn time_to(history: &[(f64, f64)], target: f64) -> String {
    let last_above = history.iter().rposition(|(_, error)| *error > target);
    match last_above {
        None => format!("< {:.1}", history[0].0),
        Some(i) if i + 1 < history.len() => format!("{:.1}", history[i + 1].0),
        Some(i) => format!("~ {:.1}", history[i].0 * history[i].1 / target),
    }
}
