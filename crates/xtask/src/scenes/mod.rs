//! `cargo xtask scenes`: test scenes too big to commit, made from nothing and the same every time.

mod igs;
mod instances;
mod moon;
mod noise;
mod ply;
mod sphere;
mod vector;

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::{Outcome, process};

/// Where they are written; git ignores it.
const FOLDER: &str = "testscenes/generated";

/// A file that a scene consists of, and what writes it.
type Part = (&'static str, fn(&mut dyn Write) -> io::Result<()>);

struct Scene {
    name: &'static str,
    about: &'static str,
    parts: &'static [Part],
}

const SCENES: &[Scene] = &[
    Scene {
        name: "million",
        about: "a cratered moon of a million triangles in a binary PLY file",
        parts: &[("million.igs", moon::write_external_scene), ("million.ply", moon::write_ply)],
    },
    Scene {
        name: "embedded",
        about: "the same moon as text inside the scene file",
        parts: &[("embedded.igs", moon::write_embedded_scene)],
    },
    Scene {
        name: "instances",
        about: "15,000 models of two meshes in the spirals of a sunflower",
        parts: &[("instances.igs", instances::write_scene)],
    },
];

/// Writes one scene, or `all`.
pub fn run(arguments: &[String]) -> Outcome {
    let [wanted] = arguments else { return Err(usage()) };
    let chosen: Vec<&Scene> = SCENES.iter().filter(|scene| wanted == "all" || wanted == scene.name).collect();
    if chosen.is_empty() {
        return Err(usage());
    }
    let folder = process::root().join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, write) in chosen.into_iter().flat_map(|scene| scene.parts) {
        let path = folder.join(name);
        let size = write_file(&path, *write).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{FOLDER}/{name}: {size} bytes");
    }
    Ok(())
}

fn usage() -> String {
    let list = SCENES.iter().map(|scene| format!("\n  {:<10} {}", scene.name, scene.about));
    format!("usage: cargo xtask scenes SCENE or all{}", list.collect::<String>())
}

fn write_file(path: &Path, write: fn(&mut dyn Write) -> io::Result<()>) -> io::Result<u64> {
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.flush()?;
    Ok(path.metadata()?.len())
}
