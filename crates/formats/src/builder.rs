//! What all mesh readers share: materials by name, polygons to triangles, degenerate triangles left out, normals made
//! good, and the notes that tell the user of it.

use std::collections::HashMap;

use indigo_decl::mesh::MeshData;

use crate::polygon::Triangulator;
use crate::vec3::{cross, dot, sub, to_f64, unit};

/// Triangles below this area (m² as stored) are left out.
const LEAST_AREA: f64 = 1e-20;
/// Normals off unit length by more than this are worth a note; less is the rounding of a text file.
const NORMAL_SLACK: f64 = 1e-2;

/// A mesh under construction.
pub(crate) struct MeshBuilder {
    /// Vertices are the reader's business; triangles go through [`MeshBuilder::polygon`].
    pub(crate) mesh: MeshData,
    material_ids: HashMap<String, u32>,
    triangulator: Triangulator,
    few_cornered: usize,
}

impl MeshBuilder {
    pub(crate) fn new() -> Self {
        Self {
            mesh: MeshData::default(),
            material_ids: HashMap::new(),
            triangulator: Triangulator::new(),
            few_cornered: 0,
        }
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.mesh.notes.push(text.into());
    }

    /// A note of something and how often it is there; none if it is not.
    pub(crate) fn note_count(&mut self, count: usize, what: &str) {
        if count > 0 {
            self.note(format!("{what}: {count}"));
        }
    }

    /// The index of a material's name, listed at first use.
    pub(crate) fn material(&mut self, name: &str) -> u32 {
        if let Some(&id) = self.material_ids.get(name) {
            return id;
        }
        let id = self.mesh.material_names.len() as u32;
        self.mesh.material_names.push(name.to_owned());
        self.material_ids.insert(name.to_owned(), id);
        id
    }

    /// Adds a face of any number of corners, which index `mesh.positions`.
    pub(crate) fn polygon(&mut self, corners: &[u32], material: u32) {
        if let &[a, b, c] = corners {
            push_triangle(&mut self.mesh, [a, b, c], material);
        } else if corners.len() < 3 {
            self.few_cornered += 1;
        } else {
            let mut cut = Vec::with_capacity(corners.len() - 2);
            self.triangulator.split(corners, &self.mesh.positions, &mut |t| cut.push(t));
            for triangle in cut {
                push_triangle(&mut self.mesh, triangle, material);
            }
        }
    }

    /// The mesh, with unit normals and with notes of what was mended.
    pub(crate) fn finish(mut self) -> MeshData {
        self.note_count(self.few_cornered, "faces of fewer than three corners, left out");
        self.note_count(
            self.triangulator.rough,
            "concave faces that cross themselves or are too large to be cut exactly, cut as fans",
        );
        self.mend_normals();
        if self.mesh.triangles.is_empty() {
            self.note("the mesh has no triangles");
        }
        self.mesh
    }

    fn mend_normals(&mut self) {
        let mut scaled = 0;
        let mut missing = 0;
        for normal in &mut self.mesh.normals {
            let long = to_f64(*normal);
            let Some(normalised) = unit(long) else {
                missing += 1;
                *normal = [0.0; 3];
                continue;
            };
            if (dot(long, long).sqrt() - 1.0).abs() > NORMAL_SLACK {
                scaled += 1;
            }
            *normal = normalised;
        }
        self.note_count(scaled, "normals of another length than 1, normalised");
        if missing > 0 {
            self.note_count(missing, "normals without direction, replaced by those of the surface");
            fill_normals(&mut self.mesh);
        }
    }
}

/// Appends a triangle unless it has next to no area.
fn push_triangle(mesh: &mut MeshData, triangle: [u32; 3], material: u32) {
    let normal = area_normal(mesh, triangle);
    if dot(normal, normal) < 4.0 * LEAST_AREA * LEAST_AREA {
        mesh.degenerate.push(triangle);
        mesh.degenerate_materials.push(material);
    } else {
        mesh.triangles.push(triangle);
        mesh.triangle_materials.push(material);
    }
}

/// The normal of a triangle, as long as twice its area.
pub(crate) fn area_normal(mesh: &MeshData, triangle: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|i| to_f64(mesh.positions.get(i as usize).copied().unwrap_or_default()));
    cross(sub(b, a), sub(c, a))
}

/// Gives vertices whose normal is zero the area-weighted mean of their triangles' normals, or +z where there is none.
fn fill_normals(mesh: &mut MeshData) {
    let mut sums: HashMap<u32, [f64; 3]> = mesh
        .normals
        .iter()
        .enumerate()
        .filter(|(_, normal)| **normal == [0.0; 3])
        .map(|(i, _)| (i as u32, [0.0; 3]))
        .collect();
    for &triangle in &mesh.triangles {
        let normal = area_normal(mesh, triangle);
        for corner in triangle {
            if let Some(sum) = sums.get_mut(&corner) {
                *sum = [sum[0] + normal[0], sum[1] + normal[1], sum[2] + normal[2]];
            }
        }
    }
    for (vertex, sum) in sums {
        if let Some(normal) = mesh.normals.get_mut(vertex as usize) {
            *normal = unit(sum).unwrap_or([0.0, 0.0, 1.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slivers_are_dropped_and_counted() {
        let mut builder = MeshBuilder::new();
        // Areas: 0.5e-20 · 0.98 and 0.5e-20 · 2.1 about the limit of 1e-20, and an exact zero.
        builder.mesh.positions = vec![[0.0; 3], [1e-10, 0.0, 0.0], [0.0, 1.9e-10, 0.0], [0.0, 2.1e-10, 0.0]];
        for triangle in [[0, 1, 2], [0, 1, 3], [0, 1, 1]] {
            builder.polygon(&triangle, 0);
        }
        let mesh = builder.finish();
        assert_eq!(mesh.triangles, [[0, 1, 3]]);
        assert_eq!(mesh.triangle_materials.len(), 1);
        assert_eq!((mesh.degenerate, mesh.degenerate_materials), (vec![[0, 1, 2], [0, 1, 1]], vec![0, 0]));
    }

    #[test]
    fn bad_normals_are_mended_and_told_of() {
        let mut builder = MeshBuilder::new();
        builder.mesh.positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [5.0; 3]];
        builder.mesh.normals = vec![[0.0, -3.0, 0.0], [0.0, 0.0, 0.0], [f32::NAN; 3], [0.0; 3]];
        builder.polygon(&[0, 1, 2], 0);
        let mesh = builder.finish();
        let down = [0.0, -1.0, 0.0];
        assert_eq!(mesh.normals, [down, down, down, [0.0, 0.0, 1.0]]);
        assert_eq!(mesh.notes.len(), 2);
    }
}
