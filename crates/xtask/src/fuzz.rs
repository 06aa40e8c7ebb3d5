//! `cargo xtask fuzz`: damaged files for every reader, on the stable toolchain.

use crate::Outcome;
use crate::process;

/// The package that holds the fuzz targets, one test each.
const PACKAGE: &str = "indigo-fuzz";
/// How long each target runs, in seconds; the targets read it.
const SECONDS: &str = "INDIGO_FUZZ_SECONDS";

/// Runs all targets for so many seconds each.
pub fn run(arguments: &[String]) -> Outcome {
    let seconds = match arguments {
        [] => 60,
        [number] => number.parse::<u32>().map_err(|_| format!("`{number}` is no number of seconds"))?,
        _ => return Err("usage: cargo xtask fuzz [SECONDS]".into()),
    };
    let mut cargo = process::cargo(&["test", "-p", PACKAGE, "--", "--nocapture"]);
    process::run(cargo.env(SECONDS, seconds.to_string()))
}
