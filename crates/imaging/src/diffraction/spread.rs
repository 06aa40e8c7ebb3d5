//! How white light of the three colour matching functions is spread by an aperture: the far field, summed
//! over wavelengths.
//!
//! S_c(ρ) = Σ_λ c̄(λ) P(ρ / λ) / λ² / Σ_λ c̄(λ), c one of X, Y and Z, where ρ = λ f is an offset on the
//! sensor, in cycles across the aperture times nm. What a mean over wavelengths does to P it does along
//! the ray from the middle, so the sectors of the far field stay as they are.

use indigo_camera::FarField;
use indigo_camera::diffraction::far_field::{SECTORS, direction, sector_of};
use indigo_spectrum::observer::cmf;
use rayon::prelude::*;

/// Wavelengths of the sum: 10 nm apart, which moves the pattern by 1 to 3 % of its size.
const WAVELENGTHS: usize = 47;
/// The visible range in nm.
const RANGE_NM: [f64; 2] = [360.0, 830.0];
/// Rings of the same width in the middle, each a sixteenth of a cycle of the shortest wavelength.
const CORE_RINGS: usize = 384;
const CORE_WIDTH: f64 = RANGE_NM[0] / 16.0;
/// Beyond, each ring is wider than the one before by this part of its radius.
const GROWTH: f64 = 1.0 / 96.0;

/// The spread of X, Y and Z over offsets in cycles times nm, up to some distance.
pub(super) struct Spread {
    /// Where rings begin; the last number is where the last one ends.
    pub radii: Vec<f64>,
    /// Density in each ring's sectors, ring after ring.
    pub density: Vec<[f32; 3]>,
    /// Angle of each sector in radians.
    widths: Vec<f64>,
}

impl Spread {
    /// Of a far field, up to a distance.
    pub fn new(field: &FarField, farthest: f64) -> Self {
        let mut radii: Vec<f64> = (0..=CORE_RINGS).map(|i| i as f64 * CORE_WIDTH).collect();
        while radii.last().is_some_and(|&r| r < farthest) {
            radii.extend(radii.last().map(|r| r * (1.0 + GROWTH)));
        }
        let wavelengths = wavelengths();
        let mut density = vec![[0.0; 3]; (radii.len() - 1) * SECTORS];
        density.par_chunks_mut(SECTORS).zip(radii.par_windows(2)).for_each_init(
            || vec![0.0f32; 3 * SECTORS],
            |sums, (ring, edges)| {
                // Component after component, as vector instructions want it.
                sums.fill(0.0);
                let middle = 0.5 * (edges[0] + edges[1]);
                for &(lambda, weights) in &wavelengths {
                    let (row, factor) = field.at_radius(middle / lambda);
                    for (sums, weight) in sums.chunks_exact_mut(SECTORS).zip(weights) {
                        let weight = (weight * factor / (lambda * lambda)) as f32;
                        sums.iter_mut().zip(row).for_each(|(s, &p)| *s += weight * p);
                    }
                }
                for (j, out) in ring.iter_mut().enumerate() {
                    *out = [sums[j], sums[SECTORS + j], sums[2 * SECTORS + j]];
                }
            },
        );
        let mut spread = Self { radii, density, widths: field.sector_widths().to_vec() };
        spread.normalise(field, &wavelengths);
        spread
    }

    /// Brings the sum over rings and what lies beyond to 1, which the middles of rings alone meet within
    /// about a thousandth.
    fn normalise(&mut self, field: &FarField, wavelengths: &[(f64, [f64; 3])]) {
        let last = self.radii.last().copied().unwrap_or(0.0);
        let mut sum = [0.0; 3];
        for (lambda, weights) in wavelengths {
            let beyond = field.beyond(last / lambda);
            sum.iter_mut().zip(weights).for_each(|(s, w)| *s += w * beyond);
        }
        for (ring, edges) in self.density.chunks_exact(SECTORS).zip(self.radii.windows(2)) {
            let squares = edges[1] * edges[1] - edges[0] * edges[0];
            for (d, width) in ring.iter().zip(field.sector_widths()) {
                let area = squares * width;
                sum.iter_mut().zip(d).for_each(|(s, &d)| *s += area * f64::from(d));
            }
        }
        let scale = sum.map(|s| (1.0 / s) as f32);
        self.density.par_iter_mut().for_each(|d| *d = [d[0] * scale[0], d[1] * scale[1], d[2] * scale[2]]);
    }

