//! Text to tokens: tags, text and CDATA, with their places.
//!
//! After a syntax error the scanner reports it and goes on at the next place that makes sense, so
//! one run finds all of them.

use crate::codes;
use crate::tag;
use crate::text;
use indigo_diag::{Diagnostic, Sink, SourceId, Span};
use std::ops::Range;

/// What document types are made of.
const DECLARATIONS: [&[u8]; 5] = [b"DOCTYPE", b"ENTITY", b"ELEMENT", b"ATTLIST", b"NOTATION"];

/// A piece of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    /// `<name ...>` or `<name .../>`; its attributes are with the scanner until the next token.
    Start { name: Range<usize>, tag: Range<usize>, empty: bool },
    /// `</name>`.
    End { name: Range<usize>, tag: Range<usize> },
    /// Text between tags, entities not yet replaced.
    Text(Range<usize>),
    /// The inside of `<![CDATA[...]]>`.
    CData(Range<usize>),
}

/// An attribute as it stands in a tag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RawAttribute {
    /// Its name.
    pub name: Range<usize>,
    /// Its value without the quotes, entities not yet replaced.
    pub value: Range<usize>,
}

/// After so many bytes it is asked whether to go on: some milliseconds of reading.
const BETWEEN_QUESTIONS: usize = 1 << 20;

/// Reads tokens one after the other.
pub(crate) struct Scanner<'a> {
    /// The whole file.
    pub bytes: &'a [u8],
    /// Which file.
    pub source: SourceId,
    /// Attributes of the start tag that came last.
    pub attributes: Vec<RawAttribute>,
    /// Where the next token begins.
    pub at: usize,
    /// How non-ASCII bytes are to be read.
    pub encoding: text::Encoding,
    /// Whether the file ended inside a tag, a comment or the like, which was reported, or is not wanted any more.
    pub cut_off: bool,
    /// Whether to read no further.
    is_stopped: &'a dyn Fn() -> bool,
    /// Where that is asked next.
    asks_at: usize,
}

impl<'a> Scanner<'a> {
    /// At the beginning of a file.
    pub fn new(bytes: &'a [u8], source: SourceId) -> Self {
        Self::until(bytes, source, &|| false)
    }

    /// At the beginning of a file that ends, as it were, when it is not wanted any more.
    pub fn until(bytes: &'a [u8], source: SourceId, is_stopped: &'a dyn Fn() -> bool) -> Self {
        let at = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        let encoding = text::Encoding::default();
        Self { bytes, source, attributes: vec![], at, encoding, cut_off: false, is_stopped, asks_at: 0 }
    }

    /// Goes to the end of the file if it is not wanted any more.
    fn ask(&mut self) {
        if self.at >= self.asks_at {
            self.asks_at = self.at + BETWEEN_QUESTIONS;
            if (self.is_stopped)() {
                (self.at, self.cut_off) = (self.bytes.len(), true);
            }
        }
    }

    /// The place of some bytes.
    pub fn span(&self, range: &Range<usize>) -> Span {
        Span::new(self.source, range.start, range.end)
    }

