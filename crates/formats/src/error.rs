//! The one error type of all readers: where, what was expected, what was found.

use std::fmt;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Position {
    /// In a text: line and column, both counted from 1; the column counts characters.
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
    },
    /// In a binary file: the byte's offset from the file's start.
    Byte(usize),
    /// In the decompressed part of a file: the offset from that part's start.
    Unpacked(usize),
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text { line, column } => write!(f, "{line}:{column}"),
            Self::Byte(offset) => write!(f, "byte {offset}"),
            Self::Unpacked(offset) => write!(f, "byte {offset} of the decompressed data"),
        }
    }
}

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{position}: expected {expected}, found {found}")]
pub struct FormatError {
    /// Where the trouble is.
    pub position: Position,
    /// What should have stood there, in words.
    pub expected: String,
    /// What stands there, in words or quoted.
    pub found: String,
}

impl FormatError {
    /// An error at `position`; the two texts complete "expected ..., found ...".
    pub fn new(position: Position, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { position, expected: expected.into(), found: found.into() }
    }
}
