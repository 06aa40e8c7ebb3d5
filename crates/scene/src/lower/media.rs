//! Media by name, built when the first material asks for them.

use super::names::Names;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_scatter::{Medium, MediumId};
use std::collections::HashMap;

/// The name of the medium that fills every scene.
const AIR: &str = "air";

/// All media of a scene, in the order of their precedence.
pub(super) struct MediumTable<'a> {
    names: Names<'a>,
    ids: HashMap<String, MediumId>,
    /// Air, and every medium that was asked for; air stands in for the others.
    media: Vec<Medium>,
    asked_for: Vec<bool>,
}

impl<'a> MediumTable<'a> {
    pub(super) fn new(root: &'a Node, sink: &mut Sink) -> Self {
        let names = Names::new(root, "medium", sink);
        let keyed = |(key, n): (&str, &'a Node)| {
            ((n.int("precedence"), n.span.source, n.span.start), (key.to_owned(), n))
        };
        let mut nodes: Vec<_> = names.entries().map(keyed).collect();
        // Of equal precedence, the one defined later wins: by file, then by place.
        nodes.sort_by_key(|(order, _)| *order);
        let mut table = Self { names, ids: HashMap::new(), media: vec![Medium::AIR], asked_for: vec![false] };
        for (_, (key, node)) in nodes {
            let Some(id) = MediumId::new(table.media.len()) else {
                sink.push(Diagnostic::error(
                    codes::TOO_MANY_MEDIA,
                    node.span,
                    "there are more media than can be told apart: 65535",
                ));
                break;
            };
            table.ids.insert(key, id);
            table.media.push(Medium::AIR);
            table.asked_for.push(false);
        }
        table
    }

    /// The medium of a name; air after reporting that there is none.
    pub(super) fn get(&mut self, name: &str, span: Span, sink: &mut Sink) -> MediumId {
        if self.is_air(name) {
            return MediumId::AIR;
        }
        let Some(node) = self.names.find(name, span, sink) else { return MediumId::AIR };
        let Some(&id) = self.ids.get(self.names.meant(name)) else { return MediumId::AIR };
        let i = id.index();
        if !self.asked_for[i] {
            self.asked_for[i] = true;
            if name == AIR {
                let message = "a medium named air: materials that name it get this one, but the air that fills every scene stays as it is";
                sink.push(Diagnostic::warning(codes::DUPLICATE_NAME, node.span_of("name"), message));
            }
            // Without a kind it is incomplete, which was reported.
            if let Some(medium) = node.alternative().and_then(|kind| Medium::build(kind, sink)) {
                self.media[i] = medium;
            }
        }
        id
    }

    /// Reports a name that no medium has.
    pub(super) fn check_name(&mut self, name: &str, span: Span, sink: &mut Sink) {
        if !self.is_air(name) {
            self.names.find(name, span, sink);
        }
    }

    /// Whether a name is that of the medium that every scene has, unless the scene defines its own.
    fn is_air(&self, name: &str) -> bool {
        name == AIR && !self.ids.contains_key(name)
    }

    /// Media that no material asked for have no effect, whatever they hold.
    pub(super) fn disregard_unused(&self) {
        for (key, node) in self.names.entries() {
            let id = self.ids.get(key);
            if !id.is_some_and(|id| self.asked_for[id.index()]) {
                node.disregard();
            }
        }
    }

    /// All media in the order of their numbers; nothing where no material asked for any.
    pub(super) fn into_arena(self) -> Vec<Medium> {
        if self.asked_for.contains(&true) { self.media } else { vec![] }
    }
}
