//! `cargo xtask bench`: measurements. Their numbers gate nothing; only ratios taken in one process do.

use crate::{Outcome, bench_machine, bench_rays, process};

/// `machine` measures how the console scales, `rays` races our ray kernel against Embree, `transport` the ways of rendering against each other; any other word
/// is a crate whose benchmarks are run.
pub fn run(arguments: &[String]) -> Outcome {
    match arguments.split_first() {
        None => Err("usage: cargo xtask bench machine|rays|transport|CRATE [ARGUMENTS]".into()),
        Some((name, rest)) if name == "machine" => bench_machine::run(rest),
        Some((name, rest)) if name == "rays" => bench_rays::run(rest),
        Some((name, rest)) if name == "transport" => {
            let bench = ["bench", "--package", "indigo-render", "--bench", "transport", "--"];
            process::run(process::cargo(&bench).args(rest))
        }
        Some((name, rest)) => {
            let package = format!("indigo-{}", name.trim_start_matches("indigo-"));
            process::run(process::cargo(&["bench", "-p", &package, "--benches", "--"]).args(rest))
        }
    }
}
