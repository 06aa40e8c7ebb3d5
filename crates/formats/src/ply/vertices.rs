//! The element `vertex`.

use super::header::{Element, Kind};
use super::skip_property;
use super::values::Values;
use crate::builder::MeshBuilder;
use crate::error::FormatError;

/// Names of the properties that are read, by their slot in a row: three coordinates, three of the normal, two of the texture.
const SLOTS: [&[&str]; 8] =
    [&["x"], &["y"], &["z"], &["nx"], &["ny"], &["nz"], &["u", "s", "texture_u"], &["v", "t", "texture_v"]];
const NORMAL: usize = 3;
const UV: usize = 6;

pub(super) fn read<V: Values>(
    element: &Element,
    values: &mut V,
    builder: &mut MeshBuilder,
) -> Result<(), FormatError> {
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|p| match p.kind {
            Kind::Scalar(_) => SLOTS.iter().position(|names| names.contains(&p.name.as_str())),
            Kind::List { .. } => None,
        })
        .collect();
    let has = |slot: usize| slots.contains(&Some(slot));
    let with_normals = (NORMAL..UV).all(has);
    let with_uvs = (UV..SLOTS.len()).all(has);
    // The count was checked against the file's size.
    let count = element.count as usize;
    let mesh = &mut builder.mesh;
    mesh.positions.reserve_exact(count);
    mesh.normals.reserve_exact(if with_normals { count } else { 0 });
    let mut uvs = Vec::with_capacity(if with_uvs { count } else { 0 });
    for _ in 0..count {
        let [x, y, z, nx, ny, nz, u, v] = read_row(element, &slots, values)?;
        mesh.positions.push([x, y, z]);
        if with_normals {
            mesh.normals.push([nx, ny, nz]);
        }
        if with_uvs {
            uvs.push([u, v]);
        }
    }
    if with_uvs {
        mesh.uv_sets.push(uvs);
        mesh.uv_names.push(("default".to_owned(), 0));
    }
    Ok(())
}

fn read_row<V: Values>(
    element: &Element,
    slots: &[Option<usize>],
    values: &mut V,
) -> Result<[f32; SLOTS.len()], FormatError> {
    let mut row = [0.0; SLOTS.len()];
    for (property, slot) in element.properties.iter().zip(slots) {
        match (property.kind, slot.and_then(|slot| row.get_mut(slot).map(|value| (slot, value)))) {
            (Kind::Scalar(scalar), Some((slot, value))) => {
                let at = values.offset();
                *value = values.real(scalar)?;
                // A normal that is not finite is mended later; a place that is not finite cannot be.
                if !value.is_finite() && !(NORMAL..UV).contains(&slot) {
                    let expected = format!("a finite number for '{}'", property.name);
                    return Err(values.error_at(at, &expected, &value.to_string()));
                }
            }
            (kind, _) => skip_property(kind, values)?,
        }
    }
    Ok(row)
}
