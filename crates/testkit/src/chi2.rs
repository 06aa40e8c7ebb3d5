//! Does a sampler follow the density that it reports?
//!
//! Pearson's chi-square test: the domain is cut into cells of equal measure, the density is
//! integrated over each cell by adaptive quadrature, and the counts of samples are compared with
//! these expectations.
//!
//! ```
//! use indigo_testkit::chi2::{Chi2, Domain};
//! // Directions with density cosθ/π on the hemisphere.
//! let test = Chi2::new(Domain::Hemisphere);
//! let result = test.run(
//!     |rng| {
//!         let (r, phi) = (rng.uniform().sqrt(), std::f64::consts::TAU * rng.uniform());
//!         Some([r * phi.cos(), r * phi.sin(), (1.0 - r * r).sqrt()])
//!     },
//!     |d| d[2].max(0.0) / std::f64::consts::PI,
//! );
//! assert!(result.passed(), "{result}");
//! ```
//!
//! What it cannot see: a density and a sampler that are wrong together, and the value of the
//! function that is sampled. Those need the weight and the furnace laws.

use std::fmt;

pub use crate::domain::Domain;
use crate::quadrature::{Integral, rectangle};
use crate::rng::Rng;
use crate::special::{chi2_p, poisson_upper_p, sidak};

/// The rule of thumb for Pearson's approximation (Cochran 1954): cells with less are pooled.
const MIN_EXPECTED: f64 = 5.0;
/// An integral of the density this far above 1 is no rounding error of a single-precision density.
const EXCESS: f64 = 1e-4;

/// A chi-square test; the fields may be set freely before it is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chi2 {
    /// What is sampled.
    pub domain: Domain,
    /// Cells along the domain's two coordinates.
    pub cells: [usize; 2],
    /// Samples drawn. Default 200,000.
    pub samples: u32,
    /// Seed of the random numbers. Default 1.
    pub seed: u64,
    /// Probability of a false alarm. Default 1e-4. Pearson's statistic follows its distribution only
    /// nearly: with most cells near the minimum expectation alarms were measured 1.3 times as frequent.
    pub level: f64,
}

impl Chi2 {
    /// The default test over a domain.
    pub fn new(domain: Domain) -> Self {
        Self { domain, cells: domain.default_cells(), samples: 200_000, seed: 1, level: 1e-4 }
    }

    /// The same as one of a family of `tests` that shares the false-alarm probability (Šidák).
    #[must_use]
    pub fn among(self, tests: usize) -> Self {
        Self { level: sidak(self.level, tests), ..self }
    }

    /// Integrates `pdf` over the cells, draws the samples and compares.
    ///
    /// `sample` gives a point, or `None` where the sampler gives up; the density may integrate to
    /// less than 1, and then as many samples must give up.
    pub fn run(
        &self,
        sample: impl FnMut(&mut Rng) -> Option<[f64; 3]>,
        pdf: impl Fn([f64; 3]) -> f64,
    ) -> Chi2Result {
        self.compare(&self.expectation(pdf), sample)
    }

    /// The integral of `pdf` over each cell.
    pub fn expectation(&self, pdf: impl Fn([f64; 3]) -> f64) -> Expectation {
        let [nu, nv] = self.cells;
        let measure = self.domain.measure();
        // A hundredth of a sample per cell: far below the noise of any cell that counts.
        let tolerance = 0.01 / f64::from(self.samples) / measure;
        let cell = |i: usize| {
            let (iu, iv) = (i / nv, i % nv);
            let side = |k: usize, n: usize| [k as f64 / n as f64, (k + 1) as f64 / n as f64];
            rectangle(side(iu, nu), side(iv, nv), tolerance, |u, v| pdf(self.domain.point(u, v)))
        };
        let parts: Vec<Integral> = (0..nu * nv).map(cell).collect();
        Expectation { cells: parts.into_iter().map(|part| part.scaled(measure)).collect() }
    }

