use super::*;

fn chunk(id: u16, parts: &[&[u8]]) -> Vec<u8> {
    let content = parts.concat();
    let mut bytes = id.to_le_bytes().to_vec();
    bytes.extend((content.len() as u32 + 6).to_le_bytes());
    bytes.extend(content);
    bytes
}

fn words(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn counted(rows: &[&[f32]]) -> Vec<u8> {
    let mut bytes = words(&[rows.len() as u16]);
    bytes.extend(rows.iter().copied().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// Two triangles that meet at a right angle along the y axis.
const RIDGE: [&[f32]; 4] = [&[0.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[-1.0, 0.0, 0.0], &[0.0, 0.0, -1.0]];

/// A file with one object; `face_chunks` go into its face list.
fn file(face_chunks: &[u8], mesh_chunks: &[u8], editor_chunks: &[u8]) -> Vec<u8> {
    let faces = words(&[2, 0, 1, 2, 7, 0, 3, 1, 7]);
    let mesh = chunk(
        id::MESH,
        &[mesh_chunks, &chunk(id::FACES, &[&faces, face_chunks]), &chunk(id::VERTICES, &[&counted(&RIDGE)])],
    );
    let object = chunk(id::OBJECT, &[b"ridge\0", &mesh]);
    chunk(id::MAIN, &[&chunk(2, &[b"\x03\0\0\0"]), &chunk(id::EDITOR, &[&object, editor_chunks])])
}

fn smoothing(groups: [u32; 2]) -> Vec<u8> {
    chunk(id::SMOOTHING, &[&groups[0].to_le_bytes(), &groups[1].to_le_bytes()])
}

fn corner_normals(mesh: &MeshData) -> Vec<[[f32; 3]; 3]> {
    mesh.triangles.iter().map(|t| t.map(|v| mesh.normals[v as usize])).collect()
}

#[test]
fn faces_without_groups_are_flat() {
    for bytes in [file(&[], &[], &[]), file(&smoothing([0, 0]), &[], &[]), file(&smoothing([1, 2]), &[], &[])]
    {
        let mesh = read(&bytes).unwrap();
        assert_eq!(corner_normals(&mesh), [[[0.0, 0.0, 1.0]; 3], [[1.0, 0.0, 0.0]; 3]]);
        assert_eq!(mesh.positions.len(), 6);
        assert_eq!(mesh.material_names, ["dummy"]);
        assert!(mesh.uv_sets.is_empty());
    }
}

#[test]
fn faces_that_share_a_group_are_smooth_across_their_edge() {
    let mesh = read(&file(&smoothing([5, 4]), &[], &[])).unwrap();
    assert_eq!(mesh.positions.len(), 4);
    let h = std::f32::consts::FRAC_1_SQRT_2;
    let expected = [[[h, 0.0, h], [h, 0.0, h], [0.0, 0.0, 1.0]], [[h, 0.0, h], [1.0, 0.0, 0.0], [h, 0.0, h]]];
    for (normals, expected) in corner_normals(&mesh).iter().zip(expected) {
        for (n, e) in normals.iter().flatten().zip(expected.iter().flatten()) {
            assert!((n - e).abs() < 1e-6, "{normals:?}");
        }
    }
}

#[test]
fn texture_coordinates_have_two_names() {
    let uvs: [&[f32]; 4] = [&[0.0, 0.0], &[0.0, 1.0], &[1.0, 0.5], &[0.5, 0.5]];
    let mesh = read(&file(&smoothing([1, 1]), &chunk(id::UVS, &[&counted(&uvs)]), &[])).unwrap();
    assert_eq!(mesh.uv_names, [("albedo".to_owned(), 0), ("default".to_owned(), 0)]);
    assert_eq!(mesh.uv_sets, [[[0.0, 0.0], [0.0, 1.0], [1.0, 0.5], [0.5, 0.5]]]);
}

#[test]
fn faces_of_undefined_materials_are_left_out_with_a_note() {
    let material = |name: &[u8], face: u16| chunk(id::FACE_MATERIAL, &[name, &words(&[1, face])]);
    let groups = [material(b"red\0", 0), material(b"lost\0", 1)].concat();
    let red = chunk(id::MATERIAL, &[&chunk(id::MATERIAL_NAME, &[b"red\0"])]);
    let mesh = read(&file(&groups, &[], &red)).unwrap();
    assert_eq!(mesh.material_names, ["red"]);
    assert_eq!(mesh.triangles.len(), 1);
    assert_eq!(mesh.notes.len(), 1);
    assert!(mesh.notes[0].contains("'lost'"), "{}", mesh.notes[0]);
}

#[test]
fn errors_carry_offsets() {
    let good = file(&[], &[], &[]);
    for n in 0..good.len() {
        assert!(read(&good[..n]).is_err(), "cut to {n} bytes");
    }
    let mut long = good.clone();
    long[2] += 1;
    let error = read(&long).unwrap_err().to_string();
    assert!(error.starts_with("byte 0: expected chunk 4D4D"), "{error}");
    let material = chunk(id::FACE_MATERIAL, &[b"red\0", &words(&[1, 2])]);
    let error = read(&file(&material, &[], &[])).unwrap_err().to_string();
    assert!(error.contains("the index of a face, of which the object has 2, found 2"), "{error}");
    let bad_faces = words(&[1, 0, 1, 4, 0]);
    let mesh =
        chunk(id::MESH, &[&chunk(id::VERTICES, &[&counted(&RIDGE)]), &chunk(id::FACES, &[&bad_faces])]);
    let object = chunk(id::OBJECT, &[b"\0", &mesh]);
    let bytes = chunk(id::MAIN, &[&chunk(id::EDITOR, &[&object])]);
    let error = read(&bytes).unwrap_err().to_string();
    let offset = bytes.len() - 8;
    assert!(error.starts_with(&format!("byte {offset}: expected indices of vertices")), "{error}");
    let nan: [&[f32]; 1] = [&[0.0, f32::NAN, 0.0]];
    let mesh = chunk(id::MESH, &[&chunk(id::VERTICES, &[&counted(&nan)])]);
    let bytes = chunk(id::MAIN, &[&chunk(id::EDITOR, &[&chunk(id::OBJECT, &[b"\0", &mesh])])]);
    assert!(read(&bytes).unwrap_err().to_string().contains("finite numbers among the vertices"));
    assert!(read(&chunk(id::MAIN, &[])).unwrap_err().to_string().contains("at least one mesh"));
}

#[test]
fn a_vertex_where_very_many_groups_meet_ends_soon() {
    // 60,000 faces round one vertex, each with a set of groups of its own.
    let n = 60_000_u16;
    let mut vertices = words(&[n]);
    for i in 0..n {
        let angle = f64::from(i) * 1e-4;
        let p = if i == 0 { [0.0; 3] } else { [angle.cos() as f32, angle.sin() as f32, 0.0] };
        vertices.extend(p.iter().flat_map(|x| x.to_le_bytes()));
    }
    let mut faces = words(&[n - 2]);
    let mut groups = Vec::new();
    for i in 1..n - 1 {
        faces.extend(words(&[0, i, i + 1, 0]));
        groups.extend(u32::from(i).to_le_bytes());
    }
    let faces = chunk(id::FACES, &[&faces, &chunk(id::SMOOTHING, &[&groups])]);
    let mesh = chunk(id::MESH, &[&chunk(id::VERTICES, &[&vertices]), &faces]);
    let bytes = chunk(id::MAIN, &[&chunk(id::EDITOR, &[&chunk(id::OBJECT, &[b"\0", &mesh])])]);
    let mesh = read(&bytes).unwrap();
    assert_eq!(mesh.triangles.len(), usize::from(n) - 2);
    assert_eq!(mesh.notes.len(), 1);
}

/// What the whole file holds: named objects, vertices, faces, objects with uvs, materials.
#[derive(Debug, Default, PartialEq)]
struct Contents {
    objects: usize,
    vertices: usize,
    faces: usize,
    uv_lists: usize,
    materials: usize,
}

fn contents(bytes: &[u8]) -> Contents {
    let mut found = Contents::default();
    let (_, main) = next_chunk(&mut Bytes::new(bytes)).unwrap().unwrap();
    let in_object = |found: &mut Contents, mut object: Bytes| {
        found.objects += 1;
        zero_terminated(&mut object, "a name").unwrap();
        each_chunk(object, |chunk, content| {
            if chunk == id::MESH {
                let mesh = Object::read(content)?;
                found.vertices += mesh.positions.len();
                found.faces += mesh.faces.len();
                found.uv_lists += usize::from(!mesh.uvs.is_empty());
            }
            Ok(())
        })
    };
    let mut in_editor = |chunk, content: Bytes| {
        match chunk {
            id::OBJECT => in_object(&mut found, content)?,
            id::MATERIAL => found.materials += 1,
            _ => {}
        }
        Ok(())
    };
    each_chunk(
        main,
        |chunk, content| if chunk == id::EDITOR { each_chunk(content, &mut in_editor) } else { Ok(()) },
    )
    .unwrap();
    found
}

#[test]
fn real_files_hold_what_other_readers_count() {
    let rows: [(&str, [usize; 5]); 9] = [
        ("CameraRollAnim.3ds", [2, 26, 12, 1, 0]),
        ("CameraRollAnimWithChildObject.3ds", [3, 52, 24, 2, 0]),
        ("RotatingCube.3DS", [1, 26, 12, 1, 0]),
        ("TargetCameraAnim.3ds", [2, 26, 12, 1, 0]),
        ("cube_with_diffuse_texture.3DS", [1, 32, 12, 1, 1]),
        ("cube_with_specular_texture.3DS", [1, 32, 12, 1, 1]),
        ("cubes_with_alpha.3DS", [5, 130, 60, 5, 5]),
        ("fels.3ds", [1, 386, 768, 0, 1]),
        ("test1.3ds", [9, 288, 108, 9, 3]),
    ];
    for (name, [objects, vertices, faces, uv_lists, materials]) in rows {
        let path = format!("{}/tests/assets/3ds/{name}", env!("CARGO_MANIFEST_DIR"));
        let bytes = std::fs::read(path).unwrap();
        assert_eq!(contents(&bytes), Contents { objects, vertices, faces, uv_lists, materials }, "{name}");
        let mesh = read(&bytes).unwrap();
        assert_eq!(mesh.triangles.len() + mesh.degenerate.len(), faces, "{name}: {:?}", mesh.notes);
        assert_eq!(mesh.uv_sets.len(), usize::from(uv_lists > 0), "{name}");
        assert_eq!(mesh.normals.len(), mesh.positions.len(), "{name}");
        for triangle in &mesh.triangles {
            assert!(triangle.iter().all(|&v| (v as usize) < mesh.positions.len()), "{name}");
        }
    }
}
