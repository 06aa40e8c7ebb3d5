//! Surfaces of revolution about the z axis, turned from a profile.

use super::sphere::Mesh;
use super::vector::normalize;

/// A point of a profile: distance from the axis, and height.
pub type Point = [f64; 2];

/// The outline of half a section, walked so that what it bounds is on its left: along the bottom away from
/// the axis, up the outside. A point given twice is a crease, over which normals are not smoothed.
#[derive(Clone, Debug, Default)]
pub struct Profile(pub Vec<Point>);

impl Profile {
    /// On to the next point.
    pub fn to(mut self, p: Point) -> Self {
        self.0.push(p);
        self
    }

    /// On along a cubic Bézier curve with two control points, in `n` steps.
    pub fn curve(mut self, [b, c, d]: [Point; 3], n: u32) -> Self {
        let a = self.0[self.0.len() - 1];
        self.0.extend((1..=n).map(|i| bezier([a, b, c, d], f64::from(i) / f64::from(n))));
        self
    }

    /// On through the points of another.
    pub fn then(mut self, points: impl IntoIterator<Item = Point>) -> Self {
        self.0.extend(points);
        self
    }

    /// The same curve moved to its right, outwards, by a distance.
    pub fn moved_out(&self, distance: f64) -> Vec<Point> {
        self.0
            .iter()
            .enumerate()
            .map(|(i, p)| {
                let n = self.normal(i);
                [p[0] + distance * n[0], p[1] + distance * n[1]]
            })
            .collect()
    }

    /// The normal that points to the right of the walk at point `i`, between those of the steps to it and from
    /// it; that of the one step at an end and on either side of a crease; up or down on the axis.
    pub fn normal(&self, i: usize) -> Point {
        let step = |from: usize| {
            let (a, b) = (self.0[from], self.0[from + 1]);
            let [dr, dz] = [b[0] - a[0], b[1] - a[1]];
            [dz / dr.hypot(dz), -dr / dr.hypot(dz)]
        };
        let is_step = |from: &usize| self.0.get(from + 1).is_some_and(|b| *b != self.0[*from]);
        let before = i.checked_sub(1).filter(is_step);
        let after = Some(i).filter(is_step);
        let [before, after] =
            [before.or(after), after.or(before)].map(|from| step(from.expect("a profile has steps")));
        if self.0[i][0] == 0.0 {
            return [0.0, before[1].signum()];
        }
        let sum = [before[0] + after[0], before[1] + after[1]];
        sum.map(|x| x / sum[0].hypot(sum[1]))
    }

    /// The mesh that a turn about the axis makes, in `n` steps, with smooth normals.
    pub fn turned(&self, n: u32) -> Mesh {
        let (mut positions, mut normals, mut rings) = (vec![], vec![], vec![]);
        for (i, &[r, z]) in self.0.iter().enumerate() {
            let [nr, nz] = self.normal(i);
            rings.push(positions.len() as u32);
            for step in 0..if r == 0.0 { 1 } else { n } {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(step) / f64::from(n)).sin_cos();
                positions.push([r * cos, r * sin, z]);
                normals.push(normalize([nr * cos, nr * sin, nz]));
            }
        }
        let mut triangles = vec![];
        for (i, pair) in self.0.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]) {
            let vertex = |k: usize, step: u32| rings[i + k] + if pair[k][0] == 0.0 { 0 } else { step % n };
            for step in 0..n {
                let [a, b] = [vertex(0, step), vertex(0, step + 1)];
                let [c, d] = [vertex(1, step), vertex(1, step + 1)];
                // One of the two has no area where a ring is a point of the axis.
                triangles.extend([[a, b, d], [a, d, c]].into_iter().filter(|t| all_different(*t)));
            }
        }
        Mesh { positions, normals, triangles }
    }
}

fn all_different([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// A point of a cubic Bézier curve.
pub fn bezier(p: [Point; 4], t: f64) -> Point {
    let s = 1.0 - t;
    let w = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    [0, 1].map(|k| (0..4).map(|i| w[i] * p[i][k]).sum())
}

/// Half a circle from `a` to `b` by the outside of the walk, without its ends.
pub fn rim(a: Point, b: Point, n: u32) -> Vec<Point> {
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let half = [a[0] - middle[0], a[1] - middle[1]];
    let turned = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        [middle[0] + cos * half[0] - sin * half[1], middle[1] + sin * half[0] + cos * half[1]]
    };
    (1..n).map(|i| turned(std::f64::consts::PI * f64::from(i) / f64::from(n))).collect()
}

#[cfg(test)]
pub mod tests {
    use super::super::vector::{cross, dot, sub};
    use super::*;
    use std::collections::HashSet;

    /// That a mesh is closed, its fronts are where its normals point, and it holds a volume near `volume`, m³.
    pub fn assert_solid(mesh: &Mesh, volume: f64) {
        let mut edges = HashSet::new();
        // Vertices of a crease differ in their normals alone.
        let place = |i: u32| mesh.positions[i as usize].map(f64::to_bits);
        for &[a, b, c] in &mesh.triangles {
            for edge in [[a, b], [b, c], [c, a]].map(|edge| edge.map(place)) {
                assert!(edges.insert(edge), "edge {edge:?} runs twice one way");
            }
            let [p, q, r] = [a, b, c].map(|i| mesh.positions[i as usize]);
            let front = cross(sub(q, p), sub(r, p));
            for i in [a, b, c] {
                assert!(dot(front, mesh.normals[i as usize]) > 0.0, "{p:?}: the normal is at the back");
            }
        }
        assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])), "a hole");
        let of = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|i| mesh.positions[i as usize]);
            dot(p, cross(q, r)) / 6.0
        };
        let sum: f64 = mesh.triangles.iter().map(of).sum();
        assert!((sum / volume - 1.0).abs() < 0.05, "{sum} m³ instead of {volume}");
    }

    #[test]
    fn a_cylinder_with_a_round_edge_is_closed_and_faces_outwards() {
        let [a, b] = [[1.0, 2.0], [0.8, 2.0]];
        assert!(rim(a, b, 8).iter().all(|p| p[1] > 2.0), "by the outside");
        let profile = Profile(vec![[0.0, 0.0], [1.0, 0.0], a]).then(rim(a, b, 8)).to(b).to([0.0, 2.0]);
        assert_solid(&profile.turned(48), 2.0 * std::f64::consts::PI);
    }

    #[test]
    fn creases_are_not_smoothed() {
        let corner = [1.0, 1.0];
        let profile = Profile(vec![[0.0, 0.0], [1.0, 0.0], corner, corner, [0.0, 1.0]]);
        assert_solid(&profile.turned(48), std::f64::consts::PI);
        let [wall, lid] = [2, 3].map(|i| profile.normal(i));
        assert_eq!([wall, lid], [[1.0, 0.0], [0.0, 1.0]]);
        assert!(profile.normal(1)[0] > 0.7 && profile.normal(1)[1] < -0.7, "elsewhere they are");
    }

    #[test]
    fn a_curve_moved_out_keeps_its_distance() {
        let curve = Profile(vec![[0.0, -1.0]]).curve([[0.5523, -1.0], [1.0, -0.5523], [1.0, 0.0]], 20);
        for [r, z] in curve.moved_out(0.1) {
            assert!((r.hypot(z) - 1.1).abs() < 2e-3);
        }
    }
}
