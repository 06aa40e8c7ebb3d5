//! Vertices, faces and what they index.

use indigo_decl::mesh::MeshData;

use super::{Header, list, number};
use crate::builder::MeshBuilder;
use crate::bytes::Bytes;
use crate::error::FormatError;
use crate::weld::{NONE, Welder};

/// Material indices that a file without material names may use.
const MAX_NAMELESS: u32 = 1 << 16;

pub(super) struct Body<'a> {
    header: &'a Header,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    /// Where set `s` has its pair for uv index `i`: at `s * set_stride + i * index_stride`.
    set_stride: usize,
    index_stride: usize,
    uv_count: usize,
    welder: Welder,
    builder: MeshBuilder,
    /// The mesh's index for each of the file's material indices, once used.
    materials: Vec<Option<u32>>,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &'a Header) -> Self {
        Self {
            header,
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            set_stride: 0,
            index_stride: 0,
            uv_count: 0,
            welder: Welder::new(),
            builder: MeshBuilder::new(),
            materials: vec![None; header.materials.len()],
        }
    }

    pub(super) fn read(mut self, mut bytes: Bytes) -> Result<MeshData, FormatError> {
        let count = list(&mut bytes, 12, "vertices")?;
        self.positions = bytes.f32_rows(count, true, "vertices")?;
        let at = bytes.offset();
        let count = list(&mut bytes, 12, "normals")?;
        if count != 0 && count != self.positions.len() {
            let expected = format!("no normals or {}, as many as vertices", self.positions.len());
            return Err(bytes.error_at(at, expected, count.to_string()));
        }
        self.normals = bytes.f32_rows(count, false, "normals")?;
        self.read_uvs(&mut bytes)?;
        self.read_faces::<3>(&mut bytes)?;
        if self.header.version >= 2 {
            self.read_faces::<4>(&mut bytes)?;
        }
        self.builder.note_count(bytes.rest().len(), "bytes after the end of the mesh");
        Ok(self.finish())
    }

    fn read_uvs(&mut self, bytes: &mut Bytes) -> Result<(), FormatError> {
        let grouped_by_set =
            self.header.version >= 3 && number(bytes, "uv layout 0 or 1", |layout| layout <= 1)? == 1;
        let at = bytes.offset();
        let pairs = list(bytes, 8, "uv pairs")?;
        self.uvs = bytes.f32_rows(pairs, true, "uv pairs")?;
        let sets = self.header.uv_sets as usize;
        // A file without uv sets may still hold a pair, for all indices to point at.
        if sets == 0 {
            return Ok(());
        }
        if !pairs.is_multiple_of(sets) {
            return Err(bytes.error_at(
                at,
                format!("as many uv pairs in each of the {sets} sets"),
                pairs.to_string(),
            ));
        }
        self.uv_count = pairs / sets;
        (self.set_stride, self.index_stride) = if grouped_by_set { (self.uv_count, 1) } else { (1, sets) };
        Ok(())
    }

    /// Faces of `N` corners: `N` position indices, `N` uv indices, material.
    fn read_faces<const N: usize>(&mut self, bytes: &mut Bytes) -> Result<(), FormatError> {
        let count = list(bytes, 4 * (2 * N + 1), "faces")?;
        let mut previous = [0; 2];
        let mut corners = [0; N];
        for _ in 0..count {
            let at = bytes.offset();
            let vertices = self.indices::<N>(bytes, &mut previous[0])?;
            let uvs = self.indices::<N>(bytes, &mut previous[1])?;
            let material = self.material(bytes)?;
            for ((slot, vertex), uv) in corners.iter_mut().zip(vertices).zip(uvs) {
                *slot = self
                    .corner(vertex, uv)
                    .map_err(|(expected, found)| bytes.error_at(at, expected, found))?;
            }
            self.builder.polygon(&corners, material);
        }
        Ok(())
    }

    /// `N` indices. In a compressed body the first is relative to the first of the face before, the others to the
    /// first.
    fn indices<const N: usize>(
        &self,
        bytes: &mut Bytes,
        previous: &mut u32,
    ) -> Result<[u32; N], FormatError> {
        let mut indices = [0; N];
        for index in &mut indices {
            *index = bytes.u32("an index")?;
        }
        if self.header.compressed {
            let mut base = *previous;
            for (i, index) in indices.iter_mut().enumerate() {
                *index = index.wrapping_add(base);
                if i == 0 {
                    base = *index;
                }
            }
            *previous = base;
        }
        Ok(indices)
    }

    /// The vertex of a corner, or what was expected and found.
    fn corner(&mut self, vertex: u32, uv: u32) -> Result<u32, (String, String)> {
        let Some(&position) = self.positions.get(vertex as usize) else {
            let expected = format!("indices of vertices, of which there are {}", self.positions.len());
            return Err((expected, format!("{vertex} in this face")));
        };
        let has_uvs = self.header.uv_sets > 0;
        if has_uvs && uv as usize >= self.uv_count {
            let expected = format!("indices of uv pairs, of which there are {} per set", self.uv_count);
            return Err((expected, format!("{uv} in this face")));
        }
        let (id, is_new) = self.welder.vertex([vertex, if has_uvs { uv } else { NONE }, NONE]);
        if is_new {
            self.builder.mesh.positions.push(position);
            self.builder.mesh.normals.extend(self.normals.get(vertex as usize));
        }
        Ok(id)
    }

    /// The mesh's index of the material whose index in the file comes next.
    fn material(&mut self, bytes: &mut Bytes) -> Result<u32, FormatError> {
        let names = &self.header.materials;
        let limit = if names.is_empty() { MAX_NAMELESS } else { names.len() as u32 };
        let index =
            number(bytes, &format!("the index of a material, below {limit}"), |n| n < limit)? as usize;
        if index >= self.materials.len() {
            self.materials.resize(index + 1, None);
        }
        let name = || names.get(index).cloned().unwrap_or_else(|| index.to_string());
        let builder = &mut self.builder;
        // Two of one name may be bound to different materials by their numbers, and stay apart.
        let id = |slot: &mut Option<u32>| {
            *slot.get_or_insert_with(|| {
                builder.mesh.material_numbers.push(index as u32);
                builder.mesh.material_names.push(name());
                (builder.mesh.material_names.len() - 1) as u32
            })
        };
        Ok(self.materials.get_mut(index).map_or(0, id))
    }

    fn finish(mut self) -> MeshData {
        let mesh = &mut self.builder.mesh;
        for set in 0..self.header.uv_sets as usize {
            let pair = |uv: u32| {
                let i = set * self.set_stride + uv as usize * self.index_stride;
                self.uvs.get(i).copied().unwrap_or_default()
            };
            mesh.uv_sets.push(self.welder.vertices.iter().map(|corner| pair(corner[1])).collect());
        }
        mesh.uv_names.clone_from(&self.header.uv_names);
        if mesh.uv_names.is_empty() && !mesh.uv_sets.is_empty() {
            mesh.uv_names.push(("default".to_owned(), 0));
        }
        if self.header.materials.is_empty() && !self.builder.mesh.triangles.is_empty() {
            self.builder.note("the file names no materials; they are named by their numbers, from 0");
        }
        self.builder.finish()
    }
}
