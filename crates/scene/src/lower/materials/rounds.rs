//! Materials that lead back to themselves, or go too deep.

use super::MaterialTable;
use crate::codes;
use indigo_decl::{Kind, Node};
use indigo_diag::{Diagnostic, Sink, Span, Spanned};
use indigo_scatter::materials::blend;
use std::collections::{HashMap, HashSet};

/// So many names of a round are told at its beginning, and at its end.
const NAMES_TOLD: usize = 3;

impl MaterialTable<'_> {
    /// Whether a material may be begun: not within itself, nor too deep in others.
    pub(super) fn may_open(&mut self, name: &str, node: Option<&Node>, span: Span, sink: &mut Sink) -> bool {
        if let Some(first) = self.open.iter().position(|open| open == name) {
            sink.push(made_of_itself(name, span, self.open[first..].iter().map(String::as_str)));
            return false;
        }
        let is_deep = self.open.len() >= blend::MAX_DEPTH as usize;
        if is_deep && node.is_some_and(|node| !constituents(node).is_empty()) {
            self.report_depth(name, span, sink);
            return false;
        }
        true
    }

    /// What goes too deep may have no end at all. What has been walked through for another one was reported with that.
    fn report_depth(&mut self, name: &str, span: Span, sink: &mut Sink) {
        if self.walked.contains(name) {
            return;
        }
        let errors = sink.error_count();
        let mut walked = std::mem::take(&mut self.walked);
        self.check_round(name, &mut walked, sink);
        self.walked = walked;
        if sink.error_count() == errors {
            let message = format!("blends are nested more than {} deep", blend::MAX_DEPTH);
            let error = Diagnostic::error(codes::BLEND_CYCLE, span, message);
            sink.push(error.expected("expected a tree of blends that is not so deep"));
        }
    }

    /// Reports materials that nothing uses and that are made of themselves. Those in use were found when built.
    pub(in crate::lower) fn check_unused(&self, sink: &mut Sink) {
        let mut done: HashSet<String> = self.asked_for.clone();
        let mut nodes: Vec<&Node> = self.names.nodes().collect();
        nodes.sort_by_key(|n| (n.span.source, n.span.start));
        for node in nodes {
            self.check_round(&node.text("name").value, &mut done, sink);
        }
    }

    /// Walks down what a material is made of, each material once, and reports the names that lead back up.
    fn check_round(&self, first: &str, done: &mut HashSet<String>, sink: &mut Sink) {
        // The materials above with their places, and what is left to be looked at of each. A list of our own: a chain of blends can
        // be longer than the thread's stack.
        let mut open: Vec<(String, Vec<Spanned<String>>)> = vec![];
        let mut above: HashMap<String, usize> = HashMap::new();
        let mut next = Some(first.to_owned());
        loop {
            if let Some(name) = next.take()
                && done.insert(name.clone())
            {
                let mut parts = self.names.get(&name).map(constituents).unwrap_or_default();
                for part in &mut parts {
                    part.value = self.names.meant(&part.value).to_owned();
                }
                above.insert(name.clone(), open.len());
                open.push((name, parts));
            }
            let Some((name, parts)) = open.last_mut() else { return };
            match parts.pop() {
                None => {
                    above.remove(name.as_str());
                    open.pop();
                }
                Some(part) => match above.get(&part.value) {
                    Some(first) => {
                        let round = open[*first..].iter().map(|(name, _)| name.as_str());
                        sink.push(made_of_itself(&part.value, part.span, round));
                    }
                    None => next = Some(part.value),
                },
            }
        }
    }
}

/// The materials that a material is made of.
fn constituents(node: &Node) -> Vec<Spanned<String>> {
    let Some(kind) = node.alternative() else { return vec![] };
    let parts = kind.block.fields.iter().filter(|f| matches!(f.kind, Kind::Reference("material")));
    parts.filter_map(|f| kind.opt_text(f.name)).collect()
}

/// The error of a material that leads back to itself by way of `round`, which begins with it.
fn made_of_itself<'n>(
    name: &'n str,
    span: Span,
    round: impl DoubleEndedIterator<Item = &'n str> + ExactSizeIterator + Clone,
) -> Diagnostic {
    let message = format!("material {name} is made of itself: {}", told(name, round));
    Diagnostic::error(codes::BLEND_CYCLE, span, message)
        .expected("expected a material that is made of others")
}

/// The names of a round back to the first, and of a long one some at both its ends: there may be as many such rounds as they
/// are long.
fn told<'n>(
    first: &'n str,
    round: impl DoubleEndedIterator<Item = &'n str> + ExactSizeIterator + Clone,
) -> String {
    let named = |names: Vec<&str>| names.join(", then ");
    let others = (round.len() + 1).checked_sub(2 * NAMES_TOLD).filter(|others| *others > 1);
    let Some(others) = others else { return named(round.chain([first]).collect()) };
    let start = round.clone().take(NAMES_TOLD).collect();
    let mut end: Vec<&str> = [first].into_iter().chain(round.rev()).take(NAMES_TOLD).collect();
    end.reverse();
    format!("{}, then {others} others, then {}", named(start), named(end))
}
