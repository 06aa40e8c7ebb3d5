//! Files to trees, with what they include.

use crate::codes;
use crate::include::INCLUDE;
use crate::limits::Limits;
use crate::tree;
use indigo_decl::{Element, Resolved, Resolver, bind};
use indigo_diag::{Diagnostic, Sink, SourceMap, Span};

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
    let mut reader = Reader::new(resolver, sources, sink, limits);
    let file = reader.resolve(path, "", None)?;
    reader.scene(&file, None)
}

/// Reads one file of any root; nothing is included.
pub fn read_document(
    path: &str,
    resolver: &dyn Resolver,
    sources: &mut SourceMap,
    sink: &mut Sink,
    limits: &Limits,
) -> Option<Element> {
    let mut reader = Reader::new(resolver, sources, sink, limits);
    let file = reader.resolve(path, "", None)?;
    reader.document(&file, None)
}

struct Reader<'a> {
    resolver: &'a dyn Resolver,
    sources: &'a mut SourceMap,
    sink: &'a mut Sink,
    limits: &'a Limits,
    /// The files being read, from the scene to the innermost include.
    chain: Vec<String>,
    bytes_left: u64,
    files_left: usize,
    elements_left: usize,
}

impl<'a> Reader<'a> {
    fn new(
        resolver: &'a dyn Resolver,
        sources: &'a mut SourceMap,
        sink: &'a mut Sink,
        limits: &'a Limits,
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
        }
    }

    fn resolve(&mut self, path: &str, from: &str, span: Option<Span>) -> Option<Resolved> {
        match self.resolver.read(path, from) {
            Ok(file) => Some(file),
            Err(error) => {
                let message = format!("cannot read {path}");
                self.sink.push(Diagnostic::error(codes::UNREADABLE, span, message).note(error.to_string()));
                None
            }
        }
    }

    /// Reads the text of a file that was found.
    fn document(&mut self, file: &Resolved, span: Option<Span>) -> Option<Element> {
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
            self.sink.push(Diagnostic::error(codes::LIMIT, span, message));
            return None;
        }
        self.bytes_left -= size;
        self.files_left -= 1;
        let Some(source) = self.sources.add(&file.path, file.bytes.clone(), span) else {
            self.sink.push(Diagnostic::error(codes::LIMIT, span, "there are too many files"));
            return None;
        };
        let errors = self.sink.error_count();
        let root = tree::parse(&file.bytes, source, self.limits, &mut self.elements_left, self.sink);
        if root.is_none() && self.sink.error_count() == errors {
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
        self.chain.push(file.path.clone());
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
            let message = format!("includes are nested deeper than {}", self.limits.include_depth);
            self.sink.push(Diagnostic::error(codes::LIMIT, span, message));
            return vec![];
        }
        let from = self.chain.last().cloned().unwrap_or_default();
        let Some(file) = self.resolve(&pathname.value, &from, Some(span)) else { return vec![] };
        if let Some(first) = self.chain.iter().position(|p| *p == file.path) {
            let mut circle: Vec<&str> = self.chain.iter().skip(first).map(String::as_str).collect();
            circle.push(&file.path);
            let message = format!("{} includes itself: {}", file.path, circle.join(" -> "));
            self.sink.push(Diagnostic::error(codes::INCLUDE_CYCLE, span, message));
            return vec![];
        }
        let Some(root) = self.scene(&file, Some(span)) else { return vec![] };
        root.children
    }
}
