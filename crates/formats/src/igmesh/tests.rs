use ruzstd::encoding::{CompressionLevel, compress_to_vec};

use super::*;

/// A file of two uv sets: one triangle and (from version 2) one quadrilateral over a square's corners.
struct Sample {
    version: u32,
    compression: u32,
    layout: u32,
    /// The 64-bit size says the frame's length rather than the body's.
    size_of_frame: bool,
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn string(text: &str) -> Vec<u8> {
    [&words(&[text.len() as u32])[..], text.as_bytes()].concat()
}

const TRIANGLE: [u32; 7] = [1, 2, 3, 1, 1, 0, 1];
const QUAD: [u32; 9] = [3, 2, 1, 0, 0, 0, 1, 1, 0];

impl Sample {
    fn header(&self) -> Vec<u8> {
        let mut bytes = words(&[MAGIC, self.version]);
        if self.version >= 4 {
            bytes.extend(words(&[self.compression, 0]));
        }
        bytes.extend(words(&[2, 2]));
        bytes.extend(string("red"));
        bytes.extend(string("blue"));
        if self.version == 1 {
            bytes.extend(words(&[1]));
            bytes.extend(string("channel1"));
            bytes.extend(words(&[1]));
        } else {
            bytes.extend(words(&[0]));
        }
        bytes
    }

