//! A small deterministic generator for tests.
//!
//! Independent of the renderer's own generator on purpose: a fault there must not hide itself here.

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators", fig. 15):
/// 64 bits of state, one output per step, passes BigCrush; two seeds give unrelated sequences.
#[derive(Clone, Debug)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// A generator whose whole sequence is fixed by `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [0, 1) as the kernel's single precision, a multiple of 2^-24 (never rounded up to 1).
    pub fn uniform_f32(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 * (1.0 / (1u32 << 24) as f32)
    }

    /// Uniform integer in `0..bound` (`bound` > 0); the bias, below `bound` / 2^64, is of no account.
    pub fn below(&mut self, bound: u64) -> u64 {
        ((u128::from(self.next_u64()) * u128::from(bound)) >> 64) as u64
    }

    /// A standard normal number (Box and Muller 1958; the second of the pair is thrown away).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;

    #[test]
    fn known_sequence_of_seed_zero() {
        // The first outputs of SplitMix64 seeded with 0, as published with the xoshiro generators.
        let mut rng = Rng::new(0);
        assert_eq!(rng.next_u64(), 0xe220_a839_7b1d_cdaf);
        assert_eq!(rng.next_u64(), 0x6e78_9e6a_a1b9_65f4);
        assert_eq!(rng.next_u64(), 0x06c4_5d18_8009_454f);
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut rng = Rng::new(1);
        let n = 1_000_000;
        let uniform = Moments::of((0..n).map(|_| rng.uniform()));
        let normal = Moments::of((0..n).map(|_| rng.normal()));
        // Five standard errors: a false alarm in two million, were the seed not fixed.
        assert!((uniform.mean() - 0.5).abs() < 5.0 * (1.0 / 12.0f64 / n as f64).sqrt());
        assert!((uniform.variance() - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0f64 / n as f64).sqrt());
        assert!(normal.mean().abs() < 5.0 / (n as f64).sqrt());
        assert!((normal.variance() - 1.0).abs() < 5.0 * (2.0 / n as f64).sqrt());
    }

    #[test]
    fn bounded_integers_reach_every_value_and_no_other() {
        let mut rng = Rng::new(2);
        let mut seen = [0u32; 7];
        for _ in 0..7000 {
            seen[rng.below(7) as usize] += 1;
        }
        // 1000 +- 29 each; six standard deviations.
        assert!(seen.iter().all(|&count| count.abs_diff(1000) < 176), "{seen:?}");
    }
}
