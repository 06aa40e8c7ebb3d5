//! Files, and places in them.

use std::sync::{Arc, OnceLock};

/// A file known to a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SourceId(pub u16);

/// A run of bytes in a file: eight bytes, freely copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// Which file.
    pub source: SourceId,
    /// Length in bytes, cut at 65535.
    pub len: u16,
    /// Offset of the first byte.
    pub start: u32,
}

impl Span {
    /// The span of the bytes `start..end` of a file (sources are at most 4 GiB long).
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        let len = end.saturating_sub(start).min(usize::from(u16::MAX)) as u16;
        Self { source, len, start: u32::try_from(start).unwrap_or(u32::MAX) }
    }
}

/// A value and where it was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// Pairs a value with its place.
    pub const fn new(value: T, span: Span) -> Self {
        Self { value, span }
    }

    /// The same place with another value.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Spanned<U> {
        Spanned { value: f(self.value), span: self.span }
    }
}

/// A human position: both numbers count from 1; the column counts characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line number.
    pub line: usize,
    /// Column number in characters.
    pub column: usize,
}

#[derive(Clone, Debug)]
struct Source {
    name: String,
    text: Arc<[u8]>,
    included_from: Option<Span>,
    /// Offsets of the bytes after each newline, made when the first position is asked for.
    line_starts: OnceLock<Vec<usize>>,
}

impl Source {
    /// How many lines begin before or at a byte, less one, and where the last of them begins.
    fn line_of(&self, byte: usize) -> (usize, usize) {
        let starts = self.line_starts.get_or_init(|| {
            let newlines = self.text.iter().enumerate().filter(|&(_, &b)| b == b'\n');
            newlines.map(|(i, _)| i + 1).collect()
        });
        let before = starts.partition_point(|&s| s <= byte);
        (before, if before == 0 { 0 } else { starts[before - 1] })
    }
}

/// The files that were read, by [`SourceId`].
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    sources: Vec<Source>,
}

impl SourceMap {
    /// Adds a file; `included_from` is the place that asked for it. `None` when 65,535 files are known already.
    pub fn add(&mut self, name: &str, text: Arc<[u8]>, included_from: Option<Span>) -> Option<SourceId> {
        let id = SourceId(u16::try_from(self.sources.len()).ok()?);
        self.sources.push(Source {
            name: name.to_owned(),
            text,
            included_from,
            line_starts: OnceLock::new(),
        });
        Some(id)
    }

    /// The name under which a file was added.
    pub fn name(&self, id: SourceId) -> &str {
        self.sources.get(usize::from(id.0)).map_or("?", |s| &s.name)
    }

    /// The bytes of a file.
    pub fn text(&self, id: SourceId) -> &[u8] {
        self.sources.get(usize::from(id.0)).map_or(&[], |s| &s.text)
    }

    /// The place that included a file.
    pub fn included_from(&self, id: SourceId) -> Option<Span> {
        self.sources.get(usize::from(id.0)).and_then(|s| s.included_from)
    }

    /// How many files are known.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether no file is known.
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// Line and column of the first byte of a span.
    pub fn position(&self, span: Span) -> Position {
        let text = self.text(span.source);
        let start = (span.start as usize).min(text.len());
        let (line, line_start) = self.line_start(span.source, start);
        Position { line: line + 1, column: 1 + characters(&text[line_start..start]) }
    }

    /// Number, from 0, of the line of a byte, and the offset at which it begins.
    fn line_start(&self, id: SourceId, byte: usize) -> (usize, usize) {
        self.sources.get(usize::from(id.0)).map_or((0, 0), |s| s.line_of(byte))
    }

    /// The line in which a span starts, and the byte range of the span within it.
    pub fn line(&self, span: Span) -> (String, std::ops::Range<usize>) {
        let text = self.text(span.source);
        let start = (span.start as usize).min(text.len());
        let (_, line_start) = self.line_start(span.source, start);
        let line_end = text[start..].iter().position(|&b| b == b'\n').map_or(text.len(), |i| start + i);
        let end = (start + usize::from(span.len)).min(line_end);
        let before = characters(&text[line_start..start]);
        let within = characters(&text[start..end.max(start)]);
        let line = String::from_utf8_lossy(&text[line_start..line_end]).trim_end_matches('\r').to_owned();
        (line, before..before + within)
    }
}

/// Characters in a run of (mostly) UTF-8 bytes: every byte that does not continue one.
fn characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| b & 0xC0 != 0x80).count()
}
