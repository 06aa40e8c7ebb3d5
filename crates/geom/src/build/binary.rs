//! The binary tree between a builder and the collapse.

use crate::wide::Box3;

/// What is sorted into a tree: a box and a number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Prim {
    /// Least corner.
    pub lo: [f32; 3],
    /// Number of the triangle or object.
    pub id: u32,
    /// Greatest corner.
    pub hi: [f32; 3],
    unused: u32,
}

impl Prim {
    pub(crate) fn new(bounds: &Box3, id: u32) -> Self {
        Self { lo: bounds.lo, id, hi: bounds.hi, unused: 0 }
    }

    #[inline(always)]
    pub(crate) fn bounds(&self) -> Box3 {
        Box3 { lo: self.lo, hi: self.hi }
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
