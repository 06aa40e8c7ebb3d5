//! A sphere of nearly equal triangles, closed, with every vertex shared.

use std::collections::HashMap;

use super::vector::{Vector, add, cross, dot, normalize, sub};

/// Triangles over shared vertices.
pub struct Mesh {
    /// Positions in metres.
    pub positions: Vec<Vector>,
    /// Unit normals, one a vertex.
    pub normals: Vec<Vector>,
    /// Indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A cube whose faces are grids of `n` x `n` squares, blown up to the unit sphere and then moved by
/// `place` from each unit direction: 12 n² triangles.
pub fn displaced(n: u32, place: impl Fn(Vector) -> Vector) -> Mesh {
    let mut index = HashMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for face in 0..6 {
        for row in 0..n {
            for column in 0..n {
                let mut corner = |dr: u32, dc: u32| {
                    let key = lattice_point(face, n, row + dr, column + dc);
                    *index.entry(key).or_insert_with(|| {
                        positions.push(place(direction(key, n)));
                        positions.len() as u32 - 1
                    })
                };
                let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    for triangle in &mut triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        if dot(cross(sub(b, a), sub(c, a)), add(add(a, b), c)) < 0.0 {
            triangle.swap(1, 2);
        }
    }
    let normals = smooth_normals(&positions, &triangles);
    Mesh { positions, normals, triangles }
}

/// A point of the cube's surface in whole steps: neighbouring faces give the same one at their edge.
fn lattice_point(face: u32, n: u32, row: u32, column: u32) -> [u32; 3] {
    let side = if face.is_multiple_of(2) { 0 } else { n };
    match face / 2 {
        0 => [side, row, column],
        1 => [row, side, column],
        _ => [row, column, side],
    }
}

/// The direction of a lattice point; the tangent evens out the triangles between centre and corner.
fn direction(key: [u32; 3], n: u32) -> Vector {
    let warp = |i: u32| ((2.0 * f64::from(i) / f64::from(n) - 1.0) * std::f64::consts::FRAC_PI_4).tan();
    normalize(key.map(warp))
}

/// Means of the adjoining faces' normals, weighted by area.
fn smooth_normals(positions: &[Vector], triangles: &[[u32; 3]]) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let twice_area = cross(sub(b, a), sub(c, a));
        for &i in triangle {
            sums[i as usize] = add(sums[i as usize], twice_area);
        }
    }
    sums.into_iter().map(normalize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_closed_and_faces_outwards() {
        let mesh = displaced(5, |d| d);
        assert_eq!(mesh.triangles.len(), 12 * 25);
        // Euler: V - E + F = 2 with E = 3F/2.
        assert_eq!(mesh.positions.len(), 2 + mesh.triangles.len() / 2);
        let mut edges = HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for edge in [(*a, *b), (*b, *c), (*c, *a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        // Each edge once in each direction: closed and consistently wound.
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.contains_key(&(b, a))));
        assert!(mesh.positions.iter().zip(&mesh.normals).all(|(&p, &n)| dot(p, n) > 0.95));
    }
}
