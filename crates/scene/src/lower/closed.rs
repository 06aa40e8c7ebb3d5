//! Whether a mesh is closed, as the surface of a medium has to be: light that gets in otherwise than it gets out takes the
//! medium along, or leaves it behind.

use super::geometry::Placed;
use super::materials::MaterialTable;
use super::meshes::MeshTable;
use crate::codes;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_geom::TriangleMesh;
use std::collections::HashMap;

/// Meshes of more triangles are not looked at: it would take seconds.
const MOST_TRIANGLES: usize = 1 << 22;

/// Warns of a mesh that is the surface of a medium and has holes.
pub(super) fn warn_if_open(
    placed: &Placed,
    span: Span,
    meshes: &mut MeshTable,
    materials: &MaterialTable,
    sink: &mut Sink,
) {
    let bounds = |slot: &u32| materials.bounds_medium(placed.slots[*slot as usize]);
    let surfaces: Vec<u32> = (0..placed.slots.len() as u32).filter(bounds).collect();
    if surfaces.is_empty() {
        return;
    }
    let open = meshes.open_edges(placed.mesh, surfaces);
    if open > 0 {
        let message = format!(
            "mesh {} is the surface of a medium, but not closed: {open} of its edges are open",
            placed.name
        );
        let warning = Diagnostic::warning(codes::NOT_CLOSED, span, message);
        let warning = warning
            .note("light that passes beside it is taken to be in the medium where it is not, or the other way round")
            .note("an edge is open unless an even number of triangles have it from end to end: where triangles meet others between the ends of an edge, it has no hole but is not tight");
        let hint = "close the mesh, cut triangles where others meet their edges, or make it one with the meshes that close it";
        sink.push_or_count(warning.hint(hint));
    }
}

