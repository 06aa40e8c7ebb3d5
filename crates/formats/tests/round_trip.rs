//! What is written in any of the formats is read back the same.

use std::fmt::Write as _;

use indigo_formats::{MeshData, obj, ply};
use proptest::prelude::*;

/// Coordinates of every magnitude that keeps areas far from the limit below which triangles are dropped.
fn coordinate() -> impl Strategy<Value = f32> {
    (-1.0e6_f32..1.0e6, -8..8_i32).prop_map(|(x, e)| x * 10.0_f32.powi(e))
}

prop_compose! {
    /// A mesh of one material whose triangles all have area.
    fn mesh()(n in 3..40_u32)(
        positions in proptest::collection::vec(proptest::array::uniform3(coordinate()), n as usize),
        uvs in proptest::collection::vec(proptest::array::uniform2(coordinate()), n as usize),
        axes in proptest::collection::vec(0..6_usize, n as usize),
        has_normals in any::<bool>(),
        has_uvs in any::<bool>(),
        corners in proptest::collection::vec(proptest::array::uniform3(0..n), 1..60),
    ) -> MeshData {
        let normal = |axis: usize| {
            let mut normal = [0.0; 3];
            normal[axis % 3] = if axis < 3 { 1.0 } else { -1.0 };
            normal
        };
        let triangles: Vec<[u32; 3]> = corners.into_iter().filter(|t| area(&positions, *t) > 1e-18).collect();
        MeshData {
            normals: if has_normals { axes.into_iter().map(normal).collect() } else { Vec::new() },
            uv_sets: if has_uvs { vec![uvs] } else { Vec::new() },
            uv_names: if has_uvs { vec![("default".to_owned(), 0)] } else { Vec::new() },
            triangle_materials: vec![0; triangles.len()],
            material_names: vec!["default".to_owned()],
            positions,
            triangles,
            ..MeshData::default()
        }
    }
}

fn area(positions: &[[f32; 3]], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|i| positions[i as usize].map(f64::from));
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt()
}

/// Shortest digits that give the same `f32`, in an ascii .ply.
fn ply_text(mesh: &MeshData) -> String {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", mesh.positions.len());
    let mut names = vec!["x", "y", "z"];
    if !mesh.normals.is_empty() {
        names.extend(["nx", "ny", "nz"]);
    }
    if !mesh.uv_sets.is_empty() {
        names.extend(["u", "v"]);
    }
    for name in names {
        let _ = writeln!(text, "property float {name}");
    }
    let faces = mesh.triangles.len();
    let _ = writeln!(text, "element face {faces}\nproperty list uchar uint vertex_indices\nend_header");
    for (i, position) in mesh.positions.iter().enumerate() {
        let normal = mesh.normals.get(i).map(|n| &n[..]).unwrap_or_default();
        let uv = mesh.uv_sets.first().map(|set| &set[i][..]).unwrap_or_default();
        let row: Vec<String> = position.iter().chain(normal).chain(uv).map(|x| format!("{x:e}")).collect();
        let _ = writeln!(text, "{}", row.join(" "));
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    text
}

/// Every face with negative indices if `negative` is set.
fn obj_text(mesh: &MeshData, negative: bool) -> String {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for [x, y, z] in &mesh.normals {
        let _ = writeln!(text, "vn {x} {y} {z}");
    }
    for [u, v] in mesh.uv_sets.iter().flatten() {
        let _ = writeln!(text, "vt {u:e} {v:e}");
    }
    text.push_str("usemtl default\n");
    let n = mesh.positions.len() as i64;
    for triangle in &mesh.triangles {
        text.push('f');
        for i in triangle.map(|i| if negative { i64::from(i) - n } else { i64::from(i) + 1 }) {
            let _ = match (mesh.uv_sets.is_empty(), mesh.normals.is_empty()) {
                (true, true) => write!(text, " {i}"),
                (false, true) => write!(text, " {i}/{i}"),
                (true, false) => write!(text, " {i}//{i}"),
                (false, false) => write!(text, " {i}/{i}/{i}"),
            };
        }
        text.push('\n');
    }
    text
}

/// Position, normal and texture coordinates.
type Corner = ([f32; 3], Option<[f32; 3]>, Option<[f32; 2]>);

/// Every corner in order, which does not depend on how vertices are numbered.
fn corners(mesh: &MeshData) -> Vec<Corner> {
    let corner = |&v: &u32| {
        let v = v as usize;
        (mesh.positions[v], mesh.normals.get(v).copied(), mesh.uv_sets.first().map(|set| set[v]))
    };
    mesh.triangles.iter().flatten().map(corner).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn ply_in_all_three_encodings(mesh in mesh().prop_filter("a face", |mesh| !mesh.triangles.is_empty())) {
        let little = ply::write_binary(&mesh);
        prop_assert_eq!(&ply::read(&little).unwrap(), &mesh);
        prop_assert_eq!(&ply::read(&big_endian(&mesh)).unwrap(), &mesh);
        prop_assert_eq!(&ply::read(ply_text(&mesh).as_bytes()).unwrap(), &mesh);
    }

    #[test]
    fn obj_with_either_sign(mesh in mesh().prop_filter("a face", |mesh| !mesh.triangles.is_empty()), negative: bool) {
        let back = obj::read(obj_text(&mesh, negative).as_bytes()).unwrap();
        prop_assert_eq!(corners(&back), corners(&mesh));
        prop_assert!(back.notes.is_empty(), "{:?}", back.notes);
        prop_assert!(back.positions.len() <= mesh.positions.len());
        prop_assert_eq!(back.triangle_materials, mesh.triangle_materials);
        prop_assert_eq!(back.uv_names, mesh.uv_names);
    }
}

/// The little-endian file with every number turned round.
fn big_endian(mesh: &MeshData) -> Vec<u8> {
    let little = ply::write_binary(mesh);
    let mark = b"end_header\n";
    let body = little.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let header = String::from_utf8(little[..body].to_vec()).unwrap().replace("little", "big");
    let mut out = header.into_bytes();
    let faces_at = little.len() - 13 * mesh.triangles.len();
    for word in little[body..faces_at].chunks_exact(4) {
        out.extend(word.iter().rev());
    }
    for face in little[faces_at..].chunks_exact(13) {
        out.push(face[0]);
        for word in face[1..].chunks_exact(4) {
            out.extend(word.iter().rev());
        }
    }
    out
}
