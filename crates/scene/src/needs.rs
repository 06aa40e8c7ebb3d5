//! What a scene needs: every file that it names, and whether it is there.

use crate::load::{LoadOptions, read_and_bind};
use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::{Sink, SourceId, SourceMap, Span};
use std::collections::{BTreeSet, HashSet};
use std::sync::{Mutex, PoisonError};

/// The files that a scene names, in itself and in what it includes.
pub struct LoadedNeeds {
    /// Scene files first, then the others in the order in which they are named; each once.
    pub needs: Vec<Need>,
    /// All scene files that were read.
    pub sources: SourceMap,
    /// What is wrong with the text of the scene. What is missing apart from included files is told by `needs` alone.
    pub sink: Sink,
}

/// A file that a scene names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// Where it was found, or else its path as it is written.
    pub path: String,
    /// Its size, or why it cannot be had.
    pub bytes: Result<u64, ResolveError>,
    /// What names it first: a place in a file as `file:line:column`; empty for the scene itself.
    pub named_in: String,
}

/// Finds out which files a scene names, whether or not it has errors elsewhere. The settings file is not one of them.
pub fn load_needs(path: &str, options: &LoadOptions) -> LoadedNeeds {
    let mut sources = SourceMap::default();
    let mut sink = Sink::new();
    let recorder = Recorder { inner: options.resolver, read: Mutex::default() };
    let recorded = LoadOptions { resolver: &recorder, inifile: None, ..*options };
    let bound = read_and_bind(path, &recorded, &mut sources, &mut sink);
    let documents = recorder.read.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut list = List::default();
    for (written, need) in documents {
        let place = place_of(&written, &need.named_in, &sources);
        list.add(Need { named_in: place.unwrap_or(need.named_in), ..need });
    }
    let mut asked = HashSet::new();
    if let Some(bound) = bound {
        bound.root.visit_paths(&mut |written, span| {
            // Not read again for each of the many materials that may use it.
            if asked.insert((written.to_owned(), span.source)) {
                let found = options.resolver.read(written, sources.name(span.source));
                list.add(need(written, place(span, &sources), found));
            }
        });
    }
    LoadedNeeds { needs: list.needs, sources, sink }
}

fn need(written: &str, named_in: String, found: Result<Resolved, ResolveError>) -> Need {
    match found {
        Ok(file) => Need { path: file.path, bytes: Ok(file.bytes.len() as u64), named_in },
        Err(error) => Need { path: written.to_owned(), bytes: Err(error), named_in },
    }
}

fn place(span: Span, sources: &SourceMap) -> String {
    let p = sources.position(span);
    format!("{}:{}:{}", sources.name(span.source), p.line, p.column)
}

/// Where a scene file names another one that it includes.
fn place_of(written: &str, file: &str, sources: &SourceMap) -> Option<String> {
    let mut all = (0..sources.len()).filter_map(|n| u16::try_from(n).ok()).map(SourceId);
    let source = all.find(|id| sources.name(*id) == file)?;
    let text = sources.text(source);
    let start = text.windows(written.len().max(1)).position(|part| part == written.as_bytes())?;
    Some(place(Span::new(source, start, start + written.len()), sources))
}

/// Files, each once: what is missing under one name may be missing from two folders, and is looked for in both.
#[derive(Default)]
struct List {
    needs: Vec<Need>,
    known: BTreeSet<(String, Option<Vec<String>>)>,
}

impl List {
    fn add(&mut self, need: Need) {
        let looked = match &need.bytes {
            Err(ResolveError::NotFound { looked }) => Some(looked.clone()),
            _ => None,
        };
        if self.known.insert((need.path.clone(), looked)) {
            self.needs.push(need);
        }
    }
}

/// Hands files on and keeps what became of each.
struct Recorder<'a> {
    inner: &'a dyn Resolver,
    /// Each with its path as it is written.
    read: Mutex<Vec<(String, Need)>>,
}

impl Resolver for Recorder<'_> {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let found = self.inner.read(path, from);
        let read = need(path, from.to_owned(), found.clone());
        self.read.lock().unwrap_or_else(PoisonError::into_inner).push((path.to_owned(), read));
        found
    }
    fn has(&self, path: &str, from: &str) -> bool {
        self.inner.has(path, from)
    }
}
