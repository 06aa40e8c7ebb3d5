//! A cursor over text: words, numbers, and the line and column of an error, which is only counted out when one occurs.

use crate::error::{FormatError, Position};

/// The longest piece of a file that an error message quotes, in bytes.
const QUOTE_LIMIT: usize = 24;

/// A text under reading; bytes need not be valid UTF-8.
#[derive(Clone)]
pub(crate) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Text<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    pub(crate) fn remaining(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    pub(crate) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    pub(crate) fn advance(&mut self) {
        self.at += 1;
    }

    /// Whether the line, or the file, ends here.
    pub(crate) fn at_line_end(&self) -> bool {
        matches!(self.peek(), None | Some(b'\n' | b'\r'))
    }

    /// The length of a line continuation (`\` and a line end) at this place, or 0.
    fn continuation(&self) -> usize {
        match self.bytes.get(self.at..) {
            Some([b'\\', b'\r', b'\n', ..]) => 3,
            Some([b'\\', b'\n' | b'\r', ..]) => 2,
            _ => 0,
        }
    }

    /// Skips blanks and continued line ends, staying on the (logical) line.
    pub(crate) fn skip_blanks(&mut self) {
        loop {
            match self.peek() {
                Some(b' ' | b'\t') => self.at += 1,
                Some(b'\\') if self.continuation() > 0 => self.at += self.continuation(),
                _ => return,
            }
        }
    }

    /// Skips blanks and line ends of every kind.
    pub(crate) fn skip_space(&mut self) {
        while self.peek().is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    /// The characters up to the next blank, line end or continuation; empty where none stand.
    pub(crate) fn word(&mut self) -> &'a [u8] {
        let start = self.at;
        while let Some(byte) = self.peek() {
            if byte <= b' ' || (byte == b'\\' && self.continuation() > 0) {
                break;
            }
            self.at += 1;
        }
        self.bytes.get(start..self.at).unwrap_or_default()
    }

    /// The rest of the logical line without the blanks around it; the cursor stays before the line end.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        while !self.at_line_end() {
            self.at += self.continuation().max(1);
        }
        self.bytes.get(start..self.at).unwrap_or_default().trim_ascii()
    }

    /// Goes to the start of the next logical line.
    pub(crate) fn next_line(&mut self) {
        while !self.at_line_end() {
            self.at += self.continuation().max(1);
        }
        match self.bytes.get(self.at..) {
            Some([b'\r', b'\n', ..]) => self.at += 2,
            Some([_, ..]) => self.at += 1,
            _ => {}
        }
    }

    /// What stands between two offsets; empty where it is not UTF-8.
    pub(crate) fn between(&self, start: usize, end: usize) -> &'a str {
        self.bytes.get(start..end).and_then(|bytes| std::str::from_utf8(bytes).ok()).unwrap_or_default()
    }

    /// The next word as a number, which need not be finite.
    pub(crate) fn number<T: std::str::FromStr>(&mut self, expected: &str) -> Result<T, FormatError> {
        let start = self.at;
        let word = self.word();
        let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        parsed.ok_or_else(|| self.error_at(start, expected))
    }

    /// The next word as a finite number.
    pub(crate) fn finite(&mut self, expected: &str) -> Result<f32, FormatError> {
        let start = self.at;
        let value: f32 = self.number(expected)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error_at(start, &format!("{expected} that is finite")))
        }
    }

    /// An error here that quotes what stands here.
    pub(crate) fn error(&self, expected: &str) -> FormatError {
        self.error_at(self.at, expected)
    }

    /// An error at `offset` that quotes what stands there.
    pub(crate) fn error_at(&self, offset: usize, expected: &str) -> FormatError {
        FormatError::new(self.position(offset), expected, self.quote(offset))
    }

    /// An error at `offset` with words of its own.
    pub(crate) fn error_saying(&self, offset: usize, expected: &str, found: &str) -> FormatError {
        FormatError::new(self.position(offset), expected, found)
    }

    /// Line and column of a byte offset.
    pub(crate) fn position(&self, offset: usize) -> Position {
        let before = self.bytes.get(..offset).unwrap_or(self.bytes);
        // A line ends with LF, CR LF, or a CR alone.
        let ends_line =
            |i: usize, byte: u8| byte == b'\n' || (byte == b'\r' && before.get(i + 1) != Some(&b'\n'));
        let mut line = 1;
        let mut line_start = 0;
        for (i, &byte) in before.iter().enumerate() {
            if ends_line(i, byte) {
                line += 1;
                line_start = i + 1;
            }
        }
        let in_line = before.get(line_start..).unwrap_or_default();
        // UTF-8 continuation bytes (10xxxxxx) start no character.
        let column = 1 + in_line.iter().filter(|&&byte| byte & 0xC0 != 0x80).count();
        Position::Text { line, column }
    }

    fn quote(&self, offset: usize) -> String {
        let Self { bytes, .. } = self;
        let rest = bytes.get(offset..).unwrap_or_default();
        let Some(first) = rest.first() else {
            return "the end of the file".to_owned();
        };
        if matches!(first, b'\n' | b'\r') {
            return "the end of the line".to_owned();
        }
        let word_end = rest.iter().skip(1).position(|&b| b <= b' ').map_or(rest.len(), |i| i + 1);
        let shown = rest.get(..word_end.min(QUOTE_LIMIT)).unwrap_or_default();
        let dots = if word_end > QUOTE_LIMIT { "..." } else { "" };
        format!("'{}{dots}'", String::from_utf8_lossy(shown).escape_debug())
    }
}

