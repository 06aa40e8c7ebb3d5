//! The wavelengths of one path: a hero drawn by importance of the observer and companions that lie
//! equal quantiles apart (Wilkie, Nawaz, Droske, Weidlich, Hanika 2014, "Hero Wavelength Spectral
//! Sampling", with a density other than the uniform one).

use indigo_math::Real;

use crate::adaptation::XYZ_TO_RGB;
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
const UNIFORM_PART: f64 = 0.1;

/// The ends of the segments, nm: the inverse of the cumulative density at `k / SEGMENTS`.
static KNOTS: [Real; SEGMENTS + 1] = knots();

/// The density before it is cut into segments, up to a factor, between grid points `i` and `i + 1`:
/// the length of the linear RGB vector that the wavelength's light has. That is the density of
/// least summed variance of the three channels for one lane and a flat spectrum.
///
/// Standard deviation of one sample's RGB colour over the colour's largest component, geometric
/// mean over nine spectra (illuminants E, D65, A, F11; red, green, blue paint under D65; bands of
/// 20 nm at 450 and 650 nm), and that of its luminance, by quadrature:
///
/// | density | 4 lanes: colour | luminance | 1 lane: colour | 8 lanes: colour |
/// |---|---|---|---|---|
/// | uniform | 1.180 | 0.344 | | |
/// | y, 5 % uniform | 1.844 | 0.317 | | |
/// | sech² fitted to y (Radziszewski et al. 2009) | 0.616 | 0.149 | 3.02 | 0.107 |
/// | x + y + z, 5 % uniform | 0.594 | 0.345 | 2.64 | 0.238 |
/// | RGB length, 5 % uniform | 0.431 | 0.203 | 2.48 | 0.214 |
/// | **RGB length, 10 % uniform** | **0.416** | 0.204 | 2.51 | 0.191 |
const fn importance(i: usize) -> f64 {
    let (mut squares, mut c) = (0.0, 0);
    while c < 3 {
        let row = 3 * c;
        let (a, b) = (CMF[i], CMF[i + 1]);
        let component = XYZ_TO_RGB[row] * (a[0] + b[0])
            + XYZ_TO_RGB[row + 1] * (a[1] + b[1])
            + XYZ_TO_RGB[row + 2] * (a[2] + b[2]);
        squares += component * component;
        c += 1;
    }
    square_root(squares)
}

/// Square root by Newton's method, for tables made by the compiler.
const fn square_root(v: f64) -> f64 {
    let mut root = if v > 1.0 { v } else { 1.0 };
    let mut step = 0;
    while step < 60 {
        root = 0.5 * (root + v / root);
        step += 1;
    }
    root
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
