//! Binds elements to their declarations: everything is checked here, once, with places.

use crate::codes;
use crate::element::Element;
use crate::field::{Alternatives, Block, Field, Group, Kind, Presence};
use crate::node::{Content, Node, Slot};
use crate::parameter;
use crate::report;
use crate::value::{self, Value};
use indigo_diag::{Diagnostic, Severity, Sink, nearest};
use std::cell::Cell;

/// Name of the wrapper that later versions of the format put round constant values.
pub(crate) const CONSTANT: &str = "constant";
/// Names of the elements that hold the value of an even spectrum.
pub(crate) const UNIFORM: &str = "uniform";
pub(crate) const VALUE: &str = "value";

/// Name of the wrapper that some exporters put round a path.
pub(crate) const PATH: &str = "path";

/// What a reference by uid has before the uid, so that it is told from a name.
pub const UID: &str = "uid ";

/// Whether an element refers to something by the uid of later versions of the format.
fn is_uid(name: &str) -> bool {
    name.ends_with("_uid")
}

/// Binds an element to its declaration.
///
/// Never stops at a fault: whatever is wrong goes to `sink`, and a harmless stand-in takes its place.
pub fn bind(element: Element, block: &'static Block, sink: &mut Sink) -> Node {
    let mut node = Node::new(block, element.span);
    report::attributes(&element, sink);
    report::stray_text(&element, sink);
    let name = &element.name;
    let mut implied: Vec<Element> = vec![];
    for child in parameter::settle(element.children, block, sink) {
        bind_child(child, name, &mut node, &mut implied, sink);
    }
    bind_implied(implied, &mut node, sink);
    report_missing(name, &node, sink);
    report_groups(name, &node, sink);
    node
}

fn bind_child(child: Element, parent: &str, node: &mut Node, implied: &mut Vec<Element>, sink: &mut Sink) {
    let block = node.block;
    if let Some(i) = block.fields.iter().position(|f| f.is_called(&child.name)) {
        let field = &block.fields[i];
        report::deprecated(&child, field, sink);
        if field.presence != Presence::Repeated && !node.slots[i].is_empty() {
            // Later exporters write name and uid of the same thing: the one that comes first counts.
            if matches!(field.kind, Kind::Reference(_)) && is_uid(&child.name) {
                return;
            }
            report::duplicate(&child, parent, sink);
            node.slots[i].clear();
        }
        let errors = sink.error_count();
        let slot = bind_field(child, field, sink);
        if slot.is_none() || sink.error_count() > errors {
            node.faulty.push(field.name);
        }
        node.slots[i].extend(slot);
        return;
    }
    if let Some(alternatives) = &block.alternatives {
        if let Some(chosen) = alternatives.blocks.iter().find(|b| b.is_called(&child.name)) {
            bind_alternative(child, parent, node, chosen, alternatives, sink);
            return;
        }
        if let Some(later) = alternatives.later.iter().find(|l| l.name == &*child.name) {
            report::later_alternative(&child, later, alternatives, sink);
            node.alternative_reported = true;
            return;
        }
        if alternatives.implied.is_some_and(|b| b.knows(&child.name)) {
            implied.push(child);
            return;
        }
    }
    report::unknown(&child, parent, block, sink);
}

fn bind_alternative(
    child: Element,
    parent: &str,
    node: &mut Node,
    chosen: &'static Block,
    alternatives: &Alternatives,
    sink: &mut Sink,
) {
    if let Some(before) = &node.alternative {
        sink.push(
            Diagnostic::error(
                codes::WRONG_ALTERNATIVE,
                child.span,
                format!("<{parent}> has both <{}> and <{}>", before.block.name, child.name),
            )
            .expected(format!("expected exactly one of {}", report::names(alternatives))),
        );
    }
    node.alternative = Some(Box::new(bind(child, chosen, sink)));
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
            .expected(format!("expected it inside <{}>", block.name)),
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
        Kind::EmbeddedMesh(_) => {
            let mesh = child.mesh?;
            slot(span, Content::Mesh(mesh))
        }
        _ => {
            let child = unwrap(child, CONSTANT, sink);
            let child = match field.kind {
                Kind::Path => unwrap(child, PATH, sink),
                // As exporters write whatever may have a texture, too: a number as if it were a spectrum.
                Kind::Real if child.child(UNIFORM).is_some() => {
                    unwrap(unwrap(child, UNIFORM, sink), VALUE, sink)
                }
                _ => child,
            };
            report::attributes(&child, sink);
            for inner in &child.children {
                report::unexpected_child(inner, &child.name, sink);
            }
            let (mut value, error) = value::parse(field, &child.text.value);
            if let (Kind::Reference(_), Value::Text(uid)) = (field.kind, &mut value)
                && is_uid(&child.name)
                && !uid.is_empty()
            {
                uid.insert_str(0, UID);
            }
            let span = if child.text.value.is_empty() { child.span } else { child.text.span };
            if let Some(error) = error {
                report::value(field, &child, span, error, sink);
            }
            slot(span, Content::Value(value))
        }
    }
}

