//! Cutting polygons into triangles: a fan where the polygon is convex, ear clipping (G. H. Meisters, "Polygons have
//! ears", Amer. Math. Monthly 82, 1975) where it is not.

use crate::vec3::{Vec3, cross, dot, sub, to_f64};

/// Ear clipping is quadratic at best: larger concave polygons are fanned, which is wrong only where they are concave.
const MAX_EAR_CORNERS: usize = 8192;
/// Point-in-triangle tests that one file may cost; a few seconds. Only files made to annoy come near it.
const EAR_BUDGET: u64 = 1 << 30;
/// A turn this small against the polygon's area counts as straight on: rounding in f32 coordinates.
const STRAIGHT: f64 = 1e-7;

/// Cuts polygons and counts those that it could not cut properly.
pub(crate) struct Triangulator {
    budget: u64,
    /// Polygons that were fanned though concave: too large, or crossing themselves.
    pub(crate) rough: usize,
}

impl Triangulator {
    pub(crate) fn new() -> Self {
        Self { budget: EAR_BUDGET, rough: 0 }
    }

    /// Calls `emit` for each triangle, wound as the polygon is. `corners` index `positions`; corners out of range are
    /// taken as the origin (callers check them before).
    pub(crate) fn split(&mut self, corners: &[u32], positions: &[[f32; 3]], emit: &mut impl FnMut([u32; 3])) {
        let point = |i: usize| {
            let index = corners.get(i % corners.len()).copied().unwrap_or(0);
            to_f64(positions.get(index as usize).copied().unwrap_or_default())
        };
        let n = corners.len();
        let normal = if n > 3 { newell(n, &point) } else { [0.0; 3] };
        match first_reflex(n, normal, &point) {
            None => fan(corners, 0, emit),
            // A simple quadrilateral has one reflex corner at most, and the diagonal from it lies inside.
            Some(reflex) if n == 4 => fan(corners, reflex, emit),
            Some(_) => {
                let cut = n <= MAX_EAR_CORNERS && self.clip_ears(corners, normal, &point, emit);
                if !cut {
                    self.rough += 1;
                    if n > MAX_EAR_CORNERS {
                        fan(corners, 0, emit);
                    }
                }
            }
        }
    }

    /// Emits all triangles; false if the last of them are a mere fan because no ear was left (or no budget).
    fn clip_ears(
        &mut self,
        corners: &[u32],
        normal: Vec3,
        point: &impl Fn(usize) -> Vec3,
        emit: &mut impl FnMut([u32; 3]),
    ) -> bool {
        let mut ring: Vec<(u32, [f64; 2])> =
            corners.iter().enumerate().map(|(i, &corner)| (corner, flatten(point(i), normal))).collect();
        let mut at = 0;
        let mut tried = 0;
        while ring.len() > 3 && tried < ring.len() {
            let cost = ring.len() as u64;
            if self.budget < cost {
                break;
            }
            self.budget -= cost;
            let n = ring.len();
            at %= n;
            let (before, after) = ((at + n - 1) % n, (at + 1) % n);
            if let (Some(&a), Some(&b), Some(&c)) = (ring.get(before), ring.get(at), ring.get(after))
                && is_ear(&ring, [a.1, b.1, c.1])
            {
                emit([a.0, b.0, c.0]);
                ring.remove(at);
                tried = 0;
            } else {
                at += 1;
                tried += 1;
            }
        }
        let clean = ring.len() == 3;
        let rest: Vec<u32> = ring.into_iter().map(|(corner, _)| corner).collect();
        fan(&rest, 0, emit);
        clean
    }
}

/// All triangles that share corner `start`.
fn fan(corners: &[u32], start: usize, emit: &mut impl FnMut([u32; 3])) {
    let n = corners.len();
    let corner = |i: usize| corners.get((start + i) % n).copied().unwrap_or(0);
    for i in 1..n.saturating_sub(1) {
        emit([corner(0), corner(i), corner(i + 1)]);
    }
}

/// Twice the area vector of a polygon, flat or not (M. E. Newell's method, Sutherland, Sproull and Schumacker,
/// Computing Surveys 6, 1974, Appendix).
fn newell(n: usize, point: &impl Fn(usize) -> Vec3) -> Vec3 {
    let origin = point(0);
    let mut normal = [0.0; 3];
    for i in 1..n - 1 {
        let part = cross(sub(point(i), origin), sub(point(i + 1), origin));
        for (sum, x) in normal.iter_mut().zip(part) {
            *sum += x;
        }
    }
    normal
}

/// The first corner at which the polygon turns against its normal; none for triangles and convex polygons.
fn first_reflex(n: usize, normal: Vec3, point: &impl Fn(usize) -> Vec3) -> Option<usize> {
    if n < 4 {
        return None;
    }
    let least = -STRAIGHT * dot(normal, normal);
    (0..n).find(|&i| {
        let (a, b, c) = (point(i + n - 1), point(i), point(i + 1));
        dot(cross(sub(b, a), sub(c, b)), normal) < least
    })
}

