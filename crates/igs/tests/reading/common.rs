//! Files in memory, and reading them.

use indigo_decl::{Element, ResolveError, Resolved, Resolver};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_scene};
use std::collections::HashMap;

/// Files by name; paths are names.
#[derive(Default)]
pub struct Files(HashMap<String, Vec<u8>>);

impl Files {
    pub fn new<const N: usize>(files: [(&str, &str); N]) -> Self {
        Self(files.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())).into_iter().collect())
    }

    pub fn scene(bytes: &[u8]) -> Self {
        Self([("scene.igs".to_owned(), bytes.to_vec())].into_iter().collect())
    }
}

impl Resolver for Files {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        match self.0.get(path) {
            Some(bytes) => Ok(Resolved { path: path.to_owned(), bytes: bytes.as_slice().into() }),
            None => Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        }
    }
}

/// What came of reading a scene.
pub struct Read {
    pub root: Option<Element>,
    pub sink: Sink,
    pub sources: SourceMap,
}

impl Read {
    pub fn of(files: &Files, limits: &Limits) -> Self {
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        let root = read_scene("scene.igs", files, &mut sources, &mut sink, limits);
        Self { root, sink, sources }
    }

    pub fn text(text: &str) -> Self {
        Self::of(&Files::scene(text.as_bytes()), &Limits::default())
    }

    /// Code and position of each diagnostic: `E0004 2:5`.
    pub fn findings(&self) -> Vec<String> {
        let place = |span| {
            let p = self.sources.position(span);
            format!(" {}:{}", p.line, p.column)
        };
        self.sink
            .diagnostics()
            .iter()
            .map(|d| format!("{}{}", d.code, d.span.map_or(String::new(), place)))
            .collect()
    }

    pub fn root(&self) -> &Element {
        self.root.as_ref().expect("a root")
    }
}
