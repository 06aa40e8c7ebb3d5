//! What a scene needs.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_scene::{LoadOptions, load_needs};
use std::collections::BTreeMap;

/// Files in memory, by their names alone.
struct Memory(BTreeMap<&'static str, &'static str>);

impl Resolver for Memory {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        match self.0.get(path) {
            Some(text) => Ok(Resolved { path: path.to_owned(), bytes: text.as_bytes().into() }),
            None => Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        }
    }
}

#[test]
fn every_file_is_named_once_and_what_is_missing_has_a_place() {
    let metal =
        "<material><name>NAME</name><phong><nk_data>PATH</nk_data><exponent>9</exponent></phong></material>";
    let metal = |name: &str, path: &str| metal.replace("NAME", name).replace("PATH", path);
    let scene = [
        "<scene><include><pathname>parts.igs</pathname></include>",
        "<include><pathname>gone.igs</pathname></include>",
        &metal("a", "au.nk"),
        &metal("b", "au.nk"),
        &metal("c", "lost.nk"),
        "</scene>",
    ];
    let scene: &'static str = scene.join("\n").leak();
    let parts: &'static str = format!("<scenedata>{}</scenedata>", metal("d", "ag.nk")).leak();
    let files = [("scene.igs", scene), ("parts.igs", parts), ("au.nk", "gold"), ("ag.nk", "silver!")];
    let memory = Memory(BTreeMap::from(files));
    let loaded = load_needs("scene.igs", &LoadOptions::new(&memory));
    let mut told: Vec<_> = loaded
        .needs
        .iter()
        .map(|n| (n.path.as_str(), n.bytes.as_ref().ok().copied(), n.named_in.as_str()))
        .collect();
    told.sort_unstable();
    assert_eq!(
        told,
        [
            ("ag.nk", Some(7), "parts.igs:1:52"),
            ("au.nk", Some(4), "scene.igs:3:41"),
            ("gone.igs", None, "scene.igs:2:20"),
            ("lost.nk", None, "scene.igs:5:41"),
            ("parts.igs", Some(parts.len() as u64), "scene.igs:1:27"),
            ("scene.igs", Some(scene.len() as u64), ""),
        ]
    );
}

#[test]
fn a_scene_that_is_not_there_is_its_own_need() {
    let loaded = load_needs("scene.igs", &LoadOptions::new(&Memory(BTreeMap::new())));
    let [scene] = &loaded.needs[..] else { panic!("{:?}", loaded.needs) };
    assert!(scene.path == "scene.igs" && scene.bytes.is_err() && loaded.sink.has_errors());
}
