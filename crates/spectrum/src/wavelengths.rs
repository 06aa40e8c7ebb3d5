//! The wavelengths of one path: a hero drawn by importance of the observer and of the light in a scene, and
//! companions that lie equal quantiles apart (Wilkie, Nawaz, Droske, Weidlich, Hanika 2014, "Hero Wavelength
//! Spectral Sampling", with a density other than the uniform one).

use indigo_math::Real;

use crate::adaptation::XYZ_TO_RGB;
use crate::grid::{COUNT, FIRST_NM, LAST_NM};
use crate::lanes::{LANES, SampledSpectrum};
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

/// Draws the wavelengths of paths.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthSampler {
    /// The ends of the segments, nm: the inverse of the cumulative density at `k / SEGMENTS`.
    knots: [Real; SEGMENTS + 1],
}

/// By the observer alone.
static VISIBLE: WavelengthSampler = WavelengthSampler { knots: knots(&IMPORTANCE) };

/// What [`importance`] says of each nanometre.
static IMPORTANCE: [f64; COUNT - 1] = {
    let mut cells = [0.0; COUNT - 1];
    let mut i = 0;
    while i < COUNT - 1 {
        cells[i] = importance(i);
        i += 1;
    }
    cells
};

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

/// Segments of a density that is given, up to a factor, in cells of equal width over the visible range. A part of
/// it is spread evenly.
const fn knots(cells: &[f64]) -> [Real; SEGMENTS + 1] {
    let n = cells.len();
    let mut sum = 0.0;
    let mut i = 0;
    while i < n {
        sum += cells[i];
        i += 1;
    }
    let even = sum * UNIFORM_PART / ((1.0 - UNIFORM_PART) * n as f64);
    let total = sum / (1.0 - UNIFORM_PART);
    let width = (LAST_NM - FIRST_NM) / n as f64;

    let mut knots = [LAST_NM as Real; SEGMENTS + 1];
    let mut cell = 0;
    let mut below = 0.0;
    let mut k = 0;
    while k < SEGMENTS {
        let target = total * k as f64 / SEGMENTS as f64;
        while cell < n - 1 && below + cells[cell] + even <= target {
            below += cells[cell] + even;
            cell += 1;
        }
        let within = (target - below) / (cells[cell] + even);
        knots[k] = (FIRST_NM + width * (cell as f64 + within)) as Real;
        k += 1;
    }
    knots
}

impl WavelengthSampler {
    /// By the observer alone.
    pub fn visible() -> &'static Self {
        &VISIBLE
    }

    /// By the observer and the light: the more, the less alike the two densities are, so that smooth light, for
    /// which the first is made, changes little.
    ///
    /// Standard deviation of one sample's RGB colour over the colour's largest component, four lanes, by
    /// quadrature; three bands of 20, 10 and 10 nm are like those of a fluorescent tube:
    ///
    /// | light and surface | observer alone | with the light |
    /// |---|---|---|
    /// | D65, white | 0.294 | 0.296 |
    /// | 2856 K, white; blue | 0.230; 0.350 | 0.201; 0.348 |
    /// | white LED, white; blue | 0.580; 0.996 | 0.520; 0.923 |
    /// | three bands, white; green | 2.485; 2.221 | 1.179; 1.139 |
    /// | 580 nm, 20 nm wide, white; green | 1.487; 1.909 | 0.363; 0.477 |
    pub fn of_light(light: &LightSpectrum) -> Self {
        let observer = LightSpectrum::of(1.0, |_| SampledSpectrum([1.0; LANES]));
        let alike: f64 = observer.cells.iter().zip(&light.cells).map(|(a, b)| a.min(*b)).sum();
        let part = LIGHT_PART * (light.shares - alike).max(0.0);
        let cells: Vec<f64> = observer
            .cells
            .iter()
            .zip(&light.cells)
            .map(|(plain, lit)| (1.0 - part * light.shares) * plain + part * lit)
            .collect();
        Self { knots: knots(&cells) }
    }

    /// The wavelengths that belong to a uniform random number `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: Real) -> SampledWavelengths {
        let mut sampled = SampledWavelengths { lambda: [0.0; LANES], pdf: [0.0; LANES] };
        for lane in 0..LANES {
            let shifted = u + lane as Real / LANES as Real;
            let x = (if shifted >= 1.0 { shifted - 1.0 } else { shifted }) * SEGMENTS as Real;
            let segment = (x as usize).min(SEGMENTS - 1);
            let width = self.knots[segment + 1] - self.knots[segment];
            sampled.lambda[lane] = self.knots[segment] + (x - segment as Real) * width;
            sampled.pdf[lane] = 1.0 / (SEGMENTS as Real * width);
        }
        sampled
    }

    /// Density, 1/nm, with which [`Self::sample`] draws a wavelength given in nm; 0 outside 360 to 830 nm.
    pub fn density(&self, lambda: Real) -> Real {
        let knots = &self.knots;
        if !(knots[0]..=knots[SEGMENTS]).contains(&lambda) {
            return 0.0;
        }
        let segment = knots.partition_point(|&knot| knot <= lambda).clamp(1, SEGMENTS) - 1;
        1.0 / (SEGMENTS as Real * (knots[segment + 1] - knots[segment]))
    }
}

