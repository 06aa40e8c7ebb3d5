//! Files to trees, with what they include.

use crate::codes;
use crate::include::{INCLUDE, set_uids_apart};
use crate::limits::Limits;
use crate::{text, tree};
use indigo_decl::{Element, Resolved, Resolver, bind, hint_of_shipped};
use indigo_diag::{Diagnostic, Sink, SourceMap, Span};
use std::sync::Arc;

/// The roots that a scene may have.
const ROOTS: [&str; 2] = ["scene", "scenedata"];

/// Reads a scene and everything that it includes.
///
/// `path` is resolved against nothing. The children of an included file's root stand where the
/// `include` stood. What is wrong goes to `sink`, and what could be read is returned, so that a
/// caller may go on to check it; `None` if that is nothing.
pub fn read_scene(
    path: &str,
    resolver: &dyn Resolver,
    sources: &mut SourceMap,
    sink: &mut Sink,
    limits: &Limits,
) -> Option<Element> {
    read_scene_until(path, resolver, sources, sink, limits, &|| false)
}

/// [`read_scene`], unless it is not wanted any more: `is_stopped` is asked before each file and after each mebibyte of one. From
/// when it says so on nothing is read and `None` is returned; what went to `sink` tells less than all then.
pub fn read_scene_until(
    path: &str,
    resolver: &dyn Resolver,
    sources: &mut SourceMap,
    sink: &mut Sink,
    limits: &Limits,
    is_stopped: &dyn Fn() -> bool,
) -> Option<Element> {
    let mut reader = Reader::new(resolver, sources, sink, limits, is_stopped);
    let file = reader.resolve(path, "", None)?;
    reader.scene(&file, None).filter(|_| !is_stopped())
}

/// Reads one file of any root; nothing is included.
pub fn read_document(
    path: &str,
    resolver: &dyn Resolver,
    sources: &mut SourceMap,
    sink: &mut Sink,
    limits: &Limits,
) -> Option<Element> {
    let mut reader = Reader::new(resolver, sources, sink, limits, &|| false);
    let file = reader.resolve(path, "", None)?;
    reader.document(&file, None)
}

/// Whether two files are one, though it may be written in two ways: with detours, or with letters of another case on
/// a disk that does not tell them apart.
fn is_same_file(a: &Resolved, b: &Resolved) -> bool {
    let (first, second) = (without_detours(&a.path), without_detours(&b.path));
    first == second || first.eq_ignore_ascii_case(&second) && a.bytes == b.bytes
}

/// A path without `.` and without steps down that are taken back.
fn without_detours(path: &str) -> String {
    let mut parts: Vec<&str> = vec![];
    for (i, part) in path.split(['/', '\\']).enumerate() {
        match part {
            "." => {}
            "" if i > 0 => {}
            ".." if parts.last().is_some_and(|last| !matches!(*last, ".." | "")) => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// A circle of files, of which a large one is told by its ends.
fn in_short<'p>(circle: &[&'p str]) -> Vec<&'p str> {
    match circle {
        &[first, second, _, .., before, last] => vec![first, second, "...", before, last],
        _ => circle.to_vec(),
    }
}

struct Reader<'a> {
    resolver: &'a dyn Resolver,
    sources: &'a mut SourceMap,
    sink: &'a mut Sink,
    limits: &'a Limits,
    /// The files being read, from the scene to the innermost include.
    chain: Vec<Resolved>,
    bytes_left: u64,
    files_left: usize,
    elements_left: usize,
    /// Whether a limit was exceeded, which was reported.
    exceeded: bool,
    /// Whether to read no further.
    is_stopped: &'a dyn Fn() -> bool,
}

impl<'a> Reader<'a> {
    fn new(
        resolver: &'a dyn Resolver,
        sources: &'a mut SourceMap,
        sink: &'a mut Sink,
        limits: &'a Limits,
        is_stopped: &'a dyn Fn() -> bool,
    ) -> Self {
        Self {
            resolver,
            sources,
            sink,
            limits,
            chain: vec![],
            bytes_left: limits.total_bytes,
            files_left: limits.files,
            elements_left: limits.elements,
            exceeded: false,
            is_stopped,
        }
    }

    fn resolve(&mut self, path: &str, from: &str, span: Option<Span>) -> Option<Resolved> {
        match self.resolver.read(path, from) {
            Ok(file) => Some(file),
            Err(error) => {
                let message = format!("cannot read {path}");
                let unreadable = Diagnostic::error(codes::UNREADABLE, span, message);
                let hint = hint_of_shipped(path, from, &error, self.resolver);
                let unreadable = unreadable.expected(error.expected()).note(error.to_string());
                self.sink.push(Diagnostic { hint, ..unreadable });
                None
            }
        }
    }

