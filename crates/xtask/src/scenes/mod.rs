//! `cargo xtask scenes`: test scenes too big to commit, made from nothing and the same every time.

mod contact_sheet;
pub mod glassware;
mod hand;
mod igs;
mod instances;
mod isosurface;
mod lampshade;
mod lathe;
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
    Scene {
        name: "wineglass",
        about: "red wine in a glass of 51,000 triangles, the same with explicit interfaces, and the glass empty",
        parts: &[
            ("wineglass.igs", |out| fill(WINE_GLASS, glassware::write_wine_glass, out)),
            ("wineglass_explicit.igs", |out| {
                // Where the wine ends it is the glass that is displaced, by nothing but what closes it.
                let scene = WINE_GLASS.replace("<precedence>10<", "<precedence>30<");
                fill(&scene, glassware::write_explicit_wine_glass, out)
            }),
            ("wineglass_empty.igs", |out| fill(WINE_GLASS, glassware::write_empty_glass, out)),
        ],
    },
    Scene {
        name: "drinks",
        about: "milk, beer and red wine in three small glasses",
        parts: &[("drinks.igs", |out| fill(DRINKS, glassware::write_drinks, out))],
    },
    Scene {
        name: "skin",
        about: "hands of epidermis over dermis, with little, some and much melanin",
        parts: &[("skin.igs", |out| fill(SKIN, hand::write_hands, out))],
    },
    Scene {
        name: "lampshade",
        about: "a lamp under a shade of cloth",
        parts: &[("lampshade.igs", |out| fill(LAMPSHADE, lampshade::write_meshes, out))],
    },
    Scene {
        name: "libraries",
        about: "contact sheets: a ball of each metal of nkdata, and of each medium of media",
        parts: &[
            ("metals.igs", |out| fill(METALS, contact_sheet::write_metals, out)),
            ("media.igs", |out| fill(MEDIA, contact_sheet::write_media, out)),
        ],
    },
];

const WINE_GLASS: &str = include_str!("../../data/scenes/wineglass.igs");
const DRINKS: &str = include_str!("../../data/scenes/drinks.igs");
const SKIN: &str = include_str!("../../data/scenes/skin.igs");
const LAMPSHADE: &str = include_str!("../../data/scenes/lampshade.igs");
const METALS: &str = include_str!("../../data/scenes/metals.igs");
const MEDIA: &str = include_str!("../../data/scenes/media.igs");

/// A scene whose last line but the closing tag are the elements that `write` makes.
fn fill(template: &str, write: fn(&mut dyn Write) -> io::Result<()>, out: &mut dyn Write) -> io::Result<()> {
    let head = template.trim_end().strip_suffix("</scene>").ok_or(io::ErrorKind::InvalidData)?;
    out.write_all(head.as_bytes())?;
    write(out)?;
    igs::write_tail(out)
}

/// Writes one scene, or `all`.
///
/// # Errors
/// For a name that is not in the list, and where a file cannot be written.
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
