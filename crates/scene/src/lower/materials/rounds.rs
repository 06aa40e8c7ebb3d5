//! The order in which materials are built, and materials that lead back to themselves.

use super::{MaterialTable, UvSets, stand_in};
use crate::codes;
use indigo_decl::{Kind, Node};
use indigo_diag::{Diagnostic, Sink, Span, Spanned};
use std::collections::{HashMap, HashSet};

/// So many names of a round are told at its beginning, and at its end.
const NAMES_TOLD: usize = 3;

impl MaterialTable<'_> {
    /// What a material is made of that is not known yet, each after what it is made of itself. Of those that lead back to
    /// themselves this is reported, and from then on grey is known for them.
    pub(super) fn unknown_parts(
        &mut self,
        name: &Spanned<String>,
        uv: UvSets,
        sink: &mut Sink,
    ) -> Vec<Spanned<String>> {
        let mut begun = HashSet::new();
        let mut walk =
            self.walk(name, |name| self.known(name, uv).is_none() && begun.insert(name.to_owned()), sink);
        for name in &walk.leading_back {
            self.add_grey(name);
        }
        walk.order.pop();
        walk.order
    }

    /// Reports materials that nothing uses and that are made of themselves. Those in use were found when built.
    pub(in crate::lower) fn check_unused(&self, sink: &mut Sink) {
        let mut done: HashSet<String> = self.asked_for.clone();
        let mut entries: Vec<(&str, &Node)> = self.names.entries().collect();
        entries.sort_by_key(|(_, n)| (n.span.source, n.span.start));
        for (key, node) in entries {
            let named = Spanned::new(key.to_owned(), node.span_of("name"));
            self.walk(&named, |name| done.insert(name.to_owned()), sink);
        }
    }

    /// Walks down what a material is made of, as far as `begins` says, and reports the names that lead back up.
    fn walk(&self, first: &Spanned<String>, mut begins: impl FnMut(&str) -> bool, sink: &mut Sink) -> Walk {
        // The materials above with their places, and what is left to be looked at of each. A list of our own: a chain of
        // blends can be longer than the thread's stack.
        let mut open: Vec<(Spanned<String>, Vec<Spanned<String>>)> = vec![];
        let mut above: HashMap<String, usize> = HashMap::new();
        let mut walk = Walk::default();
        let mut next = Some(first.clone());
        loop {
            if let Some(name) = next.take()
                && begins(&name.value)
            {
                let mut parts = self.names.get(&name.value).map(constituents).unwrap_or_default();
                parts.reverse();
                for part in &mut parts {
                    part.value = self.names.meant(&part.value).to_owned();
                }
                above.insert(name.value.clone(), open.len());
                open.push((name, parts));
            }
            let Some((_, parts)) = open.last_mut() else { return walk };
            let Some(part) = parts.pop() else {
                if let Some((done, _)) = open.pop() {
                    above.remove(&done.value);
                    walk.order.push(done);
                }
                continue;
            };
            match above.get(&part.value) {
                Some(first) => {
                    let round = open[*first..].iter().map(|(name, _)| name.value.as_str());
                    sink.push(made_of_itself(&part.value, part.span, round));
                    walk.leading_back.push(part.value);
                }
                None => next = Some(part),
            }
        }
    }
}

/// What a walk down a material found.
#[derive(Default)]
struct Walk {
    /// Materials, each after those that it is made of.
    order: Vec<Spanned<String>>,
    /// Materials that lead back to themselves.
    leading_back: Vec<String>,
}

/// The materials that a material is made of, or the one that stands in for it.
fn constituents(node: &Node) -> Vec<Spanned<String>> {
    let Some(kind) = node.alternative() else { return vec![] };
    if let Some(other) = stand_in(kind) {
        return vec![other];
    }
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