/// Projects along the normal's largest component, so that the polygon's turns become counter-clockwise.
fn flatten(p: Vec3, normal: Vec3) -> [f64; 2] {
    let [nx, ny, nz] = normal.map(f64::abs);
    let [x, y, z] = p;
    let (u, v, along) = if nx >= ny && nx >= nz {
        (y, z, normal[0])
    } else if ny >= nz {
        (z, x, normal[1])
    } else {
        (x, y, normal[2])
    };
    if along < 0.0 { [v, u] } else { [u, v] }
}

/// Twice the signed area of a triangle, positive if counter-clockwise.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether the triangle can be cut off: a left turn with no other corner in it. Corners at the same place as one of
/// its own do not count, so that holes joined to the rim by a doubled edge work.
fn is_ear(ring: &[(u32, [f64; 2])], [a, b, c]: [[f64; 2]; 3]) -> bool {
    turn(a, b, c) > 0.0
        && !ring.iter().any(|&(_, p)| {
            p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f32; 3]]) -> (Vec<[u32; 3]>, usize) {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        let mut triangulator = Triangulator::new();
        triangulator.split(&corners, points, &mut |t| triangles.push(t));
        (triangles, triangulator.rough)
    }

    /// Signed areas about `axis`: all positive and summing to the polygon's area means a proper tiling.
    fn areas(points: &[[f32; 3]], triangles: &[[u32; 3]], axis: Vec3) -> Vec<f64> {
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| to_f64(points[i as usize]));
                0.5 * dot(cross(sub(b, a), sub(c, a)), axis)
            })
            .collect()
    }

    #[test]
    fn a_convex_polygon_becomes_a_fan() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&square).0, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_dart_is_cut_at_its_reflex_corner_wherever_that_is() {
        let dart = [[0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [0.5, 0.0, 0.0], [2.0, 1.0, 0.0]];
        for shift in 0..4 {
            let mut points = dart;
            points.rotate_left(shift);
            let (triangles, rough) = cut(&points);
            let areas = areas(&points, &triangles, [0.0, 0.0, 1.0]);
            assert!(areas.iter().all(|&a| a > 0.0), "shift {shift}: {areas:?}");
            // The triangle round it (area 2) less the notch (area 1.5).
            assert!((areas.iter().sum::<f64>() - 0.5).abs() < 1e-12);
            assert_eq!(rough, 0);
        }
    }

    #[test]
    fn a_comb_is_tiled_in_every_orientation() {
        // A comb of 20 teeth in the plane: area known by the shoelace formula below.
        let mut outline = vec![[0.0, -1.0], [20.0, -1.0]];
        for tooth in (0..20).rev() {
            let x = tooth as f32;
            outline.push([x + 1.0, 0.0]);
            outline.push([x + 0.5, 5.0]);
        }
        outline.push([0.0, 0.0]);
        let shoelace: f64 = (0..outline.len())
            .map(|i| {
                let ([x0, y0], [x1, y1]) = (outline[i], outline[(i + 1) % outline.len()]);
                0.5 * f64::from(x0 * y1 - x1 * y0)
            })
            .sum();
        for axis in 0..3 {
            for mirrored in [false, true] {
                let mut points: Vec<[f32; 3]> = outline
                    .iter()
                    .map(|&[u, v]| {
                        let mut p = [0.0; 3];
                        p[(axis + 1) % 3] = u;
                        p[(axis + 2) % 3] = v;
                        p
                    })
                    .collect();
                if mirrored {
                    points.reverse();
                }
                let mut normal = [0.0; 3];
                normal[axis] = if mirrored { -1.0 } else { 1.0 };
                let (triangles, rough) = cut(&points);
                assert_eq!((triangles.len(), rough), (points.len() - 2, 0));
                let areas = areas(&points, &triangles, normal);
                assert!(areas.iter().all(|&a| a >= 0.0));
                assert!((areas.iter().sum::<f64>() - shoelace).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_polygon_that_crosses_itself_is_cut_somehow_and_counted() {
        let bow_tie = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.5, 0.0], [-1.0, 1.0, 0.0]];
        let (triangles, _) = cut(&bow_tie);
        assert_eq!(triangles.len(), 3);
    }

    #[test]
    fn a_polygon_of_many_reflex_corners_ends_soon() {
        // A star with 40,000 spikes is beyond the limit and is fanned; one with 2,000 is cut.
        for (spikes, rough_expected) in [(2_000, 0), (40_000, 1)] {
            let points: Vec<[f32; 3]> = (0..2 * spikes)
                .map(|i| {
                    let angle = std::f32::consts::PI * i as f32 / spikes as f32;
                    let radius = if i % 2 == 0 { 2.0 } else { 1.0 };
                    [radius * angle.cos(), radius * angle.sin(), 0.0]
                })
                .collect();
            let (triangles, rough) = cut(&points);
            assert_eq!((triangles.len(), rough), (points.len() - 2, rough_expected));
        }
    }
}
