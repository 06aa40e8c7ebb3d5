//! Tokens to a tree of elements.

use crate::codes;
use crate::embedded;
use crate::limits::Limits;
use crate::scan::{Scanner, Token};
use crate::text;
use indigo_decl::{Attribute, Element};
use indigo_diag::{Diagnostic, Sink, SourceId, Span, Spanned, nearest};
use std::ops::Range;

/// An element whose end tag has not come yet.
struct Open {
    element: Element,
    /// Where its name stands in the start tag.
    name: Range<usize>,
    /// The line in which it starts.
    line: usize,
    text: String,
    /// From the first to the last byte of text that is not blank.
    text_at: Option<Range<usize>>,
}

/// Builds the tree of one file.
struct Builder<'a, 'r> {
    scanner: Scanner<'a>,
    sink: &'r mut Sink,
    limits: &'r Limits,
    /// How many elements there may still be, in this file and those that follow.
    elements_left: &'r mut usize,
    open: Vec<Open>,
    root: Option<Element>,
    /// Whether something outside the root was reported.
    outside_reported: bool,
    /// An offset, and the line that it is in: lines are counted once, on the way through the file.
    counted: (usize, usize),
}

/// Reads the text of one file.
///
/// `None` if there is no root element. After a syntax error, or where reading was stopped, the tree holds what could be
/// read; an element that the file ends in is left out, since most of it may be missing.
pub(crate) fn parse(
    bytes: &[u8],
    source: SourceId,
    limits: &Limits,
    elements_left: &mut usize,
    sink: &mut Sink,
    is_stopped: &dyn Fn() -> bool,
) -> Option<Element> {
    if text::is_wide(bytes) {
        sink.push(
            Diagnostic::error(
                codes::ENCODING,
                Span::new(source, 0, 0),
                "this file is not UTF-8 but, it seems, UTF-16",
            )
            .hint("save the file as UTF-8"),
        );
        return None;
    }
    let scanner = Scanner::until(bytes, source, is_stopped);
    let mut builder = Builder {
        scanner,
        sink,
        limits,
        elements_left,
        open: vec![],
        root: None,
        outside_reported: false,
        counted: (0, 1),
    };
    builder.run();
    builder.finish()
}

impl Builder<'_, '_> {
    fn run(&mut self) {
        while let Some(token) = self.scanner.next(self.sink) {
            match token {
                Token::Start { name, tag, empty } => {
                    if !self.start(name, &tag, empty) {
                        return;
                    }
                }
                Token::End { name, tag } => self.end(&name, &tag),
                Token::Text(range) => self.text(range, true),
                Token::CData(range) => self.text(range, false),
            }
        }
    }

    /// Takes a start tag; `false` where reading cannot go on.
    fn start(&mut self, name: Range<usize>, tag: &Range<usize>, empty: bool) -> bool {
        if self.open.is_empty() && self.root.is_some() {
            self.report_outside(tag);
        }
        if self.open.len() >= self.limits.element_depth {
            let message = format!("elements are nested deeper than {}", self.limits.element_depth);
            let error = Diagnostic::error(codes::LIMIT, self.scanner.span(tag), message);
            self.sink.push(error.expected("expected no more than that"));
            return false;
        }
        if *self.elements_left == 0 {
            let message = format!("there are more than {} elements", self.limits.elements);
            let error = Diagnostic::error(codes::LIMIT, self.scanner.span(tag), message);
            self.sink.push(error.expected("expected no more than that"));
            return false;
        }
        *self.elements_left -= 1;
        let line = self.line_at(tag.start);
        let is_mesh = self.scanner.slice(&name) == b"embedded"
            && self.open.last().is_some_and(|o| &*o.element.name == "mesh");
        let mut element = Element::new(&self.scanner.name(&name, self.sink), self.scanner.span(tag));
        if is_mesh {
            let (mesh, closed) = embedded::read(&mut self.scanner, tag, empty, self.sink);
            element.mesh = Some(Box::new(mesh));
            if closed {
                self.attach(element);
            } else {
                self.open.push(Open { element, name, line, text: String::new(), text_at: None });
            }
            return true;
        }
        element.attributes = self.attributes();
        if empty {
            self.attach(element);
        } else {
            self.open.push(Open { element, name, line, text: String::new(), text_at: None });
        }
        true
    }

    fn attributes(&mut self) -> Vec<Attribute> {
        let raw = std::mem::take(&mut self.scanner.attributes);
        let read = raw
            .iter()
            .map(|a| Attribute {
                name: Spanned::new(self.scanner.name(&a.name, self.sink).into(), self.scanner.span(&a.name)),
                value: Spanned::new(
                    self.scanner.decode(&a.value, true, self.sink).into(),
                    self.scanner.span(&a.value),
                ),
            })
            .collect();
        self.scanner.attributes = raw;
        read
    }

