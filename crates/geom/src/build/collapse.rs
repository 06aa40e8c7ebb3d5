//! From two children a node to eight, by dynamic programming on the surface area cost.
//!
//! After Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs" (HPG 2017, section 3.1): for each binary node and each k, the least cost of showing
//! its subtree as at most k children of some wide node.

use super::binary::{BinaryNode, Prim};
use crate::wide::{Child, Node};
use indigo_math::pages::with_capacity;
use rayon::prelude::*;

/// Cost of testing a node's eight boxes.
const NODE_COST: f32 = 1.0;
/// Cost of testing one block of primitives.
const BLOCK_COST: f32 = 0.5;

/// Below this many nodes a subtree is planned by one thread.
const PARALLEL: usize = 8192;

/// Turns runs of primitives into leaves.
pub(crate) trait LeafMaker: Sync {
    /// Primitives in one block.
    const WIDTH: u32;
    /// Blocks in one leaf.
    const MAX_BLOCKS: u32;
    /// What leaves are made of.
    type Block: Copy + Send;
    /// A block to be overwritten.
    const EMPTY: Self::Block;
    /// A leaf of these primitives. Its blocks, one for each [`WIDTH`](Self::WIDTH) of them, are
    /// `blocks`, the first of which has the number `first`.
    fn make(&self, ids: &[u32], blocks: &mut [Self::Block], first: usize) -> Child;
}

/// What is known of a binary node.
#[derive(Clone, Copy)]
struct Plan {
    /// Least cost as up to k children, at k − 1, for k of 1 to 7.
    cost: [f32; 7],
    /// How many of k places the left child gets, at k − 1; 0: k places are no better than k − 1.
    /// Place 0 is 1 where the node becomes a wide node and 0 where it becomes a leaf.
    share: [u8; 8],
    /// Primitives below.
    count: u32,
}

/// Collapses a binary tree. Returns its nodes, each before its children, the blocks of its leaves, and
/// the root; nodes and blocks are to be numbered from `first` on.
pub(crate) fn collapse<M: LeafMaker>(
    binary: &[BinaryNode],
    prims: &[Prim],
    maker: &M,
    first: Size,
) -> (Vec<Node>, Vec<M::Block>, Child) {
    let plans = plan_all::<M>(binary);
    Emitter { binary, prims, plans: &plans, maker }.emit_all(first)
}

fn plan_all<M: LeafMaker>(binary: &[BinaryNode]) -> Vec<Plan> {
    let mut plans = with_capacity(binary.len());
    plans.resize(binary.len(), Plan { cost: [0.0; 7], share: [0; 8], count: 0 });
    plan_subtree::<M>(binary, &mut plans);
    plans
}

/// Plans the subtree of which both slices hold all nodes, the root first.
fn plan_subtree<M: LeafMaker>(binary: &[BinaryNode], plans: &mut [Plan]) {
    let node = &binary[0];
    if let Some(range) = node.prims() {
        plans[0] = leaf_plan::<M>(node, range.len() as u32);
        return;
    }
    let [left, right] = node.children(0);
    let (above, below) = plans.split_at_mut(left);
    let (left_plans, right_plans) = below.split_at_mut(right - left);
    let plan_left = |plans: &mut [Plan]| plan_subtree::<M>(&binary[left..right], plans);
    let plan_right = |plans: &mut [Plan]| plan_subtree::<M>(&binary[right..], plans);
    if binary.len() < PARALLEL {
        plan_left(left_plans);
        plan_right(right_plans);
    } else {
        rayon::join(|| plan_left(left_plans), || plan_right(right_plans));
    }
    above[0] = inner_plan::<M>(node, &left_plans[0], &right_plans[0]);
}

fn leaf_plan<M: LeafMaker>(node: &BinaryNode, count: u32) -> Plan {
    let cost = node.bounds().half_area() * BLOCK_COST * count.div_ceil(M::WIDTH) as f32;
    Plan { cost: [cost; 7], share: [0; 8], count }
}

