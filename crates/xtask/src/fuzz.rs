//! `cargo xtask fuzz`: damaged files for every reader, on the stable toolchain.

use crate::Outcome;
use crate::process;

/// The package that holds the fuzz targets, one test each.
const PACKAGE: &str = "indigo-fuzz";
/// How long each target runs, in seconds, or how many cases; the targets read it.
const SECONDS: &str = "INDIGO_FUZZ_SECONDS";
const CASES: &str = "INDIGO_FUZZ_CASES";
const USAGE: &str = "usage: cargo xtask fuzz [SECONDS | --cases N] [TARGET]";

/// Runs all targets, or those of a name, for so many seconds or cases each.
pub fn run(arguments: &[String]) -> Outcome {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (variable, amount, target) = match arguments[..] {
        ["--cases", cases] => (CASES, cases, None),
        ["--cases", cases, target] => (CASES, cases, Some(target)),
        [seconds, target] => (SECONDS, seconds, Some(target)),
        [word] if word.parse::<u64>().is_ok() => (SECONDS, word, None),
        [target] => (SECONDS, "60", Some(target)),
        [] => (SECONDS, "60", None),
        _ => return Err(USAGE.into()),
    };
    let amount: u64 = amount.parse().map_err(|_| format!("`{amount}` is no whole number; {USAGE}"))?;
    let mut cargo = process::cargo(&["test", "-p", PACKAGE, "--", "--nocapture"]);
    process::run(cargo.args(target).env(variable, amount.to_string()))
}
