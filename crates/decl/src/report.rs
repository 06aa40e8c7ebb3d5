//! The words of what binding finds.

use crate::bind::did_you_mean;
use crate::codes;
use crate::element::Element;
use crate::field::{Alternatives, Block, Field, Later};
use crate::value::ValueError;
use indigo_diag::{Diagnostic, Severity, Sink, Span, nearest};

pub(crate) fn names(alternatives: &Alternatives) -> String {
    alternatives.blocks.iter().map(|b| format!("<{}>", b.name)).collect::<Vec<_>>().join(", ")
}

pub(crate) fn stray_text(element: &Element, sink: &mut Sink) {
    if !element.text.value.is_empty() {
        sink.push(
            Diagnostic::warning(
                codes::STRAY_TEXT,
                element.text.span,
                format!("text inside <{}> is ignored", element.name),
            )
            .expected("expected elements only"),
        );
    }
}

pub(crate) fn attributes(element: &Element, sink: &mut Sink) {
    for a in &element.attributes {
        // Namespace declarations carry no content.
        if !a.name.value.starts_with("xmlns") {
            sink.push(Diagnostic::warning(
                codes::UNKNOWN_ATTRIBUTE,
                a.name.span,
                format!("attribute {} of <{}> is ignored", a.name.value, element.name),
            ));
        }
    }
}

pub(crate) fn duplicate(child: &Element, parent: &str, sink: &mut Sink) {
    sink.push(Diagnostic::warning(
        codes::DUPLICATE_ELEMENT,
        child.span,
        format!("<{}> is given more than once in <{parent}>; the last one counts", child.name),
    ));
}

pub(crate) fn deprecated(child: &Element, field: &Field, sink: &mut Sink) {
    if !field.deprecated.is_empty() {
        sink.push(
            Diagnostic::warning(
                codes::DEPRECATED_ELEMENT,
                child.span,
                format!("<{}> is deprecated", child.name),
            )
            .hint(field.deprecated),
        );
    }
}

pub(crate) fn value(field: &Field, child: &Element, span: Span, error: ValueError, sink: &mut Sink) {
    let mut text: String = child.text.value.chars().take(40).collect();
    if child.text.value.chars().nth(40).is_some() {
        text.push_str("...");
    }
    let unit = if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
    let found = if text.is_empty() { "found nothing".to_owned() } else { format!("found {text}") };
    sink.push(match error {
        ValueError::Type(expected) => {
            Diagnostic::error(codes::WRONG_TYPE, span, format!("<{}> is not {expected}", child.name))
                .expected(format!("expected {expected}{unit}, {found}"))
        }
        ValueError::Range(words) => {
            Diagnostic::error(codes::OUT_OF_RANGE, span, format!("<{}> {words}{unit}", child.name))
                .expected(found)
        }
    });
}

pub(crate) fn missing(parent: &str, span: Span, field: &Field, sink: &mut Sink) {
    sink.push(
        Diagnostic::error(codes::MISSING_ELEMENT, span, format!("<{parent}> has no <{}>", field.name))
            .expected(format!("expected <{}> inside: {}", field.name, kind_in_words(field))),
    );
}

/// What a field holds: "a number (m)".
fn kind_in_words(field: &Field) -> String {
    let words = field.kind.words();
    if field.unit.is_empty() { words } else { format!("{words} ({})", field.unit) }
}

pub(crate) fn unexpected_child(inner: &Element, parent: &str, sink: &mut Sink) {
    sink.push(
        Diagnostic::warning(
            codes::UNKNOWN_ELEMENT,
            inner.span,
            format!("unknown element <{}> in <{parent}> is ignored", inner.name),
        )
        .expected("expected text only"),
    );
}

pub(crate) fn unknown(child: &Element, parent: &str, block: &Block, sink: &mut Sink) {
    let name = &child.name;
    if block.passed_over.contains(&&**name) {
        return;
    }
    if let Some(later) = block.later.iter().find(|l| l.name == &**name) {
        if !later.is_neutral(&child.text.value) {
            let Later { since, instead, .. } = later;
            sink.push_or_count(Diagnostic::warning(
                codes::LATER_ELEMENT,
                child.span,
                format!("<{name}> in <{parent}> is of a later format version ({since}) and {instead}"),
            ));
        }
        return;
    }
    if block.ignored.contains(&&**name) {
        sink.push(Diagnostic::warning(
            codes::IGNORED_ELEMENT,
            child.span,
            format!("<{name}> in <{parent}> has no meaning any more and is ignored"),
        ));
        return;
    }
    let mut d = Diagnostic::warning(
        codes::UNKNOWN_ELEMENT,
        child.span,
        format!("unknown element <{name}> in <{parent}> is ignored"),
    );
    d.hint = did_you_mean(name, block);
    sink.push(d);
}

pub(crate) fn later_alternative(child: &Element, later: &Later, a: &Alternatives, sink: &mut Sink) {
    let (name, Later { since, .. }, stand_in) = (&child.name, later, a.stand_in);
    let message =
        format!("<{name}> is of a later format version ({since}) and not rendered: {stand_in} stands in");
    sink.push_or_count(Diagnostic::warning(codes::LATER_ELEMENT, child.span, message));
}

pub(crate) fn wrong_alternative(inner: &Element, alternatives: &Alternatives, sink: &mut Sink) {
    let mut d = Diagnostic::error(
        codes::WRONG_ALTERNATIVE,
        inner.span,
        format!("<{}> is not a {}", inner.name, alternatives.what),
    )
    .expected(format!("expected one of {}", names(alternatives)));
    d.hint = nearest(&inner.name, alternatives.blocks.iter().map(|b| b.name))
        .map(|n| format!("did you mean <{n}>?"));
    sink.push(d);
}

pub(crate) fn unread(name: &str, span: Span, severity: Severity, sink: &mut Sink) {
    let mut d = Diagnostic::error(
        codes::NOT_RENDERED,
        span,
        format!("<{name}> is read but not yet rendered by this version"),
    )
    .hint("take it out, or use a later version");
    d.severity = severity;
    sink.push(d);
}
