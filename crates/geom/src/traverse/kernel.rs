//! The traversal itself, over abstract lanes.
//!
//! Box test: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (the far distances are enlarged by
//! 1 + 2γ₃, so that rounding cannot lose a box). Triangle test: Woop, Benthin, Wald, "Watertight
//! Ray/Triangle Intersection", JCGT 2(1), 2013; an edge function of exactly 0 counts as inside on
//! both sides, so no fallback to double precision is needed for watertightness.

use super::raw::{ROW, Stack, block_at, node_at, place, prefetch, row_at};
use crate::build::{TOP_DEPTH, TRIANGLE_DEPTH};
use crate::ray::Ray;
use crate::wide::{Block, Child, Node};
use indigo_math::Float;

/// Entries of the traversal stack; no builder makes a tree that could need more.
pub(crate) const STACK_SIZE: usize = 640;

/// A node leaves at most seven children behind, and holds an eighth for a moment.
const _: () = assert!(7 * (TRIANGLE_DEPTH + TOP_DEPTH) < STACK_SIZE as u32);

/// A scalar of which the order of non-negative values is the order of the upper bits.
pub(crate) trait KeyBits: Float {
    /// The number's leading 32 bits, rounding towards 0.
    fn to_key(self) -> u32;
    /// The number of those leading bits.
    fn from_key(key: u32) -> Self;
    /// The enlargement 1 + 2γ₃ of far box distances, and a rounding more for its own product.
    const ENLARGE: Self;
}

impl KeyBits for f32 {
    const ENLARGE: Self = 1.0 + 4.0 * f32::EPSILON;
    #[inline(always)]
    fn to_key(self) -> u32 {
        self.to_bits()
    }
    #[inline(always)]
    fn from_key(key: u32) -> Self {
        Self::from_bits(key)
    }
}

impl KeyBits for f64 {
    const ENLARGE: Self = 1.0 + 4.0 * f64::EPSILON;
    #[inline(always)]
    fn to_key(self) -> u32 {
        (self.to_bits() >> 32) as u32
    }
    #[inline(always)]
    fn from_key(key: u32) -> Self {
        Self::from_bits(u64::from(key) << 32)
    }
}

/// Eight numbers side by side. Comparisons give one bit a lane, and false where a lane is NaN.
pub(crate) trait Lanes: Copy {
    /// One lane.
    type Scalar: KeyBits;
    /// The same number in all lanes.
    fn splat(v: Self::Scalar) -> Self;
    /// Eight numbers of a node or block.
    fn load(v: &[f32; 8]) -> Self;
    /// The lanes as an array.
    fn to_array(self) -> [Self::Scalar; 8];
    /// Lane by lane sum.
    fn add(self, b: Self) -> Self;
    /// Lane by lane difference.
    fn sub(self, b: Self) -> Self;
    /// Lane by lane product.
    fn mul(self, b: Self) -> Self;
    /// Lane by lane quotient.
    fn div(self, b: Self) -> Self;
    /// The lesser; `b` where either is NaN.
    fn min(self, b: Self) -> Self;
    /// The greater; `b` where either is NaN.
    fn max(self, b: Self) -> Self;
    /// Lanes where `self <= b`.
    fn le(self, b: Self) -> u32;
    /// Lanes where `self < b`.
    fn lt(self, b: Self) -> u32;
}

/// A ray in the kernel's scalar. It is read where the caller keeps it: a copy made just before
/// would be stored number by number and loaded in vectors, for which the processor waits.
struct KernelRay<T> {
    o: [T; 3],
    d: [T; 3],
    t_min: T,
}

impl<T: Float> KernelRay<T> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        Self {
            o: ray.o.cast().to_array(),
            d: ray.d.cast().to_array(),
            // Adding 0 makes a negative zero positive: distances are compared by their bits.
            t_min: T::from_f64(ray.t_min.max(0.0).to_f64()) + T::ZERO,
        }
    }
}

/// The best hit so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawHit<T> {
    /// Parameter of the ray; at first the ray's `t_max`.
    pub t: T,
    /// Barycentric coordinate of vertex 1.
    pub u: T,
    /// Barycentric coordinate of vertex 2.
    pub v: T,
    /// Triangle number in its tree.
    pub id: u32,
    /// The object, where it is not of the baked tree; else [`RawHit::BAKED`].
    pub object: u32,
}

impl<T: Float> RawHit<T> {
    /// The object of triangles in the baked tree, which are told apart afterwards.
    pub(crate) const BAKED: u32 = u32::MAX;

    /// No hit before `t_max` yet.
    pub(crate) fn none(t_max: T) -> Self {
        Self { t: t_max, u: T::ZERO, v: T::ZERO, id: u32::MAX, object: Self::BAKED }
    }
}

/// The nodes and blocks of all trees. Every child of a node and every leaf below a root in use lies
/// inside them: builders make it so, and the cache checks it.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    /// All nodes.
    pub nodes: &'a [Node],
    /// All blocks.
    pub blocks: &'a [Block],
}

