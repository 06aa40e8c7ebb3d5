//! `cargo xtask bench`: measurements. Their numbers gate nothing; only ratios taken in one process do.

use crate::{Outcome, bench_machine, bench_rays, display, process};

const USAGE: &str = "usage: cargo xtask bench machine|rays|transport|window|CRATE [ARGUMENTS]";

/// `machine` measures how the console scales, `rays` races our ray kernel against Embree, `transport` the ways of rendering against each other, `window` what the window costs; any other word
/// is a crate whose benchmarks are run.
pub fn run(arguments: &[String]) -> Outcome {
    match arguments.split_first() {
        None => Err(USAGE.into()),
        Some((name, _)) if name.starts_with('-') => Err(USAGE.into()),
        Some((name, rest)) if name == "machine" => bench_machine::run(rest),
        Some((name, rest)) if name == "rays" => bench_rays::run(rest),
        Some((name, rest)) if name == "transport" => {
            let bench = ["bench", "--package", "indigo-render", "--bench", "transport", "--"];
            process::run(process::cargo(&bench).args(rest))
        }
        Some((name, rest)) if name == "window" => window(rest),
        Some((name, rest)) => {
            let package = format!("indigo-{}", name.trim_start_matches("indigo-"));
            process::run(process::cargo(&["bench", "-p", &package, "--benches", "--"]).args(rest))
        }
    }
}

/// On a display of its own, with the console that the window is compared with built beside it: by a benchmark of the console, so
/// that both are of one build.
fn window(rest: &[String]) -> Outcome {
    let both = ["bench", "--workspace", "--no-run", "--bench", "window", "--bench", "two_machines"];
    process::run(&mut process::cargo(&both))?;
    let mut bench = process::cargo(&["bench", "--workspace", "--bench", "window", "--"]);
    let _display = display::for_tests(bench.args(rest))?;
    process::run(&mut bench)
}
