//! Scales and profiles of models that scale nothing.

use super::materials::MaterialTable;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};

/// Reports what scales a material that emits nothing, or that no such material is there: it has no effect. Those that had
/// one have been read.
pub(super) fn report_idle(root: &Node, materials: &mut MaterialTable, sink: &mut Sink) {
    for model in root.nodes("model") {
        for field in ["emission_scale", "ies_profile"] {
            for node in model.nodes(field) {
                let name = node.text("material_name");
                if materials.kind_of(&name.value).is_some() && materials.emission(&name.value, sink).is_none()
                {
                    node.disregard();
                    let message = format!("<{field}> has no effect: {} emits nothing", name.value);
                    sink.push_or_count(Diagnostic::warning(codes::IDLE_SCALE, name.span, message));
                }
            }
        }
    }
}
