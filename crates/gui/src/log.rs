//! What was said, and what was found in a scene.

use indigo_diag::{Diagnostic, Severity, Sink, SourceMap, Span, Style, to_text};
use std::sync::Arc;

/// The most lines that are kept; older ones are dropped.
const MOST_LINES: usize = 2000;

/// How much a line matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Something failed.
    Error,
    /// Something to know.
    Warning,
    /// What is done.
    Info,
}

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// How much it matters.
    pub weight: Weight,
    /// What it says.
    pub text: String,
}

/// Lines as they come.
#[derive(Debug, Default)]
pub struct Log {
    lines: std::collections::VecDeque<Line>,
}

impl Log {
    /// Adds a line.
    pub fn add(&mut self, line: Line) {
        if self.lines.len() == MOST_LINES {
            self.lines.pop_front();
        }
        self.lines.push_back(line);
    }

    /// All of them, the oldest first.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = &Line> {
        self.lines.iter()
    }
}

/// Something that was found in the files of a scene.
#[derive(Clone, Debug)]
pub struct Finding {
    /// How much it matters.
    pub weight: Weight,
    /// `file:line:column: message`.
    pub head: String,
    /// All that is known, with the line of the file.
    pub full: String,
    /// Where it is.
    pub span: Option<Span>,
}

/// Everything that was found, errors first.
pub fn findings(sink: &Sink, sources: &SourceMap) -> Vec<Finding> {
    let mut all: Vec<Finding> = sink.diagnostics().iter().map(|d| finding(d, sources)).collect();
    all.sort_by_key(|finding| finding.weight as u8);
    all
}

fn finding(diagnostic: &Diagnostic, sources: &SourceMap) -> Finding {
    let full = to_text(diagnostic, sources, Style::Plain).trim_end().to_owned();
    Finding {
        weight: match diagnostic.severity {
            Severity::Error => Weight::Error,
            Severity::Warning => Weight::Warning,
            Severity::Note => Weight::Info,
        },
        head: full.lines().next().unwrap_or_default().to_owned(),
        full,
        span: diagnostic.span,
    }
}

/// The text of a file round a place, for a view of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceView {
    /// The file.
    pub name: String,
    /// Number of the first line in `lines`, from 1.
    pub first: usize,
    /// Some lines.
    pub lines: Vec<String>,
    /// Number of the line that it is about.
    pub line: usize,
}

impl SourceView {
    /// The lines round a place.
    pub fn of(sources: &Arc<SourceMap>, span: Span) -> Self {
        const ROUND: usize = 12;
        const LONGEST: usize = 400;
        let line = sources.position(span).line;
        let first = line.saturating_sub(ROUND).max(1);
        let text = String::from_utf8_lossy(sources.text(span.source));
        let shorten = |line: &str| line.chars().take(LONGEST).collect::<String>().replace('\t', "    ");
        let lines = text.lines().skip(first - 1).take(2 * ROUND + 1).map(shorten).collect();
        Self { name: sources.name(span.source).to_owned(), first, lines, line }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_lines_go() {
        let mut log = Log::default();
        for i in 0..=MOST_LINES {
            log.add(Line { weight: Weight::Info, text: i.to_string() });
        }
        assert_eq!(log.lines().len(), MOST_LINES);
        assert_eq!(log.lines().next().map(|line| line.text.as_str()), Some("1"));
    }

    #[test]
    fn a_finding_leads_to_its_line() {
        let mut sources = SourceMap::default();
        let text = (1..=40).map(|i| format!("line {i}")).collect::<Vec<_>>().join("\n");
        let at = text.find("line 30").unwrap();
        let id = sources.add("a.igs", text.into_bytes().into(), None).unwrap();
        let mut sink = Sink::new();
        sink.push(Diagnostic::warning("W1", Span::new(id, at, at + 4), "odd"));
        sink.push(Diagnostic::error("E1", Span::new(id, 0, 4), "wrong"));
        let found = findings(&sink, &sources);
        assert_eq!(found[0].weight, Weight::Error);
        assert!(found[1].head.starts_with("a.igs:30:1:"), "{}", found[1].head);
        let view = SourceView::of(&Arc::new(sources), found[1].span.unwrap());
        assert_eq!((view.line, view.first), (30, 18));
        assert_eq!(view.lines[view.line - view.first], "line 30");
    }
}
