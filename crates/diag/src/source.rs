//! Files, and places in them.

use crate::shown::is_hidden;
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
    /// What positions are found by, made when the first is asked for.
    index: OnceLock<Index>,
}

/// Where lines begin, and how many characters lie before every so many bytes: a line can be as long as its file.
#[derive(Clone, Debug)]
struct Index {
    /// Offsets of the bytes after each line end: `\n`, `\r\n`, or `\r` alone.
    line_starts: Vec<usize>,
    /// Characters before each [`Index::STRIDE`] bytes.
    characters: Vec<usize>,
}

impl Index {
    const STRIDE: usize = 4096;

    fn of(text: &[u8]) -> Self {
        let is_end = |i: usize| text[i] == b'\n' || (text[i] == b'\r' && text.get(i + 1) != Some(&b'\n'));
        let line_starts = (0..text.len()).filter(|&i| is_end(i)).map(|i| i + 1).collect();
        let mut before = 0;
        let before_chunk = |chunk: &[u8]| {
            let here = before;
            before += characters(chunk);
            here
        };
        let characters = text.chunks(Self::STRIDE).map(before_chunk).collect();
        Self { line_starts, characters }
    }

    /// Characters before a byte.
    fn characters_before(&self, text: &[u8], byte: usize) -> usize {
        let block = (byte / Self::STRIDE).min(self.characters.len().saturating_sub(1));
        self.characters.get(block).map_or(0, |before| before + characters(&text[block * Self::STRIDE..byte]))
    }
}

/// A piece of a line round a place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The piece, in which each control character is a blank.
    pub text: String,
    /// Which of its characters the span holds.
    pub marked: std::ops::Range<usize>,
}

impl Source {
    fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::of(&self.text))
    }

    /// Number, from 0, of the line of a byte, and the offset at which it begins.
    fn line_of(&self, byte: usize) -> (usize, usize) {
        let starts = &self.index().line_starts;
        let before = starts.partition_point(|&s| s <= byte);
        (before, if before == 0 { 0 } else { starts[before - 1] })
    }

    /// Characters between two bytes.
    fn characters(&self, from: usize, to: usize) -> usize {
        let before = |byte| self.index().characters_before(&self.text, byte);
        before(to).saturating_sub(before(from))
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
        self.sources.push(Source { name: name.to_owned(), text, included_from, index: OnceLock::new() });
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
        let Some(source) = self.sources.get(usize::from(span.source.0)) else {
            return Position { line: 1, column: 1 };
        };
        let start = (span.start as usize).min(source.text.len());
        let (line, line_start) = source.line_of(start);
        Position { line: line + 1, column: 1 + source.characters(line_start, start) }
    }

    /// The line in which a span starts, or `window` characters of it round the span where it is longer.
    pub fn excerpt(&self, span: Span, window: usize) -> Excerpt {
        let Some(source) = self.sources.get(usize::from(span.source.0)) else {
            return Excerpt { text: String::new(), marked: 0..0 };
        };
        let text = &source.text[..];
        let start = (span.start as usize).min(text.len());
        let (_, line_start) = source.line_of(start);
        let mut first = line_start;
        if source.characters(line_start, start) > window * 3 / 4 {
            let starts = (line_start..start).rev().filter(|&i| is_character_start(text[i]));
            first = starts.take(window / 2).last().unwrap_or(start);
        }
        // Four bytes are the longest character.
        let reach = text.len().min(start.saturating_add(4 * window));
        let line_end = start + text[start..reach].iter().take_while(|b| !matches!(b, b'\n' | b'\r')).count();
        let shown = String::from_utf8_lossy(&text[first..line_end]);
        let shown = shown.chars().take(window).map(|c| if is_hidden(c) { ' ' } else { c }).collect();
        let before = characters(&text[first..start]);
        let end = (start + usize::from(span.len)).min(line_end);
        Excerpt { text: shown, marked: before..before + characters(&text[start..end]) }
    }
}

fn is_character_start(byte: u8) -> bool {
    byte & 0xC0 != 0x80
}

/// Characters in a run of (mostly) UTF-8 bytes: every byte that does not continue one.
fn characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| is_character_start(b)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> (SourceMap, SourceId) {
        let mut sources = SourceMap::default();
        let id = sources.add("a.igs", text.as_bytes().into(), None).unwrap();
        (sources, id)
    }

    #[test]
    fn lines_end_as_on_every_system() {
        let (sources, id) = source("a\nb\r\nc\rd");
        let lines: Vec<usize> =
            [0, 2, 5, 7].map(|at| sources.position(Span::new(id, at, at + 1)).line).to_vec();
        assert_eq!(lines, [1, 2, 3, 4]);
        assert_eq!(sources.excerpt(Span::new(id, 5, 6), 100).text, "c");
    }

    #[test]
    fn columns_of_a_long_line_count_characters() {
        let text = "ü".repeat(5000) + "x" + &"ö".repeat(5000);
        let (sources, id) = source(&text);
        let span = Span::new(id, 10_000, 10_001);
        assert_eq!(sources.position(span), Position { line: 1, column: 5001 });
        let excerpt = sources.excerpt(span, 100);
        assert_eq!(excerpt.text.chars().count(), 100);
        assert_eq!(excerpt.text.chars().nth(excerpt.marked.start), Some('x'));
        assert_eq!(excerpt.marked, 50..51);
    }

    #[test]
    fn what_turns_the_writing_is_not_shown() {
        let (sources, id) = source("a\u{202e}b\tc");
        assert_eq!(sources.excerpt(Span::new(id, 0, 1), 100).text, "a b c");
    }
}
