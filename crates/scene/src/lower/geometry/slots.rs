//! Which materials the slots of a placed mesh have.

use super::{MaterialTable, Mesh};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};

/// Names of the materials of a placed mesh and where they are named: those of the model itself, by their order in the mesh's
/// file, before those of the mesh.
pub(super) fn slot_names(node: &Node, mesh: &Mesh, sink: &mut Sink) -> Vec<(String, Span)> {
    let mut slots = mesh.slots.clone();
    // Mesh lights have no such list.
    let may_list = node.block.declares("materials");
    let Some(list) = (if may_list { node.node("materials") } else { None }) else { return slots };
    let own: Vec<(String, Span)> =
        list.texts("material_name").map(|name| (name.value.to_owned(), name.span)).collect();
    let mut missing = None;
    for (i, slot) in slots.iter_mut().enumerate() {
        let number = mesh.slot_numbers.get(i).map_or(i, |number| *number as usize);
        match own.get(number) {
            Some(own) => slot.clone_from(own),
            None => missing = missing.max(Some(number)),
        }
    }
    if let Some(number) = missing {
        let (needed, lists) = (number + 1, own.len());
        sink.push(
            Diagnostic::warning(
                codes::MATERIAL_COUNT,
                list.span,
                format!("the mesh has {needed} materials, and <materials> lists {lists}"),
            )
            .note("the others are those that the mesh names"),
        );
    }
    slots
}

/// Slots by their materials. What several slots have in common is one lamp: its flux is that of all of them.
pub(super) fn by_material(lit: &[u32], names: &[String], materials: &MaterialTable) -> Vec<Vec<u32>> {
    let mut groups: Vec<Vec<u32>> = vec![];
    for &slot in lit {
        let is_of =
            |group: &&mut Vec<u32>| materials.is_same(&names[group[0] as usize], &names[slot as usize]);
        match groups.iter_mut().find(is_of) {
            Some(group) => group.push(slot),
            None => groups.push(vec![slot]),
        }
    }
    groups
}
