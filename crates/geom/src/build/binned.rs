//! Top-down build by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007).

use super::binary::{BinaryNode, Prim};
use crate::wide::Box3;

const BINS: usize = 16;
/// Below this many primitives a subtree is built by one thread.
const PARALLEL: usize = 4096;

/// Builds a binary tree over all of `prims`, which it reorders; leaves hold up to `max_leaf`.
///
/// No leaf is deeper than `max_depth` as long as there are at most 2^`max_depth` primitives.
pub(crate) fn split_all(prims: &mut [Prim], max_leaf: usize, max_depth: u32) -> Vec<BinaryNode> {
    let mut out = Vec::with_capacity(2 * prims.len() / max_leaf);
    let task = Task { first: 0, depth_left: max_depth };
    Splitter { max_leaf }.split(prims, task, &mut out);
    out
}

#[derive(Clone, Copy)]
struct Task {
    /// Where the slice begins among all primitives.
    first: usize,
    depth_left: u32,
}

struct Splitter {
    max_leaf: usize,
}

impl Splitter {
    fn split(&self, prims: &mut [Prim], task: Task, out: &mut Vec<BinaryNode>) {
        let extent = Extent::of(prims);
        if prims.len() <= self.max_leaf {
            out.push(BinaryNode::leaf(&extent.bounds, task.first, prims.len()));
            return;
        }
        let levels_of_halving = usize::BITS - (prims.len() - 1).leading_zeros();
        let found = if levels_of_halving >= task.depth_left { None } else { best_plane(prims, &extent) };
        let middle = match found {
            Some(plane) => partition(prims, &plane),
            None => halve(prims, &extent),
        };
        let (left, right) = prims.split_at_mut(middle);
        let depth_left = task.depth_left - 1;
        let left_task = Task { depth_left, ..task };
        let right_task = Task { first: task.first + middle, depth_left };
        let at = out.len();
        out.push(BinaryNode::inner(&extent.bounds, 0));
        if left.len() + right.len() < PARALLEL {
            self.split(left, left_task, out);
            out[at] = BinaryNode::inner(&extent.bounds, out.len() - at);
            self.split(right, right_task, out);
        } else {
            let mut behind = Vec::with_capacity(2 * right.len() / self.max_leaf);
            rayon::join(|| self.split(left, left_task, out), || self.split(right, right_task, &mut behind));
            out[at] = BinaryNode::inner(&extent.bounds, out.len() - at);
            out.append(&mut behind);
        }
    }
}

/// The boxes round primitives and round their centres (doubled, which saves a product).
struct Extent {
    bounds: Box3,
    centers: Box3,
}

impl Extent {
    fn of(prims: &[Prim]) -> Self {
        let (mut bounds, mut centers) = (Box3::EMPTY, Box3::EMPTY);
        for p in prims {
            bounds = bounds.union(&p.bounds());
            let c = center(p);
            centers = centers.union(&Box3 { lo: c, hi: c });
        }
        Self { bounds, centers }
    }

    fn longest_axis(&self) -> usize {
        let d: [f32; 3] = std::array::from_fn(|i| self.centers.hi[i] - self.centers.lo[i]);
        if d[0] >= d[1] && d[0] >= d[2] { 0 } else { 1 + usize::from(d[2] > d[1]) }
    }
}

#[inline(always)]
fn center(p: &Prim) -> [f32; 3] {
    std::array::from_fn(|i| p.lo[i] + p.hi[i])
}

/// Where to cut: primitives of which the centre falls into a bin below `bin` go left.
struct Plane {
    axis: usize,
    origin: f32,
    scale: f32,
    bin: usize,
}

#[inline(always)]
fn bin_of(center: f32, origin: f32, scale: f32) -> usize {
    (((center - origin) * scale) as usize).min(BINS - 1)
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box3,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Box3::EMPTY, count: 0 };

    fn join(&self, b: &Self) -> Self {
        Self { bounds: self.bounds.union(&b.bounds), count: self.count + b.count }
    }

    fn cost(&self) -> f32 {
        self.bounds.half_area() * self.count as f32
    }
}

/// The cheapest cut between bins, or `None` where no cut separates anything.
fn best_plane(prims: &[Prim], extent: &Extent) -> Option<Plane> {
    let origin = extent.centers.lo;
    let scale: [f32; 3] = std::array::from_fn(|i| {
        let size = extent.centers.hi[i] - origin[i];
        if size > 0.0 && size.is_finite() { BINS as f32 * 0.9999 / size } else { 0.0 }
    });
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for p in prims {
        let (c, bounds) = (center(p), p.bounds());
        for axis in 0..3 {
            let bin = &mut bins[axis][bin_of(c[axis], origin[axis], scale[axis])];
            bin.bounds = bin.bounds.union(&bounds);
            bin.count += 1;
        }
    }
    let mut best: Option<(f32, Plane)> = None;
    for axis in 0..3 {
        let mut right = [Bin::EMPTY; BINS];
        let mut sum = Bin::EMPTY;
        for i in (1..BINS).rev() {
            sum = sum.join(&bins[axis][i]);
            right[i] = sum;
        }
        let mut left = Bin::EMPTY;
        for bin in 1..BINS {
            left = left.join(&bins[axis][bin - 1]);
            if left.count == 0 || right[bin].count == 0 {
                continue;
            }
            let cost = left.cost() + right[bin].cost();
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, Plane { axis, origin: origin[axis], scale: scale[axis], bin }));
            }
        }
    }
    best.map(|(_, plane)| plane)
}

/// Moves what lies left of the plane to the front; returns how many.
fn partition(prims: &mut [Prim], plane: &Plane) -> usize {
    let goes_left =
        |p: &Prim| bin_of(p.lo[plane.axis] + p.hi[plane.axis], plane.origin, plane.scale) < plane.bin;
    let (mut i, mut end) = (0, prims.len());
    while i < end {
        if goes_left(&prims[i]) {
            i += 1;
        } else {
            end -= 1;
            prims.swap(i, end);
        }
    }
    i
}

/// Cuts at the median of the centres along the longest axis.
fn halve(prims: &mut [Prim], extent: &Extent) -> usize {
    let (axis, middle) = (extent.longest_axis(), prims.len() / 2);
    prims.select_nth_unstable_by(middle, |a, b| center(a)[axis].total_cmp(&center(b)[axis]));
    middle
}