/// What the leaves without triangles stand for.
pub(crate) trait Specials<T> {
    /// Whether there are any.
    const PRESENT: bool;
    /// Tests one; changes `hit` where it is met before `hit.t` and says so.
    fn test<const ANY: bool>(&self, number: u32, hit: &mut RawHit<T>) -> bool;
}

/// What the box test needs of a ray.
struct BoxTest<L> {
    origin: [L; 3],
    inverse: [L; 3],
    /// Where in `Node::bounds` the planes are that the ray enters first, an axis each, in bytes.
    near: [usize; 3],
    /// The inverse direction for the planes through which the ray leaves, enlarged.
    inverse_far: [L; 3],
    t_min: L,
}

impl<L: Lanes> BoxTest<L> {
    #[inline(always)]
    fn new(ray: &KernelRay<L::Scalar>) -> Self {
        // 1 / 0 is infinite on purpose: a slab is then entered at ±∞ or, where the origin lies on
        // one of its planes, at NaN: min and max below then drop that slab, and the one before it, so that the ray
        // is bounded by fewer slabs than it could be, never by more.
        let inverse = ray.d.map(|d| L::Scalar::ONE / d);
        Self {
            origin: ray.o.map(L::splat),
            inverse: inverse.map(L::splat),
            near: std::array::from_fn(|i| ROW * (2 * i + usize::from(inverse[i] < L::Scalar::ZERO))),
            t_min: L::splat(ray.t_min),
            inverse_far: inverse.map(|r| L::splat(r * L::Scalar::ENLARGE)),
        }
    }

    /// Distances at which the eight boxes are entered, and which of them are met before `t_max`.
    #[inline(always)]
    fn test(&self, node: &Node, t_max: L) -> (L, u32) {
        let plane = |axis: usize, offset: usize| L::load(row_at(node, offset)).sub(self.origin[axis]);
        let near = |axis: usize| plane(axis, self.near[axis]).mul(self.inverse[axis]);
        let far = |axis: usize| plane(axis, self.near[axis] ^ ROW).mul(self.inverse_far[axis]);
        let enter = near(0).max(near(1)).max(near(2).max(self.t_min));
        let leave = far(0).min(far(1)).min(far(2).min(t_max));
        (enter, enter.le(leave))
    }
}

/// What the triangle test needs of a ray: axes permuted so that z is the direction's largest, and
/// the shear that takes the direction onto that axis.
struct TriangleTest<L> {
    axes: [usize; 3],
    origin: [L; 3],
    shear: [L; 2],
    scale: L,
    t_min: L,
}

/// Lanes of one block that were met.
struct BlockHits<L> {
    t: L,
    u: L,
    v: L,
    mask: u32,
}

impl<L: Lanes> TriangleTest<L> {
    #[inline(always)]
    fn new(ray: &KernelRay<L::Scalar>) -> Self {
        let [x, y, z] = ray.d.map(Float::abs);
        // The largest component, found without a branch: directions are random.
        let is_x = usize::from(x >= y) * usize::from(x >= z);
        let largest = (1 - is_x) * (1 + usize::from(z > y));
        let axes = *place(&[[1, 2, 0], [2, 0, 1], [0, 1, 2]], largest);
        let [kx, ky, kz] = axes;
        let scale = L::Scalar::ONE / ray.d[kz];
        Self {
            axes,
            origin: axes.map(|k| L::splat(ray.o[k])),
            shear: [L::splat(ray.d[kx] * scale), L::splat(ray.d[ky] * scale)],
            scale: L::splat(scale),
            t_min: L::splat(ray.t_min),
        }
    }

    /// A corner of eight triangles in the ray's sheared frame.
    #[inline(always)]
    fn sheared(&self, corner: &[[f32; 8]; 3]) -> [L; 3] {
        let at = |i: usize| L::load(place(corner, self.axes[i])).sub(self.origin[i]);
        let z = at(2);
        [at(0).sub(self.shear[0].mul(z)), at(1).sub(self.shear[1].mul(z)), z]
    }

    #[inline(always)]
    fn test(&self, block: &Block, t_max: L) -> BlockHits<L> {
        let zero = L::splat(L::Scalar::ZERO);
        let [ax, ay, az] = self.sheared(&block.corners[0]);
        let [bx, by, bz] = self.sheared(&block.corners[1]);
        let [cx, cy, cz] = self.sheared(&block.corners[2]);
        // Without fused operations each edge function is the exact negative of its neighbour's.
        let u = cx.mul(by).sub(cy.mul(bx));
        let v = ax.mul(cy).sub(ay.mul(cx));
        let w = bx.mul(ay).sub(by.mul(ax));
        let mask = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
        if mask == 0 {
            return BlockHits { t: zero, u: zero, v: zero, mask };
        }
        let r = L::splat(L::Scalar::ONE).div(u.add(v).add(w));
        // Barycentric coordinates first: their products with the distances do not overflow.
        let (u, v, w) = (u.mul(r), v.mul(r), w.mul(r));
        let t = u.mul(az).add(v.mul(bz).add(w.mul(cz))).mul(self.scale);
        BlockHits { t, u: v, v: w, mask: mask & self.t_min.lt(t) & t.lt(t_max) }
    }
}

