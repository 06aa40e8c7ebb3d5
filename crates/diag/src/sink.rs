//! Diagnostics and where they gather.

use crate::Span;
use std::collections::HashMap;

/// How grave a diagnostic is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Something was ignored or assumed.
    Warning,
    /// The scene cannot be rendered as written.
    Error,
}

/// One finding about a user's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How grave it is.
    pub severity: Severity,
    /// Stable code, such as `E0312`.
    pub code: &'static str,
    /// Where, if it has a place.
    pub span: Option<Span>,
    /// What is wrong.
    pub message: String,
    /// What was expected: printed behind the caret.
    pub label: Option<String>,
    /// Further facts, a line each.
    pub notes: Vec<String>,
    /// How to mend it.
    pub hint: Option<String>,
    /// How often the same was found again, elsewhere.
    pub repeats: usize,
}

impl Diagnostic {
    fn new(
        severity: Severity,
        code: &'static str,
        span: impl Into<Option<Span>>,
        message: impl Into<String>,
    ) -> Self {
        Self {
            severity,
            code,
            span: span.into(),
            message: message.into(),
            label: None,
            notes: vec![],
            hint: None,
            repeats: 0,
        }
    }

    /// An error at a place.
    pub fn error(code: &'static str, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message)
    }

    /// A warning at a place.
    pub fn warning(code: &'static str, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message)
    }

    /// Says what was expected; printed behind the caret.
    #[must_use]
    pub fn expected(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Adds a further fact.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Says how to mend it.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

/// Gathers diagnostics. Holds at most [`Sink::LIMIT`] of them and counts the rest, so that a
/// hostile file cannot fill the memory.
#[derive(Clone, Debug, Default)]
pub struct Sink {
    diagnostics: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
    dropped: usize,
    /// Where those stand that are told once and counted: by code and message.
    counted: HashMap<(&'static str, String), usize>,
}

impl Sink {
    /// How many diagnostics are kept.
    pub const LIMIT: usize = 1000;

    /// An empty sink.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        self.warnings += usize::from(diagnostic.severity == Severity::Warning);
        if self.diagnostics.len() < Self::LIMIT {
            self.diagnostics.push(diagnostic);
        } else {
            self.dropped += 1;
        }
    }

    /// Takes a diagnostic that may be true of thousands of places: of those with the same words the first is kept, and the
    /// others are counted in its [`repeats`](Diagnostic::repeats).
    pub fn push_or_count(&mut self, diagnostic: Diagnostic) {
        let key = (diagnostic.code, diagnostic.message.clone());
        if let Some(first) = self.counted.get(&key).and_then(|&i| self.diagnostics.get_mut(i)) {
            first.repeats += 1;
            return;
        }
        let place = self.diagnostics.len();
        self.push(diagnostic);
        if self.diagnostics.len() > place {
            self.counted.insert(key, place);
        }
    }

    /// Whether an error was taken.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// How many errors were taken.
    pub fn error_count(&self) -> usize {
        self.errors
    }

    /// How many warnings were taken.
    pub fn warning_count(&self) -> usize {
        self.warnings
    }

    /// How many diagnostics were not kept.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The diagnostics in the order of their arrival.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
}
