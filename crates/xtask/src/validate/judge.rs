//! What pictures say: each number beside what it must be.

use super::check::{Area, Check, Demand, Quantity, Renderer, Row, Target};
use super::oracles::EVEN_LIGHT;
use super::picture::Picture;
use super::statistics::{Comparison, Estimate, inflation, quantile, sidak};

/// Probability that any comparison of a run fails although nothing is wrong.
pub const FAMILY: f64 = 1e-3;
/// The p-value of the least deviation that counts as seen: about the threshold of a thousand comparisons, but one number for every
/// run, so that how finely a picture is rendered does not hang on how many others there are.
const SEEN: f64 = 1e-6;
/// Relative difference that sums of single-precision numbers may make, and their storage in a file.
const ROUNDING: f64 = 1e-5;
/// Blocks along a side of a picture.
pub const BLOCKS: usize = 4;

/// Why a comparison fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Something that is no number.
    NoNumber,
    /// More than noise explains.
    Deviates,
    /// Noise hides what must be seen.
    Unresolved,
    /// Renderers agree on nothing.
    NoLight,
    /// A screen would get other codes.
    WrongCodes,
}

impl Failure {
    /// In a word or two.
    pub fn words(self) -> &'static str {
        match self {
            Self::NoNumber => "no number",
            Self::Deviates => "deviates",
            Self::Unresolved => "unresolved",
            Self::NoLight => "no light",
            Self::WrongCodes => "wrong codes",
        }
    }
}

/// What one comparison said.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Who rendered.
    pub renderer: Renderer,
    /// Which number.
    pub what: String,
    /// Of which part of the picture, where it is a luminance.
    pub area: Option<Area>,
    /// What was expected, with what it is known to.
    pub expected: Estimate,
    /// Whether less is as good.
    pub is_bound: bool,
    /// What came out.
    pub measured: Estimate,
    /// The test.
    pub comparison: Comparison,
    /// What a right renderer may deviate by: what the value is known to, and rounding.
    pub allowance: f64,
    /// The share of the value that a deviation must have to be seen.
    pub resolution: f64,
    /// How much of that is noise.
    pub noise: f64,
    /// What the resolution may be.
    pub demand: f64,
    /// The p-value below which it fails.
    pub threshold: f64,
    /// Why it failed, if it did.
    pub failure: Option<Failure>,
}

impl Verdict {
    /// With what failed, if anything did.
    #[must_use]
    pub fn failing(mut self) -> Self {
        self.failure = if !self.measured.mean.is_finite() {
            Some(Failure::NoNumber)
        } else if self.comparison.p < self.threshold {
            Some(Failure::Deviates)
        } else if self.least_resolution() > self.demand {
            Some(Failure::Unresolved)
        } else {
            None
        };
        self
    }

    /// The resolution, were the noise as little as its standard error allows at the threshold: it is known by a few renders, and may have
    /// come out large by chance.
    fn least_resolution(&self) -> f64 {
        let by_chance = 1.0 - 1.0 / inflation(self.threshold, self.comparison.freedom);
        self.resolution - by_chance * self.noise
    }

    /// Whether it resolves less finely than it should, if not surely so.
    pub fn is_coarse(&self) -> bool {
        self.resolution > self.demand
    }
}

/// What is to be judged of a check.
pub struct Judge<'a> {
    /// The check.
    pub check: &'a Check,
    /// Its demand in this run.
    pub demand: Demand,
    /// For each renderer the pictures of its seeds.
    pub renders: &'a [Vec<Picture>],
    /// The p-value below which a comparison fails.
    pub threshold: f64,
}

/// The p-value below which each of many comparisons fails.
pub fn threshold(comparisons: usize) -> f64 {
    sidak(FAMILY, comparisons)
}

