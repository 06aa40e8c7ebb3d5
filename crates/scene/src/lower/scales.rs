//! Scales and profiles of models that scale nothing.

use super::materials::MaterialTable;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};

/// Reports scales and profiles of a model that are of none of the materials by which it shines: they have no effect.
/// Exporters write them for every material that they list, also for those that no face has.
pub(super) fn report_idle(model: &Node, shining: &[String], materials: &mut MaterialTable, sink: &mut Sink) {
    for field in ["emission_scale", "ies_profile"] {
        for node in model.nodes(field) {
            let name = node.text("material_name");
            if shining.iter().any(|shines| materials.is_same(shines, &name.value)) {
                continue;
            }
            node.disregard();
            // A name that is not there is reported with all others.
            if materials.kind_of(&name.value).is_none() {
                continue;
            }
            let why = match materials.emission(&name.value, sink) {
                Some(_) => "is on no triangle of this model",
                None => "emits nothing",
            };
            let message = format!("<{field}> has no effect: {} {why}", name.value);
            sink.push_or_count(Diagnostic::warning(codes::IDLE_SCALE, name.span, message));
        }
    }
}
