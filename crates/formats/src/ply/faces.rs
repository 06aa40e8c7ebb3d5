//! The element `face`.

use super::header::{Element, Kind, Scalar};
use super::values::Values;
use super::{list_length, skip_property};
use crate::builder::MeshBuilder;
use crate::error::FormatError;

pub(super) fn read<V: Values>(
    element: &Element,
    values: &mut V,
    builder: &mut MeshBuilder,
) -> Result<(), FormatError> {
    let indices = element.find(&["vertex_indices", "vertex_index"]);
    let vertices = builder.mesh.positions.len();
    let material = builder.material("default");
    // What the file can hold of triangles at most: a checked count of rows, each at least a few bytes long.
    let triangles = (element.count as usize).min(values.remaining() / 4);
    builder.mesh.triangles.reserve(triangles);
    builder.mesh.triangle_materials.reserve(triangles);
    let mut corners = Vec::new();
    for _ in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::List { count, item } if Some(i) == indices => {
                    read_corners(count, item, vertices, values, &mut corners)?;
                    builder.polygon(&corners, material);
                }
                kind => skip_property(kind, values)?,
            }
        }
    }
    Ok(())
}

fn read_corners<V: Values>(
    count: Scalar,
    item: Scalar,
    vertices: usize,
    values: &mut V,
    corners: &mut Vec<u32>,
) -> Result<(), FormatError> {
    let length = list_length(count, item, values)?;
    corners.clear();
    corners.reserve(length);
    for _ in 0..length {
        let at = values.offset();
        let index = values.integer(item)?;
        if index < 0 || index as u64 >= vertices as u64 {
            let expected = format!("the index of a vertex, of which there are {vertices}");
            return Err(values.error_at(at, &expected, &index.to_string()));
        }
        corners.push(index as u32);
    }
    Ok(())
}
