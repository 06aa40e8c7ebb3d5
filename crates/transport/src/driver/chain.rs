//! The primary sample of a Markov chain and its mutations (Kelemen et al. 2002, "A Simple and Robust
//! Mutation Strategy for the Metropolis Light Transport Algorithm").
//!
//! A state is a point of the unit cube of all blocks, of which only those that its paths asked for
//! are kept: the others have no effect, so given the state they are uniform, and a fresh number when
//! a proposal first asks for one is a draw from just that distribution.

use crate::sampler::{Block, PrimarySample};
use indigo_math::{Real, elementary, rng};

/// ln 16: the largest step of a small mutation is 16 times the smallest (Kelemen et al. 2002, section 3.3: 1/64
/// and 1/1024).
const LN_STEPS: Real = 4.0 * std::f64::consts::LN_2 as Real;

/// How proposals are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mutation {
    /// Radius of small mutations.
    pub max_change: Real,
    /// Names all randomness of the chain.
    pub key: u64,
}

/// A state of the chain and a proposal.
#[derive(Clone, Debug, Default)]
pub(super) struct ChainSample {
    current: Blocks,
    proposal: Blocks,
}

/// Blocks that a chain keeps: those of some 250 vertices. Of longer paths the rest is drawn afresh by every proposal,
/// which is symmetric too, so that the memory of all chains does not grow with the longest path.
const KEPT: usize = 1024;

/// Blocks of numbers; each is in use where its mark is that of the list.
#[derive(Clone, Debug)]
struct Blocks {
    mark: u64,
    values: Vec<(u64, [Real; 4])>,
}

impl Default for Blocks {
    fn default() -> Self {
        // Mark 0 is never in use.
        Self { mark: 0, values: vec![(0, [0.0; 4]); KEPT] }
    }
}

impl Blocks {
    /// Forgets all blocks.
    fn clear(&mut self) {
        self.mark += 1;
    }

    #[inline]
    fn get(&self, i: usize) -> Option<[Real; 4]> {
        self.values.get(i).filter(|(mark, _)| *mark == self.mark).map(|(_, v)| *v)
    }

    #[inline]
    fn put(&mut self, i: usize, v: [Real; 4]) {
        if let Some(place) = self.values.get_mut(i) {
            *place = (self.mark, v);
        }
    }
}

impl ChainSample {
    /// The numbers of a proposal: afresh, or near the current state. `step` names its randomness.
    pub fn propose(&mut self, mutation: Mutation, step: u64, is_large: bool) -> Proposal<'_> {
        self.proposal.clear();
        Proposal {
            state: &self.current,
            blocks: &mut self.proposal,
            key: rng::mix64(mutation.key ^ rng::mix64(step)),
            max_change: mutation.max_change,
            is_large,
        }
    }

    /// The last proposal becomes the state.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.current, &mut self.proposal);
    }
}

/// The numbers of a proposal as a technique asks for them.
pub(super) struct Proposal<'a> {
    state: &'a Blocks,
    blocks: &'a mut Blocks,
    key: u64,
    max_change: Real,
    is_large: bool,
}

impl PrimarySample for Proposal<'_> {
    #[inline]
    fn block(&mut self, block: Block) -> [Real; 4] {
        let i = block.index();
        if let Some(known) = self.blocks.get(i) {
            return known;
        }
        let fresh = random4(self.key, i as u64);
        let value = match self.state.get(i).filter(|_| !self.is_large) {
            Some(old) => std::array::from_fn(|d| perturbed(old[d], fresh[d], self.max_change)),
            None => fresh,
        };
        self.blocks.put(i, value);
        value
    }
}

/// Four numbers in [0, 1) named by a key and a counter.
#[inline]
fn random4(key: u64, counter: u64) -> [Real; 4] {
    let base = key ^ counter.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let (a, b) = (rng::mix64(base), rng::mix64(base.wrapping_add(0xD1B5_4A32_D192_ED03)));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32].map(rng::to_unit)
}

/// A number moved by up to `max_change` either way, round the ends of [0, 1); `u` says how far, with
/// a density that falls as 1 / distance. Symmetric: the way back is as likely.
#[inline]
fn perturbed(old: Real, u: Real, max_change: Real) -> Real {
    let (sign, u) = if u < 0.5 { (-1.0, 2.0 * u) } else { (1.0, 2.0 * u - 1.0) };
    let moved = old + sign * max_change * elementary::exp(-LN_STEPS * u);
    let wrapped = moved - moved.floor();
    if wrapped < 1.0 { wrapped } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MUTATION: Mutation = Mutation { max_change: 0.05, key: 7 };

    #[test]
    fn a_proposal_gives_the_same_numbers_when_asked_twice_and_small_ones_stay_near() {
        let mut sample = ChainSample::default();
        let mut first = sample.propose(MUTATION, 1, true);
        let start = first.block(Block::LENS);
        let far = first.block(Block::scatter(9_999));
        assert_eq!(start, first.block(Block::LENS));
        assert_eq!(far, first.block(Block::scatter(9_999)));
        sample.accept();
        let mut near = sample.propose(MUTATION, 2, false);
        let moved = near.block(Block::LENS);
        let other = near.block(Block::FILM);
        assert_ne!(other, moved);
        for (a, b) in start.into_iter().zip(moved) {
            let d = (a - b).abs();
            let d = d.min(1.0 - d);
            assert!(d > 0.05 / 17.0 && d <= 0.0501, "{a} {b}");
        }
        // Rejected: the next one starts from the same place.
        let again = sample.propose(MUTATION, 3, false).block(Block::LENS);
        assert_ne!(again, moved);
        for (a, b) in start.into_iter().zip(again) {
            let d = (a - b).abs();
            assert!(d.min(1.0 - d) <= 0.0501);
        }
    }

    /// 200,000 small steps leave the numbers uniform. A step moves by a tenth of the range on average, so that a bin of
    /// a sixteenth is left within some ten steps and what two bins hold is as good as independent after a hundred:
    /// 12 standard deviations of independent draws are more than one of such correlated ones.
    #[test]
    fn small_steps_leave_the_uniform_distribution_alone() {
        let mutation = Mutation { max_change: 0.3, key: 11 };
        let mut sample = ChainSample::default();
        let mut bins = [0u32; 16];
        let n = 200_000;
        for step in 0..n {
            let u = sample.propose(mutation, step, step == 0).block(Block::EMISSION)[2];
            sample.accept();
            bins[(u * 16.0) as usize] += 1;
        }
        let expected = n as Real / 16.0;
        for count in bins {
            // 12 standard deviations of independent draws; the chain forgets within some ten steps.
            assert!((count as Real - expected).abs() < 12.0 * expected.sqrt(), "{bins:?}");
        }
    }
}
