//! Triangle meshes as plain data, the common output of the embedded-mesh reader and of every mesh file reader.

/// A mesh as it was read: nothing smoothed, baked or transformed yet.
///
/// Every index in `triangles` and `degenerate` is below `positions.len()`; readers check that.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions in metres (before the mesh's `scale`).
    pub positions: Vec<[f32; 3]>,
    /// One unit normal per vertex, or empty where the source has none.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates: each set holds one pair per vertex (v = 0 is the bottom of an image).
    pub uv_sets: Vec<Vec<[f32; 2]>>,
    /// Names under which materials find the uv sets; one set may have several names.
    pub uv_names: Vec<(String, u32)>,
    /// Counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its index into `material_names`.
    pub triangle_materials: Vec<u32>,
    /// Names of the materials used.
    pub material_names: Vec<String>,
    /// For each of `material_names` its number in the list of the source, which may hold some that are not used and be in
    /// another order; empty where there is no such list.
    pub material_numbers: Vec<u32>,
    /// Triangles of (almost) no area, which were left out (area below 1e-20 m² as stored).
    pub degenerate: Vec<[u32; 3]>,
    /// For each of them its index into `material_names`.
    pub degenerate_materials: Vec<u32>,
    /// Anything the user should know of (a face that named an unlisted material, normals that had to be normalised...).
    pub notes: Vec<String>,
}

/// A mesh written inside a scene file, with the places that later checks need.
#[derive(Clone, Debug, PartialEq)]
pub struct EmbeddedMesh {
    /// Vertices and triangles; triangle indices are checked, materials are by name in `data.material_names`.
    pub data: MeshData,
    /// For each of `data.material_names` the place where it was first named.
    pub material_spans: Vec<indigo_diag::Span>,
}
