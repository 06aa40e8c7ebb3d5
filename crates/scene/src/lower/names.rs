//! Names defined in a scene, resolved once everything is read.

use crate::codes;
use indigo_decl::{Node, UID};
use indigo_diag::{Candidates, Diagnostic, Sink, Span};
use std::collections::{HashMap, HashSet};

/// Elements of one kind by name.
///
/// Each is known by a key: its name or, where another of that name is meant by it, a reference by its uid.
pub(super) struct Names<'a> {
    what: &'static str,
    by_name: HashMap<String, &'a Node>,
    by_uid: HashMap<String, &'a Node>,
    /// Those of another's name, which only their uids mean.
    shadowed: Vec<(String, &'a Node)>,
    /// Names that were looked for in vain, each of which is reported once.
    missed: HashSet<String>,
    /// All names, made ready when the first hint is wanted.
    candidates: Option<Candidates>,
}

/// So many unknown names are compared with all known ones for a hint. Where more are unknown it is not a slip of the
/// pen, and comparing each would take time that grows with the square of the scene.
const MOST_HINTS: usize = 20;

impl<'a> Names<'a> {
    /// The elements `what` of a scene. Where a name or uid is defined twice the last definition counts.
    pub(super) fn new(root: &'a Node, what: &'static str, sink: &mut Sink) -> Self {
        let mut by_name: HashMap<String, &Node> = HashMap::new();
        let mut by_uid: HashMap<String, &Node> = HashMap::new();
        let mut hidden = vec![];
        for node in root.nodes(what) {
            let name = node.text("name");
            if let Some(uid) = node.opt_text("uid")
                && let Some(before) = by_uid.insert(uid.value.clone(), node)
                && before.text("name").value != name.value
            {
                // Of one name it is told below.
                let message = format!("uid {} is of more than one {what}; the last one counts", uid.value);
                sink.push(Diagnostic::warning(codes::DUPLICATE_NAME, uid.span, message));
            }
            if let Some(before) = by_name.insert(name.value.clone(), node) {
                hidden.push(before);
                // Exporters repeat what several objects share.
                if before.says_the_same(node) {
                    continue;
                }
                sink.push(Diagnostic::warning(
                    codes::DUPLICATE_NAME,
                    name.span,
                    format!("{what} {} is defined more than once; the last definition counts", name.value),
                ));
            }
        }
        let key = |node: &'a Node| {
            let uid = node.opt_text("uid")?.value;
            by_uid.get(&uid).is_some_and(|meant| std::ptr::eq(*meant, node)).then(|| format!("{UID}{uid}"))
        };
        let mut shadowed = vec![];
        for node in hidden {
            match key(node) {
                Some(key) => shadowed.push((key, node)),
                None => node.disregard(),
            }
        }
        Self { what, by_name, by_uid, shadowed, missed: HashSet::new(), candidates: None }
    }

    /// The key of what a reference means, which may refer by uid.
    pub(super) fn meant<'n>(&'n self, reference: &'n str) -> &'n str {
        let Some(node) = self.of_uid(reference) else { return reference };
        match self.by_name.get_key_value(&node.text("name").value) {
            Some((name, named)) if std::ptr::eq(*named, node) => name,
            _ => reference,
        }
    }

    /// What a reference by uid means.
    fn of_uid(&self, reference: &str) -> Option<&'a Node> {
        let uid = reference.strip_prefix(UID).filter(|_| !self.by_name.contains_key(reference))?;
        self.by_uid.get(uid).copied()
    }

    /// The element of a name; `None` after reporting that there is none.
    pub(super) fn find(&mut self, name: &str, span: Span, sink: &mut Sink) -> Option<&'a Node> {
        let found = self.get(name);
        if found.is_none() && !name.is_empty() && self.missed.insert(name.to_owned()) {
            let message = format!("there is no {} named {name}", self.what);
            let mut d = Diagnostic::error(codes::UNKNOWN_NAME, span, message)
                .expected(format!("expected the name of a <{}>", self.what));
            d.hint = self.hint(name);
            sink.push(d);
        }
        found
    }

    fn hint(&mut self, name: &str) -> Option<String> {
        if self.missed.len() > MOST_HINTS {
            return None;
        }
        let by_name = &self.by_name;
        let candidates = self.candidates.get_or_insert_with(|| {
            let mut known: Vec<&str> = by_name.keys().map(String::as_str).collect();
            known.sort_unstable();
            Candidates::new(known)
        });
        candidates.nearest(name).map(|n| format!("did you mean {n}?"))
    }

    /// The element of a name, if there is one; nothing is reported.
    pub(super) fn get(&self, name: &str) -> Option<&'a Node> {
        self.of_uid(name).or_else(|| self.by_name.get(name).copied())
    }

    /// All elements that something can mean, with their keys.
    pub(super) fn entries(&self) -> impl Iterator<Item = (&str, &'a Node)> {
        let named = self.by_name.iter().map(|(name, node)| (name.as_str(), *node));
        named.chain(self.shadowed.iter().map(|(key, node)| (key.as_str(), *node)))
    }
}
