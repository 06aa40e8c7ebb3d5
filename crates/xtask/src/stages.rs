//! `cargo xtask test` and the stages it is made of.

use std::time::{Duration, Instant};

use crate::process::{cargo, run};
use crate::{Outcome, counts, display, documents, fuzz, generate, soak, tidy, venv};

/// Seconds per fuzz target in the full run.
const FULL_FUZZ_SECONDS: &str = "60";

/// `cargo xtask fmt`.
pub fn format(_: &[String]) -> Outcome {
    run(&mut cargo(&["fmt", "--all"]))
}

/// `cargo xtask lint`. With the test profile, so that the dependencies are checked once for both.
pub fn lint(_: &[String]) -> Outcome {
    run(&mut cargo(&["clippy", "--workspace", "--all-targets", "--profile", "test", "--", "-D", "warnings"]))
}

/// `cargo xtask test`: every stage runs, whatever became of those before it; then a summary.
pub fn test(arguments: &[String]) -> Outcome {
    let (flags, filters): (Vec<&String>, Vec<&String>) = arguments.iter().partition(|a| a.starts_with('-'));
    let known = ["--full", "--grid", "--window"];
    if flags.iter().any(|flag| !known.contains(&flag.as_str())) || filters.len() > 1 {
        return Err("usage: cargo xtask test [--full | --grid | --window] [FILTER]".into());
    }
    let filter = filters.first().map(|f| f.as_str());
    let has = |wanted: &str| flags.iter().any(|flag| *flag == wanted);
    let mut report = Report::default();
    if has("--grid") {
        report.stage("agreement grid", || grid(filter));
    } else if has("--window") {
        report.stage("window", || tests(WINDOW, filter));
    } else if filter.is_some() {
        report.stage("tests", || tests(&[], filter));
    } else {
        report.stage("format", || run(&mut cargo(&["fmt", "--all", "--check"])));
        report.stage("tidy", || tidy::run(&[]));
        report.stage("lint", || lint(&[]));
        report.stage("tests", || tests(&[], None));
        for (about, feature) in FURNACES {
            report.stage(about, || furnace(feature));
        }
        let mut note = None;
        report.stage("instructions", || counts::judged(&[]).map(|said| note = said));
        report.notes.extend(note);
        report.stage("generated files", || generate::run(&["--check".into()]));
        report.stage("documentation", || documents::run(&[]));
    }
    if has("--full") {
        full(&mut report);
    }
    report.finish()
}

/// The targets that hold the window's tests.
const WINDOW: &[&str] = &["--bin", "indigo", "--test", "stories"];

/// Unit, integration and documentation tests, all or those of some targets, with what they need installed first.
///
/// Targets are chosen from the whole workspace: cargo enables the features that the chosen packages ask for, so that a
/// choice of packages builds most libraries once more.
fn tests(targets: &[&str], filter: Option<&str>) -> Outcome {
    let mut tests = cargo(&["test", "--workspace", "--no-fail-fast"]);
    tests.args(targets).args(filter).env(venv::TEST_PYTHON, venv::for_tests()?);
    let _display = display::for_tests(&mut tests)?;
    run(&mut tests)
}

/// Every technique under every driver on every scene of the grid, of which the tests of each run take a part.
fn grid(filter: Option<&str>) -> Outcome {
    let tests = ["test", "--workspace", "--test", "agreement"];
    run(cargo(&tests).args(filter).args(["--", "--include-ignored"]))
}

/// The other lane counts that every run renders a furnace with: nothing may rest on there being four.
const FURNACES: &[(&str, &str)] = &[("furnace, one lane", "lanes-1"), ("furnace, eight lanes", "lanes-8")];

/// The furnace tests of whole pictures in a kernel built differently. The longest series of bounces are
/// left to four lanes: they would take minutes to quieten for one.
fn furnace(feature: &str) -> Outcome {
    let feature = format!("indigo-render/{feature}");
    let tests = ["--workspace", "--test", "pictures", "--features", &feature, "furnace"];
    run(cargo(&["test"]).args(tests).args(["--", "--skip", "a_grey_ball", "--skip", "a_highly_reflective"]))
}