impl Judge<'_> {
    /// Judges all renders of a check.
    pub fn verdicts(&self) -> Vec<Verdict> {
        let mut verdicts = vec![];
        for (i, renderer) in self.check.renderers.iter().enumerate() {
            for row in &self.check.rows {
                if matches!(row.target, Target::First(_)) && i == 0 {
                    continue;
                }
                verdicts.push(self.row(row, *renderer, i));
            }
            verdicts.extend(self.flatness(*renderer, i));
            if i > 0 && self.check.compares_pictures() {
                let first = |area, c| self.block(&self.renders[0], area, c);
                verdicts.push(self.blocks(*renderer, i, "beside the first", first, false));
            }
            verdicts.extend(self.broken_pixels(*renderer, i));
        }
        verdicts
    }

    fn row(&self, row: &Row, renderer: Renderer, i: usize) -> Verdict {
        let unit = self.check.unit;
        let [width, height] = self.renders[i][0].size;
        let measure = |pictures: &[Picture]| {
            let values: Vec<f64> = pictures.iter().map(|p| p.value(row.quantity, row.area, unit)).collect();
            Estimate::of(&values)
        };
        let measured = measure(&self.renders[i]);
        let (expected, uncertainty) = match row.target {
            Target::Value(value, uncertainty) => (Estimate::exact(value), uncertainty),
            Target::AtMost(value) => (Estimate::exact(value), 0.0),
            Target::Sampled(estimate) => (estimate, 0.0),
            Target::First(slack) => {
                let first = measure(&self.renders[0]);
                (first, slack * first.mean.abs())
            }
        };
        let is_bound = matches!(row.target, Target::AtMost(_));
        let Beside { measured, expected, comparison, allowance } =
            Beside::of(measured, expected, uncertainty, is_bound);
        let scale = scale(&expected, unit);
        let noise = quantile(SEEN, comparison.freedom) * comparison.error / scale;
        let verdict = Verdict {
            renderer,
            what: row.what.clone(),
            area: (row.quantity == Quantity::Y).then(|| row.area.unwrap_or([0, width, 0, height])),
            expected,
            is_bound,
            measured,
            comparison,
            allowance,
            // What is granted is not noticed.
            resolution: noise + allowance / scale,
            noise,
            demand: row.demand.unwrap_or(self.demand.resolution),
            threshold: self.threshold,
            failure: None,
        }
        .failing();
        // Renderers that agree on nothing at all have shown nothing.
        let is_dark = matches!(row.target, Target::First(_)) && !shines(&verdict.expected, self.threshold);
        Verdict { failure: verdict.failure.or(is_dark.then_some(Failure::NoLight)), ..verdict }
    }

    /// Each block of a picture that should have one value everywhere.
    fn flatness(&self, renderer: Renderer, i: usize) -> Option<Verdict> {
        let (value, is_bound) = match self.check.rows.first()?.target {
            _ if !self.check.is_flat => return None,
            Target::Value(value, _) => (value, false),
            Target::AtMost(value) => (value, true),
            Target::Sampled(_) | Target::First(_) => return None,
        };
        let flat = |_, c: usize| Estimate::exact(value * EVEN_LIGHT[c]);
        Some(self.blocks(renderer, i, "all alike", flat, is_bound))
    }

    fn block(&self, pictures: &[Picture], area: Area, c: usize) -> Estimate {
        let values: Vec<f64> = pictures.iter().map(|p| p.mean(Some(area))[c] / self.check.unit).collect();
        Estimate::of(&values)
    }

    /// The most surprising of all blocks and of X, Y and Z, as if it were one test (Šidák).
    fn blocks(
        &self,
        renderer: Renderer,
        i: usize,
        words: &str,
        expected: impl Fn(Area, usize) -> Estimate,
        is_bound: bool,
    ) -> Verdict {
        let mut worst: Option<Beside> = None;
        let mut errors = vec![];
        for area in areas(self.renders[i][0].size) {
            for c in 0..3 {
                let own = self.block(&self.renders[i], area, c);
                let beside = Beside::of(own, expected(area, c), 0.0, is_bound);
                errors.push(beside.comparison.error / scale(&beside.expected, self.check.unit));
                if worst.as_ref().is_none_or(|worst| beside.comparison.p < worst.comparison.p) {
                    worst = Some(beside);
                }
            }
        }
        let tests = errors.len();
        let Beside { measured, expected, mut comparison, allowance } = worst.expect("there are blocks");
        comparison.p = -((-comparison.p).ln_1p() * tests as f64).exp_m1();
        errors.sort_by(f64::total_cmp);
        let resolution = errors[tests / 2] * quantile(sidak(SEEN, tests), comparison.freedom);
        Verdict {
            renderer,
            what: format!("worst of {tests} block means, {words}"),
            area: None,
            expected,
            is_bound,
            measured,
            comparison,
            allowance,
            resolution,
            noise: resolution,
            demand: self.demand.blocks,
            threshold: self.threshold,
            failure: None,
        }
        .failing()
    }

    /// What a screen would be sent.
    pub fn codes(&self, renderer: Renderer, wrong: usize) -> Verdict {
        self.counted(renderer, "sRGB codes that are not those of the luminances", wrong, Failure::WrongCodes)
    }

    /// Something of which there must be none.
    fn counted(&self, renderer: Renderer, what: &str, count: usize, failure: Failure) -> Verdict {
        let is_wrong = count > 0;
        let comparison = Comparison {
            t: if is_wrong { f64::INFINITY } else { 0.0 },
            error: 0.0,
            freedom: 1.0,
            p: if is_wrong { 0.0 } else { 1.0 },
        };
        Verdict {
            renderer,
            what: what.to_owned(),
            area: None,
            expected: Estimate::exact(0.0),
            is_bound: false,
            measured: Estimate::exact(count as f64),
            comparison,
            allowance: 0.0,
            resolution: 0.0,
            noise: 0.0,
            demand: 0.0,
            threshold: self.threshold,
            failure: is_wrong.then_some(failure),
        }
    }

    /// Pixels that hold no numbers, which no mean of an area elsewhere would tell of.
    fn broken_pixels(&self, renderer: Renderer, i: usize) -> Option<Verdict> {
        let pixels = self.renders[i].iter().flat_map(|picture| &picture.pixels);
        let broken = pixels.filter(|pixel| pixel.iter().any(|v| !v.is_finite())).count();
        (broken > 0).then(|| self.counted(renderer, "pixels that are no numbers", broken, Failure::NoNumber))
    }
}

