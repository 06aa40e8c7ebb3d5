//! What a scene consists of: its files, each with the places that name it; and packing them.

use crate::codes;
use crate::load::{LoadOptions, load, read_and_bind};
use indigo_decl::Resolver;
use indigo_diag::{Diagnostic, Sink, SourceId, SourceMap, Span};
use indigo_igs::pack::PackWriter;
use std::collections::{BTreeMap, HashMap};
use std::io::{Error, Seek, Write};

/// A scene as far as its files could be found.
pub struct LoadedContents {
    /// The files, if nothing was wrong.
    pub contents: Option<Contents>,
    /// All scene files that were read.
    pub sources: SourceMap,
    /// Everything that was found.
    pub sink: Sink,
}

/// The files of a scene.
pub struct Contents {
    /// What each scene file names, in its order.
    uses: BTreeMap<SourceId, Vec<Use>>,
}

/// A place that names a file.
struct Use {
    /// Where the path stands.
    span: Span,
    named: Named,
}

enum Named {
    /// A scene file that is included there.
    Document(SourceId),
    /// Any other file, by its path as it is written.
    File(String),
}

/// Finds all files that a scene names, in itself and in what it includes. The scene is checked before: what has errors
/// has no contents.
pub fn load_contents(path: &str, options: &LoadOptions) -> LoadedContents {
    let checked = load(path, &LoadOptions { check_only: true, ..*options });
    if checked.sink.has_errors() {
        return LoadedContents { contents: None, sources: checked.sources, sink: checked.sink };
    }
    let mut sources = SourceMap::default();
    let mut sink = Sink::new();
    let bound = read_and_bind(path, options, &mut sources, &mut sink);
    let Some(bound) = bound.filter(|_| !sink.has_errors()) else {
        return LoadedContents { contents: None, sources, sink };
    };
    let mut uses: BTreeMap<SourceId, Vec<Use>> = BTreeMap::new();
    for source in (0..sources.len()).filter_map(|n| u16::try_from(n).ok()).map(SourceId) {
        if let Some(span) = sources.included_from(source) {
            uses.entry(span.source).or_default().push(Use { span, named: Named::Document(source) });
        }
    }
    let mut found = HashMap::new();
    bound.root.visit_paths(&mut |written, span| {
        let is_there = *found
            .entry((written.to_owned(), span.source))
            .or_insert_with(|| is_readable(written, span, options.resolver, &sources, &mut sink));
        if !is_there {
            return;
        }
        uses.entry(span.source).or_default().push(Use { span, named: Named::File(written.to_owned()) });
    });
    for (source, uses) in &mut uses {
        uses.sort_by_key(|u| u.span.start);
        // A texture of a list may be in use several times.
        uses.dedup_by_key(|u| u.span.start);
        for Use { span, .. } in uses {
            check_replaceable(*span, sources.text(*source), &mut sink);
        }
    }
    let contents = (!sink.has_errors()).then_some(Contents { uses });
    LoadedContents { contents, sources, sink }
}

/// Whether a file can be read. If not, that is warned of and the path stays as it is: nothing uses what names the file, or
/// it has a placeholder, or else the scene would have had an error.
fn is_readable(
    path: &str,
    span: Span,
    resolver: &dyn Resolver,
    sources: &SourceMap,
    sink: &mut Sink,
) -> bool {
    let read = resolver.read(path, sources.name(span.source));
    if let Err(error) = &read {
        let message = format!("cannot read {path}: {error}");
        sink.push(
            Diagnostic::warning(codes::NOT_PACKED, span, message).note("it will be missing in the pack"),
        );
    }
    read.is_ok()
}

/// Says so where a path is written in a way that another cannot take the place of.
fn check_replaceable(span: Span, text: &[u8], sink: &mut Sink) {
    let written = text.get(range(span)).unwrap_or_default();
    let count = |mark: &[u8]| written.windows(mark.len()).filter(|w| w == &mark).count();
    // As many sections begin in it as end in it: then what takes its place stands where it stood, inside or outside one.
    if span.len == u16::MAX || count(b"<![CDATA[") != count(b"]]>") {
        let message = "this path is written in a way that cannot be rewritten";
        sink.push(
            Diagnostic::error(codes::NOT_REWRITABLE, span, message)
                .expected("expected a path in one piece: plain text, or one CDATA section"),
        );
    }
}

fn range(span: Span) -> std::ops::Range<usize> {
    let start = span.start as usize;
    start..start + usize::from(span.len)
}

impl Contents {
    /// Writes the scene and all its files as a packed scene; how many files lie beside the scene.
    ///
    /// # Errors
    /// What the output says, or that a file cannot be read any more.
    pub fn pack(
        &self,
        out: impl Write + Seek,
        sources: &SourceMap,
        resolver: &dyn Resolver,
    ) -> std::io::Result<usize> {
        const SCENE: SourceId = SourceId(0);
        let names = HashMap::new();
        let mut packing = Packing { contents: self, names, sources, resolver, pack: PackWriter::new(out) };
        let scene = packing.rewritten(SCENE)?;
        packing.pack.finish(sources.name(SCENE), &scene)
    }
}

struct Packing<'a, W: Write + Seek> {
    contents: &'a Contents,
    /// Names in the pack by path as it is written, and the file that it is written in.
    names: HashMap<(&'a str, &'a str), String>,
    sources: &'a SourceMap,
    resolver: &'a dyn Resolver,
    pack: PackWriter<W>,
}

impl<'a, W: Write + Seek> Packing<'a, W> {
    /// The text of a scene file with the names that its files have in the pack, all of which are written there.
    fn rewritten(&mut self, source: SourceId) -> std::io::Result<Vec<u8>> {
        let (contents, sources) = (self.contents, self.sources);
        let text = sources.text(source);
        let mut out = Vec::with_capacity(text.len());
        let mut copied = 0;
        for Use { span, named } in contents.uses.get(&source).into_iter().flatten() {
            let name = match named {
                // As deep as includes may be nested.
                Named::Document(included) => {
                    let content = self.rewritten(*included)?;
                    self.pack.add(sources.name(*included), &content)?
                }
                Named::File(path) => self.file(path, sources.name(source))?,
            };
            let place = range(*span);
            out.extend_from_slice(text.get(copied..place.start).unwrap_or_default());
            out.extend_from_slice(name.as_bytes());
            copied = place.end;
        }
        out.extend_from_slice(text.get(copied..).unwrap_or_default());
        Ok(out)
    }

    /// The name that a file has in the pack, into which it is written when it is first named.
    fn file(&mut self, path: &'a str, from: &'a str) -> std::io::Result<String> {
        if let Some(name) = self.names.get(&(path, from)) {
            return Ok(name.clone());
        }
        let file = self.resolver.read(path, from).map_err(Error::other)?;
        let name = self.pack.add(&file.path, &file.bytes)?;
        self.names.insert((path, from), name.clone());
        Ok(name)
    }
}
