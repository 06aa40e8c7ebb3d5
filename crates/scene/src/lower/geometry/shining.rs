//! Parts of models that shine by their materials.

use super::slots::by_material;
use super::{Geometry, MaterialTable, MeshTable, Part, Placed};
use crate::lower::Context;
use crate::lower::keyframes::warn_of_standing;
use crate::lower::scales::report_idle;
use indigo_decl::Node;

/// A part of a model whose material emits.
pub(in crate::lower) struct EmittingPart<'a> {
    /// Its number among the objects.
    pub(in crate::lower) object: u32,
    /// Its mesh.
    pub(in crate::lower) mesh: u32,
    pub(in crate::lower) model: &'a Node,
    /// Name of the material.
    pub(in crate::lower) material: String,
    /// Names of the mesh's uv sets.
    pub(in crate::lower) uv_names: Vec<(String, u32)>,
}

impl<'a> Geometry<'a> {
    /// Adds the parts of a model whose materials emit, as objects of their own, and returns the slots of these materials.
    pub(super) fn add_shining(
        &mut self,
        node: &'a Node,
        placed: &Placed,
        meshes: &mut MeshTable,
        materials: &mut MaterialTable,
        context: &mut Context,
    ) -> Vec<u32> {
        let count = placed.slots.len() as u32;
        let emits =
            |slot: &u32| materials.emission(&placed.materials[*slot as usize], context.sink).is_some();
        let lit: Vec<u32> = (0..count).filter(emits).collect();
        if !lit.is_empty() && placed.movement.is_some() {
            warn_of_standing(node, "what shines", context.sink);
        }
        let mut shining = vec![];
        for slots in by_material(&lit, &placed.materials, materials) {
            let first = slots[0] as usize;
            // A mesh of one material is its own part.
            let (mesh, own) = if slots.len() as u32 == count {
                (Some(placed.mesh), placed.slots.clone())
            } else {
                (meshes.part(placed.mesh, Part::Of(slots)), vec![placed.slots[first]])
            };
            let Some(mesh) = mesh else { continue };
            let object = self.add(placed.object(mesh), &placed.name, own, None);
            let material = placed.materials[first].clone();
            shining.push(material.clone());
            let uv_names = placed.uv_names.clone();
            self.emitting.push(EmittingPart { object, mesh, model: node, material, uv_names });
        }
        // Of a mesh that is missing nothing is known.
        if !placed.is_stand_in {
            report_idle(node, &shining, materials, context.sink);
        }
        lit
    }
}
