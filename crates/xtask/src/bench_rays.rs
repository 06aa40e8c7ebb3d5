//! `cargo xtask bench rays`: races the ray kernel against Embree 4.
//!
//! Embree comes from the Python wheel `embreex`, installed into an environment of its own under
//! `target/`; nothing of it is linked or shipped.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs the race; `args` go to the benchmark (`--check` makes a missed target an error).
///
/// # Errors
/// What could not be installed, found or run, or that the benchmark failed.
pub fn run(args: &[String]) -> Result<(), String> {
    run_to_end(command()?.args(args))
}

/// The benchmark, to which arguments may be added; Embree is installed first.
///
/// # Errors
/// What could not be installed or found.
pub fn command() -> Result<Command, String> {
    let environment = Path::new("target").join("embree");
    let libraries = match find_libraries(&environment) {
        Some(found) => found,
        None => {
            install(&environment)?;
            find_libraries(&environment).ok_or("the wheel embreex holds no Embree library")?
        }
    };
    let libraries = fs::canonicalize(&libraries).map_err(|e| format!("{}: {e}", libraries.display()))?;
    let cargo = env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["bench", "--package", "indigo-geom", "--bench", "rays", "--"]);
    command.env("INDIGO_EMBREE_DIR", libraries);
    Ok(command)
}

/// Speeds are compared with those of this version.
const EMBREE: &str = "embreex==4.4.0.post1";

fn install(environment: &Path) -> Result<(), String> {
    let python = if cfg!(windows) { "python" } else { "python3" };
    run_to_end(Command::new(python).args(["-m", "venv"]).arg(environment))?;
    let scripts = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    run_to_end(Command::new(scripts.join(python)).args(["-m", "pip", "install", "--quiet", EMBREE]))
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

fn run_to_end(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|e| format!("{command:?}: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{command:?}: {status}")) }
}
