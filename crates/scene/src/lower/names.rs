//! Names defined in a scene, resolved once everything is read.

use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span, nearest};
use std::collections::HashMap;

/// Elements of one kind by name.
pub(super) struct Names<'a> {
    what: &'static str,
    by_name: HashMap<String, &'a Node>,
}

impl<'a> Names<'a> {
    /// The elements `what` of a scene. Where a name is defined twice the last definition counts.
    pub(super) fn new(root: &'a Node, what: &'static str, sink: &mut Sink) -> Self {
        let mut by_name: HashMap<String, &Node> = HashMap::new();
        for node in root.nodes(what) {
            let name = node.text("name");
            if let Some(before) = by_name.insert(name.value.clone(), node) {
                before.disregard();
                sink.push(Diagnostic::warning(
                    codes::DUPLICATE_NAME,
                    name.span,
                    format!("{what} {} is defined more than once; the last definition counts", name.value),
                ));
            }
        }
        Self { what, by_name }
    }

    /// The element of a name; `None` after reporting that there is none.
    pub(super) fn find(&self, name: &str, span: Span, sink: &mut Sink) -> Option<&'a Node> {
        let found = self.by_name.get(name).copied();
        if found.is_none() && !name.is_empty() {
            let mut known: Vec<&str> = self.by_name.keys().map(String::as_str).collect();
            known.sort_unstable();
            let mut d = Diagnostic::error(
                codes::UNKNOWN_NAME,
                span,
                format!("there is no {} named {name}", self.what),
            )
            .expected(format!("expected the name of a <{}>", self.what));
            d.hint = nearest(name, known).map(|n| format!("did you mean {n}?"));
            sink.push(d);
        }
        found
    }

    /// All elements.
    pub(super) fn nodes(&self) -> impl Iterator<Item = &'a Node> {
        self.by_name.values().copied()
    }
}
