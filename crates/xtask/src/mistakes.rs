//! `cargo xtask mistakes`: makes mistakes in a copy of the renderer, each of a kind that pictures hide well, and sees whether
//! `cargo xtask validate` tells.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use xtask::{Outcome, process};

use crate::validate::change::changed;
use crate::validate::quick_threshold;

/// Something wrong to be put into one file of the renderer.
struct Mistake {
    about: &'static str,
    file: &'static str,
    part: &'static str,
    by: &'static str,
    /// The checks of the quick form that are rendered with it: `--only`.
    only: &'static str,
}

const SHADING: &str = "crates/scatter/src/shading.rs";

const MISTAKES: &[Mistake] = &[
    Mistake {
        about: "the cosine of the light is missing where a BSDF is evaluated",
        file: SHADING,
        part: "self.leaf.f(seen_o, l, crossing) * (l.z * sign * density)",
        by: "self.leaf.f(seen_o, l, crossing) * density",
        only: "diffuse",
    },
    Mistake {
        about: "the density of scattering is 1.05 times what it is",
        file: SHADING,
        part: "self.leaf.pdf(seen_o, l, crossing) * density",
        by: "self.leaf.pdf(seen_o, l, crossing) * (1.05 * density)",
        only: "diffuse",
    },
    Mistake {
        about: "the density of the way back, which weights of bidirectional path tracing use, is 1.25 times what it is",
        file: SHADING,
        part: "self.leaf.pdf(seen_i, l, crossing.reversed()) * density",
        by: "self.leaf.pdf(seen_i, l, crossing.reversed()) * (1.25 * density)",
        only: "coloured box",
    },
    Mistake {
        about: "light from lamps keeps the cosines of shading normals: Veach's adjoint is dropped",
        file: SHADING,
        part: "if light == 0.0 { 0.0 } else { wi.dot(self.n_g).abs() / light }",
        by: "if light == 0.0 { 0.0 } else { 1.0 }",
        only: "bump maps",
    },
];

/// `cargo xtask mistakes`.
///
/// # Errors
/// What could not be built, a mistake that was not told, or a check that fails without one.
pub fn run(arguments: &[String]) -> Outcome {
    if !arguments.is_empty() {
        return Err("usage: cargo xtask mistakes".into());
    }
    let bench = Bench::new()?;
    let sound = bench.build("sound")?;
    let mut unseen = vec![];
    for (number, mistake) in MISTAKES.iter().enumerate() {
        let before = bench.validate(&sound, mistake.only, &format!("{number}-sound"))?;
        let wrong = bench.with(mistake)?;
        let after = bench.validate(&wrong, mistake.only, &format!("{number}-wrong"))?;
        println!(
            "{}: {} of {} comparisons deviate (--only {:?}); {} without it",
            mistake.about, after.deviating, after.all, mistake.only, before.deviating
        );
        if after.deviating == 0 || before.deviating > 0 {
            unseen.push(mistake.about);
        }
    }
    if unseen.is_empty() {
        Ok(())
    } else {
        Err(format!("not told apart from a sound renderer: {}", unseen.join("; ")))
    }
}

/// A copy of the working tree, in which mistakes are made and built.
struct Bench {
    folder: PathBuf,
    /// The p-value below which the quick form of all checks tells a deviation: fewer have a looser threshold.
    threshold: f64,
}

/// How many comparisons of a report there were, and failed because they deviate.
struct Said {
    all: u64,
    deviating: usize,
}

impl Bench {
    fn new() -> Result<Self, String> {
        let folder = process::target_dir().join("mistakes");
        let bench = Self { folder, threshold: quick_threshold() };
        let listed = process::capture(&mut process::command("git", &["ls-files", "-z"]))?;
        for name in String::from_utf8_lossy(&listed).split('\0').filter(|name| !name.is_empty()) {
            bench.put(name, &read(&process::root().join(name))?)?;
        }
        Ok(bench)
    }

    fn tree(&self) -> PathBuf {
        self.folder.join("tree")
    }

    /// Writes a file of the tree unless it is so already: cargo goes by the time of writing.
    fn put(&self, name: &str, bytes: &[u8]) -> Outcome {
        let path = self.tree().join(name);
        if std::fs::read(&path).is_ok_and(|now| now == bytes) {
            return Ok(());
        }
        let written =
            path.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::write(&path, bytes));
        written.map_err(|error| format!("{}: {error}", path.display()))
    }

    /// A console of the tree as it is, by its own name: the next build would take its place.
    fn build(&self, name: &str) -> Result<PathBuf, String> {
        let target = self.folder.join("build");
        let mut cargo = process::cargo(&["build", "--release", "--workspace", "--bin", "indigo_console"]);
        process::run(cargo.current_dir(self.tree()).env("CARGO_TARGET_DIR", &target))?;
        let built = target.join("release").join(format!("indigo_console{}", std::env::consts::EXE_SUFFIX));
        let kept = self.folder.join(name);
        std::fs::copy(&built, &kept).map_err(|error| format!("{}: {error}", kept.display()))?;
        Ok(kept)
    }

    /// A console with a mistake; the tree is sound again after that.
    fn with(&self, mistake: &Mistake) -> Result<PathBuf, String> {
        let sound = read(&process::root().join(mistake.file))?;
        let wrong = changed(&String::from_utf8_lossy(&sound), mistake.part, mistake.by);
        self.put(mistake.file, wrong.as_bytes())?;
        let built = self.build("wrong");
        self.put(mistake.file, &sound)?;
        built
    }

    /// What the quick form says of a console.
    fn validate(&self, console: &Path, only: &str, name: &str) -> Result<Said, String> {
        let out = self.folder.join(name);
        let this = std::env::current_exe().map_err(|error| format!("this program: {error}"))?;
        let mut command = Command::new(this);
        command
            .args(["validate", "--no-mitsuba", "--only", only, "--console"])
            .arg(console)
            .arg("--out")
            .arg(&out);
        let path = out.join("report.json");
        // That of an earlier run would be taken for this one's.
        drop(std::fs::remove_file(&path));
        // It fails where there is a mistake; the report says why.
        command.current_dir(process::root()).env("INDIGO_RESOURCES", process::root());
        command.status().map_err(|error| format!("validate: {error}"))?;
        let report: Value =
            serde_json::from_slice(&read(&path)?).map_err(|error| format!("{}: {error}", path.display()))?;
        let verdicts = report["checks"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|check| check["verdicts"].as_array())
            .flatten();
        Ok(Said {
            all: report["comparisons"].as_u64().unwrap_or_default(),
            deviating: verdicts.filter(|verdict| self.tells(verdict)).count(),
        })
    }

    /// Whether the quick form of all checks would tell a comparison that deviates.
    fn tells(&self, verdict: &Value) -> bool {
        verdict["failure"] == "deviates" && verdict["p"].as_f64().is_some_and(|p| p < self.threshold)
    }
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mistakes are made of what the renderer says today.
    #[test]
    fn each_mistake_changes_its_file() {
        for mistake in MISTAKES {
            let text =
                std::fs::read_to_string(process::root().join(mistake.file)).expect("a file of the renderer");
            assert_ne!(changed(&text, mistake.part, mistake.by), text, "{}", mistake.about);
        }
    }
}
