//! How fast mesh files are read: a binary .ply of a million triangles, an .obj of about 50 MB, best and median of
//! several readings of a file that lies in memory.
//!
//! Run with `cargo bench -p indigo-formats`.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use indigo_formats::{MeshData, obj, ply};

const REPEATS: usize = 7;

fn main() {
    report("binary .ply", &ply::write_binary(&grid(708)), ply::read);
    report("ascii .obj with uvs and normals", &obj_text(&grid(500)), obj::read);
}

/// A wavy height field of `2 n²` triangles.
fn grid(n: u32) -> MeshData {
    let at = |i: u32| i as f32 / n as f32;
    let positions = (0..=n).flat_map(|y| (0..=n).map(move |x| (at(x), at(y))));
    let triangles = (0..n).flat_map(|y| (0..n).map(move |x| y * (n + 1) + x)).flat_map(|a| {
        let b = a + n + 1;
        [[a, a + 1, b + 1], [a, b + 1, b]]
    });
    MeshData {
        positions: positions.map(|(x, y)| [x, y, (9.0 * x).sin() * (7.0 * y).cos()]).collect(),
        triangles: triangles.collect(),
        ..MeshData::default()
    }
}

fn obj_text(mesh: &MeshData) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        let _ = writeln!(text, "v {x:.6} {y:.6} {z:.6}");
    }
    for [x, y, _] in &mesh.positions {
        let _ = writeln!(text, "vt {x:.6} {y:.6}");
    }
    for [x, y, _] in &mesh.positions {
        let length = (1.0 + x * x + y * y).sqrt();
        let _ = writeln!(text, "vn {:.6} {:.6} {:.6}", x / length, y / length, 1.0 / length);
    }
    text.push_str("usemtl wave\n");
    for triangle in &mesh.triangles {
        text.push('f');
        for i in triangle.map(|i| i + 1) {
            let _ = write!(text, " {i}/{i}/{i}");
        }
        text.push('\n');
    }
    text.into_bytes()
}

fn report<E: std::fmt::Debug>(what: &str, bytes: &[u8], read: fn(&[u8]) -> Result<MeshData, E>) {
    let mut times = Vec::new();
    let mut triangles = 0;
    for _ in 0..REPEATS {
        let start = Instant::now();
        let mesh = black_box(read(black_box(bytes)).expect("the file is sound"));
        times.push(start.elapsed().as_secs_f64());
        triangles = mesh.triangles.len();
    }
    times.sort_by(f64::total_cmp);
    let (best, median) = (times[0], times[REPEATS / 2]);
    let size = bytes.len() as f64 / 1e6;
    println!(
        "{what}: {triangles} triangles, {size:.1} MB: best {best:.3} s, median {median:.3} s, {:.0} MB/s",
        size / best
    );
}
