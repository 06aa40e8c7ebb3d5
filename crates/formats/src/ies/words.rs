//! The words of a photometric file, with their places.

use crate::error::{FormatError, Position};

/// The numbers that follow the header.
pub(super) struct Words<'a> {
    text: &'a str,
    line: usize,
    /// Where the unread text begins in its line.
    column: usize,
    /// Whether `TILT=INCLUDE` stands before the numbers.
    pub is_tilt_included: bool,
}

impl<'a> Words<'a> {
    /// What follows the line `TILT=`.
    pub fn after_header(bytes: &'a [u8]) -> Result<Self, FormatError> {
        // Labels may be in any encoding; the numbers behind them are plain, or they are refused below.
        let mut start = 0;
        for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
            let end = (start + line.len() + 1).min(bytes.len());
            let label = String::from_utf8_lossy(line);
            let label = label.trim();
            let place = Position::Text { line: i + 1, column: 1 };
            if let Some(tilt) = label.to_ascii_uppercase().strip_prefix("TILT").map(str::trim_start)
                && let Some(tilt) = tilt.strip_prefix('=')
            {
                let is_tilt_included = match tilt.trim() {
                    "NONE" => false,
                    "INCLUDE" => true,
                    _ => return Err(FormatError::new(place, "TILT=NONE or TILT=INCLUDE", quoted(label))),
                };
                let rest = bytes.get(end..).unwrap_or_default();
                let text = std::str::from_utf8(rest).map_err(|e| {
                    let before = rest.get(..e.valid_up_to()).unwrap_or_default();
                    let line = i + 1 + before.split(|&b| b == b'\n').count();
                    FormatError::new(Position::Text { line, column: 1 }, "numbers", "bytes that are no text")
                })?;
                return Ok(Self { text, line: i + 2, column: 1, is_tilt_included });
            }
            start = end;
        }
        let lines = bytes.split(|&b| b == b'\n').count();
        let end = Position::Text { line: lines, column: 1 };
        Err(FormatError::new(end, "a line TILT=NONE or TILT=INCLUDE", "the end of the file"))
    }

    /// The next number, if it is as it must be; `what` it is and `how` it must be, in words.
    pub fn number(
        &mut self,
        what: &str,
        how: &str,
        is_right: impl Fn(f64) -> bool,
    ) -> Result<f64, FormatError> {
        let (word, place) = self.next();
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

    /// The next word, empty at the end, and its place.
    fn next(&mut self) -> (&'a str, Position) {
        let is_between = |c: char| c.is_whitespace() || c == ',';
        let start = self.text.find(|c| !is_between(c)).unwrap_or(self.text.len());
        let (skipped, rest) = self.text.split_at(start);
        for c in skipped.chars() {
            (self.line, self.column) =
                if c == '\n' { (self.line + 1, 1) } else { (self.line, self.column + 1) };
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
