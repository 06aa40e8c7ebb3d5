//! Binds elements to their declarations: everything is checked here, once, with places.

use crate::codes;
use crate::element::Element;
use crate::field::{Alternatives, Block, Field, Kind, Presence};
use crate::node::{Content, Node, Slot};
use crate::value::{self, ValueError};
use indigo_diag::{Diagnostic, Severity, Sink, nearest};
use std::cell::Cell;

/// Name of the wrapper that later versions of the format put round constant values.
const CONSTANT: &str = "constant";

/// Binds an element to its declaration.
///
/// Never stops at a fault: whatever is wrong goes to `sink`, and a harmless stand-in takes its place.
pub fn bind(element: Element, block: &'static Block, sink: &mut Sink) -> Node {
    let mut node = Node::new(block, element.span);
    warn_of_attributes(&element, sink);
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
    let mut implied: Vec<Element> = vec![];
    for child in element.children {
        bind_child(child, &mut node, &mut implied, sink);
    }
    bind_implied(implied, &mut node, sink);
    report_missing(&node, sink);
    node
}

fn bind_child(child: Element, node: &mut Node, implied: &mut Vec<Element>, sink: &mut Sink) {
    let block = node.block;
    if let Some(i) = block.fields.iter().position(|f| f.is_called(&child.name)) {
        let field = &block.fields[i];
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
        if field.presence != Presence::Repeated && !node.slots[i].is_empty() {
            sink.push(Diagnostic::warning(
                codes::DUPLICATE_ELEMENT,
                child.span,
                format!("<{}> is given more than once in <{}>; the last one counts", child.name, block.name),
            ));
            node.slots[i].clear();
        }
        if let Some(slot) = bind_field(child, field, sink) {
            node.slots[i].push(slot);
        }
        return;
    }
    if let Some(alternatives) = &block.alternatives {
        if let Some(chosen) = alternatives.blocks.iter().find(|b| b.is_called(&child.name)) {
            if let Some(before) = &node.alternative {
                sink.push(
                    Diagnostic::error(
                        codes::WRONG_ALTERNATIVE,
                        child.span,
                        format!("<{}> has both <{}> and <{}>", block.name, before.block.name, child.name),
                    )
                    .expected(format!("expected exactly one of {}", names(alternatives))),
                );
            }
            node.alternative = Some(Box::new(bind(child, chosen, sink)));
            return;
        }
        if alternatives.implied.is_some_and(|b| b.fields.iter().any(|f| f.is_called(&child.name))) {
            implied.push(child);
            return;
        }
    }
    report_unknown(&child, block, sink);
}

/// Fields of the implied alternative that stand directly in the parent become that alternative.
fn bind_implied(implied: Vec<Element>, node: &mut Node, sink: &mut Sink) {
    let Some(block) = node.block.alternatives.and_then(|a| a.implied) else { return };
    let Some(first) = implied.first() else { return };
    if let Some(chosen) = &node.alternative {
        sink.push(
            Diagnostic::error(
                codes::WRONG_ALTERNATIVE,
                first.span,
                format!(
                    "<{}> belongs to <{}>, but <{}> is given beside it",
                    first.name, block.name, chosen.block.name
                ),
            )
            .expected(format!("expected it inside <{}>", chosen.block.name)),
        );
        return;
    }
    let mut wrapper = Element::new(block.name, node.span);
    wrapper.children = implied;
    node.alternative = Some(Box::new(bind(wrapper, block, sink)));
}

fn bind_field(child: Element, field: &'static Field, sink: &mut Sink) -> Option<Slot> {
    let slot = |span, content| Some(Slot { span, content, read: Cell::new(false) });
    let span = child.span;
    match field.kind {
        Kind::Block(block) => slot(span, Content::Node(Box::new(bind(child, block, sink)))),
        Kind::OneOf(alternatives) => {
            bind_one_of(child, alternatives, sink).and_then(|n| slot(span, Content::Node(Box::new(n))))
        }
        Kind::EmbeddedMesh => {
            let mesh = child.mesh?;
            slot(span, Content::Mesh(mesh))
        }
        _ => {
            let child = unwrap_constant(child, sink);
            warn_of_attributes(&child, sink);
            for inner in &child.children {
                report_unexpected_child(inner, &child.name, sink);
            }
            let (value, error) = value::parse(field, &child.text.value);
            let span = if child.text.value.is_empty() { child.span } else { child.text.span };
            if let Some(error) = error {
                report_value(field, &child, span, error, sink);
            }
            slot(span, Content::Value(value))
        }
    }
}

