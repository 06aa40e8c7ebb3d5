//! Every scene that the repository ships is one to learn from: it loads without an error or a warning.

use indigo_diag::{Style, to_text};
use indigo_render::disk::DiskResolver;
use indigo_scene::{LoadOptions, load};
use std::path::{Path, PathBuf};

/// The scenes of `testscenes`, without the parts that are only there to be included.
fn shipped_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testscenes");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|e| e == "igs"));
    let mut whole: Vec<PathBuf> =
        scenes.filter(|path| !std::fs::read_to_string(path).unwrap().contains("<scenedata>")).collect();
    whole.sort();
    whole
}

/// What loading a scene has to say about it.
fn complaints(path: &Path) -> Vec<String> {
    let resolver = DiskResolver::new(vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")]);
    let options = LoadOptions::new(&resolver);
    let loaded = load(&path.to_string_lossy(), &options);
    assert!(loaded.scene.is_some() || loaded.sink.has_errors(), "no scene, and nothing said why");
    loaded.sink.diagnostics().iter().map(|d| to_text(d, &loaded.sources, Style::Plain)).collect()
}

#[test]
fn shipped_scenes_load_without_a_word() {
    let scenes = shipped_scenes();
    assert!(scenes.len() >= 8, "the scenes are gone: {scenes:?}");
    let complaints: Vec<String> = scenes.iter().flat_map(|path| complaints(path)).collect();
    assert!(complaints.is_empty(), "{}", complaints.concat());
}
