//! Openings through which the light of the surroundings comes into an interior.
//!
//! Through a portal light is found by a point of it: even over the area of all portals together, towards a
//! receiver as well as where light enters. A direction may pass several portals, and each could have
//! been the one that was drawn; the density is the sum over all of them. Portals are no surfaces: whatever
//! stands in the light's way, before a portal or behind it, still does.

use crate::line_tree::LineTree;
use indigo_math::distribution::AliasTable;
use indigo_math::warp::uniform_triangle;
use indigo_math::{Real, Vec2, Vec3, Vec3d};

/// The triangles of all portals of a scene.
#[derive(Clone, Debug)]
pub struct Portals {
    /// In the order of the tree.
    triangles: Vec<Triangle>,
    tree: LineTree,
    by_area: AliasTable,
    area_m2: f64,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    corner: Vec3,
    edge1: Vec3,
    edge2: Vec3,
    /// Unit normal, into the interior.
    normal: Vec3,
}

/// A point drawn on a portal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortalPoint {
    pub p: Vec3,
    /// Unit normal, into the interior.
    pub n: Vec3,
    /// Sum of the lengths that `p` is the sum of: its rounding is some units in the last place of this.
    pub magnitude: Real,
}

/// How a ray passes the portals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// By none.
    Beside,
    /// Through the front of one, out of the interior.
    Out,
    /// Only through backs.
    Back,
}

impl Portals {
    /// From corners in render space, counter-clockwise seen from the interior; `None` without any area.
    pub fn new(corners: &[[Vec3d; 3]]) -> Option<Self> {
        let area = |c: &[Vec3d; 3]| 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length();
        let mut solid = corners.to_vec();
        solid.retain(|c| area(c) > 0.0 && area(c).is_finite());
        let tree = LineTree::new(&mut solid);
        let areas: Vec<f64> = solid.iter().map(area).collect();
        let triangles = solid.iter().map(|c| {
            let (e1, e2) = (c[1] - c[0], c[2] - c[0]);
            Triangle {
                corner: c[0].cast(),
                edge1: e1.cast(),
                edge2: e2.cast(),
                normal: e1.cross(e2).normalized().cast(),
            }
        });
        let triangles: Vec<Triangle> = triangles.collect();
        (!triangles.is_empty()).then(|| Self {
            triangles,
            tree,
            by_area: AliasTable::new(&areas),
            area_m2: areas.iter().sum(),
        })
    }

    /// Area of all portals in m².
    pub fn area(&self) -> f64 {
        self.area_m2
    }

    /// A point, even over the area.
    #[inline]
    pub(crate) fn sample_point(&self, choice: f64, at: [Real; 2]) -> PortalPoint {
        let (i, _, _) = self.by_area.sample(choice);
        let t = &self.triangles[i];
        let (b1, b2) = uniform_triangle(Vec2::from(at));
        let (a, b) = (t.edge1 * b1, t.edge2 * b2);
        PortalPoint {
            p: t.corner + a + b,
            n: t.normal,
            magnitude: t.corner.length() + a.length() + b.length(),
        }
    }

    /// A direction out of the interior from a point, with density [`pdf_direction`](Self::pdf_direction).
    #[inline]
    pub(crate) fn sample_direction(&self, p: Vec3, choice: f64, at: [Real; 2]) -> Option<Vec3> {
        let at = self.sample_point(choice, at);
        let wi = (at.p - p).try_normalized()?;
        (wi.dot(at.n) < 0.0).then_some(wi)
    }

    /// Density (1/sr) with which [`sample_direction`](Self::sample_direction) draws a direction from `p`.
    #[inline]
    pub(crate) fn pdf_direction(&self, p: Vec3, wi: Vec3) -> Real {
        let mut sum = 0.0;
        self.visit_crossings(p, wi, |t, cos| sum += if t > 0.0 && cos > 0.0 { t * t / cos } else { 0.0 });
        sum * self.inverse_area()
    }

    /// Density (1/m²), over area across the direction, with which even points of the portals draw the line
    /// through a point towards the light; all along the line, since what lies before a portal gets its light, too.
    #[inline]
    pub(crate) fn pdf_line(&self, through: Vec3, towards: Vec3) -> Real {
        let mut sum = 0.0;
        self.visit_crossings(through, towards, |_, cos| sum += if cos > 0.0 { 1.0 / cos } else { 0.0 });
        sum * self.inverse_area()
    }

    /// How a ray of some length passes.
    pub fn passage(&self, p: Vec3, d: Vec3, length: Real) -> Passage {
        let mut passage = Passage::Beside;
        self.visit_crossings(p, d, |t, cos| {
            if t > 0.0 && t < length && passage != Passage::Out {
                passage = if cos > 0.0 { Passage::Out } else { Passage::Back };
            }
        });
        passage
    }