/// A field that holds exactly one of several blocks, directly or inside `constant`.
fn bind_one_of(child: Element, alternatives: &'static Alternatives, sink: &mut Sink) -> Option<Node> {
    let child = unwrap_constant(child, sink);
    warn_of_attributes(&child, sink);
    let mut found: Option<Node> = None;
    for inner in child.children {
        match alternatives.blocks.iter().find(|b| b.is_called(&inner.name)) {
            Some(block) => {
                if found.is_some() {
                    sink.push(
                        Diagnostic::error(
                            codes::WRONG_ALTERNATIVE,
                            inner.span,
                            format!("<{}> holds more than one element", child.name),
                        )
                        .expected(format!("expected exactly one of {}", names(alternatives))),
                    );
                }
                found = Some(bind(inner, block, sink));
            }
            None => {
                let hint = nearest(&inner.name, alternatives.blocks.iter().map(|b| b.name))
                    .map(|n| format!("did you mean <{n}>?"));
                let mut d = Diagnostic::error(
                    codes::WRONG_ALTERNATIVE,
                    inner.span,
                    format!("<{}> is not {}", inner.name, alternatives.what),
                )
                .expected(format!("expected one of {}", names(alternatives)));
                d.hint = hint;
                sink.push(d);
                return None;
            }
        }
    }
    if found.is_none() && !alternatives.optional {
        sink.push(
            Diagnostic::error(
                codes::WRONG_ALTERNATIVE,
                child.span,
                format!("<{}> holds no element", child.name),
            )
            .expected(format!("expected one of {}", names(alternatives))),
        );
    }
    found
}

fn unwrap_constant(mut child: Element, sink: &mut Sink) -> Element {
    if child.children.len() == 1 && &*child.children[0].name == CONSTANT {
        let mut inner = child.children.remove(0);
        warn_of_attributes(&inner, sink);
        inner.name = child.name;
        return inner;
    }
    child
}

fn names(alternatives: &Alternatives) -> String {
    alternatives.blocks.iter().map(|b| format!("<{}>", b.name)).collect::<Vec<_>>().join(", ")
}

fn report_value(field: &Field, child: &Element, span: indigo_diag::Span, error: ValueError, sink: &mut Sink) {
    let text: String = child.text.value.chars().take(40).collect();
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

fn report_unexpected_child(inner: &Element, parent: &str, sink: &mut Sink) {
    sink.push(
        Diagnostic::warning(
            codes::UNKNOWN_ELEMENT,
            inner.span,
            format!("unknown element <{}> in <{parent}> is ignored", inner.name),
        )
        .expected("expected text only"),
    );
}

fn report_unknown(child: &Element, block: &Block, sink: &mut Sink) {
    if let Some(later) = block.later.iter().find(|l| l.name == &*child.name) {
        sink.push(Diagnostic::warning(
            codes::LATER_ELEMENT,
            child.span,
            format!(
                "<{}> in <{}> is of a later format version ({}) and is ignored",
                child.name, block.name, later.since
            ),
        ));
        return;
    }
    if block.ignored.contains(&&*child.name) {
        sink.push(Diagnostic::warning(
            codes::IGNORED_ELEMENT,
            child.span,
            format!("<{}> in <{}> has no meaning any more and is ignored", child.name, block.name),
        ));
        return;
    }
    let alternatives = block.alternatives.iter().flat_map(|a| a.blocks.iter().map(|b| b.name));
    let known = block.fields.iter().map(|f| f.name).chain(alternatives);
    let mut d = Diagnostic::warning(
        codes::UNKNOWN_ELEMENT,
        child.span,
        format!("unknown element <{}> in <{}> is ignored", child.name, block.name),
    );
    d.hint = nearest(&child.name, known).map(|n| format!("did you mean <{n}>?"));
    sink.push(d);
}

fn warn_of_attributes(element: &Element, sink: &mut Sink) {
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

fn report_missing(node: &Node, sink: &mut Sink) {
    for (field, slots) in node.block.fields.iter().zip(&node.slots) {
        if field.presence == Presence::Required && slots.is_empty() {
            sink.push(
                Diagnostic::error(
                    codes::MISSING_ELEMENT,
                    node.span,
                    format!("<{}> has no <{}>", node.block.name, field.name),
                )
                .expected(format!("expected <{}> inside", field.name)),
            );
        }
    }
    if let Some(alternatives) = &node.block.alternatives
        && node.alternative.is_none()
        && !alternatives.optional
    {
        sink.push(
            Diagnostic::error(
                codes::MISSING_ELEMENT,
                node.span,
                format!("<{}> has no {}", node.block.name, alternatives.what),
            )
            .expected(format!("expected one of {}", names(alternatives))),
        );
    }
}

/// Reports everything that was given but that lowering did not read: it would have no effect.
///
/// Each finding is an error ([`codes::NOT_RENDERED`]) unless `severity` says otherwise.
pub fn report_unread(node: &Node, severity: Severity, sink: &mut Sink) {
    if !node.used.get() {
        push_unread(node.block.name, node.span, severity, sink);
        return;
    }
    for (field, slots) in node.block.fields.iter().zip(&node.slots) {
        for slot in slots {
            match &slot.content {
                Content::Node(inner) if slot.read.get() => report_unread(inner, severity, sink),
                _ if !slot.read.get() => push_unread(field.name, slot.span, severity, sink),
                _ => {}
            }
        }
    }
    if let Some(a) = &node.alternative {
        report_unread(a, severity, sink);
    }
}

fn push_unread(name: &str, span: indigo_diag::Span, severity: Severity, sink: &mut Sink) {
    let mut d = Diagnostic::error(
        codes::NOT_RENDERED,
        span,
        format!("<{name}> is read but not yet rendered by this version"),
    )
    .hint("take it out, or use a later version");
    d.severity = severity;
    sink.push(d);
}
