//! A scene in the one form that this program writes: version 1.0 as it is declared, in one file, with comments.

use crate::load::{LoadOptions, load};
use crate::schema::SCENE;
use indigo_decl::bind;
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{read_scene, write_explained};

/// A scene as far as it could be written in another form.
pub struct LoadedCanonical {
    /// Its text, if nothing was wrong.
    pub text: Option<String>,
    /// All scene files that were read.
    pub sources: SourceMap,
    /// Everything that was found: what has no effect is not in the text.
    pub sink: Sink,
}

/// Reads a scene with all that it includes, whatever version of the format it is written in, and writes it anew as one file.
/// `rewrite` gives what stands in place of a path, of the file in which it was written. The scene is checked before: what
/// has errors has no text.
pub fn load_canonical(
    path: &str,
    options: &LoadOptions,
    title: &str,
    rewrite: &dyn Fn(&str, &str) -> String,
) -> LoadedCanonical {
    let checked = load(path, &LoadOptions { check_only: true, ..*options });
    if checked.sink.has_errors() {
        return LoadedCanonical { text: None, sources: checked.sources, sink: checked.sink };
    }
    let (mut sources, mut again) = (SourceMap::default(), Sink::new());
    let root = read_scene(path, options.resolver, &mut sources, &mut again, &options.limits);
    let text = root.map(|root| {
        let node = bind(root, &SCENE, &mut again);
        let element = node.to_element(&|written, span| rewrite(written, sources.name(span.source)));
        write_explained(&element, &SCENE, title)
    });
    // What the first reading has found, with the lowering's share.
    LoadedCanonical { text, sources: checked.sources, sink: checked.sink }
}
