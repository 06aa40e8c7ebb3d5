//! Diagnostics of one embedded mesh, which may be wrong a million times in the same way.

use crate::codes;
use indigo_decl::codes as decl_codes;
use indigo_diag::{Diagnostic, Sink, Span};

/// So many errors of one mesh are listed; the others are counted.
const MOST_ERRORS: usize = 20;
/// So many different unknown names of one mesh are listed.
const MOST_NAMES: usize = 20;

pub(super) struct Reporter<'s> {
    pub sink: &'s mut Sink,
    errors: usize,
    /// What was warned of already, element and name.
    seen: Vec<String>,
}

impl<'s> Reporter<'s> {
    pub fn new(sink: &'s mut Sink) -> Self {
        Self { sink, errors: 0, seen: vec![] }
    }

    pub fn error(
        &mut self,
        code: &'static str,
        span: Span,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        self.errors += 1;
        if self.errors <= MOST_ERRORS {
            self.sink.push(Diagnostic::error(code, span, message).expected(expected));
        }
    }

    pub fn warning(&mut self, code: &'static str, span: Span, message: String) {
        self.sink.push(Diagnostic::warning(code, span, message));
    }

    pub fn unknown_element(&mut self, name: &str, parent: &str, span: Span) {
        if self.is_new(format!("<{parent}> <{name}>")) {
            let message = format!("unknown element <{name}> in <{parent}> is ignored");
            self.warning(decl_codes::UNKNOWN_ELEMENT, span, message);
        }
    }

    pub fn unknown_attribute(&mut self, name: &str, element: &str, span: Span) {
        if self.is_new(format!("<{element} {name}>")) {
            let message = format!("attribute {name} of <{element}> is ignored");
            self.warning(decl_codes::UNKNOWN_ATTRIBUTE, span, message);
        }
    }

    pub fn stray_text(&mut self, element: &str, span: Span) {
        if self.is_new(format!("<{element}>")) {
            self.warning(decl_codes::STRAY_TEXT, span, format!("text inside <{element}> is ignored"));
        }
    }

    fn is_new(&mut self, what: String) -> bool {
        let new = self.seen.len() < MOST_NAMES && !self.seen.contains(&what);
        if new {
            self.seen.push(what);
        }
        new
    }

    /// Says how many errors were not listed.
    pub fn finish(self, mesh: Span) {
        if self.errors > MOST_ERRORS {
            let more = self.errors - MOST_ERRORS;
            self.sink.push(Diagnostic::error(
                codes::MORE_ERRORS,
                mesh,
                format!("and {more} more errors in this mesh"),
            ));
        }
    }
}
