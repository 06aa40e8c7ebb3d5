//! Source positions and diagnostics.
//!
//! A [`Diagnostic`] says what is wrong in a user's file, where, what was expected, and how to mend
//! it. Readers push diagnostics into a [`Sink`] and go on: one run reports every fault of a scene.
//! This crate knows no file format, opens no file and prints nothing.

mod render;
mod shown;
mod sink;
mod source;
mod suggest;

pub use render::{Style, quoted, summary_to_json, to_json, to_text};
pub use shown::{is_hidden, shown};
pub use sink::{Diagnostic, Severity, Sink};
pub use source::{Excerpt, Position, SourceId, SourceMap, Span, Spanned};
pub use suggest::{Candidates, nearest};