    #[inline]
    fn inverse_area(&self) -> Real {
        (1.0 / self.area_m2) as Real
    }

    /// Calls for each portal that a line passes: distance along it, and the cosine to the normal's other side
    /// (above 0 where the line leads out of the interior).
    #[inline]
    fn visit_crossings(&self, p: Vec3, d: Vec3, mut visit: impl FnMut(Real, Real)) {
        self.tree.visit(p, d, |range| {
            for triangle in &self.triangles[range] {
                if let Some(t) = triangle.meet(p, d) {
                    visit(t, -d.dot(triangle.normal));
                }
            }
        });
    }
}

impl Triangle {
    /// Distance along a line at which it meets the triangle, from either side (Möller & Trumbore 1997).
    #[inline]
    fn meet(&self, p: Vec3, d: Vec3) -> Option<Real> {
        let across = d.cross(self.edge2);
        let determinant = self.edge1.dot(across);
        let from = p - self.corner;
        let u = from.dot(across) / determinant;
        let beside = from.cross(self.edge1);
        let v = d.dot(beside) / determinant;
        let t = self.edge2.dot(beside) / determinant;
        // A line in the triangle's plane gives numbers that are none, and no comparison holds.
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t.is_finite()).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::Float;
    use indigo_math::rng::Rng;

    const FAR: Real = Real::INFINITY;

    /// Two windows of different size in the walls x = 2 and y = 3 of a room round the origin.
    fn windows() -> Portals {
        let v = Vec3d::new;
        Portals::new(&[
            [v(2.0, -1.0, -1.0), v(2.0, 1.0, 1.0), v(2.0, 1.0, -1.0)],
            [v(2.0, -1.0, -1.0), v(2.0, -1.0, 1.0), v(2.0, 1.0, 1.0)],
            [v(-0.5, 3.0, 0.0), v(0.5, 3.0, 0.0), v(0.0, 3.0, 0.5)],
        ])
        .unwrap()
    }

    #[test]
    fn passages_are_told_apart() {
        let w = windows();
        let o = Vec3::ZERO;
        assert_eq!(w.passage(o, Vec3::new(1.0, 0.1, 0.1), FAR), Passage::Out);
        assert_eq!(w.passage(o, Vec3::new(0.0, 1.0, 0.05), FAR), Passage::Out);
        assert_eq!(w.passage(o, Vec3::new(-1.0, 0.0, 0.0), FAR), Passage::Beside);
        // Something stands before the window.
        assert_eq!(w.passage(o, Vec3::new(1.0, 0.1, 0.1), 1.9), Passage::Beside);
        assert_eq!(w.passage(Vec3::new(5.0, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0), FAR), Passage::Back);
        assert!(Portals::new(&[[Vec3d::ZERO; 3]]).is_none());
    }

    /// Directions drawn towards the windows have the mean density that the solid angle asks for: the mean
    /// of 1 / density is the solid angle that is seen, here from a point 2 m from the larger window: a pyramid's
    /// 4 asin(1 / 5), and a triangle's by Oosterom and Strackee. 4.4 standard errors: false alarms 1e-5.
    #[test]
    fn densities_cover_the_solid_angle() {
        let w = windows();
        let mut rng = Rng::new(4);
        let (mut sum, mut squares) = (0.0, 0.0);
        let n = 100_000;
        for _ in 0..n {
            let at = [rng.next_real(), rng.next_real()];
            let d = w.sample_direction(Vec3::ZERO, rng.next_real().to_f64(), at).unwrap();
            let v = 1.0 / w.pdf_direction(Vec3::ZERO, d) as f64;
            sum += v;
            squares += v * v;
        }
        let mean = sum / f64::from(n);
        let error = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
        let [a, b, c] =
            [[-0.5, 3.0, 0.0], [0.5, 3.0, 0.0], [0.0, 3.0, 0.5]].map(|p| Vec3d::from(p).normalized());
        let triangle = 2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        let exact = 4.0 * (0.2f64).asin() + triangle;
        assert!((mean - exact).abs() < 4.4 * error, "{mean} {exact} {error}");
    }

    #[test]
    fn a_line_is_as_dense_as_the_points_that_draw_it() {
        let w = windows();
        // The larger window alone, under 60°: two triangles meet in no line's density twice.
        let d = Vec3::new(0.5, 0.75f64.sqrt() as Real, 0.0);
        let through = Vec3::new(2.0, 0.3, -0.2) - d * 7.0;
        let expected = 1.0 / (0.5 * w.area());
        assert!((w.pdf_line(through, d) as f64 / expected - 1.0).abs() < 1e-4);
        assert_eq!(w.pdf_line(through, -d), 0.0);
        // The same from beyond the window.
        assert!((w.pdf_line(through + d * 20.0, d) as f64 / expected - 1.0).abs() < 1e-4);
    }
}
