use super::*;

const HEADER: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const FACES: &str = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn mesh(text: &str) -> MeshData {
    read(text.as_bytes()).unwrap()
}

fn error(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

#[test]
fn a_quad_in_ascii() {
    let mesh = mesh(&format!("{HEADER}{FACES}{SQUARE}4 0 1 2 3\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.material_names, ["default"]);
    assert!(mesh.normals.is_empty() && mesh.uv_sets.is_empty() && mesh.notes.is_empty());
}

#[test]
fn windows_line_ends_and_properties_in_any_order() {
    let text = "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty double z\r\nproperty uchar red\r\n\
        property float t\r\nproperty float s\r\nproperty list int float extra\r\nproperty float nz\r\n\
        property float ny\r\nproperty float nx\r\nproperty float y\r\nproperty short x\r\nelement face 1\r\n\
        property uchar flags\r\nproperty list uchar float texcoord\r\nproperty list short ushort vertex_index\r\n\
        element edge 1\r\nproperty int a\r\nend_header\r\n";
    let rows = "3 255 0.5 0.25 2 7 7 1 0 0 2 1\r\n3 255 0.5 0.25 0 1 0 0 2 2\r\n4 255 0.5 0.25 0 1 0 0 2 1\r\n\
        9 2 0.5 0.5 3 2 1 0\r\n7\r\n";
    let mesh = mesh(&format!("{text}{rows}"));
    assert_eq!(mesh.positions, [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0], [1.0, 2.0, 4.0]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.uv_sets, [[[0.25, 0.5]; 3]]);
    assert_eq!(mesh.uv_names, [("default".to_owned(), 0)]);
    assert_eq!(mesh.triangles, [[2, 1, 0]]);
}

#[test]
fn faces_may_come_before_vertices() {
    let text = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n\
        property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n";
    assert_eq!(mesh(text).triangles, [[0, 1, 2]]);
}

#[test]
fn both_binary_orders_and_every_number_type() {
    for big in [false, true] {
        let order = if big { "big" } else { "little" };
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty char x\nproperty ushort y\n\
             property double z\nproperty uint u\nproperty float v\nelement face 1\nproperty list uint short vertex_indices\nend_header\n"
        )
        .into_bytes();
        let mut put = |le: &[u8]| {
            if big { bytes.extend(le.iter().rev()) } else { bytes.extend(le) }
        };
        for (x, y, z) in [(-1_i8, 300_u16, 0.5_f64), (2, 300, 0.5), (-1, 400, 0.5)] {
            put(&x.to_le_bytes());
            put(&y.to_le_bytes());
            put(&z.to_le_bytes());
            put(&70_000_u32.to_le_bytes());
            put(&0.125_f32.to_le_bytes());
        }
        put(&3_u32.to_le_bytes());
        for index in [0_i16, 1, 2] {
            put(&index.to_le_bytes());
        }
        let mesh = read(&bytes).unwrap();
        assert_eq!(mesh.positions, [[-1.0, 300.0, 0.5], [2.0, 300.0, 0.5], [-1.0, 400.0, 0.5]]);
        assert_eq!(mesh.uv_sets, [[[70_000.0, 0.125]; 3]]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }
}

#[test]
fn errors_in_the_header_carry_line_and_column() {
    for (text, expected) in [
        ("plx\n", "1:1: expected 'ply'"),
        ("ply\nformat ascii 1.0\nelement vertex many\n", "3:16: expected the element's count, found 'many'"),
        ("ply\nformat ebcdic 1.0\n", "2:8: expected 'ascii'"),
        ("ply\nproperty float x\n", "2:1: expected 'element' before"),
        ("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n", "4:10: expected a number type"),
        ("ply\nformat ascii 1.0\n", "3:1: expected a header line"),
        ("ply\nend_header\n", "2:11: expected a line 'format'"),
        ("ply\nformat ascii 1.0\nelement face 1\nend_header\n", "4:11: expected an element 'vertex'"),
    ] {
        let error = error(text.as_bytes());
        assert!(error.starts_with(expected), "{text}: {error}");
    }
    let strips = format!("{HEADER}element tristrips 1\nproperty list int int vertex_indices\nend_header\n");
    assert!(error(strips.as_bytes()).contains("triangle strips"));
    assert!(error(format!("{HEADER}end_header\n{SQUARE}").as_bytes()).contains("points without faces"));
}

#[test]
fn errors_in_ascii_data_carry_line_and_column() {
    for (faces, expected) in [
        ("4 0 1 2 4\n", "15:9: expected the index of a vertex, of which there are 4, found 4"),
        ("3 0 -1 2\n", "15:5: expected the index of a vertex"),
        ("3 0 1.5 2\n", "15:5: expected a whole number, found '1.5'"),
        ("3 0 1\n", "16:1: expected a whole number, found the end of the file"),
        ("30 0 1 2\n", "15:1: expected the length of a list, found a length of 30 with 7 bytes left"),
        ("-3 0 1 2 3\n", "15:1: expected the length of a list"),
    ] {
        let error = error(format!("{HEADER}{FACES}{SQUARE}{faces}").as_bytes());
        assert!(error.starts_with(expected), "{faces}: {error}");
    }
    let nan = format!("{HEADER}{FACES}0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n");
    assert!(
        error(nan.as_bytes()).starts_with("12:3: expected a finite number for 'y'"),
        "{}",
        error(nan.as_bytes())
    );
}

#[test]
fn a_header_that_promises_billions_is_refused_at_once() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (vertices, faces) in
            [(4_294_967_295_u64, 1_u64), (0, 4_294_967_295), (u64::MAX, u64::MAX), (0, u64::MAX)]
        {
            let text = format!(
                "ply\nformat {encoding} 1.0\nelement nothing {faces}\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
                 property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
            );
            let error = error(text.as_bytes());
            assert!(error.contains("only 0 bytes more"), "{error}");
        }
    }
}

#[test]
fn binary_data_that_end_early_are_told_by_offset() {
    let mesh = MeshData {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]; 5],
        ..MeshData::default()
    };
    let whole = write_binary(&mesh);
    assert_eq!(read(&whole).unwrap().triangles, mesh.triangles);
    let cut = &whole[..whole.len() - 1];
    let error = error(cut);
    assert!(error.starts_with("byte ") && error.ends_with("found only 3 bytes more"), "{error}");
}

#[test]
fn what_is_written_is_read_back() {
    let mesh = MeshData {
        positions: vec![[0.0, 0.5, -1.0], [1.0, 0.0, 3.0e-5], [0.0, 1.0, 9.0]],
        normals: vec![[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
        uv_sets: vec![vec![[0.0, 0.0], [0.5, 1.0], [-7.0, 3.0]]],
        uv_names: vec![("default".to_owned(), 0)],
        triangles: vec![[0, 1, 2], [2, 1, 0]],
        triangle_materials: vec![0, 0],
        material_names: vec!["default".to_owned()],
        ..MeshData::default()
    };
    assert_eq!(read(&write_binary(&mesh)), Ok(mesh));
}