/// How many edges of triangles of some material slots are those of an odd number of triangles. Of a closed surface none is,
/// whether it meets itself or not. Vertices in one place are one: meshes have several where normals or texture coordinates
/// differ. Triangles that were left out for want of an area, which come with their slots, are sides all the same.
pub(super) fn open_edges(mesh: &TriangleMesh, degenerate: &[([u32; 3], u32)], slots: &[u32]) -> usize {
    if mesh.triangles().len() + degenerate.len() > MOST_TRIANGLES {
        return 0;
    }
    let mut numbers = HashMap::new();
    // Adding 0 makes one of both zeros.
    let place = |p: &[f32; 3]| p.map(|x| (x + 0.0).to_bits());
    let vertices: Vec<u32> = mesh
        .positions()
        .iter()
        .map(|p| {
            let next = numbers.len() as u32;
            *numbers.entry(place(p)).or_insert(next)
        })
        .collect();
    let mut edges: Vec<([u32; 2], bool)> = vec![];
    let triangles = (0..).zip(mesh.triangles()).map(|(i, corners)| (*corners, mesh.material_slot(i)));
    for (corners, slot) in triangles.chain(degenerate.iter().copied()) {
        let is_meant = slots.contains(&slot);
        let [a, b, c] = corners.map(|i| vertices[i as usize]);
        let of_length = [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to);
        edges.extend(of_length.map(|(from, to)| ([from.min(to), from.max(to)], is_meant)));
    }
    edges.sort_unstable();
    let is_open = |same: &&[([u32; 2], bool)]| same.len() % 2 == 1 && same.iter().any(|edge| edge.1);
    edges.chunk_by(|a, b| a.0 == b.0).filter(is_open).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_geom::MeshBuffers;

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> TriangleMesh {
        let (positions, triangles) = (positions.to_vec(), triangles.to_vec());
        TriangleMesh::new(MeshBuffers { positions, triangles, ..MeshBuffers::default() })
            .expect("a sound mesh")
    }

    const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const SIDES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn edges_of_one_triangle_are_open() {
        assert_eq!(open_edges(&mesh(&CORNERS, &SIDES), &[], &[0]), 0);
        assert_eq!(open_edges(&mesh(&CORNERS, &SIDES[..3]), &[], &[0]), 3);
        assert_eq!(open_edges(&mesh(&CORNERS, &SIDES[..2]), &[], &[0]), 4);
        assert_eq!(open_edges(&mesh(&CORNERS, &[]), &[], &[0]), 0);
    }

    /// Corners of their own for each side, with zeros of either sign, and a triangle that is no more than an edge.
    #[test]
    fn vertices_in_one_place_are_one() {
        let mut own: Vec<[f32; 3]> = SIDES.iter().flatten().map(|&i| CORNERS[i as usize]).collect();
        own[0] = [-0.0, 0.0, -0.0];
        let mut sides: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        assert_eq!(open_edges(&mesh(&own, &sides), &[], &[0]), 0);
        sides.push([0, 1, 3]);
        assert_eq!(open_edges(&mesh(&own, &sides), &[], &[0]), 0);
    }

    /// Two bodies that share an edge, of which it has four triangles.
    #[test]
    fn a_surface_may_meet_itself() {
        let mut corners = CORNERS.to_vec();
        corners.extend([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]);
        let mut sides = SIDES.to_vec();
        sides.extend([[0, 4, 1], [0, 1, 5], [1, 4, 5], [4, 0, 5]]);
        assert_eq!(open_edges(&mesh(&corners, &sides), &[], &[0]), 0);
    }

    /// A mesh of two materials: a closed body, and a sheet, which is the surface of nothing.
    #[test]
    fn edges_of_others_do_not_count() {
        let mut corners = CORNERS.to_vec();
        corners.extend([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]]);
        let triangles = [&SIDES[..], &[[4, 5, 6]]].concat();
        let triangle_materials = vec![0, 0, 0, 0, 1];
        let buffers =
            MeshBuffers { positions: corners, triangles, triangle_materials, ..MeshBuffers::default() };
        let mesh = TriangleMesh::new(buffers).expect("a sound mesh");
        assert_eq!([&[0][..], &[1], &[0, 1]].map(|slots| open_edges(&mesh, &[], slots)), [0, 3, 3]);
    }

    /// The side 0 1 3 as two, of which the edge between 0 and 1 has a corner more than that of the side beyond it.
    fn t_junction() -> TriangleMesh {
        let corners = [&CORNERS[..], &[[0.5, 0.0, 0.0]]].concat();
        mesh(&corners, &[SIDES[0], [0, 4, 3], [4, 1, 3], SIDES[2], SIDES[3]])
    }

    /// It is not watertight: rounding of its ends decides on which side of an edge a ray passes.
    #[test]
    fn edges_that_meet_between_their_ends_are_open() {
        assert_eq!(open_edges(&t_junction(), &[], &[0]), 3);
    }

    /// The triangle without an area that others fill such a place with.
    #[test]
    fn triangles_that_were_left_out_close_a_mesh() {
        assert_eq!(open_edges(&t_junction(), &[([0, 1, 4], 0)], &[0]), 0);
        // One that is no more than an edge closes nothing.
        assert_eq!(open_edges(&t_junction(), &[([0, 1, 1], 0)], &[0]), 3);
        assert_eq!(open_edges(&mesh(&CORNERS, &SIDES[..3]), &[([0, 1, 1], 0)], &[0]), 3);
    }

    #[test]
    fn what_is_told_of_and_what_is_not() {
        // Turned the wrong way: not told.
        let [a, b, c] = SIDES[3];
        let turned = [SIDES[0], SIDES[1], SIDES[2], [a, c, b]];
        assert_eq!(open_edges(&mesh(&CORNERS, &turned), &[], &[0]), 0);
        // Beside the place where it should be, be it by a rounding: told.
        let mut corners = CORNERS.to_vec();
        corners.push([0.0, 1.0_f32.next_up(), 0.0]);
        let beside = [SIDES[0], SIDES[1], SIDES[2], SIDES[3].map(|i| if i == 2 { 4 } else { i })];
        assert_eq!(open_edges(&mesh(&corners, &beside), &[], &[0]), 4);
    }

    #[test]
    fn meshes_that_are_too_large_are_not_looked_at() {
        let sheets = |count: usize| vec![SIDES[0]; count];
        assert_eq!(open_edges(&mesh(&CORNERS, &sheets(MOST_TRIANGLES + 1)), &[], &[0]), 0);
        assert_eq!(open_edges(&mesh(&CORNERS, &sheets(3)), &[], &[0]), 3);
    }
}
