//! Choosing a lamp, or a part of one, by what it may give a receiver.
//!
//! A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018: lamps are the
//! leaves of a tree. A draw begins at its root and goes on into one of two parts, with chances in proportion to what each
//! may give the receiver, which knows the distance, the directions into which lamps shine, and the side on which the
//! receiver is lit. It takes as many steps as the tree is deep, and the probability of any leaf is the product of the
//! chances on the way to it: exactly what it is drawn with.
//!
//! The parts are triangles, so that of a large lamp the near ones are drawn, and of a ball those in front. What stands
//! between is not known.
//!
//! Walks are calls of their own: they are long, and in the many scenes of a single lamp there is nothing to walk.
//!
//! Where rounding leaves out what a receiver sees edge-on, its density is 0, and scattering finds it with its full weight.

mod build;
mod cluster;
mod node;

use crate::area::AreaLight;
use crate::query::Receiver;
pub(crate) use cluster::Lobe;
use indigo_math::Float;
use node::Node;

/// What has no slot, since it does not shine.
const NONE: u32 = u32::MAX;

/// A tree over the triangles of all lamps.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightTree {
    /// In the order of a walk in depth.
    nodes: Vec<Node>,
    /// The triangles that shine, in the order of the leaves.
    slots: Vec<Slot>,
    /// For each lamp where its triangles begin in `slot_of`.
    offsets: Vec<u32>,
    /// For each triangle of each lamp its slot.
    slot_of: Vec<u32>,
}

/// A triangle of a lamp.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub lamp: u32,
    pub triangle: u32,
    /// Its part of its leaf's flux.
    part: f64,
}

impl LightTree {
    /// A tree over lamps.
    pub fn new(lamps: &[AreaLight]) -> Self {
        build::build(lamps)
    }

    /// Draws a triangle for a receiver by a number in [0, 1), and gives its probability; `None` where the
    /// light of none can arrive.
    #[inline(never)]
    pub fn sample(&self, to: &Receiver, mut u: f64) -> Option<(Slot, f64)> {
        let mut chance = 1.0;
        let mut i = 0;
        let mut node = self.nodes.first()?;
        while node.second != 0 {
            let first = self.share_of_first(i, to)?;
            if u < first {
                (u, chance, i) = (u / first, chance * first, i + 1);
            } else {
                let second = 1.0 - first;
                (u, chance, i) = ((u - first) / second, chance * second, node.second as usize);
            }
            node = &self.nodes[i];
        }
        let leaf = &self.slots[node.first as usize..node.end as usize];
        let drawn = leaf.iter().find(|slot| {
            let is_here = u < slot.part;
            u -= slot.part;
            is_here
        });
        // The parts are all of it but for rounding.
        let slot = drawn.or(leaf.last())?;
        chance *= slot.part;
        (chance > 0.0).then_some((*slot, chance))
    }

    /// Probability with which [`sample`](Self::sample) draws a triangle of a lamp for a receiver.
    #[inline(never)]
    pub fn probability(&self, lamp: usize, triangle: u32, to: &Receiver) -> f64 {
        let slot = self.slot_of[(self.offsets[lamp] + triangle) as usize];
        if slot == NONE {
            return 0.0;
        }
        let mut chance = 1.0;
        let mut i = 0;
        while self.nodes[i].second != 0 {
            let Some(first) = self.share_of_first(i, to) else { return 0.0 };
            let second = self.nodes[i].second as usize;
            if slot < self.nodes[second].first {
                (chance, i) = (chance * first, i + 1);
            } else {
                (chance, i) = (chance * (1.0 - first), second);
            }
            if chance == 0.0 {
                return 0.0;
            }
        }
        chance * self.slots[slot as usize].part
    }

    /// The chance of a node's first part; `None` where no light of either can arrive.
    #[inline]
    fn share_of_first(&self, i: usize, to: &Receiver) -> Option<f64> {
        let parts = [&self.nodes[i + 1], &self.nodes[self.nodes[i].second as usize]];
        let [a, b] = parts.map(|node| node.importance(to));
        let sum = a + b;
        if sum > 0.0 && sum.is_finite() {
            return Some(a.to_f64() / sum.to_f64());
        }
        // On a lamp without extent distances say nothing.
        let [a, b] = parts.map(|node| node.intensity);
        (sum != 0.0).then(|| a.to_f64() / (a + b).to_f64())
    }
}

#[cfg(test)]
mod tests;