fn inner_plan<M: LeafMaker>(node: &BinaryNode, left: &Plan, right: &Plan) -> Plan {
    let area = node.bounds().half_area();
    let mut share = [0u8; 8];
    let mut least = [f32::INFINITY; 8];
    for k in 2..=8usize {
        for s in (k - 1).saturating_sub(6).max(1)..=(k - 1).min(7) {
            let cost = left.cost[s - 1] + right.cost[k - s - 1];
            // A share is chosen even where all costs overflow.
            if cost < least[k - 1] || share[k - 1] == 0 {
                least[k - 1] = cost;
                share[k - 1] = s as u8;
            }
        }
    }
    let count = left.count + right.count;
    let blocks = count.div_ceil(M::WIDTH);
    let as_leaf = area * BLOCK_COST * blocks as f32;
    let as_node = least[7] + area * NODE_COST;
    let is_node = blocks > M::MAX_BLOCKS || as_node < as_leaf;
    let mut cost = [if is_node { as_node } else { as_leaf }; 7];
    share[0] = u8::from(is_node);
    for k in 1..7 {
        if least[k] < cost[k - 1] {
            cost[k] = least[k];
        } else {
            cost[k] = cost[k - 1];
            share[k] = 0;
        }
    }
    Plan { cost, share, count }
}

/// Numbers of nodes and blocks.
#[derive(Clone, Copy, Default)]
pub(crate) struct Size {
    pub nodes: usize,
    pub blocks: usize,
}

impl Size {
    fn plus(self, other: Self) -> Self {
        Self { nodes: self.nodes + other.nodes, blocks: self.blocks + other.blocks }
    }
}

/// Room for the nodes and blocks of a subtree, the number of the first of each, and how many are in use.
struct Room<'a, B> {
    nodes: &'a mut [Node],
    blocks: &'a mut [B],
    first: Size,
    used: Size,
}

/// A subtree that one thread emits, and the place of the reference to it.
struct Task {
    binary: usize,
    parent: usize,
    place: usize,
    size: Size,
}

struct Emitter<'a, M> {
    binary: &'a [BinaryNode],
    prims: &'a [Prim],
    plans: &'a [Plan],
    maker: &'a M,
}

