//! Triangle meshes, checked once when they are made.

use indigo_math::{Vec2, Vec3d};

/// The arrays of a mesh, not yet checked.
#[derive(Clone, Debug, Default)]
pub struct MeshBuffers {
    /// Vertex positions in object space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Three vertex indices a triangle; counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// One normal a vertex, of any length, or none at all.
    pub normals: Vec<[f32; 3]>,
    /// Sets of texture coordinates, each with one pair a vertex.
    pub uv_sets: Vec<Vec<[f32; 2]>>,
    /// One material slot a triangle, or none at all, which means slot 0 throughout.
    pub triangle_materials: Vec<u32>,
    /// Whether shading follows the vertex normals.
    pub smooth: bool,
}

/// Why buffers do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} uses vertex {index}, but the mesh has {vertices} vertices")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// How many there are.
        vertices: usize,
    },
    /// There are normals, but not one a vertex.
    #[error("{found} normals for {expected} vertices")]
    NormalCount {
        /// Number of vertices.
        expected: usize,
        /// Number of normals.
        found: usize,
    },
    /// A uv set does not have one pair a vertex.
    #[error("uv set {set} has {found} pairs for {expected} vertices")]
    UvCount {
        /// The set.
        set: usize,
        /// Number of vertices.
        expected: usize,
        /// Number of pairs.
        found: usize,
    },
    /// There are material slots, but not one a triangle.
    #[error("{found} material slots for {expected} triangles")]
    MaterialCount {
        /// Number of triangles.
        expected: usize,
        /// Number of slots.
        found: usize,
    },
    /// More triangles than [`TriangleMesh::MAX_TRIANGLES`].
    #[error("{0} triangles in one mesh, more than 2^27")]
    TooManyTriangles(usize),
}

/// A triangle mesh whose indices and array lengths are known to fit.
///
/// Positions may still be infinite or NaN: such triangles are left out of the tree and counted.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    buffers: MeshBuffers,
}

impl TriangleMesh {
    /// The largest number of triangles in a mesh, and in all trees of a scene together.
    pub const MAX_TRIANGLES: usize = 1 << 27;

    /// Checks that the arrays fit together.
    pub fn new(buffers: MeshBuffers) -> Result<Self, MeshError> {
        let (vertices, triangles) = (buffers.positions.len(), buffers.triangles.len());
        if triangles > Self::MAX_TRIANGLES {
            return Err(MeshError::TooManyTriangles(triangles));
        }
        for (triangle, corners) in buffers.triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertices });
            }
        }
        let fits = |found: usize, expected: usize| found == 0 || found == expected;
        if !fits(buffers.normals.len(), vertices) {
            return Err(MeshError::NormalCount { expected: vertices, found: buffers.normals.len() });
        }
        for (set, uvs) in buffers.uv_sets.iter().enumerate() {
            if uvs.len() != vertices {
                return Err(MeshError::UvCount { set, expected: vertices, found: uvs.len() });
            }
        }
        if !fits(buffers.triangle_materials.len(), triangles) {
            let found = buffers.triangle_materials.len();
            return Err(MeshError::MaterialCount { expected: triangles, found });
        }
        Ok(Self { buffers })
    }

    /// Vertex positions in object space, metres.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.buffers.positions
    }

    /// Three vertex indices a triangle, each in range.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.buffers.triangles
    }

    /// One normal a vertex, or none.
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.buffers.normals
    }

    /// The sets of texture coordinates.
    pub fn uv_sets(&self) -> &[Vec<[f32; 2]>] {
        &self.buffers.uv_sets
    }

    /// Whether shading follows the vertex normals.
    pub fn is_smooth(&self) -> bool {
        self.buffers.smooth && !self.buffers.normals.is_empty()
    }

    /// The material slot of a triangle of this mesh.
    #[inline]
    pub fn material_slot(&self, triangle: u32) -> u32 {
        self.buffers.triangle_materials.get(triangle as usize).copied().unwrap_or(0)
    }

    /// The corners of a triangle of this mesh in object space.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.buffers.triangles[triangle as usize].map(|i| self.buffers.positions[i as usize])
    }

    /// The vertex normals at the corners of a triangle, where shading follows them.
    #[inline]
    pub(crate) fn corner_normals(&self, triangle: u32) -> Option<[Vec3d; 3]> {
        let to_vec = |i: u32| Vec3d::from(self.buffers.normals[i as usize].map(f64::from));
        self.is_smooth().then(|| self.buffers.triangles[triangle as usize].map(to_vec))
    }

    /// The texture coordinates at the corners of a triangle, where the mesh has that set.
    #[inline]
    pub(crate) fn corner_uvs(&self, triangle: u32, set: u32) -> Option<[Vec2<f64>; 3]> {
        let uvs = self.buffers.uv_sets.get(set as usize)?;
        let to_vec = |i: u32| Vec2::from(uvs[i as usize].map(f64::from));
        Some(self.buffers.triangles[triangle as usize].map(to_vec))
    }

    /// Bytes held by the arrays.
    pub fn bytes(&self) -> usize {
        let b = &self.buffers;
        let uvs: usize = b.uv_sets.iter().map(|s| size_of_val(s.as_slice())).sum();
        size_of_val(b.positions.as_slice())
            + size_of_val(b.triangles.as_slice())
            + size_of_val(b.normals.as_slice())
            + uvs
            + size_of_val(b.triangle_materials.as_slice())
    }
}
