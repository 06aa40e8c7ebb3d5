//! Improves a binary tree by taking subtrees out and putting them where they cost least.
//!
//! Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization" (Computer
//! Graphics Forum 37(2), 2018): all searches of a round look at the same tree and run in parallel;
//! then the moves are made one by one, the most rewarding first, leaving out those that touch what
//! an earlier one changed. Unlike there, a later round looks only at nodes for which an earlier one
//! found a better place and at what the moves touched: of the others hardly any finds one.

use super::binary::BinaryNode;
use crate::stop::Stop;
use crate::wide::Box3;
use indigo_math::pages::with_capacity;
use rayon::prelude::*;

/// Most rounds.
const ROUNDS: usize = 8;
/// Part of the nodes, those of the largest area, that the first round tries to move.
const CANDIDATES: f64 = 0.25;
/// No further round begins after as many searches as this part of the nodes.
const SEARCHES: f64 = 0.5;

const ROOT: u32 = 0;
const NONE: u32 = u32::MAX;
/// In [`Node::link`]: the node is a leaf.
const LEAF: u32 = 1 << 31;

/// The better tree, or `None` where it would be deeper than `max_depth`, or the work was stopped.
pub(crate) fn improve(binary: &[BinaryNode], max_depth: u32, stop: &Stop) -> Option<Vec<BinaryNode>> {
    let mut tree = Tree::new(binary);
    let mut candidates = tree.largest((binary.len() as f64 * CANDIDATES) as usize);
    let mut searches_left = (binary.len() as f64 * SEARCHES) as usize;
    for _ in 0..ROUNDS {
        if stop.is_set() {
            return None;
        }
        searches_left = searches_left.saturating_sub(candidates.len());
        let moves = tree.find_moves(&candidates);
        candidates = tree.make_moves(&moves);
        if candidates.is_empty() || searches_left == 0 {
            break;
        }
    }
    tree.in_order(binary, max_depth)
}

/// A node with links both ways; half a cache line, so that one line holds both children of a parent.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Node {
    bounds: Box3,
    parent: u32,
    /// Inner node: the first of its two children, whose place is even. Leaf: [`LEAF`] and the index
    /// of its binary node.
    link: u32,
}

impl Node {
    /// The first of two children; `None` for a leaf.
    #[inline(always)]
    fn first_child(&self) -> Option<u32> {
        (self.link & LEAF == 0).then_some(self.link)
    }
}