    /// Says that a limit is exceeded, the first time: files that include each other may do so a thousand times.
    fn exceed(&mut self, span: Option<Span>, message: String) {
        if !std::mem::replace(&mut self.exceeded, true) {
            self.sink
                .push(Diagnostic::error(codes::LIMIT, span, message).expected("expected no more than that"));
        }
    }

    /// Reads the text of a file that was found.
    fn document(&mut self, file: &Resolved, span: Option<Span>) -> Option<Element> {
        if text::is_binary(&file.bytes) {
            // Known by name alone: no line of it is worth showing.
            let at = self.sources.add(&file.path, Arc::from([]), span).map(|source| Span::new(source, 0, 0));
            self.sink.push(
                Diagnostic::error(codes::ENCODING, at, "this is not a text file")
                    .expected("expected a scene in XML"),
            );
            return None;
        }
        let size = file.bytes.len() as u64;
        let most = self.limits.file_bytes.min(u64::from(u32::MAX));
        let exceeded = if size > most {
            Some(format!("{} has {size} bytes; a file may have {most}", file.path))
        } else if size > self.bytes_left {
            Some(format!(
                "with {} all files together have more than {} bytes",
                file.path, self.limits.total_bytes
            ))
        } else if self.files_left == 0 {
            Some(format!("more than {} files are included", self.limits.files))
        } else {
            None
        };
        if let Some(message) = exceeded {
            self.exceed(span, message);
            return None;
        }
        self.bytes_left -= size;
        self.files_left -= 1;
        let Some(source) = self.sources.add(&file.path, file.bytes.clone(), span) else {
            self.exceed(span, "there are too many files".to_owned());
            return None;
        };
        let errors = self.sink.error_count();
        let (left, is_stopped) = (&mut self.elements_left, self.is_stopped);
        let root = tree::parse(&file.bytes, source, self.limits, left, self.sink, is_stopped);
        if root.is_none() && self.sink.error_count() == errors && !is_stopped() {
            self.sink.push(
                Diagnostic::error(codes::WRONG_ROOT, Span::new(source, 0, 0), "this file holds no element")
                    .expected("expected <scene>"),
            );
        }
        root
    }

    fn scene(&mut self, file: &Resolved, span: Option<Span>) -> Option<Element> {
        let mut root = self.document(file, span)?;
        if !ROOTS.contains(&&*root.name) {
            self.sink.push(
                Diagnostic::error(
                    codes::WRONG_ROOT,
                    root.span,
                    format!("the root element is <{}>", root.name),
                )
                .expected("expected <scene> or <scenedata>"),
            );
            return None;
        }
        self.chain.push(file.clone());
        if root.children.iter().any(|c| INCLUDE.is_called(&c.name)) {
            let mut children = Vec::with_capacity(root.children.len());
            for child in root.children {
                if INCLUDE.is_called(&child.name) {
                    children.append(&mut self.include(child));
                } else {
                    children.push(child);
                }
            }
            root.children = children;
        }
        self.chain.pop();
        Some(root)
    }

    /// The elements that an `include` stands for.
    fn include(&mut self, element: Element) -> Vec<Element> {
        let node = bind(element, &INCLUDE, self.sink);
        let pathname = node.text("pathname");
        if pathname.value.is_empty() {
            return vec![];
        }
        let span = pathname.span;
        if self.chain.len() > self.limits.include_depth {
            self.exceed(Some(span), format!("includes are nested deeper than {}", self.limits.include_depth));
            return vec![];
        }
        if self.files_left == 0 && self.exceeded || self.elements_left == 0 || (self.is_stopped)() {
            // Nothing more can be read, and it was said, or nothing more is wanted.
            return vec![];
        }
        let from = self.chain.last().map_or_else(String::new, |file| file.path.clone());
        let Some(file) = self.resolve(&pathname.value, &from, Some(span)) else { return vec![] };
        if let Some(first) = self.chain.iter().position(|f| is_same_file(f, &file)) {
            let circle: Vec<&str> = self.chain.iter().skip(first).chain([&file]).map(|f| &*f.path).collect();
            let message = format!("{} includes itself: {}", file.path, in_short(&circle).join(" -> "));
            self.sink.push(Diagnostic::error(codes::INCLUDE_CYCLE, span, message));
            return vec![];
        }
        let Some(mut root) = self.scene(&file, Some(span)) else { return vec![] };
        if node.bool("offset_uids") {
            // Files are counted down.
            set_uids_apart(&mut root.children, self.limits.files - self.files_left);
        }
        root.children
    }
}
