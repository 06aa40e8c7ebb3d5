//! Counter-based random numbers: every number is a function of a key and a counter, so that any
//! sample can be replayed alone and any thread can make any part of a sequence.

use crate::Real;

/// Mixes 64 bits thoroughly (the finaliser of SplitMix64: Steele, Lea & Flood 2014, variant 13 of Stafford).
#[inline]
pub const fn mix64(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// A key made of several words, in order.
#[inline]
pub const fn key(words: &[u64]) -> u64 {
    let mut h = 0x9E37_79B9_7F4A_7C15;
    let mut i = 0;
    while i < words.len() {
        h = mix64(h ^ words[i]).wrapping_add(0x9E37_79B9_7F4A_7C15);
        i += 1;
    }
    mix64(h)
}

/// A number in [0, 1) from the upper bits of a word.
#[inline(always)]
pub fn to_unit(bits: u32) -> Real {
    #[cfg(not(feature = "f64"))]
    {
        (bits >> 8) as Real * (1.0 / (1u32 << 24) as Real)
    }
    #[cfg(feature = "f64")]
    {
        f64::from(bits) * (1.0 / 4_294_967_296.0)
    }
}

/// A stream of random numbers named by a key.
#[derive(Clone, Debug)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// The stream of a key (see [`key`]).
    pub const fn new(key: u64) -> Self {
        Self { state: key }
    }

    /// 64 random bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mix64(self.state)
    }

    /// A number in [0, 1).
    #[inline]
    pub fn next_real(&mut self) -> Real {
        to_unit((self.next_u64() >> 32) as u32)
    }

    /// A number in [0, 1) with 53 random bits.
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A whole number below `n`; 0 for `n` = 0. The bias is below n / 2⁶⁴.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next_u64()) * n as u128) >> 64) as usize
    }
}