    fn body(&self) -> Vec<u8> {
        let mut bytes = words(&[4]);
        bytes.extend(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
        bytes.extend(words(&[0]));
        if self.version >= 3 {
            bytes.extend(words(&[self.layout]));
        }
        bytes.extend(words(&[4]));
        // Set 0 holds (0,1) and (2,3), set 1 holds (10,11) and (12,13).
        bytes.extend(floats(&if self.layout == 1 && self.version >= 3 {
            [0.0, 1.0, 2.0, 3.0, 10.0, 11.0, 12.0, 13.0]
        } else {
            [0.0, 1.0, 10.0, 11.0, 2.0, 3.0, 12.0, 13.0]
        }));
        let delta = |face: &[u32]| -> Vec<u32> {
            let n = face.len() / 2;
            let relative =
                |i: usize| if i.is_multiple_of(n) { face[i] } else { face[i].wrapping_sub(face[i / n * n]) };
            (0..2 * n).map(relative).chain([face[2 * n]]).collect()
        };
        let face = |face: &[u32]| words(&if self.compression == 1 { delta(face) } else { face.to_vec() });
        bytes.extend(words(&[1]));
        bytes.extend(face(&TRIANGLE));
        if self.version >= 2 {
            bytes.extend(words(&[1]));
            bytes.extend(face(&QUAD));
        }
        bytes
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.header();
        let body = self.body();
        if self.compression == 1 {
            let frame = compress_to_vec(&body[..], CompressionLevel::Fastest);
            let size = if self.size_of_frame { frame.len() } else { body.len() };
            bytes.extend((size as u64).to_le_bytes());
            bytes.extend(frame);
        } else {
            bytes.extend(body);
        }
        bytes
    }
}

fn samples() -> impl Iterator<Item = Sample> {
    let plain = |version, layout| Sample { version, compression: 0, layout, size_of_frame: false };
    let packed = |size_of_frame| Sample { version: 4, compression: 1, layout: 1, size_of_frame };
    [plain(1, 0), plain(2, 0), plain(3, 0), plain(3, 1), plain(4, 1), packed(false), packed(true)].into_iter()
}

/// Position, uv of both sets, for each corner of each triangle.
fn corners(mesh: &MeshData) -> Vec<([f32; 3], [f32; 2], [f32; 2])> {
    let corner = |v: u32| {
        let v = v as usize;
        (mesh.positions[v], mesh.uv_sets[0][v], mesh.uv_sets[1][v])
    };
    mesh.triangles.iter().flatten().map(|&v| corner(v)).collect()
}

#[test]
fn all_versions_and_layouts_say_the_same() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uvs = [([0.0, 1.0], [10.0, 11.0]), ([2.0, 3.0], [12.0, 13.0])];
    let corner = |v: usize, uv: usize| (square[v], uvs[uv].0, uvs[uv].1);
    let mut expected = vec![corner(1, 1), corner(2, 1), corner(3, 0)];
    let quad = [corner(3, 0), corner(2, 0), corner(1, 1), corner(0, 1)];
    expected.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
    for sample in samples() {
        let mesh = read(&sample.bytes()).unwrap();
        let faces = if sample.version == 1 { 1 } else { 3 };
        assert_eq!(corners(&mesh), expected[..3 * faces], "version {}", sample.version);
        assert_eq!(mesh.triangle_materials, [0, 1, 1][..faces]);
        assert_eq!(mesh.material_names, ["blue", "red"][..if faces == 1 { 1 } else { 2 }]);
        assert_eq!(mesh.material_numbers, [1, 0][..mesh.material_names.len()]);
        let name = if sample.version == 1 { ("channel1".to_owned(), 1) } else { ("default".to_owned(), 0) };
        assert_eq!(mesh.uv_names, [name]);
        assert!(mesh.normals.is_empty() && mesh.notes.is_empty(), "{:?}", mesh.notes);
    }
}

#[test]
fn a_cut_file_is_an_error_at_every_length() {
    for sample in samples() {
        let bytes = sample.bytes();
        for n in 0..bytes.len() {
            assert!(read(&bytes[..n]).is_err(), "version {} cut to {n} bytes", sample.version);
        }
    }
}

#[test]
fn errors_carry_offsets() {
    let good = Sample { version: 3, compression: 0, layout: 0, size_of_frame: false };
    let body_at = good.header().len();
    let triangle_at = body_at + 4 + 48 + 4 + 4 + 4 + 32 + 4;
    for (at, value, expected) in [
        (0, 7, "byte 0: expected the number 5456751 that starts an .igmesh file, found 7"),
        (4, 9, "byte 4: expected an .igmesh version from 1 to 4, found 9"),
        (8, 9, "byte 8: expected the number of uv sets (at most 8), found 9"),
        (body_at, u32::MAX, "expected 4294967295 vertices (51539607540 bytes or more)"),
        (body_at + 8, f32::NAN.to_bits(), "expected finite numbers among the vertices"),
        (body_at + 52, 3, "found 3"),
        (triangle_at + 4, 4, "expected indices of vertices, of which there are 4, found 4 in this face"),
        (triangle_at + 12, 2, "expected indices of uv pairs, of which there are 2 per set, found 2"),
        (triangle_at + 24, 2, "expected the index of a material, below 2, found 2"),
    ] {
        let mut bytes = good.bytes();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn a_wrong_size_and_a_bomb_are_refused() {
    let sample = Sample { version: 4, compression: 1, layout: 1, size_of_frame: false };
    let size_at = sample.header().len();
    for size in [0, 1, u64::MAX, 1 << 40] {
        let mut bytes = sample.bytes();
        bytes[size_at..size_at + 8].copy_from_slice(&size.to_le_bytes());
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.starts_with(&format!("byte {size_at}: expected")), "{error}");
    }
    // 64 MiB of zeros in a few kilobytes.
    let bomb = compress_to_vec(&vec![0; 64 << 20][..], CompressionLevel::Fastest);
    let mut bytes = sample.header();
    bytes.extend((bomb.len() as u64).to_le_bytes());
    bytes.extend(bomb);
    let error = read(&bytes).unwrap_err().to_string();
    assert!(error.contains("one that grows beyond"), "{error}");
}

#[test]
fn a_file_without_names_or_uv_sets() {
    let mut bytes = words(&[MAGIC, 2, 0, 0, 0, 3]);
    bytes.extend(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    bytes.extend(words(&[3]));
    bytes.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    bytes.extend(words(&[1]));
    bytes.extend(floats(&[0.0, 0.0]));
    bytes.extend(words(&[1, 0, 1, 2, 0, 0, 0, 5, 0]));
    let mesh = read(&bytes).unwrap();
    assert_eq!(mesh.material_names, ["5"]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert!(mesh.uv_sets.is_empty() && mesh.uv_names.is_empty());
    assert_eq!(mesh.notes.len(), 1);
}
