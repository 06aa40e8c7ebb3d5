//! Stanford .ply, after G. Turk, "The PLY Polygon File Format" (1994): ascii and both binary byte orders, properties of
//! any type in any order, faces of any number of corners.
//!
//! - Vertices: `x y z`; optional `nx ny nz`; optional texture coordinates `u v`, `s t` or `texture_u texture_v`, exposed as "default".
//! - Faces: the list `vertex_indices` or `vertex_index`. Triangle strips are refused by name.
//! - One material, "default". A file without normals gives a mesh without normals.
//! - Other elements and properties are skipped.

use indigo_decl::mesh::MeshData;

use crate::builder::MeshBuilder;
use crate::error::FormatError;
use header::{Element, Encoding, Header, Kind, Scalar};
use values::{Ascii, Binary, Values};

mod faces;
mod header;
mod values;
mod vertices;
mod write;

pub use write::write_binary;

/// Reads a mesh from the bytes of a .ply file.
///
/// # Errors
/// With line and column in the header and in ascii files, with the byte's offset in binary data: a header that is not
/// PLY's or promises more than the file can hold, data that end early, indices out of range, coordinates that are not
/// finite, files without faces.
pub fn read(bytes: &[u8]) -> Result<MeshData, FormatError> {
    let header = header::read(bytes)?;
    match header.encoding {
        Encoding::Ascii => read_body(&header, &mut Ascii::new(bytes, header.body)),
        Encoding::Little => read_body(&header, &mut Binary::<false>::new(bytes, header.body)),
        Encoding::Big => read_body(&header, &mut Binary::<true>::new(bytes, header.body)),
    }
}

fn read_body<V: Values>(header: &Header, values: &mut V) -> Result<MeshData, FormatError> {
    let mut builder = MeshBuilder::new();
    let mut seen_vertices = false;
    let mut faces_before_vertices = None;
    let mut seen_faces = false;
    for element in &header.elements {
        check_promise(element, values)?;
        match element.name.as_str() {
            "vertex" if !seen_vertices => {
                vertices::read(element, values, &mut builder)?;
                seen_vertices = true;
            }
            "face" if !seen_faces => {
                seen_faces = true;
                if seen_vertices {
                    faces::read(element, values, &mut builder)?;
                } else {
                    faces_before_vertices = Some((element, values.clone()));
                    skip(element, values)?;
                }
            }
            _ => skip(element, values)?,
        }
    }
    // Polygons are cut by the places of their corners, so faces that come first wait for the vertices.
    if let Some((element, mut values)) = faces_before_vertices {
        faces::read(element, &mut values, &mut builder)?;
    }
    Ok(builder.finish())
}

/// Refuses a count that the rest of the file cannot hold, before anything is allocated for it.
fn check_promise<V: Values>(element: &Element, values: &V) -> Result<(), FormatError> {
    let row: usize = element.properties.iter().map(|property| values.least_bytes(property.kind)).sum();
    let needed = u128::from(element.count) * row as u128;
    let remaining = values.remaining();
    // The last value of an ascii file needs no separator.
    if needed <= remaining as u128 + 1 {
        return Ok(());
    }
    Err(values.error(
        &format!("{} rows of element '{}' ({needed} bytes or more)", element.count, element.name),
        &format!("only {remaining} bytes more"),
    ))
}

fn skip<V: Values>(element: &Element, values: &mut V) -> Result<(), FormatError> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property.kind, values)?;
        }
    }
    Ok(())
}

fn skip_property<V: Values>(kind: Kind, values: &mut V) -> Result<(), FormatError> {
    match kind {
        Kind::Scalar(scalar) => values.skip(scalar, 1),
        Kind::List { count, item } => {
            let n = list_length(count, item, values)?;
            values.skip(item, n)
        }
    }
}

/// The length of the list that starts here, checked against what is left of the file.
fn list_length<V: Values>(count: Scalar, item: Scalar, values: &mut V) -> Result<usize, FormatError> {
    let at = values.offset();
    let length = values.integer(count)?;
    let needed = i128::from(length) * values.least_bytes(Kind::Scalar(item)) as i128;
    if length < 0 || needed > values.remaining() as i128 + 1 {
        let found = format!("a length of {length} with {} bytes left", values.remaining());
        return Err(values.error_at(at, "the length of a list", &found));
    }
    Ok(length as usize)
}

#[cfg(test)]
mod tests;