    /// Some bytes; none where the range is not within the file.
    pub fn slice(&self, range: &Range<usize>) -> &'a [u8] {
        self.bytes.get(range.clone()).unwrap_or_default()
    }

    /// The byte at an offset.
    pub fn byte(&self, at: usize) -> Option<u8> {
        self.bytes.get(at).copied()
    }

    /// The offset of the first of some bytes at or after `from`; the end of the file if there is none.
    pub fn find(&self, from: usize, wanted: impl Fn(u8) -> bool) -> usize {
        let rest = self.bytes.get(from..).unwrap_or_default();
        rest.iter().position(|&b| wanted(b)).map_or(self.bytes.len(), |i| from + i)
    }

    /// The offset of a byte sequence at or after `from`.
    fn find_sequence(&self, from: usize, wanted: &[u8]) -> Option<usize> {
        let rest = self.bytes.get(from..)?;
        rest.windows(wanted.len()).position(|w| w == wanted).map(|i| from + i)
    }

    fn starts_with(&self, at: usize, wanted: &[u8]) -> bool {
        self.bytes.get(at..).is_some_and(|rest| rest.starts_with(wanted))
    }

    /// The next token, or `None` at the end of the file.
    pub fn next(&mut self, sink: &mut Sink) -> Option<Token> {
        self.ask();
        while self.at < self.bytes.len() {
            if self.byte(self.at) != Some(b'<') {
                return Some(self.text(sink));
            }
            match self.byte(self.at + 1) {
                Some(b'!') if self.starts_with(self.at, b"<![CDATA[") => return Some(self.cdata(sink)),
                Some(b'!') => self.declaration(sink),
                Some(b'?') => self.instruction(sink),
                Some(b'/') if self.byte(self.at + 2).is_some_and(tag::starts_name) => {
                    return tag::end(self, sink);
                }
                Some(b) if tag::starts_name(b) => return tag::start(self, sink),
                _ => return Some(self.text(sink)),
            }
        }
        None
    }

    /// Text up to the next markup. A `<` that begins none is reported and is text.
    fn text(&mut self, sink: &mut Sink) -> Token {
        let start = self.at;
        loop {
            self.at = self.find(self.at, |b| b == b'<');
            match (self.byte(self.at), self.byte(self.at + 1)) {
                (None, _) | (_, Some(b'!' | b'?')) => break,
                (_, Some(b)) if tag::starts_name(b) => break,
                (_, Some(b'/')) if self.byte(self.at + 2).is_some_and(tag::starts_name) => break,
                _ => {}
            }
            sink.push(
                Diagnostic::error(
                    codes::STRAY_LESS_THAN,
                    self.span(&(self.at..self.at + 1)),
                    "this < begins no tag",
                )
                .hint("write &lt; for a < in a text"),
            );
            self.at += 1;
        }
        Token::Text(start..self.at)
    }

    fn cdata(&mut self, sink: &mut Sink) -> Token {
        let open = self.at..self.at + 9;
        match self.find_sequence(open.end, b"]]>") {
            Some(end) => {
                self.at = end + 3;
                Token::CData(open.end..end)
            }
            None => {
                self.report_cut_off(&open, "a CDATA section", "]]>", sink);
                Token::CData(open.end..self.bytes.len())
            }
        }
    }

    /// `<!-- comment -->`, `<!DOCTYPE ...>`, or the `<!==== title ====>` that some exporters write.
    fn declaration(&mut self, sink: &mut Sink) {
        let open = self.at..self.at + 2;
        if self.starts_with(self.at, b"<!--") {
            match self.find_sequence(open.end + 2, b"-->") {
                Some(end) => self.at = end + 3,
                None => self.report_cut_off(&(open.start..open.end + 2), "a comment", "-->", sink),
            }
            return;
        }
        let name = open.end..self.find(open.end, |b| !b.is_ascii_uppercase());
        if DECLARATIONS.contains(&self.slice(&name)) {
            sink.push(
                Diagnostic::error(
                    codes::DOCTYPE,
                    self.span(&(open.start..name.end)),
                    "document types and entity declarations are not read",
                )
                .hint("take it out; only the entities &lt; &gt; &amp; &quot; &apos; and &#...; are known"),
            );
            self.skip_nested();
        } else {
            self.at = self.find(open.end, |b| b == b'>') + 1;
        }
        if self.at > self.bytes.len() {
            self.report_cut_off(&open, "a declaration", ">", sink);
        }
    }

    /// Moves past the `>` that closes the `<` here, brackets nested.
    fn skip_nested(&mut self) {
        let mut depth = 0_usize;
        loop {
            self.at = self.find(self.at, |b| b == b'<' || b == b'>') + 1;
            match self.byte(self.at - 1) {
                Some(b'<') => depth += 1,
                Some(_) if depth > 1 => depth -= 1,
                _ => return,
            }
        }
    }

    fn instruction(&mut self, sink: &mut Sink) {
        let open = self.at..self.at + 2;
        let Some(end) = self.find_sequence(open.end, b"?>") else {
            self.report_cut_off(&open, "a processing instruction", "?>", sink);
            return;
        };
        if self.starts_with(open.end, b"xml ") {
            self.encoding.declare(self.slice(&(open.end..end)), self.span(&(open.start..end + 2)), sink);
        }
        self.at = end + 2;
    }

    /// Reports that the file ends inside something, and goes to the end of the file.
    pub fn report_cut_off(&mut self, open: &Range<usize>, what: &str, closing: &str, sink: &mut Sink) {
        sink.push(
            Diagnostic::error(codes::CUT_OFF, self.span(open), format!("the file ends inside {what}"))
                .expected(format!("expected {closing} after this")),
        );
        self.at = self.bytes.len();
        self.cut_off = true;
    }

    /// Some bytes as text, entities replaced where asked for.
    pub fn decode(&mut self, range: &Range<usize>, entities: bool, sink: &mut Sink) -> String {
        text::decode(self.slice(range), self.source, range.start, &mut self.encoding, entities, sink)
    }

    /// A name as text.
    pub fn name(&mut self, range: &Range<usize>, sink: &mut Sink) -> String {
        self.decode(range, false, sink)
    }
}