/// What a release needs beyond every change: the other lane counts, the double-precision oracle, the whole
/// agreement grid, a network render through a long night, and minutes of fuzzing.
fn full(report: &mut Report) {
    for variant in VARIANTS {
        report.stage(variant.about, || variant.test());
    }
    report.stage("agreement grid", || grid(None));
    report.stage("long night", || soak::run(&[]));
    report.stage("fuzzing", || fuzz::run(&[FULL_FUZZ_SECONDS.into()]));
}

/// The kernel built differently.
struct Variant {
    about: &'static str,
    package: &'static str,
    feature: &'static str,
    /// Crates whose tests are run under it: those that hold kernel code.
    crates: &'static [&'static str],
}

const SPECTRAL: &[&str] = &[
    "indigo-spectrum",
    "indigo-texture",
    "indigo-scatter",
    "indigo-light",
    "indigo-camera",
    "indigo-transport",
];

const VARIANTS: &[Variant] = &[
    Variant { about: "one lane", package: "indigo-spectrum", feature: "lanes-1", crates: SPECTRAL },
    Variant { about: "eight lanes", package: "indigo-spectrum", feature: "lanes-8", crates: SPECTRAL },
    Variant {
        about: "double precision",
        package: "indigo-math",
        feature: "f64",
        crates: &["indigo-math", "indigo-scatter", "indigo-transport"],
    },
];

impl Variant {
    fn test(&self) -> Outcome {
        let feature = format!("{}/{}", self.package, self.feature);
        let mut tests = cargo(&["test", "--no-fail-fast", "--package", self.package]);
        for name in self.crates.iter().filter(|name| **name != self.package) {
            tests.args(["--package", name]);
        }
        run(tests.args(["--features", &feature]).env(venv::TEST_PYTHON, venv::for_tests()?))
    }
}

/// Results and times of the stages.
#[derive(Default)]
struct Report {
    stages: Vec<(String, Duration, Outcome)>,
    /// What passed without being judged.
    notes: Vec<String>,
}

impl Report {
    fn stage(&mut self, name: &str, work: impl FnOnce() -> Outcome) {
        println!("\n== {name}");
        let start = Instant::now();
        let outcome = work();
        if let Err(message) = &outcome {
            eprintln!("{name}: {message}");
        }
        self.stages.push((name.to_string(), start.elapsed(), outcome));
    }

    fn finish(&self) -> Outcome {
        println!("\n== summary");
        for (name, time, outcome) in &self.stages {
            let verdict = if outcome.is_ok() { "ok" } else { "FAILED" };
            println!("{name:<20} {verdict:<7} {:>7.1} s", time.as_secs_f64());
        }
        let total: Duration = self.stages.iter().map(|(_, time, _)| *time).sum();
        let failed: Vec<&str> = self
            .stages
            .iter()
            .filter(|(_, _, outcome)| outcome.is_err())
            .map(|(name, ..)| name.as_str())
            .collect();
        println!("{:<28} {:>7.1} s", "total", total.as_secs_f64());
        // Last, where it is seen: a stage that judged nothing has passed nothing.
        for note in &self.notes {
            println!("*** {note}");
        }
        if failed.is_empty() {
            println!("all {} stages passed", self.stages.len());
            Ok(())
        } else {
            Err(format!("failed: {}", failed.join(", ")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_stage_does_not_stop_the_others_and_is_named() {
        let mut report = Report::default();
        let mut ran = false;
        report.stage("first", || Err("broken".into()));
        report.stage("second", || {
            ran = true;
            Ok(())
        });
        assert!(ran);
        assert_eq!(report.finish().unwrap_err(), "failed: first");
    }

    #[test]
    fn unknown_options_are_refused_before_anything_runs() {
        assert!(test(&["--fast".into()]).unwrap_err().contains("usage"));
        assert!(test(&["a".into(), "b".into()]).unwrap_err().contains("usage"));
    }
}