/// The tree: the root in place 0, nothing in place 1, then pairs of siblings.
struct Tree {
    nodes: Vec<Node>,
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
        let mut nodes = with_capacity(binary.len() + 1);
        let empty = Node { bounds: Box3::EMPTY, parent: NONE, link: LEAF };
        nodes.resize(2, empty);
        // Binary node, the place for it, and its parent.
        let mut stack = vec![(0, ROOT, NONE)];
        while let Some((i, place, parent)) = stack.pop() {
            let node = &binary[i];
            let mut link = LEAF | i as u32;
            if node.prims().is_none() {
                let [left, right] = node.children(i);
                link = nodes.len() as u32;
                nodes.resize(nodes.len() + 2, empty);
                stack.extend([(right, link + 1, place), (left, link, place)]);
            }
            nodes[place as usize] = Node { bounds: node.bounds(), parent, link };
        }
        Self { nodes }
    }

    #[inline(always)]
    fn node(&self, i: u32) -> &Node {
        &self.nodes[i as usize]
    }

    fn parent(&self, i: u32) -> u32 {
        self.node(i).parent
    }

    fn area(&self, i: u32) -> f32 {
        self.node(i).bounds.half_area()
    }

    /// The other child of the parent; not for the root.
    fn sibling(i: u32) -> u32 {
        i ^ 1
    }

    /// Of all nodes but the root the `wanted` ones of the largest area.
    fn largest(&self, wanted: usize) -> Vec<u32> {
        let areas = (2..self.nodes.len() as u32).into_par_iter().map(|i| (self.area(i), i));
        let mut nodes: Vec<(f32, u32)> = areas.collect();
        if wanted < nodes.len() {
            nodes.select_nth_unstable_by(wanted, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            nodes.truncate(wanted);
        }
        in_tree_order(nodes.into_iter().map(|(_, i)| i).collect())
    }

    /// The moves that would pay, the most rewarding first.
    fn find_moves(&self, candidates: &[u32]) -> Vec<Move> {
        let search = |stack: &mut Vec<_>, &node: &u32| self.best_move(node, stack);
        let mut moves: Vec<Move> = candidates.par_iter().map_init(Vec::new, search).flatten().collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.node.cmp(&b.node)));
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
        let (node_bounds, node_area) = (self.node(node).bounds, self.area(node));
        let mut best = Move { node, beside: NONE, gain: 0.0 };
        // Without the node its parent goes, and the boxes of all above shrink.
        let mut saved = self.area(parent);
        let mut other = Self::sibling(node);
        let mut shrunk = self.node(other).bounds;
        let mut above = parent;
        loop {
            stack.push((saved, other));
            while let Some((saved, at)) = stack.pop() {
                if saved - node_area <= best.gain {
                    continue;
                }
                let here = self.node(at);
                let gain = saved - here.bounds.union(&node_bounds).half_area();
                if gain > best.gain {
                    best = Move { node, beside: at, gain };
                }
                if let Some(first) = here.first_child() {
                    let below = gain + here.bounds.half_area();
                    if below - node_area > best.gain {
                        stack.extend([(below, first), (below, first + 1)]);
                    }
                }
            }
            if above != parent {
                shrunk = shrunk.union(&self.node(other).bounds);
                saved += self.area(above) - shrunk.half_area();
            }
            if above == ROOT {
                break;
            }
            other = Self::sibling(above);
            above = self.parent(above);
        }
        let stays = best.beside == NONE || best.beside == parent || best.beside == Self::sibling(node);
        (!stays).then_some(best)
    }

    /// Makes the moves that do not touch what another one has. Returns what to look at next: all
    /// nodes that were to move, and what has been touched.
    fn make_moves(&mut self, moves: &[Move]) -> Vec<u32> {
        let mut touched = vec![false; self.nodes.len()];
        let mut next: Vec<u32> = moves.iter().map(|m| m.node).collect();
        for m in moves {
            let parent = self.parent(m.node);
            if parent == ROOT || m.beside == ROOT {
                continue;
            }
            let involved =
                [m.node, parent, self.parent(parent), Self::sibling(m.node), m.beside, self.parent(m.beside)];
            // An earlier move may also have brought the goal below the node itself.
            if involved.iter().any(|&i| touched[i as usize]) || self.is_below(m.beside, m.node) {
                continue;
            }
            for i in involved {
                touched[i as usize] = true;
            }
            next.extend(involved.into_iter().filter(|&i| i != ROOT));
            self.make_move(*m);
        }
        in_tree_order(next)
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

    /// The sibling takes its parent's place; what stood at the goal takes the sibling's, so that the
    /// pair can hang below the goal's place.
    fn make_move(&mut self, m: Move) {
        let (parent, free) = (self.parent(m.node), Self::sibling(m.node));
        self.put(free, parent);
        self.put(m.beside, free);
        let above = self.parent(m.beside);
        let bounds = self.node(free).bounds.union(&self.node(m.node).bounds);
        self.nodes[m.beside as usize] = Node { bounds, parent: above, link: m.node & !1 };
        self.nodes[free as usize].parent = m.beside;
        self.nodes[m.node as usize].parent = m.beside;
        self.refit(self.parent(parent));
        self.refit(above);
    }

    /// Puts a copy of a node and of all below it into another place, which keeps its parent.
    fn put(&mut self, from: u32, to: u32) {
        let Node { bounds, link, .. } = *self.node(from);
        let parent = self.parent(to);
        let node = Node { bounds, parent, link };
        self.nodes[to as usize] = node;
        if let Some(first) = node.first_child() {
            self.nodes[first as usize].parent = to;
            self.nodes[first as usize + 1].parent = to;
        }
    }

    /// Makes the boxes from a node up to the root fit again.
    fn refit(&mut self, mut i: u32) {
        while i != NONE {
            let Some(first) = self.node(i).first_child() else { return };
            let fitted = self.node(first).bounds.union(&self.node(first + 1).bounds);
            self.nodes[i as usize].bounds = fitted;
            i = self.parent(i);
        }
    }

    /// The tree in pre-order again, or `None` where it is too deep.
    fn in_order(&self, binary: &[BinaryNode], max_depth: u32) -> Option<Vec<BinaryNode>> {
        let mut out: Vec<BinaryNode> = with_capacity(binary.len());
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
            let node = self.node(i);
            if let Some(first) = node.first_child() {
                out.push(BinaryNode::inner(&node.bounds, 0));
                stack.push((first + 1, depth + 1, at as u32));
                stack.push((first, depth + 1, NONE));
            } else {
                out.push(binary[(node.link & !LEAF) as usize]);
            }
        }
        Some(out)
    }
}

/// Sorted and each once: neighbours in the tree look at the same nodes.
fn in_tree_order(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.par_sort_unstable();
    nodes.dedup();
    nodes
}