    fn text(&mut self, range: Range<usize>, entities: bool) {
        let bytes = self.scanner.slice(&range);
        let Some(first) = bytes.iter().position(|b| !b.is_ascii_whitespace()) else {
            // A blank between two pieces of text still separates them.
            if let Some(open) = self.open.last_mut().filter(|o| o.text_at.is_some()) {
                open.text.push(' ');
            }
            return;
        };
        let last = bytes.iter().rposition(|b| !b.is_ascii_whitespace()).unwrap_or(first);
        let inked = range.start + first..range.start + last + 1;
        if self.open.is_empty() {
            self.report_outside(&inked);
            return;
        }
        let text = self.scanner.decode(&range, entities, self.sink);
        if let Some(open) = self.open.last_mut() {
            open.text.push_str(&text);
            let start = open.text_at.as_ref().map_or(inked.start, |r| r.start);
            open.text_at = Some(start..inked.end);
        }
    }

    fn end(&mut self, name: &Range<usize>, tag: &Range<usize>) {
        let written = self.scanner.slice(name);
        let matches = |o: &Open| self.scanner.slice(&o.name) == written;
        if self.open.last().is_some_and(matches) {
            self.close();
            return;
        }
        let Some(depth) = self.open.iter().rposition(matches) else {
            self.end_of_nothing(name, tag);
            return;
        };
        while self.open.len() > depth + 1 {
            self.report_unclosed(name, tag);
            self.close();
        }
        self.close();
    }

    /// An end tag that closes no open element: perhaps a misspelt one of the innermost.
    fn end_of_nothing(&mut self, name: &Range<usize>, tag: &Range<usize>) {
        let written = self.scanner.name(name, self.sink);
        let mut d = Diagnostic::error(
            codes::MISMATCHED_TAGS,
            self.scanner.span(tag),
            format!("</{written}> closes nothing that is open"),
        );
        let mut misspelt = false;
        if let Some(Open { element, line, .. }) = self.open.last() {
            misspelt = nearest(&written, [&*element.name]).is_some();
            d = d
                .expected(format!("expected </{}>", element.name))
                .note(format!("<{}> begins in line {line}", element.name));
        }
        self.sink.push(d);
        if misspelt {
            self.close();
        }
    }

    fn report_unclosed(&mut self, name: &Range<usize>, tag: &Range<usize>) {
        let closing = self.scanner.name(name, self.sink);
        let line = self.line_at(tag.start);
        let Some(open) = self.open.last() else { return };
        let inner = &open.element.name;
        self.sink.push(
            Diagnostic::error(codes::MISMATCHED_TAGS, open.element.span, format!("<{inner}> is not closed"))
                .expected(format!("expected </{inner}> before </{closing}>"))
                .note(format!("</{closing}> stands in line {line}")),
        );
    }

    /// The line of an offset that is not before any asked for earlier.
    fn line_at(&mut self, offset: usize) -> usize {
        let (from, line) = self.counted;
        let passed = self.scanner.slice(&(from..offset.max(from)));
        self.counted = (offset.max(from), line + passed.split(|&b| b == b'\n').count() - 1);
        self.counted.1
    }

    /// Closes the innermost element.
    fn close(&mut self) {
        let Some(mut open) = self.open.pop() else { return };
        if let Some(at) = open.text_at {
            open.element.text = Spanned::new(open.text.trim_ascii().into(), self.scanner.span(&at));
        }
        self.attach(open.element);
    }

    /// Puts a finished element where it belongs.
    fn attach(&mut self, element: Element) {
        match self.open.last_mut() {
            Some(parent) => parent.element.children.push(element),
            None if self.root.is_none() => self.root = Some(element),
            None => {}
        }
    }

    fn report_outside(&mut self, at: &Range<usize>) {
        if std::mem::replace(&mut self.outside_reported, true) {
            return;
        }
        let place = if self.root.is_some() { "after the end of" } else { "before" };
        self.sink.push(
            Diagnostic::error(
                codes::OUTSIDE_ROOT,
                self.scanner.span(at),
                format!("there is something {place} the root element"),
            )
            .expected("expected nothing here"),
        );
    }

    fn finish(mut self) -> Option<Element> {
        let unfinished = self.scanner.at >= self.scanner.bytes.len() && !self.scanner.cut_off;
        if let (Some(innermost), true) = (self.open.last(), unfinished) {
            let (name, span) = (innermost.element.name.clone(), innermost.element.span);
            let mut d =
                Diagnostic::error(codes::CUT_OFF, span, format!("the file ends before <{name}> is closed"))
                    .expected(format!("expected </{name}> somewhere after this"));
            for outer in self.open.iter().rev().skip(1).take(3) {
                let Open { element, line, .. } = outer;
                d = d.note(format!("<{}>, which begins in line {line}, is not closed either", element.name));
            }
            self.sink.push(d);
        }
        if self.root.is_none() && !self.open.is_empty() {
            self.open.truncate(1);
            self.close();
        }
        self.root
    }
}
