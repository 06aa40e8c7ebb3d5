//! What the integration tests share: sound sample files of every kind, and the checks that any answer must pass.

use indigo_formats::{FormatError, MeshData, MeshFormat, Position};

/// A sound file: its kind, a label, its bytes.
pub type Sample = (MeshFormat, &'static str, Vec<u8>);

/// One sound file, or more, of every kind: the seeds of the fuzz targets, and a scene of several objects.
pub fn samples() -> Vec<Sample> {
    [
        (MeshFormat::Obj, "fuzz/seeds/obj/house.obj"),
        (MeshFormat::Ply, "fuzz/seeds/ply/square_ascii.ply"),
        (MeshFormat::Ply, "fuzz/seeds/ply/square_little_endian.ply"),
        (MeshFormat::Ply, "fuzz/seeds/ply/square_big_endian.ply"),
        (MeshFormat::ThreeDs, "fuzz/seeds/3ds/cube.3ds"),
        (MeshFormat::ThreeDs, "crates/formats/tests/assets/3ds/test1.3ds"),
        (MeshFormat::Igmesh, "fuzz/seeds/igmesh/version_1.igmesh"),
        (MeshFormat::Igmesh, "fuzz/seeds/igmesh/version_3.igmesh"),
        (MeshFormat::Igmesh, "fuzz/seeds/igmesh/version_4_compressed.igmesh"),
    ]
    .into_iter()
    .map(|(kind, path)| {
        let from_here = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        (kind, path, std::fs::read(from_here).unwrap())
    })
    .collect()
}

/// Checks all that [`MeshData`] promises, or that an error says where and what.
pub fn check_answer(kind: MeshFormat, answer: &Result<MeshData, FormatError>, bytes: &[u8]) {
    match answer {
        Ok(mesh) => check_mesh(mesh),
        Err(error) => check_error(kind, error, bytes),
    }
}

fn check_mesh(mesh: &MeshData) {
    let n = mesh.positions.len();
    assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.normals.is_empty() || mesh.normals.len() == n);
    for [x, y, z] in &mesh.normals {
        assert!(((x * x + y * y + z * z).sqrt() - 1.0).abs() < 1e-5, "a normal {x} {y} {z}");
    }
    for set in &mesh.uv_sets {
        assert_eq!(set.len(), n);
        assert!(set.iter().flatten().all(|x| x.is_finite()));
    }
    for (name, set) in &mesh.uv_names {
        assert!((*set as usize) < mesh.uv_sets.len(), "uv set {name}");
    }
    assert!(mesh.triangles.iter().chain(&mesh.degenerate).flatten().all(|&i| (i as usize) < n));
    assert_eq!(mesh.degenerate_materials.len(), mesh.degenerate.len());
    assert_eq!(mesh.triangle_materials.len(), mesh.triangles.len());
    assert!(mesh.triangle_materials.iter().all(|&m| (m as usize) < mesh.material_names.len()));
}

fn check_error(kind: MeshFormat, error: &FormatError, bytes: &[u8]) {
    assert!(!error.expected.is_empty() && !error.found.is_empty(), "{error}");
    match error.position {
        Position::Text { line, column } => {
            assert!(matches!(kind, MeshFormat::Obj | MeshFormat::Ply), "{error}");
            let lines = 1 + bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count();
            assert!((1..=lines).contains(&line) && (1..=bytes.len() + 1).contains(&column), "{error}");
        }
        Position::Byte(offset) => {
            assert!(kind != MeshFormat::Obj && offset <= bytes.len(), "{error}");
        }
        Position::Unpacked(_) => assert_eq!(kind, MeshFormat::Igmesh, "{error}"),
    }
}
