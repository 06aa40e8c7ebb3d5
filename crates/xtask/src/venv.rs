//! A Python environment under the build folder, for tests that let other programs judge our files.

use std::path::{Path, PathBuf};

use crate::process::{self, command};

/// Where tests find the Python that has the packages of [`for_tests`].
pub const TEST_PYTHON: &str = "INDIGO_TEST_PYTHON";

/// What the tests import. OpenEXR, the reference implementation, reads back our EXR files; colour-science works
/// out how colours are shown. pyoidn brings Open Image Denoise itself, for the processors that it is built for. Pinned: a new version may change what a test sees only by a commit here.
const TEST_PACKAGES: &[&str] = &[
    "OpenEXR==3.4.4",
    "numpy==2.3.5",
    "colour-science==0.4.7",
    "pyoidn==2.5.1.0; sys_platform == 'linux' and platform_machine == 'x86_64'",
];

/// What `cargo xtask validate` renders with beside Indigo.
const OTHER_RENDERERS: &[&str] = &["mitsuba==3.9.1", "numpy==2.3.5"];

/// What `cargo xtask bench rays` races; speeds are compared with those of this version.
const OTHER_KERNELS: &[&str] = &["embreex==4.4.0.post1"];

/// The environment of other renderers, made on first use; gives its Python.
pub fn for_validation() -> Result<PathBuf, String> {
    ensure("mitsuba", OTHER_RENDERERS).map(|folder| python_of(&folder))
}

/// The environment of other ray kernels, made on first use; gives its folder.
pub fn for_rays() -> Result<PathBuf, String> {
    ensure("embree", OTHER_KERNELS)
}

/// The environment of the tests, made on first use; gives its Python.
pub fn for_tests() -> Result<PathBuf, String> {
    ensure("venv", TEST_PACKAGES).map(|folder| python_of(&folder))
}

fn python_of(folder: &Path) -> PathBuf {
    folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// An environment `name` under the build folder with these packages; gives its folder.
///
/// A file in it records what is installed, so that a second call does nothing.
fn ensure(name: &str, packages: &[&str]) -> Result<PathBuf, String> {
    let folder = process::target_dir().join(name);
    let python = python_of(&folder);
    let record = folder.join("installed.txt");
    let wanted = packages.join("\n");
    if python.exists() && std::fs::read_to_string(&record).is_ok_and(|installed| installed == wanted) {
        return Ok(folder);
    }
    let system = if cfg!(windows) { "python" } else { "python3" };
    process::run(command(system, &["-m", "venv"]).arg(&folder))
        .map_err(|error| format!("{error} (on Debian and Ubuntu: apt-get install python3-venv)"))?;
    let quiet = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    process::run(command(&python, &quiet).args(packages))?;
    std::fs::write(&record, wanted).map_err(|error| format!("{}: {error}", record.display()))?;
    Ok(folder)
}
