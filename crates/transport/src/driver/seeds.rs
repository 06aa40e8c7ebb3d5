//! Where Markov chains start: at seeds drawn among many independent samples, in proportion to their targets (Veach
//! 1997, section 11.3.1).
//!
//! Drawn among M seeds, bright light is too seldom a start by about E[target²] / (M b²) of its share, which a mean b over
//! the same M seeds makes up for: their product is unbiased. So all chains share their seeds, and b begins with them.
//! Where the halves of a picture are to be independent of each other, each has a pool of its own: that of the chains
//! of even and that of those of odd number.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Seeds of all chains.
#[derive(Debug)]
pub(super) struct Seeds {
    /// Seeds of each block.
    pub per_block: u64,
    /// One for each chain.
    blocks: Vec<OnceLock<Block>>,
    /// The block that is to be traced next.
    next: AtomicUsize,
    is_cancelled: AtomicBool,
    /// In how many pools the blocks are, by turns.
    pub pools: usize,
}

/// Seeds that are traced in one go.
#[derive(Debug)]
pub(super) struct Block {
    /// The target of each.
    pub targets: Vec<f64>,
    /// Contributions that were no numbers.
    pub refused: u64,
}

impl Block {
    /// Sum of the targets.
    pub fn sum(&self) -> f64 {
        self.targets.iter().sum()
    }
}

impl Seeds {
    /// As many seeds as pixels, within limits: to start takes about as long as a sample for each pixel.
    pub fn new(chains: u64, pixels: u64) -> Self {
        Self {
            per_block: (pixels / chains).clamp(16, 1024),
            blocks: (0..chains).map(|_| OnceLock::new()).collect(),
            next: AtomicUsize::new(0),
            is_cancelled: AtomicBool::new(false),
            pools: 1,
        }
    }

    /// Ends all waiting: what is not there will not come.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether nobody wants to start any more.
    pub fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }

    /// Traces blocks beside all other threads that are here until there are no more, and waits for those that others
    /// are at. Says whether all are there, which they are unless the start was cancelled.
    pub fn complete(&self, mut trace: impl FnMut(usize) -> Block) -> bool {
        while !self.is_cancelled() && self.next.load(Ordering::Relaxed) < self.blocks.len() {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            if let Some(place) = self.blocks.get(number) {
                // The counter gives each number once.
                place.get_or_init(|| trace(number));
            }
        }
        while !self.is_cancelled() {
            if self.blocks.iter().all(|block| block.get().is_some()) {
                return true;
            }
            std::thread::yield_now();
        }
        false
    }

    /// The blocks of a pool that are there.
    pub fn pool(&self, pool: usize) -> impl Iterator<Item = &Block> {
        self.blocks.iter().skip(pool).step_by(self.pools).filter_map(OnceLock::get)
    }

    /// Draws a seed of a pool in proportion to the targets, by a number in [0, 1): its block and its place in that.
    pub fn draw(&self, pool: usize, u: f64) -> Option<(usize, u64)> {
        let mut rest = u * self.pool(pool).map(Block::sum).sum::<f64>();
        let mut last = None;
        for (i, block) in self.pool(pool).enumerate() {
            let sum = block.sum();
            if rest >= sum {
                rest -= sum;
                continue;
            }
            for (step, &target) in block.targets.iter().enumerate().filter(|(_, t)| **t > 0.0) {
                last = Some((self.pools * i + pool, step as u64));
                if rest < target {
                    return last;
                }
                rest -= target;
            }
        }
        // Rounding may leave a little of the sum.
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(number: usize) -> Block {
        let target = |step: u64| if step.is_multiple_of(3) { 0.0 } else { (number as u64 + step) as f64 };
        Block { targets: (0..128).map(target).collect(), refused: 0 }
    }

    #[test]
    fn seeds_are_drawn_by_their_targets() {
        let mut seeds = Seeds::new(4, 1);
        seeds.pools = 2;
        assert!(seeds.complete(block));
        for half in 0..2 {
            let total: f64 = seeds.pool(half).map(Block::sum).sum();
            let n = 200_000;
            let mut counts = vec![0_u32; 4 * 128];
            for i in 0..n {
                let (block, step) =
                    seeds.draw(half, (f64::from(i) + 0.5) / f64::from(n)).expect("there is light");
                assert_eq!(block % 2, half, "a seed of the other half");
                counts[block * 128 + step as usize] += 1;
            }
            for (i, &count) in counts.iter().enumerate().filter(|(i, _)| i / 128 % 2 == half) {
                let expected = block(i / 128).targets[i % 128] / total * f64::from(n);
                assert!((f64::from(count) - expected).abs() <= 1.0, "seed {i}: {count} for {expected}");
            }
        }
    }

    #[test]
    fn threads_share_the_work_and_a_cancelled_start_ends() {
        let seeds = Seeds::new(64, 1);
        let traced = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    assert!(seeds.complete(|number| {
                        traced.fetch_add(1, Ordering::Relaxed);
                        block(number)
                    }));
                });
            }
        });
        assert_eq!(traced.into_inner(), 64);

        let cancelled = Seeds::new(64, 1);
        let is_complete = cancelled.complete(|number| {
            if number == 10 {
                cancelled.cancel();
            }
            block(number)
        });
        assert!(!is_complete && cancelled.pool(0).count() == 11);
    }

    #[test]
    fn where_there_is_no_light_nothing_is_drawn() {
        let seeds = Seeds::new(2, 1);
        assert!(seeds.complete(|_| Block { targets: vec![0.0; 128], refused: 0 }));
        assert_eq!(seeds.draw(0, 0.5), None);
    }
}