    /// Draws the samples and compares them with an expectation made by [`Self::expectation`].
    pub fn compare(
        &self,
        expectation: &Expectation,
        mut sample: impl FnMut(&mut Rng) -> Option<[f64; 3]>,
    ) -> Chi2Result {
        let mut rng = Rng::new(self.seed);
        let mut counts = Counts { cells: vec![0; expectation.cells.len()], lost: 0, outside: 0 };
        for _ in 0..self.samples {
            match sample(&mut rng) {
                None => counts.lost += 1,
                Some(point) => match self.domain.coordinates(point) {
                    None => counts.outside += 1,
                    Some((u, v)) => counts.cells[self.cell(u, v)] += 1,
                },
            }
        }
        self.judge(expectation, &counts)
    }

    fn cell(&self, u: f64, v: f64) -> usize {
        let index = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
        index(u, self.cells[0]) * self.cells[1] + index(v, self.cells[1])
    }

    fn judge(&self, expectation: &Expectation, counts: &Counts) -> Chi2Result {
        let n = f64::from(self.samples);
        let integral = expectation.cells.iter().fold(Integral::default(), |sum, &cell| sum + cell);
        let cells = expectation.cells.iter().zip(&counts.cells);
        let mut bins: Vec<Bin> = cells.map(|(&cell, &count)| Bin::new(cell, n, count)).collect();
        // Giving up is one more cell, so a density that lacks what the sampler never loses shows.
        let lost = Integral { value: (1.0 - integral.value).max(0.0), error: integral.error };
        bins.push(Bin::new(lost, n, counts.lost));
        let (bins, rare) = pool(bins);
        let statistic = bins.iter().map(Bin::statistic).sum::<f64>();
        let dof = bins.len().saturating_sub(1);
        let p_bins = if dof == 0 { 1.0 } else { chi2_p(statistic, dof as f64) };
        Chi2Result {
            statistic,
            dof,
            p: rare.map_or(p_bins, |rare| smaller_of_two(p_bins, rare.rare_p())),
            threshold: self.level,
            samples: self.samples,
            lost: counts.lost,
            outside: counts.outside,
            integral: integral.value,
            integral_error: integral.error,
        }
    }
}

/// Probabilities of the cells of one [`Chi2`].
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    cells: Vec<Integral>,
}

struct Counts {
    cells: Vec<u32>,
    lost: u32,
    outside: u32,
}

/// Expected and observed number of samples of a cell or of several together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bin {
    expected: f64,
    /// Error of the quadrature behind `expected`.
    error: f64,
    observed: f64,
}

impl Bin {
    fn new(probability: Integral, samples: f64, observed: u32) -> Self {
        Self {
            expected: samples * probability.value,
            error: samples * probability.error,
            observed: f64::from(observed),
        }
    }

    fn statistic(&self) -> f64 {
        (self.observed - self.expected).powi(2) / self.expected
    }

    /// Where next to nothing is expected, the count is Poisson: probability of as many samples.
    fn rare_p(&self) -> f64 {
        poisson_upper_p(self.observed as u64, self.expected.max(0.0) + self.error)
    }
}

impl std::ops::Add for Bin {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            expected: self.expected + other.expected,
            error: self.error + other.error,
            observed: self.observed + other.observed,
        }
    }
}

/// Keeps the bins with at least [`MIN_EXPECTED`] and pools the others into one; that one comes
/// second and apart if even together they are too few for Pearson's approximation. (Pooled with a
/// well filled cell, samples where none can be would hide in its noise.)
fn pool(bins: Vec<Bin>) -> (Vec<Bin>, Option<Bin>) {
    // A bin that is not a number counts as well filled: its statistic then fails the test.
    let (rare, mut kept): (Vec<Bin>, Vec<Bin>) =
        bins.into_iter().partition(|bin| bin.expected < MIN_EXPECTED);
    let rare = rare.into_iter().reduce(|a, b| a + b);
    match rare {
        Some(pooled) if pooled.expected >= MIN_EXPECTED => {
            kept.push(pooled);
            (kept, None)
        }
        rare => (kept, rare),
    }
}

