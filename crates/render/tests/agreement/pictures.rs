//! The modes' pictures side by side, for the eye.

use super::SIDE;
use indigo_testkit::png;
use std::path::Path;

/// Writes pictures of mean X, Y, Z from left to right, where the environment names a folder.
pub fn write(name: &str, pictures: &[Vec<[f64; 3]>]) {
    let Ok(folder) = std::env::var("INDIGO_GRID_PICTURES") else { return };
    let side = SIDE as usize;
    let brightest = pictures[0].iter().map(|p| p[1]).sum::<f64>() / pictures[0].len() as f64 * 3.0;
    let zoom = 8;
    let width = side * zoom * pictures.len();
    let mut bytes = vec![0u8; width * side * zoom * 3];
    for (i, pixel) in bytes.chunks_exact_mut(3).enumerate() {
        let (x, y) = (i % width / zoom, i / width / zoom);
        let [cx, cy, cz] = pictures[x / side][y * side + x % side].map(|v| v / brightest);
        // Linear Rec. 709 (IEC 61966-2-1).
        let rgb = [
            3.2406 * cx - 1.5372 * cy - 0.4986 * cz,
            -0.9689 * cx + 1.8758 * cy + 0.0415 * cz,
            0.0557 * cx - 0.2040 * cy + 1.0570 * cz,
        ];
        pixel.copy_from_slice(&rgb.map(|v| (v.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8));
    }
    let path = Path::new(&folder).join(format!("{name}.png"));
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    let rows: Vec<&[u8]> = bytes.chunks_exact(width * 3).collect();
    let mut file = std::fs::File::create(path).expect("a writable folder");
    png::write_rgb(width, &rows, &mut file).expect("room for a picture");
}
