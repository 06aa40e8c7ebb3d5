//! Improves a binary tree by taking subtrees out and putting them where they cost least.
//!
//! Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization" (Computer
//! Graphics Forum 37(2), 2018): all searches of a round look at the same tree and run in parallel;
//! then the moves are made one by one, the most rewarding first, leaving out those that touch what
//! an earlier one changed.

use super::binary::BinaryNode;
use crate::wide::Box3;
use rayon::prelude::*;

/// Rounds.
const ROUNDS: usize = 4;
/// Part of the nodes, those of the largest area, that each round tries to move.
const CANDIDATES: f64 = 0.25;

const ROOT: u32 = 0;
const NONE: u32 = u32::MAX;

/// The better tree, or `None` where it would be deeper than `max_depth`.
pub(crate) fn improve(binary: &[BinaryNode], max_depth: u32) -> Option<Vec<BinaryNode>> {
    let mut tree = Tree::new(binary);
    for _ in 0..ROUNDS {
        let moves = tree.find_moves();
        tree.make_moves(&moves);
    }
    tree.in_order(binary, max_depth)
}

/// The tree with links both ways. Leaves keep the index of their binary node.
struct Tree {
    bounds: Vec<Box3>,
    parents: Vec<u32>,
    /// Both children; [`NONE`] on leaves.
    children: Vec<[u32; 2]>,
}

/// A subtree to be moved beside another.
#[derive(Clone, Copy)]
struct Move {
    node: u32,
    beside: u32,
    /// By how much the sum of all areas falls.
    gain: f32,
}

impl Tree {
    fn new(binary: &[BinaryNode]) -> Self {
        let mut parents = vec![NONE; binary.len()];
        let mut children = vec![[NONE; 2]; binary.len()];
        for (i, node) in binary.iter().enumerate() {
            if node.prims().is_none() {
                children[i] = node.children(i).map(|c| c as u32);
                children[i].iter().for_each(|&c| parents[c as usize] = i as u32);
            }
        }
        Self { bounds: binary.iter().map(BinaryNode::bounds).collect(), parents, children }
    }

    fn parent(&self, i: u32) -> u32 {
        self.parents[i as usize]
    }

    fn area(&self, i: u32) -> f32 {
        self.bounds[i as usize].half_area()
    }

    fn sibling(&self, i: u32) -> u32 {
        let [a, b] = self.children[self.parent(i) as usize];
        if a == i { b } else { a }
    }

    fn find_moves(&self) -> Vec<Move> {
        let mut candidates: Vec<(f32, u32)> =
            (1..self.bounds.len() as u32).map(|i| (self.area(i), i)).collect();
        let wanted = (candidates.len() as f64 * CANDIDATES) as usize;
        if wanted == 0 {
            return Vec::new();
        }
        candidates.select_nth_unstable_by(wanted, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let search = |stack: &mut Vec<_>, &(_, node): &(f32, u32)| self.best_move(node, stack);
        let mut moves: Vec<Move> =
            candidates[..wanted].par_iter().map_init(Vec::new, search).flatten().collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.node.cmp(&b.node)));
        moves
    }

    /// Where a node is best put, if anywhere else than where it is (the paper's algorithm 1).
    ///
    /// Goes up from the node; at each ancestor the other side is searched downwards, as long as the
    /// area saved so far exceeds what the node at least costs there.
    fn best_move(&self, node: u32, stack: &mut Vec<(f32, u32)>) -> Option<Move> {
        let parent = self.parent(node);
        if parent == ROOT {
            return None;
        }
        let (node_bounds, node_area) = (self.bounds[node as usize], self.area(node));
        let mut best = Move { node, beside: NONE, gain: 0.0 };
        // Without the node its parent goes, and the boxes of all above shrink.
        let mut saved = self.area(parent);
        let mut other = self.sibling(node);
        let mut shrunk = self.bounds[other as usize];
        let mut above = parent;
        loop {
            stack.push((saved, other));
            while let Some((saved, at)) = stack.pop() {
                if saved - node_area <= best.gain {
                    continue;
                }
                let gain = saved - self.bounds[at as usize].union(&node_bounds).half_area();
                if gain > best.gain {
                    best = Move { node, beside: at, gain };
                }
                let [a, b] = self.children[at as usize];
                if a != NONE {
                    let below = gain + self.area(at);
                    stack.extend([(below, a), (below, b)]);
                }
            }
            if above != parent {
                shrunk = shrunk.union(&self.bounds[other as usize]);
                saved += self.area(above) - shrunk.half_area();
            }
            if above == ROOT {
                break;
            }
            other = self.sibling(above);
            above = self.parent(above);
        }
        let stays = best.beside == NONE || best.beside == parent || best.beside == self.sibling(node);
        (!stays).then_some(best)
    }

    fn make_moves(&mut self, moves: &[Move]) {
        let mut touched = vec![false; self.bounds.len()];
        for m in moves {
            let parent = self.parent(m.node);
            if parent == ROOT || m.beside == ROOT {
                continue;
            }
            let involved =
                [m.node, parent, self.parent(parent), self.sibling(m.node), m.beside, self.parent(m.beside)];
            // An earlier move may also have brought the goal below the node itself.
            if involved.iter().any(|&i| touched[i as usize]) || self.is_below(m.beside, m.node) {
                continue;
            }
            for i in involved {
                touched[i as usize] = true;
            }
            self.make_move(*m);
        }
    }

    fn is_below(&self, mut i: u32, ancestor: u32) -> bool {
        while i != ROOT {
            if i == ancestor {
                return true;
            }
            i = self.parent(i);
        }
        false
    }

    fn make_move(&mut self, m: Move) {
        let (parent, sibling) = (self.parent(m.node), self.sibling(m.node));
        let grandparent = self.parent(parent);
        self.replace_child(grandparent, parent, sibling);
        // The parent that has become free holds the node and its new sibling.
        let new_above = self.parent(m.beside);
        self.replace_child(new_above, m.beside, parent);
        self.children[parent as usize] = [m.beside, m.node];
        self.parents[m.beside as usize] = parent;
        self.refit(grandparent);
        self.refit(parent);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        let pair = &mut self.children[parent as usize];
        pair[usize::from(pair[0] != old)] = new;
        self.parents[new as usize] = parent;
    }

    /// Makes the boxes from a node up to the root fit again.
    fn refit(&mut self, mut i: u32) {
        while i != NONE {
            let [a, b] = self.children[i as usize];
            let fitted = self.bounds[a as usize].union(&self.bounds[b as usize]);
            self.bounds[i as usize] = fitted;
            i = self.parent(i);
        }
    }

    /// The tree in pre-order again, or `None` where it is too deep.
    fn in_order(&self, binary: &[BinaryNode], max_depth: u32) -> Option<Vec<BinaryNode>> {
        let mut out: Vec<BinaryNode> = Vec::with_capacity(binary.len());
        // Node, its depth, and the place of the parent whose right child it is.
        let mut stack = vec![(ROOT, 0, NONE)];
        while let Some((i, depth, right_of)) = stack.pop() {
            if depth > max_depth {
                return None;
            }
            let at = out.len();
            if right_of != NONE {
                let above = right_of as usize;
                out[above] = BinaryNode::inner(&out[above].bounds(), at - above);
            }
            let [a, b] = self.children[i as usize];
            if a == NONE {
                out.push(binary[i as usize]);
            } else {
                out.push(BinaryNode::inner(&self.bounds[i as usize], 0));
                stack.push((b, depth + 1, at as u32));
                stack.push((a, depth + 1, NONE));
            }
        }
        Some(out)
    }
}