/// The kernel; see [`Kernel::walk`](super::Kernel::walk).
#[inline(always)]
pub(super) fn walk<L: Lanes, const ANY: bool, S: Specials<L::Scalar>>(
    view: View,
    root: Child,
    ray: &Ray,
    hit: &mut RawHit<L::Scalar>,
    specials: &S,
) -> bool {
    let ray = KernelRay::new(ray);
    let boxes = BoxTest::<L>::new(&ray);
    let triangles = TriangleTest::<L>::new(&ray);
    let mut t_max = L::splat(hit.t);
    let mut stack = Stack::<STACK_SIZE>::new();
    let mut top = 0;
    let mut found = false;
    let mut current = root;
    loop {
        let mut alive = true;
        while !current.is_leaf() {
            let node = node_at(view.nodes, current);
            let (enter, mask) = boxes.test(node, t_max);
            if mask == 0 {
                alive = false;
                break;
            }
            (current, top) = descend::<L, ANY>(view, node, enter, mask, &mut stack, top);
        }
        if alive {
            let changed = if S::PRESENT && current.blocks() == 0 {
                specials.test::<ANY>(current.first(), hit)
            } else {
                test_leaf::<L, ANY>(view, current, &triangles, t_max, hit)
            };
            if changed {
                if ANY {
                    return true;
                }
                found = true;
                t_max = L::splat(hit.t);
            }
        }
        loop {
            if top == 0 {
                return found;
            }
            top -= 1;
            let entry = stack.get(top);
            if ANY || L::Scalar::from_key((entry >> 32) as u32) < hit.t {
                current = Child(entry as u32);
                break;
            }
        }
    }
}

/// Picks the child to go on with and puts the others on the stack, the nearest on top; returns the
/// child and the stack's new height.
#[inline(always)]
fn descend<L: Lanes, const ANY: bool>(
    view: View,
    node: &Node,
    enter: L,
    mask: u32,
    stack: &mut Stack<STACK_SIZE>,
    mut top: usize,
) -> (Child, usize) {
    let first = mask.trailing_zeros() as usize;
    let mut rest = mask & (mask - 1);
    let child = |i: usize| *place(&node.children, i);
    if rest == 0 {
        return (child(first), top);
    }
    if ANY {
        while rest != 0 {
            let later = child(rest.trailing_zeros() as usize);
            prefetch(view.nodes, view.blocks, later);
            stack.put(top, u64::from(later.0));
            top += 1;
            rest &= rest - 1;
        }
        return (child(first), top);
    }
    // Both before it is known which is nearer: what comes next waits for that, the memory need not.
    prefetch(view.nodes, view.blocks, child(first));
    prefetch(view.nodes, view.blocks, child(rest.trailing_zeros() as usize));
    let distances = enter.to_array();
    let entry = |i: usize| u64::from(place(&distances, i).to_key()) << 32 | u64::from(child(i).0);
    let (a, b) = (entry(first), entry(rest.trailing_zeros() as usize));
    rest &= rest - 1;
    let (nearer, farther) = if a < b { (a, b) } else { (b, a) };
    stack.put(top, farther);
    if rest == 0 {
        return (Child(nearer as u32), top + 1);
    }
    let base = top;
    stack.put(top + 1, nearer);
    top += 2;
    while rest != 0 {
        let another = entry(rest.trailing_zeros() as usize);
        prefetch(view.nodes, view.blocks, Child(another as u32));
        stack.put_sorted(base, top, another);
        top += 1;
        rest &= rest - 1;
    }
    top -= 1;
    (Child(stack.get(top) as u32), top)
}

/// Tests the blocks of a leaf against what the ray has met so far.
#[inline(always)]
fn test_leaf<L: Lanes, const ANY: bool>(
    view: View,
    leaf: Child,
    triangles: &TriangleTest<L>,
    mut t_max: L,
    hit: &mut RawHit<L::Scalar>,
) -> bool {
    let mut changed = false;
    for i in 0..leaf.blocks() {
        let block = block_at(view.blocks, leaf, i);
        let hits = triangles.test(block, t_max);
        if hits.mask == 0 {
            continue;
        }
        changed = true;
        if ANY {
            break;
        }
        let (t, u, v) = (hits.t.to_array(), hits.u.to_array(), hits.v.to_array());
        let mut mask = hits.mask;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            if *place(&t, lane) < hit.t {
                let (t, u, v) = (*place(&t, lane), *place(&u, lane), *place(&v, lane));
                *hit = RawHit { t, u, v, id: *place(&block.ids, lane), object: RawHit::<L::Scalar>::BAKED };
            }
        }
        t_max = L::splat(hit.t);
    }
    changed
}
