//! The far field of an opening: where light of one wavelength goes that passes it.
//!
//! The sensor lies in the plane where the lens brings the light together, so that the diffraction seen
//! there is Fraunhofer's: a point's light of wavelength λ is spread over offsets x on the sensor by
//!
//! PSF_λ(x) = (2a / (λ s))² P(x · 2a / (λ s)),   P(f) = |Â(f)|² / ∫ |Â|²,
//!
//! with the Fourier transform Â of the amplitude A behind the opening drawn on the unit square, the
//! square's side 2a and the distance s from lens to sensor (Goodman, "Introduction to Fourier Optics",
//! sections 4.4 and 6.2). f counts cycles across the square. One P serves all wavelengths.
//!
//! P is kept in polar coordinates, as constant numbers in rings and sectors: fine rings where the core
//! and its dark rings are, wider ones where only the spectrum's breadth can be seen. P(-f) = P(f), since
//! A is real, so half a circle of sectors suffices.
//!
//! Beyond the last ring each direction goes on by the law of an edge. A piece of an edge of length dl
//! sends its light at right angles to itself, dl / (4π² r²) of power per unit of r to either side: from a
//! drawing's autocorrelation at small shifts τ, which is less than at 0 by half of ∮ |τ · n| dl, whose
//! transform this is (Porod's law of small-angle scattering, in two dimensions). In polar coordinates
//! that is a density that falls as r⁻³ in every direction; a circle's total beyond r is 2 / (π² r), as of the
//! Airy disc.

// tidy: load-time mathematics

use super::fourier::PowerSpectrum;
use crate::Mask;
use indigo_math::pages::fresh;
use rayon::prelude::*;

/// Cells along a side of the drawing.
pub(crate) const SIDE: usize = 2048;
/// Cells along a side of the drawing for the core, which needs fewer but finer frequencies.
const CORE_SIDE: usize = 256;
/// Where the core ends, in cycles: a tenth of the core's cells, where folding is far below 1 %.
const CORE: usize = 24;
/// Steps per cycle in the core: a linear rise between them blurs by 1/60 of the first dark ring's radius.
const CORE_STEPS: usize = 16;
/// Where the drawing's spectrum ends that is used: at half its cells' own frequency, below which
/// folding adds less than 1 %.
const LAST: usize = SIDE / 4;
/// Steps per cycle beyond the core: as many as the spectrum of something of width 1 needs.
const STEPS: usize = 2;
/// Rings per cycle in the core.
const CORE_RINGS: usize = 16;
/// Rings from the core's end to the last: each is 0.8 % wider than the one before, less than
/// the wavelengths of a colour spread it.
const OUTER_RINGS: usize = 392;
/// Sectors of half a circle: a third to two thirds of a cycle wide in the last ring.
pub const SECTORS: usize = 4096;

/// The far field of an opening, in cycles across its square.
#[derive(Clone, Debug)]
pub struct FarField {
    /// Where rings begin; the last number is where the last one ends.
    radii: Vec<f64>,
    /// P in each ring's sectors, ring after ring, and at last r³ P beyond them.
    density: Vec<f32>,
    /// Angle of each sector in radians.
    widths: Vec<f64>,
    /// The part of the light that goes farther than each radius.
    beyond: Vec<f64>,
    /// Whether all sectors of a ring are alike.
    is_round: bool,
}

impl FarField {
    /// The far field of an amplitude drawn on `SIDE` × `SIDE` cells. `None` where all of it is dark.
    pub(super) fn new(amplitude: &Mask) -> Option<Self> {
        let core = PowerSpectrum::new(&shrunk(amplitude, CORE_SIDE), CORE_STEPS, CORE);
        let outer = PowerSpectrum::new(amplitude, STEPS, LAST);
        let radii = radii();
        let rings = radii.len() - 1;
        let directions: Vec<[f64; 2]> = (0..SECTORS).map(|j| direction(j as f64 + 0.5)).collect();
        let mut density = fresh(vec![0.0; (rings + 1) * SECTORS]);
        density.par_chunks_mut(SECTORS).take(rings).enumerate().for_each(|(i, row)| {
            let (lo, hi) = (radii[i], radii[i + 1]);
            let (spectrum, step) = if hi <= CORE as f64 { (&core, CORE_STEPS) } else { (&outer, STEPS) };
            // At least as many points as the spectrum has itself.
            let points = ((hi - lo) * step as f64).ceil() as usize;
            for (out, [x, y]) in row.iter_mut().zip(&directions) {
                *out = ring_mean(lo, hi, points, |r| spectrum.at(r * x, r * y)) as f32;
            }
        });
        Self::of_rings(radii, density, false)
    }

