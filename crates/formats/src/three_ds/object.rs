//! One mesh object, as it stands in the file.

use super::{each_chunk, id, next_chunk, zero_terminated};
use crate::bytes::Bytes;
use crate::error::FormatError;

/// Bytes of a face: three indices and flags, 16 bits each.
const FACE_BYTES: usize = 8;

pub(super) struct Face {
    /// Indices into the object's positions.
    pub(super) corners: [u16; 3],
    /// Index into the object's material names.
    pub(super) material: Option<u32>,
    /// A bit for each smoothing group; 0 means flat.
    pub(super) smoothing: u32,
}

#[derive(Default)]
pub(super) struct Object {
    pub(super) positions: Vec<[f32; 3]>,
    /// One pair per position, or empty.
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) faces: Vec<Face>,
    /// Names that faces refer to, defined or not.
    pub(super) materials: Vec<String>,
}

impl Object {
    pub(super) fn read(mesh: Bytes) -> Result<Self, FormatError> {
        let mut object = Self::default();
        let mut faces = None;
        each_chunk(mesh, |chunk, mut content| {
            match chunk {
                id::VERTICES => {
                    let count = content.u16("the number of vertices")?;
                    object.positions = content.f32_rows(count.into(), true, "vertices")?;
                }
                id::UVS => {
                    let count = content.u16("the number of texture coordinates")?;
                    object.uvs = content.f32_rows(count.into(), true, "texture coordinates")?;
                }
                id::FACES => faces = Some(content),
                _ => {}
            }
            Ok(())
        })?;
        // Faces are checked against the vertices, whichever come first in the file.
        if let Some(content) = faces {
            object.read_faces(content)?;
        }
        Ok(object)
    }

    fn read_faces(&mut self, mut content: Bytes) -> Result<(), FormatError> {
        let count = usize::from(content.u16("the number of faces")?);
        let start = content.offset();
        let rows = content.take(count * FACE_BYTES, "faces")?.as_chunks::<FACE_BYTES>().0;
        self.faces.reserve_exact(count);
        for (i, &[a0, a1, b0, b1, c0, c1, _, _]) in rows.iter().enumerate() {
            let corners = [[a0, a1], [b0, b1], [c0, c1]].map(u16::from_le_bytes);
            if let Some(index) = corners.iter().find(|&&corner| usize::from(corner) >= self.positions.len()) {
                return Err(content.error_at(
                    start + i * FACE_BYTES,
                    format!("indices of vertices, of which the object has {}", self.positions.len()),
                    format!("{index} in face {i}"),
                ));
            }
            self.faces.push(Face { corners, material: None, smoothing: 0 });
        }
        while let Some((chunk, content)) = next_chunk(&mut content)? {
            match chunk {
                id::FACE_MATERIAL => self.read_face_material(content)?,
                id::SMOOTHING => self.read_smoothing(content)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn read_face_material(&mut self, mut content: Bytes) -> Result<(), FormatError> {
        let material = self.materials.len() as u32;
        self.materials.push(zero_terminated(&mut content, "a material's name")?);
        let count = content.u16("the number of faces of a material")?;
        for _ in 0..count {
            let at = content.offset();
            let index = content.u16("the index of a face")?;
            let faces = self.faces.len();
            let Some(face) = self.faces.get_mut(usize::from(index)) else {
                let expected = format!("the index of a face, of which the object has {faces}");
                return Err(content.error_at(at, expected, index.to_string()));
            };
            face.material = Some(material);
        }
        Ok(())
    }

    fn read_smoothing(&mut self, mut content: Bytes) -> Result<(), FormatError> {
        for face in &mut self.faces {
            face.smoothing = content.u32("the smoothing groups of a face")?;
        }
        Ok(())
    }
}
