//! Binary PLY, as the mesh reader reads it.

use std::io::{self, Write};

use super::sphere::Mesh;

/// Writes positions, normals and triangles, little-endian, in single precision.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.positions.len())?;
    for property in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(out, "property float {property}")?;
    }
    writeln!(out, "element face {}\nproperty list uchar int vertex_indices", mesh.triangles.len())?;
    writeln!(out, "end_header")?;
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        for number in position.iter().chain(normal) {
            out.write_all(&(*number as f32).to_le_bytes())?;
        }
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        for index in triangle {
            out.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_the_header() {
        let mesh = Mesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            triangles: vec![[0, 1, 2]],
        };
        let mut bytes = Vec::new();
        write(&mesh, &mut bytes).unwrap();
        let end = b"end_header\n";
        let data = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
        assert_eq!(bytes.len() - data, 3 * 24 + 13);
        assert_eq!(&bytes[data + 72..data + 77], &[3, 0, 0, 0, 0]);
    }
}
