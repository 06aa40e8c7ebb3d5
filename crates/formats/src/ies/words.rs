//! The words of a photometric file, with their places.

use crate::error::{FormatError, Position};

/// What the lines up to the numbers say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Whether the file is of the edition of 2019.
    pub is_of_2019: bool,
    pub tilt: Tilt,
    /// Where the line `TILT=` stands.
    pub tilt_place: Position,
}

/// Factors for the lamp's tilt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Tilt {
    None,
    /// They stand before the numbers.
    Included,
    /// They stand in another file.
    File(String),
}

/// The numbers that follow the header.
pub(super) struct Words<'a> {
    text: &'a str,
    line_end: char,
    line: usize,
    /// Where the unread text begins in its line.
    column: usize,
    /// Where the last number stands.
    pub place: Position,
}

impl<'a> Words<'a> {
    /// The header, and what follows its line `TILT=`.
    pub fn after_header(bytes: &'a [u8]) -> Result<(Header, Self), FormatError> {
        let at = |line: usize| Position::Text { line, column: 1 };
        // By the mark of UTF-16, or the zero that it has beside every plain letter.
        if matches!(bytes, [0xFE, 0xFF, ..] | [0xFF, 0xFE, ..] | [0, ..] | [_, 0, ..]) {
            return Err(FormatError::new(at(1), "a text in ASCII or UTF-8", "UTF-16, or no text"));
        }
        // Some systems of old end lines by a carriage return alone.
        let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        let mut is_of_2019 = false;
        // Labels may be in any encoding; the numbers behind them are plain, or they are refused below.
        let mut start = 0;
        for (i, line) in bytes.split(|&b| b == line_end).enumerate() {
            let end = (start + line.len() + 1).min(bytes.len());
            let label = String::from_utf8_lossy(line);
            let label = label.trim_start_matches('\u{FEFF}').trim();
            let capitals = label.to_ascii_uppercase();
            is_of_2019 |= i == 0 && capitals.contains("LM-63-2019");
            if let Some(tilt) = capitals.strip_prefix("TILT").map(str::trim_start)
                && let Some(tilt) = tilt.strip_prefix('=')
            {
                let tilt = match tilt.trim() {
                    "" => {
                        let expected = "TILT=NONE, TILT=INCLUDE or the name of a file";
                        return Err(FormatError::new(at(i + 1), expected, quoted(label)));
                    }
                    "NONE" => Tilt::None,
                    "INCLUDE" => Tilt::Included,
                    _ => Tilt::File(label.split_once('=').map_or("", |(_, name)| name.trim()).to_owned()),
                };
                let rest = bytes.get(end..).unwrap_or_default();
                let text = std::str::from_utf8(rest).map_err(|e| {
                    let before = rest.get(..e.valid_up_to()).unwrap_or_default();
                    let line = i + 1 + before.split(|&b| b == line_end).count();
                    FormatError::new(at(line), "numbers", "bytes that are no text")
                })?;
                let header = Header { is_of_2019, tilt, tilt_place: at(i + 1) };
                let words =
                    Self { text, line_end: line_end.into(), line: i + 2, column: 1, place: at(i + 2) };
                return Ok((header, words));
            }
            start = end;
        }
        let lines = bytes.split(|&b| b == line_end).count();
        Err(FormatError::new(at(lines), "a line TILT=NONE or TILT=INCLUDE", "the end of the file"))
    }

    /// The next number, if it is as it must be; `what` it is and `how` it must be, in words.
    pub fn number(
        &mut self,
        what: &str,
        how: &str,
        is_right: impl Fn(f64) -> bool,
    ) -> Result<f64, FormatError> {
        let (word, place) = self.next();
        self.place = place;
        let value = word.parse::<f64>().ok().filter(|v| v.is_finite() && is_right(*v));
        value.ok_or_else(|| {
            let found = if word.is_empty() { "the end of the file".to_owned() } else { quoted(word) };
            FormatError::new(place, format!("{what}: {how}"), found)
        })
    }

    /// The next number, a count from `least` to as many as there are bytes left.
    pub fn count(&mut self, what: &str, least: usize) -> Result<usize, FormatError> {
        let most = self.text.len();
        let how = format!("a whole number from {least} up, with as many numbers to follow");
        let value = self.number(what, &how, |v| v.fract() == 0.0 && v >= least as f64 && v <= most as f64)?;
        Ok(value as usize)
    }

    /// Nothing may follow; `after` what, in words.
    pub fn end(&mut self, after: &str) -> Result<(), FormatError> {
        let (word, place) = self.next();
        // DOS closed texts by a control character.
        if word.trim_matches('\u{1A}').is_empty() {
            return Ok(());
        }
        let expected = format!("the end of the file after {after} (commas part numbers)");
        Err(FormatError::new(place, expected, quoted(word)))
    }

    /// The next word, empty at the end, and its place.
    fn next(&mut self) -> (&'a str, Position) {
        let is_between = |c: char| c.is_whitespace() || c == ',';
        let start = self.text.find(|c| !is_between(c)).unwrap_or(self.text.len());
        let (skipped, rest) = self.text.split_at(start);
        for c in skipped.chars() {
            (self.line, self.column) =
                if c == self.line_end { (self.line + 1, 1) } else { (self.line, self.column + 1) };
        }
        let place = Position::Text { line: self.line, column: self.column };
        let (word, rest) = rest.split_at(rest.find(is_between).unwrap_or(rest.len()));
        self.column += word.chars().count();
        self.text = rest;
        (word, place)
    }
}

/// The first of a text, in quotation marks.
fn quoted(text: &str) -> String {
    const MOST: usize = 40;
    let short: String = text.chars().take(MOST).collect();
    format!("'{short}'")
}
