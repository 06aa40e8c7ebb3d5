//! Primary samples: the numbers in [0, 1) that decide everything about a path.
//!
//! Every decision has a dimension of its own that depends on where in the path it is taken, and on
//! nothing else: a point set keeps its stratification, and a mutation its meaning, whatever the
//! length of the path.

use indigo_math::{Real, rng, sobol};

/// Names four numbers of a primary sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block(u32);

impl Block {
    /// Film x and y, wavelength, and time.
    pub const FILM: Self = Self(0);
    /// Lens x and y, and the direction in which light leaves a lamp.
    pub const LENS: Self = Self(1);
    /// Choice of light, a point on it or a direction towards it, and the choice's further digits, where light
    /// paths begin.
    pub const EMISSION: Self = Self(2);

    /// Diffraction at the camera's aperture; two are free.
    pub const DIFFRACTION: Self = Self(3);

    /// Blocks of each vertex.
    const STRIDE: u32 = 4;

    const fn of(vertex: u32, which: u32) -> Self {
        Self(4 + Self::STRIDE * vertex + which)
    }

    /// Choice of light, two numbers for the point or direction on it, and both roulette and the further digits
    /// of the choice, at a vertex of the camera's path. The two may share a number, since they decide about
    /// different terms of a sum: light that is drawn here, and what the path finds beyond.
    pub const fn light(vertex: u32) -> Self {
        Self::of(vertex, 0)
    }

    /// Three numbers for the scattered direction at a vertex of the camera's path, and the choice among
    /// blended materials.
    pub const fn scatter(vertex: u32) -> Self {
        Self::of(vertex, 1)
    }

    /// The same at a vertex of the light's path.
    pub const fn light_scatter(vertex: u32) -> Self {
        Self::of(vertex, 2)
    }

    /// Roulette at a vertex of the light's path, a choice of connections at one of the camera's path, and the
    /// distances at which the camera's path and the light's are scattered on the way to their vertices.
    pub const fn connect(vertex: u32) -> Self {
        Self::of(vertex, 3)
    }

    /// Its place in a list of all blocks.
    pub(crate) const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A source of primary samples.
pub trait PrimarySample {
    /// The four numbers in [0, 1) of a block; asked twice it gives the same ones.
    fn block(&mut self, block: Block) -> [Real; 4];
}

/// A point of an Owen-scrambled Sobol' sequence.
#[derive(Clone, Copy, Debug)]
pub struct SobolSample {
    key: u64,
    index: u32,
}

impl SobolSample {
    /// Point `index` of the sequence that a seed and a stream (a pixel, say) name.
    pub fn new(seed: u64, stream: u64, index: u32) -> Self {
        Self { key: rng::key(&[seed, stream]), index }
    }
}

impl PrimarySample for SobolSample {
    #[inline]
    fn block(&mut self, block: Block) -> [Real; 4] {
        sobol::block4(
            rng::mix64(self.key ^ u64::from(block.0).wrapping_mul(0x9E37_79B9_7F4A_7C15)),
            self.index,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_do_not_collide_and_can_be_replayed() {
        let mut names = vec![Block::FILM, Block::LENS, Block::EMISSION, Block::DIFFRACTION];
        for vertex in 0..100 {
            names.extend([
                Block::light(vertex),
                Block::scatter(vertex),
                Block::light_scatter(vertex),
                Block::connect(vertex),
            ]);
        }
        let mut indices: Vec<u32> = names.iter().map(|b| b.0).collect();
        indices.sort_unstable();
        indices.dedup();
        assert_eq!(indices.len(), names.len());
        let mut a = SobolSample::new(1, 2, 3);
        let mut b = SobolSample::new(1, 2, 3);
        let first = a.block(Block::light(7));
        a.block(Block::FILM);
        assert_eq!(first, b.block(Block::light(7)));
        assert_ne!(first, SobolSample::new(2, 2, 3).block(Block::light(7)));
    }
}
