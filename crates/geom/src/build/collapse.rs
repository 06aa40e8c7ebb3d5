//! From two children a node to eight, by dynamic programming on the surface area cost.
//!
//! After Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs" (HPG 2017, section 3.1): for each binary node and each k, the least cost of showing
//! its subtree as at most k children of some wide node.

use super::binary::{BinaryNode, Prim};
use crate::wide::{Child, Node};

/// Cost of testing a node's eight boxes.
const NODE_COST: f32 = 1.0;
/// Cost of testing one block of primitives.
const BLOCK_COST: f32 = 0.5;

/// Below this many nodes a subtree is planned by one thread.
const PARALLEL: usize = 8192;

/// Turns runs of primitives into leaves.
pub(crate) trait LeafMaker {
    /// Primitives in one block.
    const WIDTH: u32;
    /// Blocks in one leaf.
    const MAX_BLOCKS: u32;
    /// A leaf of these primitives.
    fn make(&mut self, ids: &[u32]) -> Child;
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

/// Collapses a binary tree; appends its nodes, each before its children, and returns the root.
pub(crate) fn collapse<M: LeafMaker>(
    binary: &[BinaryNode],
    prims: &[Prim],
    maker: &mut M,
    nodes: &mut Vec<Node>,
) -> Child {
    let plans = plan_all::<M>(binary);
    Emitter { binary, prims, plans: &plans, nodes, ids: Vec::new() }.emit(0, maker)
}

fn plan_all<M: LeafMaker>(binary: &[BinaryNode]) -> Vec<Plan> {
    let mut plans = vec![Plan { cost: [0.0; 7], share: [0; 8], count: 0 }; binary.len()];
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

struct Emitter<'a> {
    binary: &'a [BinaryNode],
    prims: &'a [Prim],
    plans: &'a [Plan],
    nodes: &'a mut Vec<Node>,
    ids: Vec<u32>,
}

impl Emitter<'_> {
    fn emit<M: LeafMaker>(&mut self, i: usize, maker: &mut M) -> Child {
        if self.plans[i].share[0] == 0 {
            self.ids.clear();
            self.collect_ids(i);
            self.ids.sort_unstable();
            return maker.make(&self.ids);
        }
        let [left, right] = self.binary[i].children(i);
        let share = self.plans[i].share[7] as usize;
        let (mut places, mut used) = ([0usize; 8], 0);
        self.gather(left, share, &mut places, &mut used);
        self.gather(right, 8 - share, &mut places, &mut used);
        let at = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        for (place, &below) in places[..used].iter().enumerate() {
            let child = self.emit(below, maker);
            let bounds = self.binary[below].bounds();
            self.nodes[at].set(place, &bounds, child);
        }
        Child::node(at)
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

    fn collect_ids(&mut self, i: usize) {
        if let Some(range) = self.binary[i].prims() {
            self.ids.extend(self.prims[range].iter().map(Prim::id));
        } else {
            let [left, right] = self.binary[i].children(i);
            self.collect_ids(left);
            self.collect_ids(right);
        }
    }
}
