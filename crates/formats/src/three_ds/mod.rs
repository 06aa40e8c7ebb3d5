//! 3D Studio .3ds: nested chunks of a 16-bit id, a 32-bit length and content, all little-endian.
//!
//! - All mesh objects of the file make one mesh. Vertices stand in world space already: the local frame that an object
//!   carries is not applied.
//! - A face's material is the name in the file. Faces without one have the material "dummy"; faces that name a material
//!   which the file does not define are left out, with a note.
//! - Normals come from the smoothing groups: faces that share a group are smooth across their common vertices, faces
//!   of no group are flat.
//! - Texture coordinates are exposed under two names, "albedo" and "default".
//!
//! The chunks read here nest six deep, and one function reads each depth, so a file cannot make the reader recurse.

use std::collections::{BTreeMap, HashMap, HashSet};

use indigo_decl::mesh::MeshData;

use crate::builder::MeshBuilder;
use crate::bytes::Bytes;
use crate::error::FormatError;
use object::{Face, Object};

mod object;
mod smooth;

/// Chunk ids.
mod id {
    pub(super) const MAIN: u16 = 0x4D4D;
    pub(super) const EDITOR: u16 = 0x3D3D;
    pub(super) const OBJECT: u16 = 0x4000;
    pub(super) const MESH: u16 = 0x4100;
    pub(super) const VERTICES: u16 = 0x4110;
    pub(super) const FACES: u16 = 0x4120;
    pub(super) const FACE_MATERIAL: u16 = 0x4130;
    pub(super) const UVS: u16 = 0x4140;
    pub(super) const SMOOTHING: u16 = 0x4150;
    pub(super) const MATERIAL: u16 = 0xAFFF;
    pub(super) const MATERIAL_NAME: u16 = 0xA000;
}

/// Bytes of a chunk's id and length.
const CHUNK_HEADER: usize = 6;

/// Reads a mesh from the bytes of a .3ds file.
///
/// # Errors
/// At the offset of a chunk that does not fit into its parent, of data that end early, of indices out of range and of
/// coordinates that are not finite; and for a file without a mesh.
pub fn read(bytes: &[u8]) -> Result<MeshData, FormatError> {
    let mut file = Bytes::new(bytes);
    let Some((id::MAIN, main)) = next_chunk(&mut file)? else {
        return Err(file.error_at(0, "the chunk 4D4D that starts a .3ds file", "another"));
    };
    let mut materials = HashSet::new();
    let mut objects = Vec::new();
    each_chunk(main, |chunk, mut content| {
        if chunk == id::EDITOR {
            while let Some((chunk, content)) = next_chunk(&mut content)? {
                match chunk {
                    id::MATERIAL => each_chunk(content, |chunk, mut content| {
                        if chunk == id::MATERIAL_NAME {
                            materials.insert(zero_terminated(&mut content, "a material's name")?);
                        }
                        Ok(())
                    })?,
                    id::OBJECT => objects.push(content),
                    _ => {}
                }
            }
        }
        Ok(())
    })?;
    let mut assembly = Assembly::new(materials);
    for object in objects {
        assembly.named_object(object)?;
    }
    if assembly.meshes == 0 {
        return Err(file.error_at(0, "a .3ds file with at least one mesh object", "none"));
    }
    Ok(assembly.finish())
}

/// The id and content of the next chunk; none at the end of the parent.
fn next_chunk<'a>(parent: &mut Bytes<'a>) -> Result<Option<(u16, Bytes<'a>)>, FormatError> {
    if parent.is_empty() {
        return Ok(None);
    }
    let start = parent.offset();
    let id = parent.u16("a chunk's id")?;
    let length = parent.u32("a chunk's length")? as usize;
    let left = parent.rest().len();
    match length.checked_sub(CHUNK_HEADER) {
        Some(size) if size <= left => Ok(Some((id, parent.sub(size, "a chunk's content")?))),
        _ => Err(parent.error_at(
            start,
            format!("chunk {id:04X} to be {CHUNK_HEADER} to {} bytes long", left + CHUNK_HEADER),
            format!("a length of {length}"),
        )),
    }
}