impl<M: LeafMaker> Emitter<'_, M> {
    /// First the nodes near the root, then, side by side, the subtrees below them.
    fn emit_all(&self, first: Size) -> (Vec<Node>, Vec<M::Block>, Child) {
        let (mut nodes, mut tasks) = (Vec::new(), Vec::new());
        if self.is_small(0) {
            let task = Task { binary: 0, parent: 0, place: 0, size: Size::default() };
            tasks.push(task);
        } else {
            self.emit_top(0, first.nodes, &mut nodes, &mut tasks);
        }
        tasks.par_iter_mut().for_each(|t| t.size = self.size(t.binary));
        let top = Size { nodes: nodes.len(), blocks: 0 };
        let all = tasks.iter().fold(top, |sum, t| sum.plus(t.size));
        let mut out_nodes = with_capacity(all.nodes);
        out_nodes.append(&mut nodes);
        out_nodes.resize(all.nodes, Node::EMPTY);
        let mut out_blocks = with_capacity(all.blocks);
        out_blocks.resize(all.blocks, M::EMPTY);
        let (top_nodes, mut free_nodes) = out_nodes.split_at_mut(top.nodes);
        let mut free_blocks = out_blocks.as_mut_slice();
        let mut begin = first.plus(top);
        let mut rooms = Vec::with_capacity(tasks.len());
        for t in &tasks {
            let (nodes, behind_nodes) = free_nodes.split_at_mut(t.size.nodes);
            let (blocks, behind_blocks) = free_blocks.split_at_mut(t.size.blocks);
            (free_nodes, free_blocks) = (behind_nodes, behind_blocks);
            rooms.push((t, Room { nodes, blocks, first: begin, used: Size::default() }));
            begin = begin.plus(t.size);
        }
        let roots: Vec<Child> = rooms
            .par_iter_mut()
            .map_init(Vec::new, |ids, (task, room)| self.emit(task.binary, room, ids))
            .collect();
        for (task, &root) in tasks.iter().zip(&roots) {
            if let Some(node) = top_nodes.get_mut(task.parent) {
                node.children[task.place] = root;
            }
        }
        let root = if top.nodes == 0 { roots[0] } else { Child::node(first.nodes) };
        (out_nodes, out_blocks, root)
    }

    /// Whether a subtree is a task by itself.
    fn is_small(&self, i: usize) -> bool {
        self.plans[i].share[0] == 0 || (self.plans[i].count as usize) < PARALLEL
    }

    /// Emits node `i` and, of the nodes below it, those that are no tasks by themselves.
    fn emit_top(&self, i: usize, first: usize, nodes: &mut Vec<Node>, tasks: &mut Vec<Task>) -> Child {
        let at = nodes.len();
        nodes.push(Node::EMPTY);
        let (places, used) = self.children(i);
        for (place, &below) in places[..used].iter().enumerate() {
            let child = if self.is_small(below) {
                tasks.push(Task { binary: below, parent: at, place, size: Size::default() });
                Child::NONE
            } else {
                self.emit_top(below, first, nodes, tasks)
            };
            nodes[at].set(place, &self.binary[below].bounds(), child);
        }
        Child::node(first + at)
    }

    /// What [`emit`](Self::emit) will use.
    fn size(&self, i: usize) -> Size {
        if self.plans[i].share[0] == 0 {
            return Size { nodes: 0, blocks: self.plans[i].count.div_ceil(M::WIDTH) as usize };
        }
        let (places, used) = self.children(i);
        let below = places[..used].iter().map(|&i| self.size(i));
        below.fold(Size { nodes: 1, blocks: 0 }, Size::plus)
    }

    fn emit(&self, i: usize, room: &mut Room<M::Block>, ids: &mut Vec<u32>) -> Child {
        if self.plans[i].share[0] == 0 {
            ids.clear();
            self.collect_ids(i, ids);
            ids.sort_unstable();
            let first = room.used.blocks;
            room.used.blocks += ids.len().div_ceil(M::WIDTH as usize);
            let blocks = &mut room.blocks[first..room.used.blocks];
            return self.maker.make(ids, blocks, room.first.blocks + first);
        }
        let at = room.used.nodes;
        room.used.nodes += 1;
        let (places, used) = self.children(i);
        for (place, &below) in places[..used].iter().enumerate() {
            let child = self.emit(below, room, ids);
            room.nodes[at].set(place, &self.binary[below].bounds(), child);
        }
        Child::node(room.first.nodes + at)
    }

    /// The binary nodes that become the children of the wide node made of `i`, and how many they are.
    fn children(&self, i: usize) -> ([usize; 8], usize) {
        let [left, right] = self.binary[i].children(i);
        let share = self.plans[i].share[7] as usize;
        let (mut places, mut used) = ([0usize; 8], 0);
        self.gather(left, share, &mut places, &mut used);
        self.gather(right, 8 - share, &mut places, &mut used);
        // The largest first: that is where a ray that asks for any hit is most likely to find one.
        let area = |i: &usize| self.binary[*i].bounds().half_area();
        places[..used].sort_unstable_by(|a, b| area(b).total_cmp(&area(a)));
        (places, used)
    }

    /// The binary nodes that become children when the subtree of `i` gets `k` places.
    fn gather(&self, i: usize, k: usize, places: &mut [usize; 8], used: &mut usize) {
        let share = if k == 1 { 0 } else { self.plans[i].share[k - 1] as usize };
        if k == 1 || self.binary[i].prims().is_some() {
            places[*used] = i;
            *used += 1;
        } else if share == 0 {
            self.gather(i, k - 1, places, used);
        } else {
            let [left, right] = self.binary[i].children(i);
            self.gather(left, share, places, used);
            self.gather(right, k - share, places, used);
        }
    }

    fn collect_ids(&self, i: usize, ids: &mut Vec<u32>) {
        if let Some(range) = self.binary[i].prims() {
            ids.extend(self.prims[range].iter().map(Prim::id));
        } else {
            let [left, right] = self.binary[i].children(i);
            self.collect_ids(left, ids);
            self.collect_ids(right, ids);
        }
    }
}
