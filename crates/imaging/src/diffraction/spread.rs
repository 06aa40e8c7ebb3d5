//! How white light of the three colour matching functions is spread by an aperture: the far field, summed
//! over wavelengths.
//!
//! S_c(ρ) = Σ_λ c̄(λ) P(ρ / λ) / λ² / Σ_λ c̄(λ), c one of X, Y and Z, where ρ = λ f is an offset on the
//! sensor, in cycles across the aperture times nm. What a mean over wavelengths does to P it does along
//! the ray from the middle, so the sectors of the far field stay as they are.

use indigo_camera::FarField;
use indigo_camera::diffraction::far_field::{SECTORS, direction, sector_of};
use indigo_math::pages::fresh;
use indigo_spectrum::observer::cmf;
use rayon::prelude::*;
use std::ops::Range;

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
    /// Sectors of a ring that are kept: a single one where all are alike.
    kept: usize,
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
        let kept = if field.is_round() { 1 } else { SECTORS };
        let mut density = fresh(vec![[0.0; 3]; (radii.len() - 1) * kept]);
        density.par_chunks_mut(kept).zip(radii.par_windows(2)).for_each(|(ring, edges)| {
            add_rows(&rows_at(field, &wavelengths, 0.5 * (edges[0] + edges[1])), ring);
        });
        let mut spread = Self { radii, density, kept, widths: field.sector_widths().to_vec() };
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
        // All sectors together where they are alike.
        let half_turn = [field.sector_widths().iter().sum()];
        let widths = if self.kept == 1 { &half_turn } else { field.sector_widths() };
        for (ring, edges) in self.density.chunks_exact(self.kept).zip(self.radii.windows(2)) {
            let squares = edges[1] * edges[1] - edges[0] * edges[0];
            for (d, width) in ring.iter().zip(widths) {
                let area = squares * width;
                sum.iter_mut().zip(d).for_each(|(s, &d)| *s += area * f64::from(d));
            }
        }
        let scale = sum.map(|s| (1.0 / s) as f32);
        self.density.par_iter_mut().for_each(|d| *d = [d[0] * scale[0], d[1] * scale[1], d[2] * scale[2]]);
    }

    /// Averages the rings from `first` on over directions by a triangle; `half_width` tells half of its base, an
    /// angle in radians, for an offset.
    pub fn smooth(&mut self, first: usize, half_width: impl Fn([f64; 2]) -> f64 + Sync) {
        if self.kept == 1 {
            return;
        }
        let directions: Vec<[f64; 2]> = (0..SECTORS).map(|j| direction(j as f64 + 0.5)).collect();
        let rings = self.density.par_chunks_mut(SECTORS).zip(self.radii.par_windows(2)).skip(first);
        rings.for_each_init(Vec::new, |sharp: &mut Vec<[f32; 3]>, (ring, edges)| {
            sharp.clear();
            sharp.extend_from_slice(ring);
            let middle = 0.5 * (edges[0] + edges[1]);
            for (j, (out, [x, y])) in ring.iter_mut().zip(&directions).enumerate() {
                // Sectors are even in y / (|x| + |y|): so many are there per radian.
                let per_radian = 0.5 * SECTORS as f64 / (x + y.abs()).powi(2);
                *out = mean_round(sharp, j, per_radian * half_width([middle * x, middle * y]));
            }
        });
    }

    /// Density at an offset, linear between the middles of rings and of sectors.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        // The opposite offset has the same density.
        let (x, y) = if x < 0.0 { (-x, -y) } else { (x, y) };
        let radius = (x * x + y * y).sqrt();
        let middle = |i: usize| 0.5 * (self.radii[i] + self.radii[i + 1]);
        let rings = self.radii.len() - 1;
        let here = self.ring_at(radius);
        let first = if radius < middle(here) { here.saturating_sub(1) } else { here.min(rings - 2) };
        let t = (radius - middle(first)) / (middle(first + 1) - middle(first));
        if self.kept == 1 {
            let (a, b) = (self.density[first], self.density[first + 1]);
            return std::array::from_fn(|c| f64::from(a[c]) + t * (f64::from(b[c]) - f64::from(a[c])));
        }
        // Beyond straight up comes straight down, on the other side.
        let place = sector_of(x, y) - 0.5;
        let left = place.floor();
        let s = (place - left) as f32;
        let [left, right] = [left, left + 1.0].map(|j| (j as i64).rem_euclid(SECTORS as i64) as usize);
        let row = |ring: usize| {
            let row = &self.density[ring * SECTORS..(ring + 1) * SECTORS];
            let (a, b) = (row[left], row[right]);
            std::array::from_fn::<f64, 3, _>(|c| f64::from(a[c] + s * (b[c] - a[c])))
        };
        let (a, b) = (row(first), row(first + 1));
        std::array::from_fn(|c| a[c] + t * (b[c] - a[c]))
    }

    /// The ring that a distance falls into; the last one for all beyond.
    pub fn ring_at(&self, radius: f64) -> usize {
        let core = CORE_RINGS as f64 * CORE_WIDTH;
        let place = if radius < core {
            radius / CORE_WIDTH
        } else {
            CORE_RINGS as f64 + (radius / core).ln() / GROWTH.ln_1p()
        };
        (place as usize).min(self.radii.len() - 2)
    }

    /// The sectors as they lie among pixels, of which a cycle times nm has so many along each axis. What is more than
    /// `reach` pixels from the middle along an axis is of no interest.
    pub fn sectors(&self, [cx, cy]: [f64; 2], reach: f64) -> Vec<Sector> {
        let sector = |(j, &width): (usize, &f64)| {
            let [x, y] = direction(j as f64 + 0.5);
            let ends = [direction(j as f64), direction(j as f64 + 1.0)];
            // No direction of the sector goes farther than along both axes its slower end does.
            let least = |axis: usize| ends[0][axis].abs().min(ends[1][axis].abs());
            Sector {
                width,
                reach: (reach / (cx * least(0))).min(reach / (cy * least(1))),
                along: ((x * cx).powi(2) + (y * cy).powi(2)).sqrt(),
                across: ((y * cx).powi(2) + (x * cy).powi(2)).sqrt(),
            }
        };
        self.widths.iter().enumerate().map(sector).collect()
    }

    /// Calls `put` for points spread over some rings as far as their sectors reach, with each point's offset and its
    /// share of X, Y and Z. Points lie no farther apart than `spacing` pixels, on one half of the circle; each stands for
    /// the opposite one, too.
    pub fn for_each_point(
        &self,
        rings: Range<usize>,
        sectors: &[Sector],
        spacing: f64,
        mut put: impl FnMut([f64; 2], [f64; 3]),
    ) {
        let points = |pixels: f64| (pixels / spacing).ceil().max(1.0) as usize;
        for i in rings {
            let lo = self.radii[i];
            let ring = &self.density[i * self.kept..(i + 1) * self.kept];
            for (j, (d, sector)) in ring.iter().cycle().zip(sectors).enumerate() {
                let hi = self.radii[i + 1].min(sector.reach);
                if hi <= lo {
                    continue;
                }
                let radial = points((hi - lo) * sector.along);
                let around = points(hi * sector.width * sector.across);
                let area = (hi * hi - lo * lo) * sector.width / (radial * around) as f64;
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

/// A sector among pixels.
pub(super) struct Sector {
    /// Its angle in radians.
    width: f64,
    /// The distance beyond which none of it is of interest.
    reach: f64,
    /// Pixels of one unit along its ray and across it.
    along: f64,
    across: f64,
}

/// The sectors of the far field at a distance for each wavelength, with what they count in X, Y and Z.
fn rows_at<'a>(
    field: &'a FarField,
    wavelengths: &[(f64, [f64; 3])],
    distance: f64,
) -> Vec<(&'a [f32], [f64; 3])> {
    let mut rows: Vec<(&[f32], [f64; 3])> = Vec::with_capacity(wavelengths.len());
    for (lambda, weights) in wavelengths {
        let (row, factor) = field.at_radius(distance / lambda);
        let weights = weights.map(|w| w * factor / (lambda * lambda));
        match rows.last_mut() {
            // Far out all wavelengths share one law.
            Some((last, sum)) if std::ptr::eq(*last, row) => {
                sum.iter_mut().zip(weights).for_each(|(s, w)| *s += w);
            }
            _ => rows.push((row, weights)),
        }
    }
    rows
}

/// Sums rows by their weights. So few sectors at a time that their sums stay in the processor's first cache,
/// component after component, as vector instructions want it.
fn add_rows(rows: &[(&[f32], [f64; 3])], ring: &mut [[f32; 3]]) {
    const TOGETHER: usize = 256;
    for (block, out) in ring.chunks_mut(TOGETHER).enumerate() {
        let mut sums = [[0.0f32; TOGETHER]; 3];
        for (row, weights) in rows {
            let row = &row[block * TOGETHER..][..out.len()];
            for (sums, &weight) in sums.iter_mut().zip(weights) {
                let weight = weight as f32;
                sums.iter_mut().zip(row).for_each(|(s, &p)| *s += weight * p);
            }
        }
        for (j, out) in out.iter_mut().enumerate() {
            *out = [sums[0][j], sums[1][j], sums[2][j]];
        }
    }
}

/// The mean of a ring round sector `j` by a triangle that is `half` sectors wide on each side.
fn mean_round(ring: &[[f32; 3]], j: usize, half: f64) -> [f32; 3] {
    let reach = half.ceil() as i64 - 1;
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    for k in -reach..=reach {
        let weight = 1.0 - k.abs() as f64 / half;
        // Beyond straight up comes straight down, on the other side.
        let d = ring[(j as i64 + k).rem_euclid(SECTORS as i64) as usize];
        sum.iter_mut().zip(d).for_each(|(s, d)| *s += weight * f64::from(d));
        weights += weight;
    }
    sum.map(|s| (s / weights) as f32)
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