/// A field that holds exactly one of several blocks, directly or inside `constant`.
fn bind_one_of(child: Element, alternatives: &'static Alternatives, sink: &mut Sink) -> Option<Node> {
    let child = unwrap(child, CONSTANT, sink);
    report::attributes(&child, sink);
    report::stray_text(&child, sink);
    let mut found: Option<Node> = None;
    for inner in child.children {
        if let Some(block) = alternatives.blocks.iter().find(|b| b.is_called(&inner.name)) {
            if found.is_some() {
                sink.push(
                    Diagnostic::error(
                        codes::WRONG_ALTERNATIVE,
                        inner.span,
                        format!("<{}> holds more than one element", child.name),
                    )
                    .expected(format!("expected exactly one of {}", report::names(alternatives))),
                );
            }
            found = Some(bind(inner, block, sink));
        } else {
            match alternatives.later.iter().find(|l| l.name == &*inner.name) {
                Some(later) => report::later_alternative(&inner, later, alternatives, sink),
                None => report::wrong_alternative(&inner, alternatives, sink),
            }
            return None;
        }
    }
    if found.is_none() && !alternatives.optional {
        sink.push(
            Diagnostic::error(
                codes::WRONG_ALTERNATIVE,
                child.span,
                format!("<{}> holds no element", child.name),
            )
            .expected(format!("expected one of {}", report::names(alternatives))),
        );
    }
    found
}

/// Takes off a wrapper of the given name, if that is all there is inside.
fn unwrap(mut child: Element, wrapper: &str, sink: &mut Sink) -> Element {
    if child.children.len() != 1 || &*child.children[0].name != wrapper {
        return child;
    }
    report::attributes(&child, sink);
    report::stray_text(&child, sink);
    let mut inner = child.children.remove(0);
    inner.name = child.name;
    inner
}

fn report_missing(name: &str, node: &Node, sink: &mut Sink) {
    for (field, slots) in node.block.fields.iter().zip(&node.slots) {
        if field.presence == Presence::Required && slots.is_empty() && !node.faulty.contains(&field.name) {
            report::missing(name, node.span, field, sink);
        }
    }
    if let Some(alternatives) = &node.block.alternatives
        && node.alternative.is_none()
        && !node.alternative_reported
        && !alternatives.optional
    {
        sink.push(
            Diagnostic::error(
                codes::MISSING_ELEMENT,
                node.span,
                format!("<{name}> has no {}", alternatives.what),
            )
            .expected(format!("expected one of {}", report::names(alternatives))),
        );
    }
}

fn report_groups(name: &str, node: &Node, sink: &mut Sink) {
    for Group { fields, exclusive } in node.block.needs {
        let given: Vec<&&str> = fields.iter().filter(|f| node.has(f)).collect();
        let list = fields.iter().map(|f| format!("<{f}>")).collect::<Vec<_>>().join(", ");
        if given.is_empty() && !fields.iter().any(|f| node.faulty.contains(f)) {
            sink.push(
                Diagnostic::error(codes::MISSING_ELEMENT, node.span, format!("<{name}> has none of {list}"))
                    .expected("expected one of them inside"),
            );
        } else if *exclusive && let [first, second, ..] = given[..] {
            sink.push(
                Diagnostic::error(
                    codes::WRONG_ALTERNATIVE,
                    node.span_of(second),
                    format!("<{name}> has both <{first}> and <{second}>"),
                )
                .expected(format!("expected exactly one of {list}")),
            );
        }
    }
}

/// Reports everything that was given but that lowering did not read: it would have no effect.
///
/// Each finding is an error ([`codes::NOT_RENDERED`]) unless `severity` says otherwise.
pub fn report_unread(node: &Node, severity: Severity, sink: &mut Sink) {
    if !node.used.get() {
        report::unread(node.block.name, node.span, severity, sink);
        return;
    }
    for (field, slots) in node.block.fields.iter().zip(&node.slots) {
        for slot in slots {
            match &slot.content {
                Content::Node(inner) if slot.read.get() => report_unread(inner, severity, sink),
                _ if !slot.read.get() => report::unread(field.name, slot.span, severity, sink),
                _ => {}
            }
        }
    }
    if let Some(a) = &node.alternative {
        report_unread(a, severity, sink);
    }
}

/// The name that a misspelt one probably means, among everything that a block knows.
pub(crate) fn did_you_mean(name: &str, block: &Block) -> Option<String> {
    let alternatives = block.alternatives.iter().flat_map(|a| a.blocks.iter().map(|b| b.name));
    let implied =
        block.alternatives.iter().filter_map(|a| a.implied).flat_map(|b| b.fields.iter().map(|f| f.name));
    let parameters = block.parameters.iter().map(|p| p.name);
    let known = block.fields.iter().map(|f| f.name).chain(parameters).chain(alternatives).chain(implied);
    nearest(name, known).map(|n| format!("did you mean <{n}>?"))
}
