//! Triangles as the builders see them: corners only, in the space of their tree.

use crate::mesh::TriangleMesh;
use crate::object::Object;
use indigo_math::{Transform, Vec3};
use std::borrow::Cow;

/// Vertices and triangles of one tree.
pub(crate) struct Soup<'a> {
    /// Vertex positions in the tree's space.
    pub positions: Cow<'a, [[f32; 3]]>,
    /// Vertex indices, all in range.
    pub triangles: Cow<'a, [[u32; 3]]>,
}

impl<'a> Soup<'a> {
    /// A mesh in its own space.
    pub(crate) fn of(mesh: &'a TriangleMesh) -> Self {
        Self { positions: Cow::Borrowed(mesh.positions()), triangles: Cow::Borrowed(mesh.triangles()) }
    }

    /// The corners of a triangle.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.triangles[triangle as usize].map(|i| self.positions[i as usize])
    }
}

/// A vertex of a baked mesh in render space, as the tree holds it.
#[inline]
pub(crate) fn baked_vertex(transform: &Transform, p: [f32; 3]) -> [f32; 3] {
    transform.point(Vec3::<f32>::from(p)).to_array()
}

/// The given mesh objects as one soup in render space, with the first triangle of each.
pub(crate) fn bake<'a>(
    meshes: &'a [TriangleMesh],
    objects: &[Object],
    baked: &[u32],
) -> (Soup<'a>, Vec<(u32, u32)>) {
    let placed = baked.iter().filter_map(|&object| match &objects[object as usize] {
        Object::Mesh { mesh, transform } => Some((object, &meshes[*mesh as usize], transform)),
        _ => None,
    });
    let placed: Vec<_> = placed.filter(|(_, mesh, _)| !mesh.triangles().is_empty()).collect();
    if let [(object, mesh, transform)] = placed[..]
        && *transform == Transform::IDENTITY
    {
        return (Soup::of(mesh), vec![(0, object)]);
    }
    let (mut positions, mut triangles, mut owners) = (Vec::new(), Vec::new(), Vec::new());
    for (object, mesh, transform) in placed {
        let first_vertex = positions.len() as u32;
        owners.push((triangles.len() as u32, object));
        positions.extend(mesh.positions().iter().map(|&p| baked_vertex(transform, p)));
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|i| i + first_vertex)));
    }
    (Soup { positions: Cow::Owned(positions), triangles: Cow::Owned(triangles) }, owners)
}