    /// The far field of the circle that fills the square: Airy's disc. Nothing need be drawn or transformed for it.
    pub(super) fn of_circle() -> Self {
        let radii = radii();
        let rings = radii.len() - 1;
        let mut density = fresh(vec![0.0; (rings + 1) * SECTORS]);
        density.par_chunks_mut(SECTORS).zip(radii.par_windows(2)).for_each(|(row, edges)| {
            let (lo, hi) = (edges[0], edges[1]);
            // As many points as make each arc of the rings about a tenth of a cycle.
            let points = ((hi - lo) * 10.0).ceil() as usize + 1;
            row.fill(ring_mean(lo, hi, points, airy) as f32);
        });
        Self::of_rings(radii, density, true).unwrap_or_else(|| unreachable!("a circle lets light through"))
    }

    /// From the density in each ring's sectors, on any scale, with room for what lies beyond; `None` where all of it is 0.
    fn of_rings(radii: Vec<f64>, density: Vec<f32>, is_round: bool) -> Option<Self> {
        let widths = (0..SECTORS).map(sector_width).collect();
        let mut field = Self { radii, density, widths, beyond: vec![], is_round };
        field.add_tail();
        field.normalise().then_some(field)
    }

    /// Whether the light goes in all directions alike.
    pub fn is_round(&self) -> bool {
        self.is_round
    }

    /// Brings all light to 1; false where there is none.
    fn normalise(&mut self) -> bool {
        let mut sum = 0.0;
        let mut beyond: Vec<f64> = (0..self.radii.len()).map(|i| self.ring_power(i).sum()).collect();
        for power in beyond.iter_mut().rev() {
            sum += *power;
            *power = sum;
        }
        if sum.is_nan() || sum <= 0.0 {
            return false;
        }
        self.density.iter_mut().for_each(|d| *d = (f64::from(*d) / sum) as f32);
        self.beyond = beyond.iter().map(|b| b / sum).collect();
        true
    }

    /// r³ P beyond the rings: its mean over the last octave, in which the law of an edge holds.
    fn add_tail(&mut self) {
        let rings = self.radii.len() - 1;
        let first = self.radii.partition_point(|&r| r < 0.5 * LAST as f64);
        let all = (self.radii[rings] / self.radii[first]).ln();
        let mut sums = vec![0.0; SECTORS];
        for i in first..rings {
            let (lo, hi) = (self.radii[i], self.radii[i + 1]);
            let weight = (hi / lo).ln() / all * (0.5 * (lo + hi)).powi(3);
            let row = &self.density[i * SECTORS..(i + 1) * SECTORS];
            sums.iter_mut().zip(row).for_each(|(sum, &d)| *sum += weight * f64::from(d));
        }
        let tail = &mut self.density[rings * SECTORS..];
        tail.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum as f32);
    }

    /// Where rings begin, and where the last one ends.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// P at a distance, sector by sector: these numbers times the factor beside them.
    pub fn at_radius(&self, r: f64) -> (&[f32], f64) {
        let i = self.radii.partition_point(|&edge| edge <= r).max(1) - 1;
        let factor = if i + 1 == self.radii.len() { r.powi(-3) } else { 1.0 };
        (&self.density[i * SECTORS..(i + 1) * SECTORS], factor)
    }

    /// P in each ring's sectors, ring after ring, and at last r³ P beyond them.
    pub(super) fn density(&self) -> &[f32] {
        &self.density
    }

    /// Power of ring `i`, or of all that lies beyond the rings, in each sector and the one opposite.
    pub(super) fn ring_power(&self, i: usize) -> impl Iterator<Item = f64> + '_ {
        let weight = match self.radii.get(i + 1) {
            Some(hi) => hi * hi - self.radii[i] * self.radii[i],
            // 2 ∫ r⁻³ r dr.
            None => 2.0 / self.radii[i],
        };
        let row = &self.density[i * SECTORS..(i + 1) * SECTORS];
        row.iter().zip(&self.widths).map(move |(&d, width)| f64::from(d) * weight * width)
    }

    /// The part of the light that goes farther than a distance.
    pub fn beyond(&self, r: f64) -> f64 {
        let i = self.radii.partition_point(|&edge| edge <= r).max(1) - 1;
        let (lo, far) = (self.radii[i], self.beyond[i]);
        match self.radii.get(i + 1) {
            Some(hi) => far + (r * r - lo * lo) / (hi * hi - lo * lo) * (self.beyond[i + 1] - far),
            None => far * lo / r,
        }
    }

    /// Angle of each sector in radians.
    pub fn sector_widths(&self) -> &[f64] {
        &self.widths
    }
}

/// The angle of a direction from the right, in turns, where `sector` counts sectors and parts of them
/// from straight down to straight up.
pub(super) fn turns(sector: f64) -> f64 {
    let [x, y] = direction(sector);
    y.atan2(x) / std::f64::consts::TAU
}

/// The sector of a direction with x ≥ 0, and where in it, as one number: an angle in all but its speed,
/// without its cost.
#[inline]
pub fn sector_of<T: indigo_math::Float>(x: T, y: T) -> T {
    let half = T::from_f64(0.5 * SECTORS as f64);
    half + half * y / (x + y.abs())
}

/// The unit direction at a place among the sectors: the inverse of [`sector_of`].
pub fn direction(sector: f64) -> [f64; 2] {
    let y = 2.0 * sector / SECTORS as f64 - 1.0;
    let x = 1.0 - y.abs();
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}

