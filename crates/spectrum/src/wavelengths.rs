//! The wavelengths of one path: a hero drawn by importance of the observer and companions that lie
//! equal quantiles apart (Wilkie, Nawaz, Droske, Weidlich, Hanika 2014, "Hero Wavelength Spectral
//! Sampling", with a density other than the uniform one).

use indigo_math::Real;

use crate::grid::{COUNT, FIRST_NM, LAST_NM};
use crate::lanes::LANES;
use crate::observer::CMF;

/// The wavelengths of one path and the density with which each was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledWavelengths {
    /// Wavelengths in nm; lane 0 is the hero.
    pub lambda: [Real; LANES],
    /// Density of each wavelength, 1/nm.
    pub pdf: [Real; LANES],
}

/// Equally probable segments of the visible range. The density is constant within a segment, so
/// that sampling it is one look-up and exact.
const SEGMENTS: usize = 1024;

/// Part of the samples that is spread evenly over the visible range, so that no wavelength has a
/// density near zero.
const UNIFORM_PART: f64 = 0.05;

/// The ends of the segments, nm: the inverse of the cumulative density at `k / SEGMENTS`.
static KNOTS: [Real; SEGMENTS + 1] = knots();

/// The density before it is cut into segments, up to a factor, between grid points `i` and `i + 1`.
const fn importance(i: usize) -> f64 {
    let (a, b) = (CMF[i], CMF[i + 1]);
    (a[0] + a[1] + a[2] + b[0] + b[1] + b[2]) / 2.0
}

const fn knots() -> [Real; SEGMENTS + 1] {
    let mut total = 0.0;
    let mut i = 0;
    while i < COUNT - 1 {
        total += importance(i);
        i += 1;
    }
    let even = total * UNIFORM_PART / ((1.0 - UNIFORM_PART) * (COUNT - 1) as f64);
    let total = total / (1.0 - UNIFORM_PART);

    let mut knots = [LAST_NM as Real; SEGMENTS + 1];
    let mut cell = 0;
    let mut below = 0.0;
    let mut k = 0;
    while k < SEGMENTS {
        let target = total * k as f64 / SEGMENTS as f64;
        while cell < COUNT - 2 && below + importance(cell) + even <= target {
            below += importance(cell) + even;
            cell += 1;
        }
        let within = (target - below) / (importance(cell) + even);
        knots[k] = (FIRST_NM + cell as f64 + within) as Real;
        k += 1;
    }
    knots
}

impl SampledWavelengths {
    /// The wavelengths that belong to a uniform random number `u` in [0, 1).
    #[inline]
    pub fn sample(u: Real) -> Self {
        let mut sampled = Self { lambda: [0.0; LANES], pdf: [0.0; LANES] };
        for lane in 0..LANES {
            let shifted = u + lane as Real / LANES as Real;
            let x = (if shifted >= 1.0 { shifted - 1.0 } else { shifted }) * SEGMENTS as Real;
            let segment = (x as usize).min(SEGMENTS - 1);
            let width = KNOTS[segment + 1] - KNOTS[segment];
            sampled.lambda[lane] = KNOTS[segment] + (x - segment as Real) * width;
            sampled.pdf[lane] = 1.0 / (SEGMENTS as Real * width);
        }
        sampled
    }

    /// Density, 1/nm, with which [`Self::sample`] draws a wavelength given in nm; 0 outside 360 to 830 nm.
    pub fn density(lambda: Real) -> Real {
        if !(KNOTS[0]..=KNOTS[SEGMENTS]).contains(&lambda) {
            return 0.0;
        }
        let segment = KNOTS.partition_point(|&knot| knot <= lambda).clamp(1, SEGMENTS) - 1;
        1.0 / (SEGMENTS as Real * (KNOTS[segment + 1] - KNOTS[segment]))
    }
}
