//! Closed meshes of what is inside a field: where it is negative.

use std::collections::HashMap;

use super::sphere::Mesh;
use super::vector::{Vector, add, cross, dot, normalize, scale, sub};

/// A lattice of points.
pub struct Lattice {
    /// Its lowest corner.
    pub low: Vector,
    /// From point to point.
    pub step: f64,
    /// Steps along each axis.
    pub steps: [usize; 3],
}

impl Lattice {
    /// That which covers a box.
    pub fn over(low: Vector, high: Vector, step: f64) -> Self {
        let steps = [0, 1, 2].map(|i| ((high[i] - low[i]) / step).ceil() as usize);
        Self { low, step, steps }
    }

    fn at(&self, p: [usize; 3]) -> Vector {
        add(self.low, p.map(|i| i as f64 * self.step))
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.steps.map(|n| n + 1);
        (z * ny + y) * nx + x
    }

    /// The field at all points; an edge of the surface that would pass closer to a point than a fiftieth of a step is
    /// moved away from it, lest triangles degenerate.
    fn values(&self, field: &impl Fn(Vector) -> f64) -> Vec<f64> {
        let [nx, ny, nz] = self.steps.map(|n| n + 1);
        let apart = |value: f64| value.abs().max(0.02 * self.step).copysign(value);
        let points = (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        points.map(|p| apart(field(self.at(p)))).collect()
    }
}

/// The three axes in each order: the walks along a cube's edges from its lowest corner to its highest, each of which
/// spans a tetrahedron (Kuhn 1960). Neighbouring cubes divide the face between them in the same way.
const WALKS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// The surface where a field is 0, negative inside, by marching tetrahedra; normals are the field's gradient. The field has to
/// be positive all round the lattice's border.
pub fn isosurface(lattice: &Lattice, field: impl Fn(Vector) -> f64) -> Mesh {
    let values = lattice.values(&field);
    let mut made = Made {
        mesh: Mesh { positions: vec![], normals: vec![], triangles: vec![] },
        of_edge: HashMap::new(),
    };
    let [nx, ny, nz] = lattice.steps;
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let corners =
                    (0..8).map(|i| values[lattice.index([x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2)])]);
                let inside = corners.filter(|&value| value < 0.0).count();
                if inside == 0 || inside == 8 {
                    continue;
                }
                for walk in WALKS {
                    let mut p = [x, y, z];
                    let mut tetrahedron = [(lattice.index(p), values[lattice.index(p)], lattice.at(p)); 4];
                    for (axis, corner) in walk.into_iter().zip(&mut tetrahedron[1..]) {
                        p[axis] += 1;
                        *corner = (lattice.index(p), values[lattice.index(p)], lattice.at(p));
                    }
                    made.cut(&tetrahedron);
                }
            }
        }
    }
    let mut mesh = made.mesh;
    let h = 0.1 * lattice.step;
    let slope = |p: Vector, axis: usize| {
        let mut d = [0.0; 3];
        d[axis] = h;
        field(add(p, d)) - field(sub(p, d))
    };
    mesh.normals = mesh.positions.iter().map(|&p| normalize([0, 1, 2].map(|axis| slope(p, axis)))).collect();
    mesh
}

/// A corner: number, value, position.
type Corner = (usize, f64, Vector);

struct Made {
    mesh: Mesh,
    /// The vertex on an edge between two corners.
    of_edge: HashMap<(usize, usize), u32>,
}

impl Made {
    /// Adds what a tetrahedron holds of the surface.
    fn cut(&mut self, corners: &[Corner; 4]) {
        let (inside, outside): (Vec<Corner>, Vec<Corner>) = corners.iter().partition(|corner| corner.1 < 0.0);
        let polygon: Vec<u32> = match (inside.as_slice(), outside.as_slice()) {
            ([a], out) => out.iter().map(|b| self.vertex(a, b)).collect(),
            (within, [b]) => within.iter().map(|a| self.vertex(a, b)).collect(),
            ([a, b], [c, d]) => [(a, c), (a, d), (b, d), (b, c)].map(|(p, q)| self.vertex(p, q)).to_vec(),
            _ => return,
        };
        let outwards = sub(outside[0].2, inside[0].2);
        for i in 2..polygon.len() {
            let [a, b, c] = [polygon[0], polygon[i - 1], polygon[i]];
            let [p, q, r] = [a, b, c].map(|i| self.mesh.positions[i as usize]);
            let front = dot(cross(sub(q, p), sub(r, p)), outwards) > 0.0;
            self.mesh.triangles.push(if front { [a, b, c] } else { [a, c, b] });
        }
    }

    /// Where the surface crosses the edge between two corners.
    fn vertex(&mut self, a: &Corner, b: &Corner) -> u32 {
        let (low, high) = if a.0 < b.0 { (a, b) } else { (b, a) };
        let positions = &mut self.mesh.positions;
        *self.of_edge.entry((low.0, high.0)).or_insert_with(|| {
            positions.push(add(low.2, scale(low.1 / (low.1 - high.1), sub(high.2, low.2))));
            positions.len() as u32 - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::lathe::tests::assert_solid;
    use super::*;

    #[test]
    fn a_ball_and_a_ring_are_closed_and_face_outwards() {
        let lattice = Lattice::over([-1.4; 3], [1.4; 3], 0.1);
        let ball = isosurface(&lattice, |p| dot(p, p).sqrt() - 1.0);
        assert_solid(&ball, 4.0 / 3.0 * std::f64::consts::PI);
        let ring = isosurface(&lattice, |[x, y, z]| (x.hypot(y) - 0.9).hypot(z) - 0.35);
        assert_solid(&ring, 2.0 * std::f64::consts::PI.powi(2) * 0.9 * 0.35f64.powi(2));
    }
}