/// A share is of this: the value, or where that is 0 what one is in the picture's unit.
fn scale(expected: &Estimate, unit: f64) -> f64 {
    if expected.mean == 0.0 { unit } else { expected.mean.abs() }
}

/// Whether an estimate is above 0 beyond its noise.
fn shines(estimate: &Estimate, threshold: f64) -> bool {
    let freedom = estimate.count.max(2) - 1;
    estimate.mean > quantile(threshold, freedom as f64) * estimate.error
}

/// A number beside another.
struct Beside {
    measured: Estimate,
    expected: Estimate,
    comparison: Comparison,
    /// What was granted.
    allowance: f64,
}

impl Beside {
    fn of(measured: Estimate, expected: Estimate, uncertainty: f64, is_bound: bool) -> Self {
        let allowance = uncertainty + ROUNDING * expected.mean.abs().max(measured.mean.abs());
        let mut comparison = Comparison::of(&measured, &expected, allowance);
        if is_bound && measured.mean <= expected.mean {
            comparison = Comparison { t: comparison.t.min(0.0), p: 1.0, ..comparison };
        }
        Self { measured, expected, comparison, allowance }
    }
}

/// Columns and rows of the blocks of a picture.
fn areas([width, height]: [usize; 2]) -> impl Iterator<Item = Area> {
    let cut = |i: usize, n: usize| i * n / BLOCKS;
    (0..BLOCKS * BLOCKS).map(move |block| {
        let (x, y) = (block % BLOCKS, block / BLOCKS);
        [cut(x, width), cut(x + 1, width), cut(y, height), cut(y + 1, height)]
    })
}
