//! The one tree format that every builder writes and the kernel reads.
//!
//! Nodes have eight children, boxes as structure of arrays, so that one register holds one plane of
//! all eight; leaves are runs of blocks of eight triangles with their corners copied in, also as
//! structure of arrays.

/// A reference to a child, or the root of a tree.
///
/// Inner node: its index. Leaf: bit 31, the number of blocks in bits 27 to 30, the first block
/// below. A leaf of no blocks stands for an object other than a triangle and carries its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub u32);

/// The largest number of blocks in a leaf that a builder makes.
pub(crate) const MAX_LEAF_BLOCKS: u32 = 2;
/// Blocks are numbered in 27 bits.
pub(crate) const MAX_BLOCKS: usize = 1 << 27;

impl Child {
    const LEAF: u32 = 1 << 31;
    const SHIFT: u32 = 27;
    const FIRST: u32 = (1 << Self::SHIFT) - 1;
    /// What fills the unused places of a node, and the root of a tree of nothing: a leaf of no blocks
    /// that stands for no object, so that it does no harm even where it is looked at.
    pub(crate) const NONE: Self = Self(Self::LEAF | Self::FIRST);

    /// An inner node.
    pub(crate) fn node(index: usize) -> Self {
        debug_assert!(index < Self::LEAF as usize);
        Self(index as u32)
    }

    /// A leaf of `blocks` blocks from `first` on.
    pub(crate) fn leaf(first: usize, blocks: u32) -> Self {
        debug_assert!(first < MAX_BLOCKS && (1..15).contains(&blocks));
        Self(Self::LEAF | blocks << Self::SHIFT | first as u32)
    }

    /// A leaf that is not made of triangles.
    pub(crate) fn special(number: u32) -> Self {
        debug_assert!(number < Self::FIRST);
        Self(Self::LEAF | number)
    }

    #[inline(always)]
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// Number of blocks of a leaf; 0 for a special one.
    #[inline(always)]
    pub(crate) fn blocks(self) -> u32 {
        self.0 >> Self::SHIFT & 15
    }

    /// First block of a leaf, or number of a special one.
    #[inline(always)]
    pub(crate) fn first(self) -> u32 {
        self.0 & Self::FIRST
    }

    /// The same child after its tree has been moved behind others.
    pub(crate) fn moved(self, nodes: usize, blocks: usize) -> Self {
        if self == Self::NONE {
            self
        } else if self.is_leaf() {
            Self::leaf(self.first() as usize + blocks, self.blocks())
        } else {
            Self::node(self.0 as usize + nodes)
        }
    }
}

/// Eight boxes and what they hold; 256 bytes, four cache lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// x lo, x hi, y lo, y hi, z lo, z hi of the eight children; unused places are empty boxes.
    pub bounds: [[f32; 8]; 6],
    /// The children.
    pub children: [Child; 8],
    /// Fills the last cache line.
    pub unused: [u32; 8],
}

impl Node {
    /// A node without children.
    pub(crate) const EMPTY: Self = {
        let (lo, hi) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8]);
        Self { bounds: [lo, hi, lo, hi, lo, hi], children: [Child::NONE; 8], unused: [0; 8] }
    };

    /// Puts a child into a place.
    pub(crate) fn set(&mut self, place: usize, bounds: &Box3, child: Child) {
        for axis in 0..3 {
            self.bounds[2 * axis][place] = bounds.lo[axis];
            self.bounds[2 * axis + 1][place] = bounds.hi[axis];
        }
        self.children[place] = child;
    }

    /// The box of the child in a place.
    pub(crate) fn child_bounds(&self, place: usize) -> Box3 {
        let at = |side: usize| std::array::from_fn(|axis| self.bounds[2 * axis + side][place]);
        Box3 { lo: at(0), hi: at(1) }
    }
}

/// Eight triangles; 320 bytes, five cache lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// Corners 0, 1, 2; each x, y, z; each of eight triangles. Unused places are all zero, which no
    /// ray hits.
    pub corners: [[[f32; 8]; 3]; 3],
    /// Triangle numbers; [`Block::UNUSED`] where a place is unused.
    pub ids: [u32; 8],
}

impl Block {
    /// The id in a place without a triangle.
    pub(crate) const UNUSED: u32 = u32::MAX;
    /// A block without triangles.
    pub(crate) const EMPTY: Self = Self { corners: [[[0.0; 8]; 3]; 3], ids: [Self::UNUSED; 8] };

    /// Puts a triangle into a place.
    pub(crate) fn set(&mut self, place: usize, corners: &[[f32; 3]; 3], id: u32) {
        for (rows, corner) in self.corners.iter_mut().zip(corners) {
            for (row, value) in rows.iter_mut().zip(corner) {
                row[place] = *value;
            }
        }
        self.ids[place] = id;
    }
}

/// A box in single precision, as nodes hold them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    /// Least corner.
    pub lo: [f32; 3],
    /// Greatest corner.
    pub hi: [f32; 3],
}

impl Box3 {
    /// The box that holds nothing.
    pub(crate) const EMPTY: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    /// The smallest box round some points.
    pub(crate) fn of(points: &[[f32; 3]]) -> Self {
        points.iter().fold(Self::EMPTY, |b, p| b.union(&Self { lo: *p, hi: *p }))
    }

    /// The smallest box that holds both.
    #[inline(always)]
    pub(crate) fn union(&self, b: &Self) -> Self {
        let lesser = |a: f32, b: f32| if a < b { a } else { b };
        let greater = |a: f32, b: f32| if a > b { a } else { b };
        Self {
            lo: std::array::from_fn(|i| lesser(self.lo[i], b.lo[i])),
            hi: std::array::from_fn(|i| greater(self.hi[i], b.hi[i])),
        }
    }

    /// Half the surface area; 0 for an empty box.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let d: [f32; 3] = std::array::from_fn(|i| self.hi[i] - self.lo[i]);
        if d[0] < 0.0 { 0.0 } else { d[0] * d[1] + d[1] * d[2] + d[2] * d[0] }
    }

    /// Whether `b` lies inside this box.
    pub(crate) fn holds(&self, b: &Self) -> bool {
        (0..3).all(|i| self.lo[i] <= b.lo[i] && b.hi[i] <= self.hi[i])
    }
}

/// A tree, or several behind each other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WideTree {
    /// All inner nodes; within one tree a child comes after its parent.
    pub nodes: Vec<Node>,
    /// All triangles.
    pub blocks: Vec<Block>,
    /// Where to begin; [`Child::NONE`] for nothing.
    pub root: Child,
    /// Box round everything below the root.
    pub bounds: Box3,
}

impl WideTree {
    /// A tree of nothing.
    pub(crate) fn empty() -> Self {
        Self { nodes: Vec::new(), blocks: Vec::new(), root: Child::NONE, bounds: Box3::EMPTY }
    }
}

/// How many entries the traversal stack needs at most below `root`.
///
/// A node with k children leaves at most k − 1 on the stack while one of them is looked at.
/// Needs children after their parents, so that one backward pass suffices.
pub(crate) fn stack_need(nodes: &[Node], root: Child) -> usize {
    let mut need = vec![0u32; nodes.len()];
    for (i, node) in nodes.iter().enumerate().rev() {
        let present = node.children.iter().filter(|c| **c != Child::NONE);
        let below = |c: &Child| if c.is_leaf() { 0 } else { need[c.0 as usize] };
        let (count, deepest) = present.fold((0u32, 0), |(n, m), c| (n + 1, m.max(below(c))));
        need[i] = deepest + count.saturating_sub(1);
    }
    if root.is_leaf() { 0 } else { need[root.0 as usize] as usize }
}
