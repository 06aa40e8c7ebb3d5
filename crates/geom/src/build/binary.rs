//! The binary tree between a builder and the collapse.

use crate::wide::Box3;

/// A box as x, y, z of the least corner and the negated greatest corner, each with a place to spare,
/// so that a union is one minimum of eight lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Lanes([f32; 8]);

impl Lanes {
    pub(crate) const EMPTY: Self = Self([f32::INFINITY; 8]);

    #[inline(always)]
    pub(crate) fn join(&self, b: &Self) -> Self {
        // Not a comparison and choice: that becomes a masked store into the bins, which stalls.
        Self(std::array::from_fn(|i| self.0[i].min(b.0[i])))
    }

    #[inline(always)]
    pub(crate) fn lo(&self) -> [f32; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    #[inline(always)]
    pub(crate) fn size(&self) -> [f32; 3] {
        std::array::from_fn(|i| -self.0[4 + i] - self.0[i])
    }

    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let [x, y, z] = self.size();
        x * y + y * z + z * x
    }

    #[inline(always)]
    pub(crate) fn to_box(self) -> Box3 {
        Box3 { lo: self.lo(), hi: std::array::from_fn(|i| -self.0[4 + i]) }
    }
}

/// What is sorted into a tree: a box, with a number in the first spare place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prim(Lanes);

impl Prim {
    /// Stands for what is not to be sorted in; no primitive has its number.
    pub(crate) const NONE: Self = Self(Lanes([f32::from_bits(u32::MAX); 8]));

    pub(crate) fn new(b: &Box3, id: u32) -> Self {
        let ([x, y, z], [a, b, c]) = (b.lo, b.hi);
        Self(Lanes([x, y, z, f32::from_bits(id), -a, -b, -c, 0.0]))
    }

    #[inline(always)]
    pub(crate) fn id(&self) -> u32 {
        self.0.0[3].to_bits()
    }

    #[inline(always)]
    pub(crate) fn lanes(&self) -> &Lanes {
        &self.0
    }

    /// Twice the centre, which saves a product.
    #[inline(always)]
    pub(crate) fn center(&self) -> [f32; 3] {
        std::array::from_fn(|i| self.0.0[i] - self.0.0[4 + i])
    }

    /// The doubled centre as a box.
    #[inline(always)]
    pub(crate) fn center_lanes(&self) -> Lanes {
        let l = &self.0.0;
        Lanes(std::array::from_fn(|i| if i < 4 { l[i] - l[i + 4] } else { l[i] - l[i - 4] }))
    }
}

/// A node of a binary tree in pre-order: the left child follows its parent at once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct BinaryNode {
    lo: [f32; 3],
    /// Inner node: distance to the right child. Leaf: first primitive.
    link: u32,
    hi: [f32; 3],
    /// Leaf: number of primitives. Inner node: 0.
    count: u32,
}

impl BinaryNode {
    pub(crate) fn leaf(bounds: &Box3, first: usize, count: usize) -> Self {
        Self { lo: bounds.lo, link: first as u32, hi: bounds.hi, count: count as u32 }
    }

    pub(crate) fn inner(bounds: &Box3, right_distance: usize) -> Self {
        Self { lo: bounds.lo, link: right_distance as u32, hi: bounds.hi, count: 0 }
    }

    #[inline(always)]
    pub(crate) fn bounds(&self) -> Box3 {
        Box3 { lo: self.lo, hi: self.hi }
    }

    /// The primitives of a leaf.
    #[inline(always)]
    pub(crate) fn prims(&self) -> Option<std::ops::Range<usize>> {
        (self.count > 0).then(|| self.link as usize..(self.link + self.count) as usize)
    }

    /// Both children of inner node `i`.
    #[inline(always)]
    pub(crate) fn children(&self, i: usize) -> [usize; 2] {
        [i + 1, i + self.link as usize]
    }
}
