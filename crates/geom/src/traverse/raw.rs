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
    // SAFETY: callers pass the index of a set bit of an 8-bit mask into an array of 8, an axis into
    // an array of 3, or 2·axis + side into an array of 6.
    unsafe { array.get_unchecked(i) }
}

/// The node of an inner child.
#[inline(always)]
pub(super) fn node_at(nodes: &[Node], child: Child) -> &Node {
    debug_assert!((child.0 as usize) < nodes.len());
    // SAFETY: a `View` is only made of trees whose children all lie inside it (builders make it so,
    // `cache` checks it), and unused places have empty boxes, which no ray meets.
    unsafe { nodes.get_unchecked(child.0 as usize) }
}

/// Block `i` of a leaf.
#[inline(always)]
pub(super) fn block_at(blocks: &[Block], leaf: Child, i: u32) -> &Block {
    let index = (leaf.first() + i) as usize;
    debug_assert!(index < blocks.len());
    // SAFETY: as for `node_at`: leaf ranges lie inside the blocks.
    unsafe { blocks.get_unchecked(index) }
}

/// Children still to be visited: entry distance in the upper half, child in the lower.
pub(super) struct Stack<const N: usize> {
    entries: [MaybeUninit<u64>; N],
    len: usize,
}

impl<const N: usize> Stack<N> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; N], len: 0 }
    }

    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(super) fn push(&mut self, entry: u64) {
        debug_assert!(self.len < N);
        // SAFETY: no tree whose `stack_need` exceeds N is ever traversed.
        unsafe { self.entries.get_unchecked_mut(self.len) }.write(entry);
        self.len += 1;
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<u64> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: all entries below the old length were written, and the length never exceeds N.
        Some(unsafe { self.entries.get_unchecked(self.len).assume_init() })
    }

    /// Pushes into the run from `base` on, which falls from bottom to top, keeping it so.
    #[inline(always)]
    pub(super) fn insert_descending(&mut self, base: usize, entry: u64) {
        debug_assert!(self.len < N);
        let mut at = self.len;
        // SAFETY: `base < at <= len < N`, and entries below the length were written.
        unsafe {
            while at > base {
                let below = self.entries.get_unchecked(at - 1).assume_init();
                if below >= entry {
                    break;
                }
                self.entries.get_unchecked_mut(at).write(below);
                at -= 1;
            }
            self.entries.get_unchecked_mut(at).write(entry);
        }
        self.len += 1;
    }
}
