//! Mitsuba 3 beside Indigo: scenes written in both formats by one description. Mitsuba comes from its wheel into an
//! environment of its own, and renders by its spectral variant.

pub mod scenes;
pub mod stage;

use std::path::Path;

use serde_json::json;

use super::check::{Check, PATH, Quantity, Renderer, TECHNIQUES, Target};
use super::console::{self, Picture};
use crate::{Outcome, process, venv};

const GROUP: &str = "Beside Mitsuba";
/// Samples per pixel of each render, of both.
const SAMPLES: u32 = 128;
/// Means of the parts of a picture must agree within this share, beyond noise: what single precision and the digits of the
/// observers' tables may make in two programs.
const AGREEMENT: f64 = 2e-4;
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
    check = check.unit(stage::UNIT).effort(SAMPLES * entry.effort, 3e-2);
    let techniques = if entry.stage.map.is_some() { PATH } else { TECHNIQUES };
    check.renderers = [&[Renderer::Mitsuba], techniques].concat();
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

/// Renders with Mitsuba what the checks want of it, into the places that it has there.
///
/// # Errors
/// What could not be installed or run.
pub fn render(checks: &[Check], renders: &mut [Vec<Vec<Picture>>], folder: &Path, seeds: usize) -> Outcome {
    let wanted: Vec<(usize, &Check)> =
        checks.iter().enumerate().filter(|(_, c)| c.mitsuba.is_some()).collect();
    if wanted.is_empty() {
        return Ok(());
    }
    let path = |check: &Check| folder.join(format!("{}.xyz", check.slug()));
    let jobs: Vec<serde_json::Value> = wanted
        .iter()
        .map(|(_, check)| {
            json!({"name": check.name, "scene": check.mitsuba, "samples": check.samples, "seeds": seeds,
                   "first_seed": first_seed(check), "out": path(check)})
        })
        .collect();
    let write = |name: &str, text: String| {
        let path = folder.join(name);
        std::fs::write(&path, text)
            .map(|()| path.clone())
            .map_err(|error| format!("{}: {error}", path.display()))
    };
    let script = write("render.py", SCRIPT.to_owned())?;
    let list = write("mitsuba.json", serde_json::Value::from(jobs).to_string())?;
    let python = venv::for_validation()?;
    process::run(std::process::Command::new(python).arg(script).arg(list))?;
    for (i, check) in wanted {
        renders[i][0] = read(&path(check), stage::SIDE as usize)?;
    }
    Ok(())
}

/// Mitsuba's first of a check, of 32 bits.
fn first_seed(check: &Check) -> u32 {
    (console::seed(check, Renderer::Mitsuba, 0) % (1 << 31)) as u32
}

/// Pictures of 32-bit numbers, X, Y and Z of each pixel in units of the luminance of even radiance.
fn read(path: &Path, side: usize) -> Result<Vec<Picture>, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (numbers, _) = bytes.as_chunks::<4>();
    let values: Vec<f64> = numbers.iter().map(|b| f64::from(f32::from_le_bytes(*b)) * stage::UNIT).collect();
    let (pixels, _) = values.as_chunks::<3>();
    let pictures = pixels.chunks_exact(side * side);
    Ok(pictures.map(|pixels| Picture { size: [side; 2], pixels: pixels.to_vec() }).collect())
}
