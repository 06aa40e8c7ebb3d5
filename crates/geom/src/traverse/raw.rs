//! The few places where the kernel goes without a bounds check.
//!
//! A check costs a compare and a branch a step and a zeroed stack 5 KiB of stores a ray; both are
//! paid a hundred million times a second. Each use states what makes it safe, and debug builds check.
#![allow(unsafe_code)]

use crate::wide::{Block, Child, Node};
use std::mem::MaybeUninit;

/// Entry `i` of an array; `i` comes from a lane mask, a permutation of axes or a sign, so it is in
/// range by construction.
#[inline(always)]
pub(super) fn place<T, const N: usize>(array: &[T; N], i: usize) -> &T {
    debug_assert!(i < N);
    // SAFETY: callers pass the index of a set bit of an 8-bit mask into an array of 8, or an axis
    // into an array of 3.
    unsafe { array.get_unchecked(i) }
}

/// The node of an inner child.
#[inline(always)]
pub(super) fn node_at(nodes: &[Node], child: Child) -> &Node {
    debug_assert!((child.0 as usize) < nodes.len());
    // SAFETY: a `View` is only made of trees whose children all lie inside it (builders make it so,
    // `cache` checks it). Unused places hold `Child::NONE`, which is no inner child.
    unsafe { nodes.get_unchecked(child.0 as usize) }
}

/// Bytes of one row of `Node::bounds`.
pub(super) const ROW: usize = size_of::<[f32; 8]>();

/// The row of a node's bounds that begins so many bytes in, a multiple of [`ROW`].
#[inline(always)]
pub(super) fn row_at(node: &Node, offset: usize) -> &[f32; 8] {
    debug_assert!(offset < 6 * ROW && offset.is_multiple_of(ROW));
    // SAFETY: callers pass ROW · (2·axis + side), so the row lies inside `bounds`. An index instead
    // of bytes would be multiplied anew for every node.
    unsafe { &*(&raw const node.bounds).byte_add(offset).cast::<[f32; 8]>() }
}

/// Block `i` of a leaf.
#[inline(always)]
pub(super) fn block_at(blocks: &[Block], leaf: Child, i: u32) -> &Block {
    let index = (leaf.first() + i) as usize;
    debug_assert!(index < blocks.len());
    // SAFETY: as for `node_at`: leaf ranges lie inside the blocks.
    unsafe { blocks.get_unchecked(index) }
}

/// Asks for what a child holds, which a ray will look at later.
#[inline(always)]
pub(super) fn prefetch(nodes: &[Node], blocks: &[Block], child: Child) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let (base, at, lines) = if child.is_leaf() {
            (blocks.as_ptr().cast::<i8>(), child.first() as usize * size_of::<Block>(), 5)
        } else {
            (nodes.as_ptr().cast::<i8>(), child.0 as usize * size_of::<Node>(), 4)
        };
        for line in 0..lines {
            // SAFETY: a prefetch of any address does nothing but move memory into the cache.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(base.wrapping_add(at + 64 * line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (nodes, blocks, child);
}

/// Children still to be visited: entry distance in the upper half, child in the lower.
///
/// The caller keeps the number of entries, `top`, in a variable of its own: inside this struct it
/// would live in memory and every push would wait for the store of the last.
pub(super) struct Stack<const N: usize>([MaybeUninit<u64>; N]);

impl<const N: usize> Stack<N> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; N])
    }

    /// Writes an entry above `top` others.
    #[inline(always)]
    pub(super) fn put(&mut self, top: usize, entry: u64) {
        debug_assert!(top < N);
        // SAFETY: no tree whose `stack_need` exceeds N is ever traversed.
        unsafe { self.0.get_unchecked_mut(top) }.write(entry);
    }

    /// The entry above `top` others, which has been put there.
    #[inline(always)]
    pub(super) fn get(&self, top: usize) -> u64 {
        debug_assert!(top < N);
        // SAFETY: entries are put before they are got, from the bottom on, and `top` is below N as in `put`.
        unsafe { self.0.get_unchecked(top).assume_init() }
    }

    /// Puts an entry above `top` others into the run from `base` on, which falls from bottom to top
    /// and goes on doing so.
    #[inline(always)]
    pub(super) fn put_sorted(&mut self, base: usize, top: usize, entry: u64) {
        let mut at = top;
        while at > base && self.get(at - 1) < entry {
            self.put(at, self.get(at - 1));
            at -= 1;
        }
        self.put(at, entry);
    }
}
