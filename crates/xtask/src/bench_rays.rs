//! `cargo xtask bench rays`: races the ray kernel against Embree 4.
//!
//! Embree comes from the Python wheel `embreex`, installed into an environment of its own under the build folder; nothing of it is
//! linked or shipped.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Outcome, process, venv};

/// Runs the race; `args` go to the benchmark (`--check` makes a missed target an error).
///
/// # Errors
/// What could not be installed, found or run, or that the benchmark failed.
pub fn run(args: &[String]) -> Outcome {
    process::run(command()?.args(args))
}

/// The benchmark, to which arguments may be added; Embree is installed first.
///
/// # Errors
/// What could not be installed or found.
pub fn command() -> Result<Command, String> {
    let environment = venv::for_rays()?;
    let libraries = find_libraries(&environment).ok_or("the wheel embreex holds no Embree library")?;
    let mut command = process::cargo(&["bench", "--package", "indigo-geom", "--bench", "rays", "--"]);
    command.env("INDIGO_EMBREE_DIR", libraries);
    Ok(command)
}

/// The folder inside the environment that holds Embree's shared library.
fn find_libraries(folder: &Path) -> Option<PathBuf> {
    let entries: Vec<PathBuf> = fs::read_dir(folder).ok()?.filter_map(|e| Some(e.ok()?.path())).collect();
    let is_embree = |p: &PathBuf| p.file_name().is_some_and(|n| n.to_string_lossy().contains("embree4"));
    if entries.iter().any(|p| p.is_file() && is_embree(p)) {
        return Some(folder.to_path_buf());
    }
    entries.iter().filter(|p| p.is_dir() && !p.is_symlink()).find_map(|p| find_libraries(p))
}