fn each_chunk<'a>(
    mut parent: Bytes<'a>,
    mut visit: impl FnMut(u16, Bytes<'a>) -> Result<(), FormatError>,
) -> Result<(), FormatError> {
    while let Some((id, content)) = next_chunk(&mut parent)? {
        visit(id, content)?;
    }
    Ok(())
}

fn zero_terminated(bytes: &mut Bytes, what: &str) -> Result<String, FormatError> {
    let Some(length) = bytes.rest().iter().position(|&byte| byte == 0) else {
        return Err(bytes.error_at(bytes.offset(), format!("{what} that ends with a zero byte"), "none"));
    };
    let name = crate::text::name(bytes.take(length, what)?);
    bytes.take(1, what)?;
    Ok(name)
}

/// The mesh that the objects are gathered in.
struct Assembly {
    builder: MeshBuilder,
    /// Names of the materials that the file defines.
    materials: HashSet<String>,
    uvs: Vec<[f32; 2]>,
    any_uvs: bool,
    meshes: usize,
    /// For each material that is named but not defined, how many faces were left out.
    unlisted: BTreeMap<String, usize>,
    unsmoothed: usize,
}

impl Assembly {
    fn new(materials: HashSet<String>) -> Self {
        Self {
            builder: MeshBuilder::new(),
            materials,
            uvs: Vec::new(),
            any_uvs: false,
            meshes: 0,
            unlisted: BTreeMap::new(),
            unsmoothed: 0,
        }
    }

    /// A named object may be a mesh, a light or a camera.
    fn named_object(&mut self, mut content: Bytes) -> Result<(), FormatError> {
        zero_terminated(&mut content, "an object's name")?;
        each_chunk(content, |chunk, content| {
            if chunk == id::MESH {
                self.meshes += 1;
                self.add(&Object::read(content)?);
            }
            Ok(())
        })
    }

    fn add(&mut self, object: &Object) {
        self.any_uvs |= !object.uvs.is_empty();
        let materials: Vec<Option<u32>> =
            object.materials.iter().map(|name| self.listed_material(name)).collect();
        let (normals, unsmoothed) = smooth::corner_normals(object);
        self.unsmoothed += unsmoothed;
        let mut vertices = HashMap::new();
        for (face, normals) in object.faces.iter().zip(normals) {
            let material = match face.material {
                None => Some(self.builder.material("dummy")),
                Some(i) => materials.get(i as usize).copied().flatten(),
            };
            let Some(material) = material else {
                self.leave_out(object, face);
                continue;
            };
            let mut triangle = [0; 3];
            for ((slot, &corner), normal) in triangle.iter_mut().zip(&face.corners).zip(normals) {
                *slot = *vertices
                    .entry((corner, normal.map(f32::to_bits)))
                    .or_insert_with(|| self.vertex(object, corner, normal));
            }
            self.builder.polygon(&triangle, material);
        }
    }

    fn vertex(&mut self, object: &Object, corner: u16, normal: [f32; 3]) -> u32 {
        let mesh = &mut self.builder.mesh;
        let id = mesh.positions.len() as u32;
        mesh.positions.push(object.positions.get(usize::from(corner)).copied().unwrap_or_default());
        mesh.normals.push(normal);
        self.uvs.push(object.uvs.get(usize::from(corner)).copied().unwrap_or_default());
        id
    }

    fn listed_material(&mut self, name: &str) -> Option<u32> {
        self.materials.contains(name).then(|| self.builder.material(name))
    }

    fn leave_out(&mut self, object: &Object, face: &Face) {
        let name = face.material.and_then(|i| object.materials.get(i as usize));
        *self.unlisted.entry(name.cloned().unwrap_or_default()).or_default() += 1;
    }

    fn finish(mut self) -> MeshData {
        for (name, count) in &self.unlisted {
            self.builder.note(format!(
                "{count} faces name the material '{name}', which the file does not define, and were left out"
            ));
        }
        self.builder.note_count(
            self.unsmoothed,
            "face corners left flat, since too many different smoothing groups meet there",
        );
        if self.any_uvs {
            self.builder.mesh.uv_sets = vec![self.uvs];
            self.builder.mesh.uv_names = vec![("albedo".to_owned(), 0), ("default".to_owned(), 0)];
        }
        self.builder.finish()
    }
}

#[cfg(test)]
mod tests;