/// The p-value of the smaller of two independent p-values.
fn smaller_of_two(p: f64, q: f64) -> f64 {
    if p.is_nan() || q.is_nan() {
        return f64::NAN;
    }
    let least = p.min(q);
    least * (2.0 - least)
}

/// The outcome of a chi-square test.
#[derive(Clone, Debug, PartialEq)]
pub struct Chi2Result {
    /// Pearson's Σ (observed - expected)² / expected over the cells, rare ones pooled.
    pub statistic: f64,
    /// Degrees of freedom: cells after pooling - 1.
    pub dof: usize,
    /// Probability of a deviation as large, if the sampler follows the density: Pearson's, combined
    /// with a Poisson test of the cells where hardly any sample is expected, if there are such.
    pub p: f64,
    /// The p-value below which the test fails.
    pub threshold: f64,
    /// Samples drawn.
    pub samples: u32,
    /// How many of them gave up.
    pub lost: u32,
    /// How many lay outside the domain, or were not unit vectors, or not numbers.
    pub outside: u32,
    /// Integral of the density over the domain.
    pub integral: f64,
    /// The quadrature's own estimate of that integral's error.
    pub integral_error: f64,
}

impl Chi2Result {
    /// Whether sampler and density agree: p at or above the threshold, no point outside the domain,
    /// and a density that integrates to no more than 1.
    pub fn passed(&self) -> bool {
        self.p >= self.threshold && self.outside == 0 && self.integral <= 1.0 + EXCESS + self.integral_error
    }
}

