//! `cargo xtask validate`: renders scenes whose pictures are known, and says in a report whether they came out.
//!
//! Nothing of the renderer is linked: scenes are files, pictures are what the release console writes.

pub mod agreement;
pub mod check;
pub mod console;
pub mod cross;
pub mod images;
pub mod oracles;
pub mod page;
#[path = "../../../testkit/src/png.rs"]
mod png;
pub mod report;
#[path = "../../../render/tests/common/shapes.rs"]
#[allow(dead_code, reason = "the renderer's tests make their scenes of the same parts")]
pub mod shapes;
pub mod statistics;
#[path = "../../../render/tests/common/text.rs"]
#[allow(dead_code, reason = "the renderer's tests make their scenes of the same parts")]
pub mod text;

use std::path::PathBuf;
use std::time::Instant;

use check::{Check, FAMILY, judge};
use console::Console;
use report::{Checked, Report};

use crate::{Outcome, process, venv};

/// Independent renders of each check, in the quick form and in the full one.
const SEEDS: [usize; 2] = [16, 64];
const USAGE: &str = "usage: cargo xtask validate [--full] [--only GROUP OR NAME] [--console PROGRAM] [--jobs N] \
                     [--no-mitsuba] [--out FOLDER]";

struct Options {
    full: bool,
    only: Option<String>,
    console: Option<PathBuf>,
    jobs: usize,
    mitsuba: bool,
    out: PathBuf,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self {
            full: false,
            only: None,
            console: None,
            // A short render waits for its files to reach the disk for half of its time.
            jobs: 2 * std::thread::available_parallelism().map_or(1, usize::from),
            mitsuba: true,
            out: process::target_dir().join("validation"),
        };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(USAGE);
            match word.as_str() {
                "--full" => options.full = true,
                "--no-mitsuba" => options.mitsuba = false,
                "--only" => options.only = Some(value()?.to_lowercase()),
                "--console" => options.console = Some(value()?.into()),
                "--jobs" => options.jobs = value()?.parse().map_err(|_| USAGE)?,
                "--out" => options.out = value()?.into(),
                _ => return Err(USAGE.into()),
            }
        }
        Ok(Self { jobs: options.jobs.max(1), ..options })
    }

    fn wants(&self, check: &Check) -> bool {
        let is_named = self.only.as_ref().is_none_or(|only| {
            check.group.to_lowercase().contains(only) || check.name.to_lowercase().contains(only)
        });
        is_named && (self.full || !check.full_only) && (self.mitsuba || check.mitsuba.is_none())
    }
}

/// `cargo xtask validate`.
///
/// # Errors
/// What could not be run, or how many comparisons failed.
pub fn run(arguments: &[String]) -> Outcome {
    let options = Options::parse(arguments)?;
    let start = Instant::now();
    let all = [oracles::all(), agreement::all(), cross::all()].concat();
    let checks: Vec<Check> = all.into_iter().filter(|check| options.wants(check)).collect();
    if checks.is_empty() {
        return Err("no check has that name".into());
    }
    let console = Console::new(options.console.clone(), &options.out.join("scenes"), options.jobs)?;
    let seeds = SEEDS[usize::from(options.full)];
    if checks.iter().any(|check| check.mitsuba.is_some()) {
        // Before all that takes long: it may need a network.
        venv::for_validation()?;
    }
    let comparisons: usize = checks.iter().map(Check::comparisons).sum();
    println!("{} checks, {comparisons} comparisons, {seeds} renders each", checks.len());
    let mut renders = console.render(&checks, seeds)?;
    cross::render(&checks, &mut renders, &console.folder, seeds)?;
    let checked = checks.into_iter().zip(renders).map(|(check, renders)| {
        let verdicts = judge(&check, &renders, comparisons);
        Checked { check, renders, verdicts }
    });
    let report = Report {
        checked: checked.collect(),
        command: format!("cargo xtask validate {}", arguments.join(" ")),
        seconds: start.elapsed().as_secs_f64(),
        seeds,
        family: FAMILY,
        version: version(&console),
    };
    report.write(&options.out)?;
    report.say();
    if !options.mitsuba {
        println!("left out: the scenes beside Mitsuba (--no-mitsuba)");
    }
    match report.failures().count() {
        0 => Ok(()),
        count => Err(format!("{count} of {comparisons} comparisons failed")),
    }
}

fn version(console: &Console) -> String {
    let said = process::capture(std::process::Command::new(&console.program).arg("-version"));
    let commit = process::capture(&mut process::command("git", &["rev-parse", "--short", "HEAD"]));
    let text = |bytes: Result<Vec<u8>, String>| {
        bytes.map_or_else(|_| String::new(), |bytes| String::from_utf8_lossy(&bytes).trim().to_owned())
    };
    let said = text(said);
    format!("{}, commit {}", said.lines().next().unwrap_or("unknown version"), text(commit))
}

#[cfg(test)]
mod tests {
    use super::check::Renderer;
    use super::console::Picture;
    use super::*;

    #[test]
    fn every_check_has_a_name_of_its_own_and_expects_something() {
        let all = [oracles::all(), agreement::all(), cross::all()].concat();
        let mut slugs: Vec<String> = all.iter().map(Check::slug).collect();
        slugs.sort();
        slugs.dedup();
        assert_eq!(slugs.len(), all.len(), "two checks share their files");
        assert!(all.iter().all(|check| check.comparisons() > 0 && !check.renderers.is_empty()));
    }

    /// A picture of one value, noisy so that its mean is known to a hundredth of a percent.
    fn pictures(value: f64) -> Vec<Picture> {
        let noise = |seed: usize| 1.0 + 4e-4 * (f64::from(seed as u32 % 4) - 1.5);
        (0..16).map(|seed| Picture { size: [8, 8], pixels: vec![[value * noise(seed); 3]; 64] }).collect()
    }

    #[test]
    fn a_wrong_picture_fails_and_a_right_one_passes() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).is(2.0, 0.0).by(check::TECHNIQUES);
        let fails = |first: f64, second: f64| {
            let verdicts = judge(&check, &[pictures(first), pictures(second)], 300);
            verdicts.iter().filter(|verdict| verdict.failure.is_some()).count()
        };
        assert_eq!(fails(2.0, 2.0), 0);
        assert_eq!(fails(2.01, 2.0), 2, "the value, and the pictures beside each other");
        assert_eq!(fails(2.0, f64::NAN), 2);
    }

    #[test]
    fn noise_is_no_excuse() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).is(2.0, 0.0).by(check::PATH);
        let noisy = (0..16).map(|s| Picture { size: [1, 1], pixels: vec![[f64::from(s % 5); 3]] }).collect();
        let verdicts = judge(&check, &[noisy], 300);
        assert_eq!(verdicts[0].failure.as_deref(), Some("too noisy to tell"));
        assert_ne!(Renderer::Path.settings(), Renderer::Hybrid.settings());
    }
}