/// The angle of a sector in radians.
fn sector_width(j: usize) -> f64 {
    (turns(j as f64 + 1.0) - turns(j as f64)) * std::f64::consts::TAU
}

fn radii() -> Vec<f64> {
    let growth = (LAST as f64 / CORE as f64).ln() / OUTER_RINGS as f64;
    let inner = (0..CORE * CORE_RINGS).map(|i| i as f64 / CORE_RINGS as f64);
    inner.chain((0..=OUTER_RINGS).map(|i| CORE as f64 * (growth * i as f64).exp())).collect()
}

/// Airy's pattern, 1 in the middle, at a distance in cycles across the circle.
fn airy(f: f64) -> f64 {
    let x = std::f64::consts::PI * f;
    if x < 1e-6 { 1.0 } else { (2.0 * bessel_1(x) / x).powi(2) }
}

/// J₁ of a number that is not negative: by the mean over a period of cos(τ - x sin τ) (DLMF 10.9.2), whose even sums
/// converge faster than any power once there are more points than x; farther out by Hankel's expansion (DLMF 10.17.3).
/// Right to 1e-12.
fn bessel_1(x: f64) -> f64 {
    const POINTS: usize = 64;
    if x < 40.0 {
        let term = |k: usize| {
            let t = std::f64::consts::PI * (k as f64 + 0.5) / POINTS as f64;
            (t - x * t.sin()).cos()
        };
        return (0..POINTS).map(term).sum::<f64>() / POINTS as f64;
    }
    // Terms a_k(1) / x^k, of which the even ones belong to the cosine and the odd ones to the sine.
    let (mut even, mut odd, mut term) = (0.0, 0.0, 1.0);
    for k in 0..8u32 {
        let sign = if k / 2 % 2 == 0 { 1.0 } else { -1.0 };
        *(if k % 2 == 0 { &mut even } else { &mut odd }) += sign * term;
        let odd_number = f64::from(2 * k + 1);
        term *= (4.0 - odd_number * odd_number) / (8.0 * f64::from(k + 1) * x);
    }
    let phase = x - 0.75 * std::f64::consts::PI;
    (2.0 / (std::f64::consts::PI * x)).sqrt() * (even * phase.cos() - odd * phase.sin())
}

/// The mean of a function over a ring's width, by area.
fn ring_mean(lo: f64, hi: f64, points: usize, f: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in 0..points {
        let r = lo + (hi - lo) * (k as f64 + 0.5) / points as f64;
        sum += r * f(r);
        weights += r;
    }
    sum / weights
}

/// A drawing on fewer cells, each the mean of those that it covers; `side` divides the drawing's.
fn shrunk(mask: &Mask, side: usize) -> Mask {
    let n = mask.side / side;
    let mut cells = vec![0.0; side * side];
    cells.par_chunks_mut(side).zip(mask.cells.par_chunks(n * mask.side)).for_each(|(out, rows)| {
        for row in rows.chunks_exact(mask.side) {
            out.iter_mut().zip(row.chunks_exact(n)).for_each(|(v, block)| *v += block.iter().sum::<f32>());
        }
        for v in out {
            *v /= (n * n) as f32;
        }
    });
    Mask { side, cells }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz and Stegun, table 9.1, and the eleventh zero; both ways of summing where they meet.
    #[test]
    fn the_bessel_function_is_that_of_the_tables() {
        for (x, expected) in
            [(0.0, 0.0), (1.0, 0.440_050_585_744_9), (5.0, -0.327_579_137_591_5), (10.0, 0.043_472_746_168_9)]
        {
            assert!((bessel_1(x) - expected).abs() < 1e-12, "{x}");
        }
        assert!((bessel_1(40.0 - 1e-13) - bessel_1(40.0)).abs() < 1e-12);
        assert!(bessel_1(35.332_307_550_083_87).abs() < 1e-12);
        // J_1(100), DLMF 10.75.
        assert!((bessel_1(100.0) + 0.077_145_352_014_112).abs() < 1e-12);
    }

    /// What is known of the circle is what comes of drawing one: half a per cent of the middle in the core, and as much
    /// light within each distance.
    #[test]
    fn a_drawn_circle_has_the_far_field_of_a_circle() {
        let exact = FarField::of_circle();
        let drawn = FarField::new(&crate::Aperture::Circular.draw_amplitude(SIDE)).expect("it is open");
        assert!(exact.is_round() && !drawn.is_round());
        let middle = exact.density[0];
        for (a, b) in exact.density[..CORE * CORE_RINGS * SECTORS].iter().zip(&drawn.density) {
            assert!((a - b).abs() < 5e-3 * middle, "{a} {b}");
        }
        for (a, b) in exact.beyond.iter().zip(&drawn.beyond) {
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
        // Encircled energy (Born and Wolf, 8.5.2): 83.8 % within the first dark ring.
        assert!((exact.beyond(1.2197) - 0.1622).abs() < 1e-3, "{}", exact.beyond(1.2197));
    }
}