impl fmt::Display for Chi2Result {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "chi-square {:.1} with {} degrees of freedom, p = {:.3e}, {} at {:.1e}; {} samples, {} gave up, \
             {} outside the domain; the density integrates to {:.6} +- {:.0e}",
            self.statistic,
            self.dof,
            self.p,
            if self.passed() { "passed" } else { "FAILED" },
            self.threshold,
            self.samples,
            self.lost,
            self.outside,
            self.integral,
            self.integral_error
        )
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::quadrature::direction;
    use crate::special::binomial_two_sided_p;

    fn uniform_sphere(rng: &mut Rng) -> [f64; 3] {
        direction(2.0 * rng.uniform() - 1.0, TAU * rng.uniform())
    }

    /// A lobe n cos^(n-1) that the default cells must pool in its tail.
    fn lobe(rng: &mut Rng) -> [f64; 3] {
        direction(rng.uniform().powf(1.0 / 8.0), TAU * rng.uniform())
    }

    fn lobe_pdf(d: [f64; 3]) -> f64 {
        8.0 * d[2].max(0.0).powi(7) / TAU
    }

    #[test]
    fn false_alarm_rate_is_as_stated() {
        let test = Chi2 { samples: 3000, cells: [8, 8], ..Chi2::new(Domain::Sphere) };
        let expectation = test.expectation(lobe_pdf);
        for rate in [0.05, 0.01] {
            let alarms = (0..2000)
                .filter(|&seed| {
                    // Far from the default seed's neighbourhood, the same for both rates.
                    !Chi2 { seed: 7_000_000 + seed, level: rate, ..test }
                        .compare(&expectation, |rng| Some(lobe(rng)))
                        .passed()
                })
                .count() as u64;
            let p = binomial_two_sided_p(alarms, 2000, rate);
            assert!(p > 1e-3, "{alarms} alarms in 2000 at a stated rate of {rate}: p = {p}");
        }
    }

    #[test]
    fn a_density_wrong_by_five_percent_is_caught() {
        // 5% too much on one hemisphere, 5% too little on the other, default settings: the
        // non-centrality is 200,000 x 0.05² = 500 beside a standard deviation of 32.
        let test = Chi2::new(Domain::Sphere);
        let expectation = test.expectation(|d| (1.0 + 0.05 * d[2].signum()) / (2.0 * TAU));
        for seed in 0..100 {
            let result = Chi2 { seed, ..test }.compare(&expectation, |rng| Some(uniform_sphere(rng)));
            assert!(!result.passed(), "{result}");
        }
    }

    #[test]
    fn a_density_scaled_by_five_percent_is_caught() {
        let test = Chi2::new(Domain::Sphere);
        for factor in [0.95, 1.05] {
            let result = test.run(|rng| Some(uniform_sphere(rng)), |_| factor / (2.0 * TAU));
            assert!(!result.passed(), "{result}");
        }
    }

    #[test]
    fn every_domain_passes_with_its_uniform_sampler() {
        let flat = |domain: Domain, rng: &mut Rng| Some(domain.point(rng.uniform(), rng.uniform()));
        let domains =
            [Domain::Interval(-2.0, 5.0), Domain::Square, Domain::Disk, Domain::Hemisphere, Domain::Sphere];
        for domain in domains {
            let result = Chi2::new(domain).among(5).run(|rng| flat(domain, rng), |_| 1.0 / domain.measure());
            assert!(result.passed(), "{domain:?}: {result}");
            assert!((result.integral - 1.0).abs() < 1e-9, "{domain:?}: {result}");
        }
    }

    #[test]
    fn samples_that_give_up_need_a_density_that_allows_it() {
        let test = Chi2::new(Domain::Square);
        let mut half = |rng: &mut Rng| {
            let point = [rng.uniform(), rng.uniform(), 0.0];
            (rng.uniform() < 0.75).then_some(point)
        };
        assert!(test.run(&mut half, |_| 0.75).passed());
        assert!(!test.run(&mut half, |_| 1.0).passed());
    }

    #[test]
    fn samples_where_the_density_is_zero_are_caught() {
        // One sample in a thousand goes to the lower hemisphere, where the density is 0.
        let result = Chi2::new(Domain::Sphere).run(
            |rng| {
                let stray = rng.uniform() < 1e-3;
                let z = rng.uniform();
                Some(direction(if stray { -z } else { z }, TAU * rng.uniform()))
            },
            |d| if d[2] >= 0.0 { 1.0 / TAU } else { 0.0 },
        );
        assert!(!result.passed(), "{result}");
    }

    #[test]
    fn points_outside_the_domain_are_caught() {
        let outside = |point: [f64; 3], domain| Chi2::new(domain).run(|_| Some(point), |_| 1.0).outside;
        assert_eq!(outside([1.5, 0.5, 0.0], Domain::Square), 200_000);
        assert_eq!(outside([0.0, 0.0, -1.0], Domain::Hemisphere), 200_000);
        assert_eq!(outside([0.0, 0.0, 1.01], Domain::Sphere), 200_000);
        assert_eq!(outside([f64::NAN, 0.0, 0.0], Domain::Disk), 200_000);
    }

    #[test]
    fn a_density_that_is_not_a_number_fails() {
        let result =
            Chi2::new(Domain::Square).run(|rng| Some([rng.uniform(), rng.uniform(), 0.0]), |_| f64::NAN);
        assert!(!result.passed(), "{result}");
    }

    #[test]
    fn pooling_keeps_all_counts() {
        let bin = |expected, observed| Bin { expected, error: 0.0, observed };
        let (kept, rare) = pool(vec![bin(0.0, 1.0), bin(3.0, 2.0), bin(100.0, 90.0), bin(2.5, 4.0)]);
        assert_eq!(kept, vec![bin(100.0, 90.0), bin(5.5, 7.0)]);
        assert_eq!(rare, None);
        let (kept, rare) = pool(vec![bin(0.0, 1.0), bin(100.0, 90.0), bin(2.5, 4.0)]);
        assert_eq!(kept, vec![bin(100.0, 90.0)]);
        assert_eq!(rare, Some(bin(2.5, 5.0)));
    }
}
