//! Mitsuba 3 beside Indigo: scenes written in both formats by one description. Mitsuba comes from its wheel into an
//! environment of its own, and renders by its spectral variant.

pub mod scenes;
pub mod stage;

use std::path::Path;

use serde_json::json;

use super::check::{Check, Form, Quantity, Renderer, TECHNIQUES, Target};
use super::console::{self, Console, Rendered, Series};
use super::kept::{Keep, Stamp};
use super::picture::Picture;
use crate::{Outcome, process, venv};

const GROUP: &str = "Beside Mitsuba";
/// Samples per pixel of each render in the quick form, of both, in scenes of the least noise.
const SAMPLES: u32 = 32;
/// What must be seen in each part of a picture, in the quick form and in the full one.
const QUICK: f64 = 3e-2;
const FULL: f64 = 5e-3;
/// Means of the parts of a picture must agree within this share, beyond noise: what single precision and the digits of the
/// observers' tables may make in two programs.
const AGREEMENT: f64 = 2e-4;
/// Where it writes which it is.
const VERSION: &str = "mitsuba-version.txt";
/// The script that renders with Mitsuba.
const SCRIPT: &str = include_str!("mitsuba.py");

/// All of them.
pub fn all() -> Vec<Check> {
    scenes::all().iter().map(check).collect()
}

fn check(entry: &scenes::Entry) -> Check {
    let mut check = Check::new(GROUP, entry.name, entry.about, entry.stage.text());
    check.files = entry.stage.files();
    check.mitsuba = Some(entry.stage.dictionary());
    let samples = SAMPLES * entry.effort;
    check = check.unit(stage::UNIT).effort(samples, QUICK).in_full(samples * entry.fine, FULL);
    check.renderers = [&[Renderer::Mitsuba], TECHNIQUES].concat();
    let side = stage::SIDE as usize;
    let half = side / 2;
    let areas = [
        ("picture", [0, side, 0, side]),
        ("upper left", [0, half, 0, half]),
        ("upper right", [half, side, 0, half]),
        ("lower left", [0, half, half, side]),
        ("lower right", [half, side, half, side]),
        ("middle", [side / 3, 2 * side / 3, side / 3, 2 * side / 3]),
    ];
    for (name, area) in areas {
        check = check.row(name, Quantity::Y, Some(area), Target::First(AGREEMENT.max(entry.slack)));
    }
    if entry.is_coloured {
        check = check.row("X / Y", Quantity::XOverY, None, Target::First(AGREEMENT));
        check = check.row("Z / Y", Quantity::ZOverY, None, Target::First(AGREEMENT));
    }
    check
}

/// Renders with Mitsuba what the checks want of it, into the places that it has there. What it could not render is a failure
/// of those checks.
///
/// # Errors
/// What could not be installed or started.
pub fn render(checks: &[Check], renders: &mut [Rendered], console: &Console, form: Form) -> Outcome {
    let folder = &console.folder;
    let wanted: Vec<(usize, &Check)> =
        checks.iter().enumerate().filter(|(_, c)| c.mitsuba.is_some()).collect();
    if wanted.is_empty() {
        return Ok(());
    }
    let path = |check: &Check| folder.join(format!("{}.xyz", check.slug()));
    let mut jobs = vec![];
    for (_, check) in &wanted {
        let job = json!({"name": check.name, "scene": check.mitsuba, "samples": form.demand(check).samples,
                         "seeds": form.seeds(), "first_seed": first_seed(check), "out": path(check)});
        let stamp = Stamp::of([SCRIPT.as_bytes(), job.to_string().as_bytes()]);
        let mark = path(check).with_extension("stamp");
        if !(console.keep == Keep::Resume && stamp.is_in(&mark)) {
            drop(std::fs::remove_file(path(check)));
            stamp.write(&mark)?;
        }
        if !path(check).exists() {
            jobs.push(job);
        }
    }
    let end = if jobs.is_empty() { Ok(()) } else { run_script(&jobs, folder) };
    for (i, check) in wanted {
        let own = read(&path(check), stage::SIDE as usize, form.seeds());
        let own = own.map_err(|error| end.clone().err().unwrap_or(error));
        renders[i] = own.and_then(|own| {
            let mut all = renders[i].clone()?;
            all[0] = own;
            Ok(all)
        });
    }
    Ok(())
}

fn run_script(jobs: &[serde_json::Value], folder: &Path) -> Outcome {
    let write = |name: &str, text: String| {
        let path = folder.join(name);
        std::fs::write(&path, text)
            .map(|()| path.clone())
            .map_err(|error| format!("{}: {error}", path.display()))
    };
    let script = write("render.py", SCRIPT.to_owned())?;
    let list = write("mitsuba.json", serde_json::Value::from(jobs).to_string())?;
    let python = venv::for_validation()?;
    process::run(std::process::Command::new(python).arg(script).arg(list).arg(folder.join(VERSION)))
}

/// Which Mitsuba rendered what lies in a folder, if any did.
pub fn version(folder: &Path) -> Option<String> {
    std::fs::read_to_string(folder.join(VERSION)).ok()
}

/// Mitsuba's first of a check, of 32 bits.
fn first_seed(check: &Check) -> u32 {
    (console::seed(check, Renderer::Mitsuba, 0) % (1 << 31)) as u32
}

/// Seconds, and pictures of X, Y and Z of each pixel in units of the luminance of even radiance: all 32-bit numbers.
fn read(path: &Path, side: usize, seeds: usize) -> Result<Series, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (numbers, _) = bytes.as_chunks::<4>();
    let mut numbers = numbers.iter().map(|b| f64::from(f32::from_le_bytes(*b)));
    let seconds = numbers.next().unwrap_or(0.0);
    let values: Vec<f64> = numbers.map(|v| v * stage::UNIT).collect();
    let (pixels, _) = values.as_chunks::<3>();
    let pictures = pixels.chunks_exact(side * side);
    if pictures.len() != seeds {
        return Err(format!("{}: {} pictures, expected {seeds}", path.display(), pictures.len()));
    }
    let pictures = pictures.map(|pixels| Picture { size: [side; 2], pixels: pixels.to_vec() }).collect();
    Ok(Series { pictures, wrong_codes: 0, seconds })
}