    /// Density at an offset, averaged over directions by a triangle whose half width is the angle `half_width`,
    /// and linear between the middles of rings.
    pub fn at(&self, [x, y]: [f64; 2], half_width: f64) -> [f64; 3] {
        // The opposite offset has the same density.
        let (x, y) = if x < 0.0 { (-x, -y) } else { (x, y) };
        let radius = (x * x + y * y).sqrt();
        let middle = |i: usize| 0.5 * (self.radii[i] + self.radii[i + 1]);
        let rings = self.radii.len() - 1;
        let here = self.ring_at(radius);
        let first = if radius < middle(here) { here.saturating_sub(1) } else { here.min(rings - 2) };
        let t = (radius - middle(first)) / (middle(first + 1) - middle(first));
        let place = sector_of(x, y);
        // Sectors per radian there.
        let [u, v] = [x / radius, y.abs() / radius];
        let half = half_width * 0.5 * SECTORS as f64 / ((u + v) * (u + v));
        let (a, b) = (self.arc(first, place, half), self.arc(first + 1, place, half));
        std::array::from_fn(|c| a[c] + t * (b[c] - a[c]))
    }

    /// The ring that a distance falls into; the last one for all beyond.
    fn ring_at(&self, radius: f64) -> usize {
        let core = CORE_RINGS as f64 * CORE_WIDTH;
        let place = if radius < core {
            radius / CORE_WIDTH
        } else {
            CORE_RINGS as f64 + (radius / core).ln() / GROWTH.ln_1p()
        };
        (place as usize).min(self.radii.len() - 2)
    }

    /// The mean over sectors round a place of a ring.
    fn arc(&self, ring: usize, place: f64, half: f64) -> [f64; 3] {
        let row = &self.density[ring * SECTORS..(ring + 1) * SECTORS];
        let (first, last) = ((place - half - 0.5).ceil() as i64, (place + half - 0.5).floor() as i64);
        if last < first {
            return row[(place as usize).min(SECTORS - 1)].map(f64::from);
        }
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for j in first..=last {
            let weight = 1.0 - (j as f64 + 0.5 - place).abs() / half;
            // Beyond straight up comes straight down, on the other side.
            let d = row[j.rem_euclid(SECTORS as i64) as usize];
            sum.iter_mut().zip(d).for_each(|(s, d)| *s += weight * f64::from(d));
            weights += weight;
        }
        if weights > 0.0 {
            sum.map(|s| s / weights)
        } else {
            row[first.rem_euclid(SECTORS as i64) as usize].map(f64::from)
        }
    }

    /// Calls `put` for points spread over the rings that begin nearer than a distance, with each point's
    /// offset and its share of X, Y and Z. Points lie no farther apart than `spacing`.
    pub fn for_each_point(&self, farthest: f64, spacing: f64, mut put: impl FnMut([f64; 2], [f64; 3])) {
        for (ring, edges) in self.density.chunks_exact(SECTORS).zip(self.radii.windows(2)) {
            let (lo, hi) = (edges[0], edges[1]);
            if lo >= farthest {
                break;
            }
            let radial = ((hi - lo) / spacing).ceil().max(1.0) as usize;
            for (j, (d, &width)) in ring.iter().zip(&self.widths).enumerate() {
                let around = (hi * width / spacing).ceil().max(1.0) as usize;
                // Half of the ring's power, as each point stands for the opposite one, too.
                let area = 0.5 * (hi * hi - lo * lo) * width / (radial * around) as f64;
                let share = d.map(|d| area * f64::from(d));
                for k in 0..radial * around {
                    let [x, y] = direction(j as f64 + ((k % around) as f64 + 0.5) / around as f64);
                    // By area: the squares of the radii are even.
                    let t = ((k / around) as f64 + 0.5) / radial as f64;
                    let r = (lo * lo + t * (hi * hi - lo * lo)).sqrt();
                    put([r * x, r * y], share);
                }
            }
        }
    }
}

/// Wavelengths in nm, with their weights for X, Y and Z, which sum to 1.
fn wavelengths() -> Vec<(f64, [f64; 3])> {
    let step = (RANGE_NM[1] - RANGE_NM[0]) / WAVELENGTHS as f64;
    let at = |k: usize| RANGE_NM[0] + step * (k as f64 + 0.5);
    let mut sum = [0.0; 3];
    for k in 0..WAVELENGTHS {
        sum.iter_mut().zip(cmf(at(k))).for_each(|(s, c)| *s += c);
    }
    let weights = |k| {
        let c = cmf(at(k));
        std::array::from_fn(|i| c[i] / sum[i])
    };
    (0..WAVELENGTHS).map(|k| (at(k), weights(k))).collect()
}
