//! Random numbers for this crate's tests.

use indigo_math::Real;

/// Uniform numbers in [0, 1): SplitMix64 (Steele, Lea, Flood 2014), the top 24 bits.
pub struct Uniform(u64);

impl Uniform {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> Real {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as Real / (1_u64 << 24) as Real
    }

    pub fn triple(&mut self) -> [Real; 3] {
        std::array::from_fn(|_| self.next())
    }
}
