use super::*;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn mesh(text: &str) -> MeshData {
    read(text.as_bytes()).unwrap()
}

fn error(text: &str) -> String {
    read(text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn all_four_kinds_of_corner() {
    let attributes = "vt 0.25 0.5\nvn 0 0 1\n";
    for face in ["f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1"] {
        let mesh = mesh(&format!("{SQUARE}{attributes}{face}\n"));
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(
            mesh.normals.len(),
            if face.contains("/1 ") && !face.starts_with("f 1/1 ") { 3 } else { 0 }
        );
        let has_uv = face.contains("1/1");
        assert_eq!(mesh.uv_sets, if has_uv { vec![vec![[0.25, 0.5]; 3]] } else { vec![] });
        assert_eq!(mesh.uv_names.len(), usize::from(has_uv));
    }
}

#[test]
fn negative_indices_count_from_the_latest() {
    let mesh = mesh(&format!("{SQUARE}f -4 -3 -2\nv 5 5 5\nf -1 -3 -5\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 2, 0]]);
    assert_eq!(mesh.positions[3], [5.0; 3]);
}

#[test]
fn polygons_materials_and_ignored_statements() {
    let mesh = mesh(&format!(
        "# a comment\nmtllib x.mtl\no thing\n{SQUARE}f 1 2 3 # before any material\nusemtl red paint\ns off\nf 1 2 3 4\ng a\nusemtl unused\nusemtl default\nf 4 3 2\n"
    ));
    assert_eq!(mesh.material_names, ["default", "red paint"]);
    assert_eq!(mesh.triangle_materials, [0, 1, 1, 0]);
    assert_eq!(mesh.notes.len(), 1);
}

#[test]
fn continued_lines_windows_line_ends_extra_numbers_and_a_byte_order_mark() {
    let mesh = mesh("\u{feff}v 0 0 \\\r\n 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv 0 1e0 0\r\nf 1 \\\r\n2 3");
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles.len(), 1);
}

#[test]
fn equal_corners_are_one_vertex_and_different_ones_are_not() {
    let mesh = mesh(&format!("{SQUARE}vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n"));
    assert_eq!(mesh.positions.len(), 5);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 2, 3]]);
    assert_eq!(mesh.uv_sets[0][4], [1.0, 1.0]);
}

#[test]
fn missing_normals_among_others_are_those_of_the_face() {
    // Two bare triangles meet at a right angle along one edge: its vertices are split.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 5\nf 1 2 3\nf 1 4 2\nf 1//1 2//1 3//1\n";
    let mesh = mesh(text);
    for (triangle, expected) in mesh.triangles.iter().zip([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    {
        for &vertex in triangle {
            assert_eq!(mesh.normals[vertex as usize], expected);
        }
    }
    let corner_positions = mesh.triangles[1].map(|v| mesh.positions[v as usize]);
    assert_eq!(corner_positions, [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(
        mesh.notes.len(),
        3,
        "no material, bare vertices, normals not of unit length: {:?}",
        mesh.notes
    );
}

#[test]
fn unknown_statements_are_told_of_once() {
    let mesh = mesh(&format!("{SQUARE}usemtl m\nwibble 1\nf 1 2 3\nwobble\n"));
    assert_eq!(mesh.notes.len(), 2);
    assert!(mesh.notes[0].contains("6:1") && mesh.notes[0].contains("wibble"), "{}", mesh.notes[0]);
}

#[test]
fn errors_carry_line_and_column() {
    assert_eq!(error("v 0 0 zero\n"), "1:7: expected a coordinate of a vertex, found 'zero'");
    assert_eq!(error("v 0 0\n"), "1:6: expected a coordinate of a vertex, found the end of the line");
    assert_eq!(error("v 0 0 nan\n"), "1:7: expected a coordinate of a vertex that is finite, found 'nan'");
    assert_eq!(error("v 0 0 1e99"), "1:7: expected a coordinate of a vertex that is finite, found '1e99'");
    assert_eq!(
        error(&format!("{SQUARE}f 1 2 9\n")),
        "5:7: expected an index of vertices (v), of which there are 4 so far, found '9'"
    );
    for face in
        ["f 0 1 2", "f -0 1 2", "f 1 2 -5", "f 1 2 3/1", "f 1 2 3//1", "f 1 2 99999999999999999999999"]
    {
        let error = error(&format!("{SQUARE}{face}\n"));
        assert!(error.starts_with("5:") && error.contains("so far"), "{face}: {error}");
    }
    for face in ["f 1 2 x", "f 1 2 3/", "f 1 2 3/x", "f 1 2 1.5", "f 1 2 3//", "f 1 2 3/1/1/1", "f 1 2 --3"] {
        let error = error(&format!("{SQUARE}vt 0 0\nvn 0 0 1\n{face}\n"));
        assert!(error.starts_with("7:") && error.contains(": expected a"), "{face}: {error}");
    }
    assert_eq!(error("v 1 2 3\n"), "2:1: expected at least one face (f), found the end of the file");
    assert_eq!(error(""), "1:1: expected at least one face (f), found the end of the file");
}

#[test]
fn faces_of_two_corners_and_slivers_are_left_out() {
    let mesh = mesh(&format!("{SQUARE}usemtl m\nf 1 2\nf 1 2 2\nf 1 2 3\n"));
    assert_eq!((mesh.triangles.len(), mesh.degenerate.len(), mesh.notes.len()), (1, 1, 1));
}
