//! Top-down build by the surface area heuristic over bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007).

use super::binary::{BinaryNode, Lanes, Prim};
use crate::stop::Stop;
use indigo_math::pages::with_capacity;

/// Most bins along an axis.
const BINS: usize = 16;
/// Below this many primitives a subtree is built by one thread.
///
/// What the right of two threads builds is copied behind what the left one did, at every such level.
const PARALLEL: usize = 1 << 14;

/// Builds a binary tree over all of `prims`, which it reorders; leaves hold up to `max_leaf`.
///
/// No leaf is deeper than `max_depth` as long as there are at most 2^`max_depth` primitives. Once stopped,
/// what comes out is of no use.
pub(crate) fn split_all(prims: &mut [Prim], max_leaf: usize, max_depth: u32, stop: &Stop) -> Vec<BinaryNode> {
    let mut out = with_capacity(2 * prims.len() / max_leaf);
    let task = Task { first: 0, depth_left: max_depth, extent: Extent::of(prims) };
    Splitter { max_leaf, stop }.split(prims, task, &mut out);
    out
}

#[derive(Clone, Copy)]
struct Task {
    /// Where the slice begins among all primitives.
    first: usize,
    depth_left: u32,
    extent: Extent,
}

struct Splitter<'a> {
    max_leaf: usize,
    stop: &'a Stop,
}

impl Splitter<'_> {
    fn split(&self, prims: &mut [Prim], task: Task, out: &mut Vec<BinaryNode>) {
        let bounds = task.extent.bounds.to_box();
        if prims.len() <= self.max_leaf || prims.len() >= PARALLEL && self.stop.is_set() {
            out.push(BinaryNode::leaf(&bounds, task.first, prims.len()));
            return;
        }
        let levels_of_halving = usize::BITS - (prims.len() - 1).leading_zeros();
        let found = if levels_of_halving >= task.depth_left { None } else { best_plane(prims, &task.extent) };
        let (middle, extents) = match found {
            Some(plane) => partition(prims, &plane),
            None => halve(prims, &task.extent),
        };
        let (left, right) = prims.split_at_mut(middle);
        let depth_left = task.depth_left - 1;
        let left_task = Task { first: task.first, depth_left, extent: extents[0] };
        let right_task = Task { first: task.first + middle, depth_left, extent: extents[1] };
        let at = out.len();
        out.push(BinaryNode::inner(&bounds, 0));
        if left.len() + right.len() < PARALLEL {
            self.split(left, left_task, out);
            out[at] = BinaryNode::inner(&bounds, out.len() - at);
            self.split(right, right_task, out);
        } else {
            let mut behind = with_capacity(2 * right.len() / self.max_leaf);
            rayon::join(|| self.split(left, left_task, out), || self.split(right, right_task, &mut behind));
            out[at] = BinaryNode::inner(&bounds, out.len() - at);
            out.append(&mut behind);
        }
    }
}

/// The boxes round primitives and round their doubled centres.
#[derive(Clone, Copy)]
struct Extent {
    bounds: Lanes,
    centers: Lanes,
}

impl Extent {
    const EMPTY: Self = Self { bounds: Lanes::EMPTY, centers: Lanes::EMPTY };

    fn of(prims: &[Prim]) -> Self {
        prims.iter().fold(Self::EMPTY, |e, p| e.with(p))
    }

    #[inline(always)]
    fn with(&self, p: &Prim) -> Self {
        Self { bounds: self.bounds.join(p.lanes()), centers: self.centers.join(&p.center_lanes()) }
    }

    fn longest_axis(&self) -> usize {
        let d = self.centers.size();
        if d[0] >= d[1] && d[0] >= d[2] { 0 } else { 1 + usize::from(d[2] > d[1]) }
    }
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

/// The cheapest cut between bins, or `None` where no cut separates anything.
fn best_plane(prims: &[Prim], extent: &Extent) -> Option<Plane> {
    // Few primitives need few bins, and there are many nodes of few.
    let used = (4 + prims.len() / 8).min(BINS);
    let origin = extent.centers.lo();
    let scale = extent
        .centers
        .size()
        .map(|size| if size > 0.0 && size.is_finite() { used as f32 * 0.9999 / size } else { 0.0 });
    let mut bounds = [[Lanes::EMPTY; BINS]; 3];
    let mut counts = [[0u32; BINS]; 3];
    for p in prims {
        let c = p.center();
        for axis in 0..3 {
            let bin = bin_of(c[axis], origin[axis], scale[axis]);
            bounds[axis][bin] = bounds[axis][bin].join(p.lanes());
            counts[axis][bin] += 1;
        }
    }
    let mut best: Option<(f32, Plane)> = None;
    for axis in (0..3).filter(|&axis| scale[axis] > 0.0) {
        let cut = best_cut(&bounds[axis][..used], &counts[axis][..used], prims.len() as u32);
        if let Some((cost, bin)) = cut
            && best.as_ref().is_none_or(|(least, _)| cost < *least)
        {
            best = Some((cost, Plane { axis, origin: origin[axis], scale: scale[axis], bin }));
        }
    }
    best.map(|(_, plane)| plane)
}

/// The cheapest cut along one axis: its cost, and the first bin to the right of it.
fn best_cut(bounds: &[Lanes], counts: &[u32], total: u32) -> Option<(f32, usize)> {
    let mut right_areas = [0.0; BINS];
    let mut right = Lanes::EMPTY;
    for bin in (1..bounds.len()).rev() {
        right = right.join(&bounds[bin]);
        right_areas[bin] = right.half_area();
    }
    let (mut left, mut count) = (Lanes::EMPTY, 0);
    let mut best: Option<(f32, usize)> = None;
    for bin in 1..bounds.len() {
        left = left.join(&bounds[bin - 1]);
        count += counts[bin - 1];
        if count == 0 || count == total {
            continue;
        }
        let cost = left.half_area() * count as f32 + right_areas[bin] * (total - count) as f32;
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, bin));
        }
    }
    best
}

/// Moves what lies left of the plane to the front; returns how many, and the extents of both sides.
fn partition(prims: &mut [Prim], plane: &Plane) -> (usize, [Extent; 2]) {
    let (mut i, mut end) = (0, prims.len());
    let [mut left, mut right] = [Extent::EMPTY; 2];
    while i < end {
        let p = prims[i];
        if bin_of(p.center()[plane.axis], plane.origin, plane.scale) < plane.bin {
            left = left.with(&p);
            i += 1;
        } else {
            right = right.with(&p);
            end -= 1;
            prims.swap(i, end);
        }
    }
    (i, [left, right])
}

/// Cuts at the median of the centres along the longest axis.
fn halve(prims: &mut [Prim], extent: &Extent) -> (usize, [Extent; 2]) {
    let (axis, middle) = (extent.longest_axis(), prims.len() / 2);
    prims.select_nth_unstable_by(middle, |a, b| a.center()[axis].total_cmp(&b.center()[axis]));
    (middle, [Extent::of(&prims[..middle]), Extent::of(&prims[middle..])])
}
