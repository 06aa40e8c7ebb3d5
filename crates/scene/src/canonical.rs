//! A scene in the one form that this program writes: version 1.0 as it is declared, in one file, with comments.

use crate::load::{LoadOptions, load};
use crate::schema::SCENE;
use indigo_decl::{Element, bind};
use indigo_diag::{Sink, SourceMap, Span};
use indigo_igs::{read_scene, write_explained};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A scene as far as it could be written in another form.
pub struct LoadedCanonical {
    /// Its text, if nothing was wrong.
    pub text: Option<String>,
    /// How many files it names that cannot be had: those keep the paths that they had.
    pub missing: usize,
    /// All scene files that were read.
    pub sources: SourceMap,
    /// Everything that was found: what has no effect is not in the text.
    pub sink: Sink,
}

/// A file that a scene names.
pub struct NamedFile<'a> {
    /// Its path, as it is written.
    pub written: &'a str,
    /// Where it was found.
    pub path: &'a str,
    /// What is in it.
    pub bytes: &'a Arc<[u8]>,
}

/// Reads a scene with all that it includes, whatever version of the format it is written in, and writes it anew as one file.
/// `rewrite` gives what stands in place of the path of a file. The scene is checked before: what has errors has no text.
pub fn load_canonical(
    path: &str,
    options: &LoadOptions,
    title: &str,
    rewrite: &dyn Fn(&NamedFile) -> String,
) -> LoadedCanonical {
    let checked = load(path, &LoadOptions { check_only: true, ..*options });
    let nothing = |sources, sink| LoadedCanonical { text: None, missing: 0, sources, sink };
    if checked.sink.has_errors() {
        return nothing(checked.sources, checked.sink);
    }
    let (mut sources, mut again) = (SourceMap::default(), Sink::new());
    let root = read_scene(path, options.resolver, &mut sources, &mut again, &options.limits);
    let Some(node) = root.map(|root| bind(root, &SCENE, &mut again)).filter(|_| !again.has_errors()) else {
        // The files have changed meanwhile.
        return nothing(sources, again);
    };
    let missing = Cell::new(0);
    let known = RefCell::new(BTreeMap::new());
    let find = |written: &str, span: Span| {
        // What is nowhere is in use nowhere, or has a placeholder, or it would have been an error.
        let Ok(found) = options.resolver.read(written, sources.name(span.source)) else {
            missing.set(missing.get() + 1);
            return written.to_owned();
        };
        rewrite(&NamedFile { written, path: &found.path, bytes: &found.bytes })
    };
    // Not read again for each of the many materials that may use it.
    let find_once = |written: &str, span: Span| -> String {
        let key = (written.to_owned(), span.source);
        known.borrow_mut().entry(key).or_insert_with(|| find(written, span)).clone()
    };
    let mut element = node.to_element(&find_once);
    by_place(&mut element.children, "medium");
    let text = Some(write_explained(&element, &SCENE, title));
    // What the first reading has found, with the lowering's share.
    LoadedCanonical { text, missing: missing.get(), sources: checked.sources, sink: checked.sink }
}

/// Orders elements of a name by file and place: of media of one precedence the one that comes later wins.
fn by_place(elements: &mut [Element], name: &str) {
    let at: Vec<usize> = (0..elements.len()).filter(|&i| *elements[i].name == *name).collect();
    let mut sorted: Vec<Element> = at.iter().map(|&i| elements[i].clone()).collect();
    sorted.sort_by_key(|element| (element.span.source, element.span.start));
    for (i, element) in at.into_iter().zip(sorted) {
        elements[i] = element;
    }
}
