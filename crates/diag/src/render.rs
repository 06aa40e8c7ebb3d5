//! Diagnostics as text for people and as JSON for programs.

use crate::shown::{is_hidden, shown};
use crate::source::Excerpt;
use crate::{Diagnostic, Severity, Sink, SourceMap, Span};
use std::borrow::Cow;
use std::fmt::Write as _;

/// How text is decorated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// No escape codes.
    Plain,
    /// ANSI colours.
    Colour,
}

/// Longest part of a source line that is shown; longer ones are cut round the caret.
const LINE_WINDOW: usize = 100;

/// A diagnostic as people read it: position, code, message, the line with a caret, notes and hint.
///
/// ```text
/// scene.igs:41:16: error[E0203]: exponent must be > 0
///    41 |     <exponent>-3</exponent>
///       |               ^^ found -3
/// ```
pub fn to_text(diagnostic: &Diagnostic, sources: &SourceMap, style: Style) -> String {
    let (red, yellow, bold, dim, off) = match style {
        Style::Plain => ("", "", "", "", ""),
        Style::Colour => ("\x1b[1;31m", "\x1b[1;33m", "\x1b[1m", "\x1b[2m", "\x1b[0m"),
    };
    let (word, colour) = match diagnostic.severity {
        Severity::Error => ("error", red),
        Severity::Warning => ("warning", yellow),
        Severity::Note => ("note", bold),
    };
    let mut out = String::new();
    if let Some(span) = diagnostic.span {
        let p = sources.position(span);
        let name = shortened(sources.name(span.source));
        let _ = write!(out, "{bold}{name}:{}:{}:{off} ", p.line, p.column);
    }
    let message = shortened(&diagnostic.message);
    let _ = writeln!(out, "{colour}{word}[{}]{off}: {bold}{message}{off}", diagnostic.code);
    if let Some(span) = diagnostic.span {
        excerpt(&mut out, diagnostic, sources, span, (colour, dim, off));
    } else if let Some(label) = &diagnostic.label {
        let _ = writeln!(out, "  = {}", shortened(label));
    }
    for note in notes(diagnostic) {
        let _ = writeln!(out, "  = note: {}", shortened(&note));
    }
    if let Some(hint) = &diagnostic.hint {
        let _ = writeln!(out, "  = hint: {}", shortened(hint));
    }
    include_chain(&mut out, diagnostic, sources);
    out
}

/// Its notes, and how often it was found again.
fn notes(diagnostic: &Diagnostic) -> impl Iterator<Item = Cow<'_, str>> {
    let again = match diagnostic.repeats {
        0 => None,
        1 => Some(Cow::from("the same was found once more")),
        n => Some(Cow::from(format!("the same was found {n} more times"))),
    };
    diagnostic.notes.iter().map(|note| Cow::from(note.as_str())).chain(again)
}

fn excerpt(
    out: &mut String,
    diagnostic: &Diagnostic,
    sources: &SourceMap,
    span: Span,
    (colour, dim, off): (&str, &str, &str),
) {
    let number = sources.position(span).line;
    let Excerpt { text, marked } = sources.excerpt(span, LINE_WINDOW);
    let carets = marked.len().clamp(1, LINE_WINDOW.saturating_sub(marked.start).max(1));
    let _ = writeln!(out, "{dim}{number:>5} |{off} {}", text.trim_end());
    let _ = write!(out, "{dim}      |{off} {}{colour}{}{off}", " ".repeat(marked.start), "^".repeat(carets));
    match &diagnostic.label {
        Some(label) => {
            let _ = writeln!(out, " {colour}{}{off}", shortened(label));
        }
        None => out.push('\n'),
    }
}

/// Of a long chain of includes so many at each end are shown: where the fault is, and where it all began.
const CHAIN_ENDS: usize = 2;

fn include_chain(out: &mut String, diagnostic: &Diagnostic, sources: &SourceMap) {
    let first = diagnostic.span.and_then(|s| sources.included_from(s.source));
    let chain: Vec<Span> = std::iter::successors(first, |s| sources.included_from(s.source)).collect();
    let hidden = chain.len().saturating_sub(2 * CHAIN_ENDS);
    for (i, span) in chain.iter().enumerate() {
        if hidden > 1 && (CHAIN_ENDS..CHAIN_ENDS + hidden).contains(&i) {
            if i == CHAIN_ENDS {
                let _ = writeln!(out, "  = note: ... through {hidden} more files ...");
            }
            continue;
        }
        let (p, name) = (sources.position(*span), shortened(sources.name(span.source)));
        let _ = writeln!(out, "  = note: included from {name}:{}:{}", p.line, p.column);
    }
}

/// Longest text that is shown as it is: a message, not somebody's path of thousands of letters.
const LONGEST: usize = 500;
/// What is shown of the beginning of a longer one; as much of its end.
const SHOWN: usize = 200;

/// A text without its middle if it is very long, and without what a terminal would act on: names come from files.
fn shortened(text: &str) -> Cow<'_, str> {
    let text = shown(text);
    let length = text.chars().count();
    if length <= LONGEST {
        return text;
    }
    let part = |skip: usize| text.chars().skip(skip).take(SHOWN).collect::<String>();
    format!("{} ... {}", part(0), part(length - SHOWN)).into()
}

