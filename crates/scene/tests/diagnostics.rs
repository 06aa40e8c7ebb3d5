//! Whole rendered messages: each `tests/diagnostics/NAME.igs` against `NAME.stderr` beside it.
//!
//! `INDIGO_BLESS=1 cargo test -p indigo-scene --test diagnostics` writes the expected messages anew;
//! look at the difference before you commit it.

use indigo_decl::{ResolveError, Resolved, Resolver, bind};
use indigo_diag::{Sink, SourceMap, Style, to_text};
use indigo_igs::{Limits, read_scene};
use indigo_scene::schema::SCENE;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/diagnostics")
}

/// Files of the folder, by their names within it.
struct Folder;

impl Resolver for Folder {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let beside = from.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
        let name = format!("{beside}{path}");
        match std::fs::read(folder().join(&name)) {
            Ok(bytes) => Ok(Resolved { path: name, bytes: bytes.into() }),
            Err(_) => Err(ResolveError::NotFound { looked: vec![name] }),
        }
    }
}

fn messages(name: &str) -> String {
    let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
    if let Some(root) = read_scene(name, &Folder, &mut sources, &mut sink, &Limits::default()) {
        bind(root, &SCENE, &mut sink);
    }
    sink.diagnostics().iter().map(|d| to_text(d, &sources, Style::Plain)).collect()
}

#[test]
fn messages_are_as_expected() {
    let bless = std::env::var_os("INDIGO_BLESS").is_some();
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .expect("the folder of fixtures")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("a plain name"))
        .filter(|name| Path::new(name).extension().is_some_and(|e| e == "igs"))
        .collect();
    names.sort();
    assert!(names.len() >= 30, "{} fixtures", names.len());
    let mut wrong = vec![];
    for name in &names {
        let found = messages(name);
        let expected_path = folder().join(name).with_extension("stderr");
        if bless {
            std::fs::write(&expected_path, &found).expect("a writable folder");
        }
        let expected = std::fs::read_to_string(&expected_path).unwrap_or_default();
        if found != expected {
            wrong.push(format!("== {name}\n-- expected\n{expected}-- found\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
