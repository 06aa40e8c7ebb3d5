//! A tree of boxes round triangles, to find those that a line may meet.

use indigo_math::{Float, Real, Vec3, Vec3d};
use std::ops::Range;

/// Triangles of a leaf, at most: testing so few costs about as much as one more box.
const LEAF: usize = 4;

/// Boxes in the order of a walk in depth; each knows where the walk goes on without what is inside.
#[derive(Clone, Debug, Default)]
pub(crate) struct LineTree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    center: Vec3,
    half: Vec3,
    /// The next node outside.
    skip: u32,
    first: u32,
    /// Triangles of a leaf; none of an inner node.
    count: u32,
}

impl LineTree {
    /// A tree over triangles, which it puts into its own order.
    pub fn new(triangles: &mut [[Vec3d; 3]]) -> Self {
        let mut tree = Self::default();
        tree.add(triangles, 0);
        tree
    }

    /// Adds the nodes of a run of triangles, which are halved in the middle of their longest extent.
    fn add(&mut self, triangles: &mut [[Vec3d; 3]], first: usize) {
        let (low, high) = bounds(triangles);
        let at = self.nodes.len();
        let n = triangles.len();
        self.nodes.push(Node {
            center: ((low + high) * 0.5).cast(),
            half: padded((high - low) * 0.5, low, high),
            skip: 0,
            first: first as u32,
            count: if n <= LEAF { n as u32 } else { 0 },
        });
        if n > LEAF {
            let extent = (high - low).to_array();
            let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
            let middle = |t: &[Vec3d; 3]| t.iter().map(|p| p.to_array()[axis]).sum::<f64>();
            triangles.select_nth_unstable_by(n / 2, |a, b| middle(a).total_cmp(&middle(b)));
            let (left, right) = triangles.split_at_mut(n / 2);
            self.add(left, first);
            self.add(right, first + n / 2);
        }
        self.nodes[at].skip = self.nodes.len() as u32;
    }

    /// Calls with each run of triangles in whose box a line may pass, to both sides of `p`.
    #[inline]
    pub fn visit(&self, p: Vec3, d: Vec3, mut visit: impl FnMut(Range<usize>)) {
        let mut i = 0;
        while let Some(node) = self.nodes.get(i) {
            if !node.may_meet(p, d) {
                i = node.skip as usize;
                continue;
            }
            if node.count > 0 {
                visit(node.first as usize..(node.first + node.count) as usize);
            }
            i += 1;
        }
    }
}

impl Node {
    /// Whether a line passes the box, or misses it by no more than rounding.
    ///
    /// It misses a box if, seen along an axis across it, it lies aside of the box's shadow (Gottschalk, Lin &
    /// Manocha 1996, section 5). The three axes across the line and one of the box's suffice for a line.
    #[inline]
    fn may_meet(&self, p: Vec3, d: Vec3) -> bool {
        let (c, h, d_abs) = (self.center - p, self.half, d.abs());
        let near = |aside: [Real; 2], shadow: Real| {
            // A difference, two products and a difference, each rounded once.
            let rounding = (aside[0].abs() + aside[1].abs()) * (4.0 * Real::EPSILON);
            (aside[0] - aside[1]).abs() <= shadow + rounding
        };
        near([c.y * d.z, c.z * d.y], h.y * d_abs.z + h.z * d_abs.y)
            && near([c.z * d.x, c.x * d.z], h.z * d_abs.x + h.x * d_abs.z)
            && near([c.x * d.y, c.y * d.x], h.x * d_abs.y + h.y * d_abs.x)
    }
}

fn bounds(triangles: &[[Vec3d; 3]]) -> (Vec3d, Vec3d) {
    let all = Vec3d::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
    triangles.iter().flatten().fold((all, -all), |(low, high), &p| (low.min(p), high.max(p)))
}

/// Half a box's extent with room for the rounding of its middle, and of corners and edges of what is in it.
fn padded(half: Vec3d, low: Vec3d, high: Vec3d) -> Vec3 {
    let largest = low.abs().max(high.abs());
    (half + largest * (4.0 * Real::EPSILON.to_f64())).cast()
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::rng::Rng;

    /// 1000 small triangles about a ball, and lines through points of them and past them: none is left out.
    #[test]
    fn what_a_line_meets_is_visited() {
        let mut rng = Rng::new(8);
        let mut triangles: Vec<[Vec3d; 3]> = (0..1000)
            .map(|_| {
                let any = |rng: &mut Rng| {
                    let mut number = || 2.0 * rng.next_real() - 1.0;
                    Vec3::new(number(), number(), number()).cast::<f64>()
                };
                let at = any(&mut rng).normalized() * 5.0;
                [0; 3].map(|_| at + any(&mut rng) * 0.1)
            })
            .collect();
        let tree = LineTree::new(&mut triangles);
        let mut tested = 0;
        for (i, t) in triangles.iter().enumerate() {
            let middle: Vec3 = ((t[0] + t[1] + t[2]) * (1.0 / 3.0)).cast();
            let p = Vec3::new(rng.next_real(), rng.next_real(), rng.next_real());
            let mut found = false;
            tree.visit(p, (p - middle).normalized(), |range| {
                tested += range.len();
                found |= range.contains(&i);
            });
            assert!(found, "{i}");
        }
        // Two sides of the ball are met; some dozens of triangles are looked at, not a thousand.
        assert!(tested < 1000 * 40, "{tested}");
    }

    #[test]
    fn flat_boxes_are_met() {
        let v = Vec3d::new;
        let tree = LineTree::new(&mut [[v(0.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.0, 1.0, 1.0)]]);
        let met = |p: Vec3, d: Vec3| {
            let mut met = false;
            tree.visit(p, d, |_| met = true);
            met
        };
        assert!(met(Vec3::new(0.2, 0.2, 0.0), Vec3::new(0.0, 0.0, 1.0)));
        assert!(met(Vec3::new(0.2, 0.2, 0.0), Vec3::new(0.0, 0.0, -1.0)));
        assert!(!met(Vec3::new(1.2, 0.2, 0.0), Vec3::new(0.0, 0.0, 1.0)));
        assert!(!met(Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0)));
    }
}
