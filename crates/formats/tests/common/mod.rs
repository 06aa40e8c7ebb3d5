//! What the integration tests share: sound sample files of every kind, and the checks that any answer must pass.

use indigo_formats::{FormatError, MeshData, MeshFormat, Position};

/// A sound file: its kind, a label, its bytes.
pub type Sample = (MeshFormat, &'static str, Vec<u8>);

const OBJ: &str = "# a house\nmtllib house.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.75 0\nv 0 1 0\nv 0.5 0.5 -1e0\n\
    vt 0 0\nvt 1 0\nvt 0.5 1\nvn 0 0 1\nusemtl wall\nf 1/1/1 2/2/1 3//1 4/3/1 5//1\nusemtl roof\n\
    f -1 -2 \\\n  -3\nf 1 6 2\ns off\nf 3 2 6\n";

const PLY_HEAD: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
    property float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 2\n\
    property uchar flag\nproperty list uchar int vertex_indices\nend_header\n";

const PLY_ROWS: [[f32; 8]; 4] = [
    [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    [0.0, 1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 1.0],
];

fn ply_ascii() -> Vec<u8> {
    let mut text = format!("ply\nformat ascii 1.0\n{PLY_HEAD}");
    for row in PLY_ROWS {
        let words: Vec<String> = row.iter().map(f32::to_string).collect();
        text += &words.join(" ");
        text.push('\n');
    }
    text += "7 3 0 1 2\n7 4 0 1 2 3\n";
    text.into_bytes()
}

fn ply_binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{PLY_HEAD}").into_bytes();
    let mut word = |value: [u8; 4]| {
        if big { bytes.extend(value.iter().rev()) } else { bytes.extend(value) }
    };
    PLY_ROWS.iter().flatten().for_each(|value| word(value.to_le_bytes()));
    for face in [&[0, 1, 2][..], &[0, 1, 2, 3]] {
        bytes.extend([7, face.len() as u8]);
        for index in face {
            bytes.extend(if big { i32::to_be_bytes(*index) } else { i32::to_le_bytes(*index) });
        }
    }
    bytes
}

/// A .igmesh of one triangle and one quadrilateral, uv layout 1.
fn igmesh(version: u32) -> Vec<u8> {
    let mut head = vec![5_456_751, version];
    if version >= 4 {
        head.extend([1, 0]);
    }
    head.extend([1, 1, 3]);
    let mut bytes = words(&head);
    bytes.extend(b"red");
    bytes.extend(words(&[1, 2]));
    bytes.extend(b"uv");
    bytes.extend(words(&[0]));
    let mut body = words(&[4]);
    body.extend(words(&[0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_bits)));
    body.extend(words(&[0]));
    if version >= 3 {
        body.extend(words(&[1]));
    }
    body.extend(words(&[2]));
    body.extend(words(&[0.0_f32, 0.25, 0.5, 0.75].map(f32::to_bits)));
    body.extend(words(&[1, 0, 1, 2, 0, 0, 1, 0]));
    if version >= 2 {
        body.extend(words(&[1, 0, 1, 2, 3, 0, 0, 1, 1, 0]));
    }
    if version >= 4 {
        let frame = ruzstd::encoding::compress_to_vec(&body[..], ruzstd::encoding::CompressionLevel::Fastest);
        bytes.extend((body.len() as u64).to_le_bytes());
        bytes.extend(frame);
    } else {
        bytes.extend(body);
    }
    bytes
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// One sound file, or more, of every kind.
pub fn samples() -> Vec<Sample> {
    let asset = |name: &str| {
        std::fs::read(format!("{}/tests/assets/3ds/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    };
    vec![
        (MeshFormat::Obj, "obj", OBJ.into()),
        (MeshFormat::Ply, "ascii ply", ply_ascii()),
        (MeshFormat::Ply, "little-endian ply", ply_binary(false)),
        (MeshFormat::Ply, "big-endian ply", ply_binary(true)),
        (MeshFormat::ThreeDs, "3ds cube", asset("cube_with_diffuse_texture.3DS")),
        (MeshFormat::ThreeDs, "3ds scene", asset("test1.3ds")),
        (MeshFormat::Igmesh, "igmesh 1", igmesh(1)),
        (MeshFormat::Igmesh, "igmesh 3", igmesh(3)),
        (MeshFormat::Igmesh, "igmesh 4, compressed", igmesh(4)),
    ]
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
    assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < n));
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

/// A small deterministic generator of test input (G. Marsaglia, "Xorshift RNGs", J. Stat. Software 8(14), 2003).
pub struct Xorshift(pub u64);

impl Xorshift {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// One of many ways to damage a file: cut, flip bits, overwrite with special values, remove, repeat or swap a stretch.
pub fn damage(bytes: &[u8], rng: &mut Xorshift) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=rng.below(3) {
        if out.is_empty() {
            break;
        }
        let at = rng.below(out.len());
        let length = 1 + rng.below((out.len() - at).min(24));
        match rng.below(7) {
            0 => out.truncate(at),
            1 => out[at] ^= 1 << rng.below(8),
            2 => out[at] = rng.next() as u8,
            3 => {
                let special = [0, 1, 0x7F, 0x80, 0xFF, b'-', b'9', b'\n', b'/', b' '][rng.below(10)];
                out[at..at + length.min(4)].fill(special);
            }
            4 => drop(out.drain(at..at + length)),
            5 => {
                let stretch = out[at..at + length].to_vec();
                for _ in 0..=rng.below(4) {
                    out.splice(at..at, stretch.iter().copied());
                }
            }
            _ => {
                let other = rng.below(out.len());
                out.swap(at, other);
            }
        }
    }
    out
}