/// A diagnostic as one line of JSON.
pub fn to_json(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let mut out = String::from("{");
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let _ = write!(out, "\"severity\":\"{severity}\",\"code\":\"{}\",", diagnostic.code);
    if let Some(span) = diagnostic.span {
        let p = sources.position(span);
        let _ = write!(out, "\"file\":{},", quoted(sources.name(span.source)));
        let _ = write!(out, "\"line\":{},\"column\":{},", p.line, p.column);
    }
    let _ = write!(out, "\"message\":{}", quoted(&diagnostic.message));
    for (key, value) in [("expected", &diagnostic.label), ("hint", &diagnostic.hint)] {
        if let Some(value) = value {
            let _ = write!(out, ",\"{key}\":{}", quoted(value));
        }
    }
    let notes: Vec<String> = notes(diagnostic).map(|n| quoted(&n)).collect();
    let _ = write!(out, ",\"notes\":[{}]}}", notes.join(","));
    out
}

/// How much was found in a file and what it brings in, as one line of JSON to follow the diagnostics.
pub fn summary_to_json(file: &str, sink: &Sink) -> String {
    format!(
        "{{\"summary\":{{\"file\":{},\"errors\":{},\"warnings\":{},\"not_listed\":{}}}}}",
        quoted(file),
        sink.error_count(),
        sink.warning_count(),
        sink.dropped()
    )
}

/// A text as a string of JSON, with its quotation marks.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            // Not only those that must be: such lines are looked at on terminals, too. All are of four digits.
            c if is_hidden(c) => {
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SourceMap;

    fn map() -> (SourceMap, Span) {
        let mut sources = SourceMap::default();
        let text = "<scene>\n\t<größe>-3</größe>\n</scene>\n";
        let main = sources.add("main.igs", b"<include/>".as_slice().into(), None).unwrap();
        let id = sources.add("a.igs", text.as_bytes().into(), Some(Span::new(main, 0, 10))).unwrap();
        let at = text.find("-3").unwrap();
        (sources, Span::new(id, at, at + 2))
    }

    #[test]
    fn text_has_position_line_caret_and_include_chain() {
        let (sources, span) = map();
        let d = Diagnostic::error("E0203", span, "size must be > 0").expected("found -3").hint("use 3");
        let expected = "a.igs:2:9: error[E0203]: size must be > 0\n    2 |  <größe>-3</größe>\n      |         ^^ found -3\n  = hint: use 3\n  = note: included from main.igs:1:1\n";
        assert_eq!(to_text(&d, &sources, Style::Plain), expected);
    }

    #[test]
    fn json_is_escaped() {
        let (sources, span) = map();
        let d = Diagnostic::warning("W0001", span, "a \"b\"\n");
        assert_eq!(
            to_json(&d, &sources),
            "{\"severity\":\"warning\",\"code\":\"W0001\",\"file\":\"a.igs\",\"line\":2,\"column\":9,\"message\":\"a \\\"b\\\"\\u000a\",\"notes\":[]}"
        );
    }

    #[test]
    fn the_summary_counts_everything() {
        let (_, span) = map();
        let mut sink = Sink::new();
        sink.push(Diagnostic::warning("W0001", span, "a"));
        (0..Sink::LIMIT).for_each(|_| sink.push(Diagnostic::error("E0203", span, "b")));
        let expected =
            "{\"summary\":{\"file\":\"a \\\"b\\\".igs\",\"errors\":1000,\"warnings\":1,\"not_listed\":1}}";
        assert_eq!(summary_to_json("a \"b\".igs", &sink), expected);
    }

    #[test]
    fn very_long_texts_and_chains_are_shortened() {
        let mut sources = SourceMap::default();
        let mut from = None;
        for i in 0..30 {
            let id = sources.add(&format!("{i}.igs"), b"<include/>".as_slice().into(), from).unwrap();
            from = Some(Span::new(id, 0, 10));
        }
        let path = "very/long/".repeat(500);
        let d =
            Diagnostic::error("E0302", from, format!("cannot read {path}x: no such file")).note(path.clone());
        let text = to_text(&d, &sources, Style::Plain);
        assert!(text.len() < 1500 && text.contains("error[E0302]: cannot read very/long/"), "{text}");
        assert!(text.contains("ong/x: no such file\n"), "{text}");
        let chain: Vec<&str> =
            text.lines().filter(|l| l.contains("from ") || l.contains("through")).collect();
        let expected = ["from 28.igs", "from 27.igs", "through 25 more", "from 1.igs", "from 0.igs"];
        assert_eq!(chain.len(), expected.len(), "{text}");
        assert!(chain.iter().zip(expected).all(|(line, part)| line.contains(part)), "{chain:?}");
        // Programs get all of it.
        assert!(to_json(&d, &sources).contains(&path));
    }

    #[test]
    fn a_span_outside_its_file_is_harmless() {
        let (sources, span) = map();
        let d = Diagnostic::error("E0001", Span { start: 1_000_000, ..span }, "far away");
        assert!(to_text(&d, &sources, Style::Plain).contains("far away"));
    }
}
