//! Deterministic numbers without state: everything is a function of a key.

use super::vector::{Vector, scale};

/// Uniform in [0, 1) from two integers (the finaliser of SplitMix64, Steele, Lea and Flood 2014).
pub fn uniform(stream: u64, index: u64) -> f64 {
    let mut z =
        index.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(stream.wrapping_mul(0xd1b5_4a32_d192_ed03));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Value noise in [-1, 1]: random values at the points of a lattice, blended by a smooth cubic.
pub fn value_noise(p: Vector) -> f64 {
    let cell = p.map(f64::floor);
    let t = [0, 1, 2].map(|i| smooth(p[i] - cell[i]));
    let corner = |i: usize| {
        let key = (0..3).fold(0u64, |key, axis| {
            let coordinate = cell[axis] as i64 + ((i >> axis) & 1) as i64;
            key.wrapping_mul(0x1_0000_01b3).wrapping_add((coordinate + 1_000_000) as u64)
        });
        let weight: f64 =
            (0..3).map(|axis| if (i >> axis) & 1 == 1 { t[axis] } else { 1.0 - t[axis] }).product();
        weight * (2.0 * uniform(1, key) - 1.0)
    };
    (0..8).map(corner).sum()
}

fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Octaves of value noise, each of twice the frequency and half the height of the one before.
pub fn fractal(p: Vector, octaves: u32) -> f64 {
    (0..octaves)
        .map(|octave| {
            let frequency = f64::from(1u32 << octave);
            // Shifted, so that the lattices of the octaves do not meet in the origin.
            value_noise(scale(frequency, p).map(|x| x + 17.3 * f64::from(octave))) / frequency
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_and_continuous() {
        let mut extremes = (0.0f64, 0.0f64);
        for i in 0..2000 {
            let p = [uniform(2, i) * 20.0 - 10.0, uniform(3, i) * 20.0 - 10.0, uniform(4, i) * 20.0 - 10.0];
            let here = value_noise(p);
            let near = value_noise([p[0] + 1e-7, p[1], p[2]]);
            assert!((here - near).abs() < 1e-6, "a step at {p:?}");
            extremes = (extremes.0.min(here), extremes.1.max(here));
        }
        assert!(
            extremes.0 < -0.5 && extremes.1 > 0.5 && extremes.0 >= -1.0 && extremes.1 <= 1.0,
            "{extremes:?}"
        );
    }

    #[test]
    fn keys_give_unrelated_numbers() {
        let mean = (0..10_000).map(|i| uniform(9, i)).sum::<f64>() / 10_000.0;
        // Six standard errors of 0.0029.
        assert!((mean - 0.5).abs() < 0.018, "{mean}");
        assert!(uniform(0, 1) != uniform(1, 0));
    }
}