impl SampledWavelengths {
    /// The wavelengths that [`WavelengthSampler::visible`] draws with a number in [0, 1).
    #[inline]
    pub fn sample(u: Real) -> Self {
        VISIBLE.sample(u)
    }
}

/// The part of the samples that goes by the scene's light as well as by the observer, where the two have nothing in
/// common. The rest is for light that is little of the whole, but all that there is at some place. Daylight beside
/// the last two lights of the table above has a deviation of 0.97, for 0.29 alone; with 0.2 in place of 0.4 it is
/// 0.43 and 0.66, and the lights' own 0.41 and 1.65; with 0.75 it is 1.6 and 1.4, and 0.21 and 0.63.
const LIGHT_PART: f64 = 0.4;

/// Cells of a light's spectrum per nanometre.
const FINE: usize = 8;

/// What the light of a scene is made of, as the observer sees it.
#[derive(Clone, Debug)]
pub struct LightSpectrum {
    /// What the observer gets of each cell; sums to `shares`.
    cells: Vec<f64>,
    shares: f64,
}

impl Default for LightSpectrum {
    fn default() -> Self {
        Self { cells: vec![0.0; (COUNT - 1) * FINE], shares: 0.0 }
    }
}

impl LightSpectrum {
    /// One light alone.
    fn of(share: f64, radiance: impl Fn(&SampledWavelengths) -> SampledSpectrum) -> Self {
        let mut spectrum = Self::default();
        spectrum.add(share, radiance);
        spectrum
    }

    /// Adds a light with its share of all light; all shares are to sum to 1 at most. Light that nobody can see is left out.
    ///
    /// For a white surface a density in proportion to light times observer leaves no noise of colour, and it bounds
    /// that of any other, as a surface reflects no more than all.
    pub fn add(&mut self, share: f64, radiance: impl Fn(&SampledWavelengths) -> SampledSpectrum) {
        let mut seen = Vec::with_capacity(self.cells.len());
        for first in (0..self.cells.len()).step_by(LANES) {
            let middle = |lane: usize| FIRST_NM + ((first + lane) as f64 + 0.5) / FINE as f64;
            let lambda = std::array::from_fn(|lane| middle(lane) as Real);
            let values = radiance(&SampledWavelengths { lambda, pdf: [1.0; LANES] });
            for (lane, k) in (first..self.cells.len()).enumerate().take(LANES) {
                seen.push(f64::from(values[lane] as f32).max(0.0) * IMPORTANCE[k / FINE]);
            }
        }
        let sum: f64 = seen.iter().sum();
        if sum > 0.0 && sum.is_finite() {
            self.shares += share;
            // Each value counts in the cells beside it as well, as an edge may lie in any of them.
            let at = |k: usize| seen.get(k).copied().unwrap_or(0.0);
            for (k, cell) in self.cells.iter_mut().enumerate() {
                *cell += share * (at(k.wrapping_sub(1)) + at(k) + at(k + 1)) / (3.0 * sum);
            }
        }
    }
}