/// A name from a file as scene files have it: in UTF-8 or else Latin-1, without blanks at its ends.
pub(crate) fn name(bytes: &[u8]) -> String {
    let in_latin1 = || bytes.iter().map(|&byte| char::from(byte)).collect();
    let name = std::str::from_utf8(bytes).map_or_else(|_| in_latin1(), str::to_owned);
    name.trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_scenes_are() {
        for (bytes, read) in [
            (&b"Metal "[..], "Metal"),
            (" gr\u{fc}n".as_bytes(), "gr\u{fc}n"),
            (b"gr\xfcn", "gr\u{fc}n"),
            (b"a  b", "a  b"),
        ] {
            assert_eq!(name(bytes), read);
        }
    }

    fn position(text: &str, offset: usize) -> (usize, usize) {
        match Text::new(text.as_bytes(), 0).position(offset) {
            Position::Text { line, column } => (line, column),
            other => panic!("a text position, not {other:?}"),
        }
    }

    #[test]
    fn counts_lines_of_every_ending_and_columns_in_characters() {
        assert_eq!(position("ab\ncd", 4), (2, 2));
        assert_eq!(position("ab\r\ncd", 5), (2, 2));
        assert_eq!(position("ab\rcd", 4), (2, 2));
        assert_eq!(position("€ x", 4), (1, 3));
        assert_eq!(position("ab", 99), (1, 3));
    }

    #[test]
    fn a_continuation_joins_lines() {
        let mut text = Text::new(b"f 1 \\\n  2\\\r\n3\nv", 0);
        assert_eq!(text.word(), b"f");
        for expected in [b"1", b"2", b"3"] {
            text.skip_blanks();
            assert_eq!(text.word(), expected);
        }
        assert!(text.at_line_end());
        text.next_line();
        assert_eq!(text.word(), b"v");
    }

    #[test]
    fn errors_quote_the_offending_word() {
        let mut text = Text::new(b"1.5 x\x7Fyz nan", 0);
        assert_eq!(text.finite("a number"), Ok(1.5));
        text.skip_blanks();
        let error = text.finite("a number").unwrap_err();
        assert_eq!(error.to_string(), "1:5: expected a number, found 'x\\u{7f}yz'");
        let mut text = Text::new(b"nan", 0);
        assert!(text.finite("a number").unwrap_err().to_string().contains("that is finite"));
    }
}
