//! Do two noisy images agree, block by block?
//!
//! Averages of whole images hide what matters most, a technique that is wrong in one corner of the
//! picture. So the picture is cut into blocks, each block is compared by Welch's t-test between
//! independent batches, and Šidák's correction keeps the alarm rate of the whole grid at the stated
//! family level. One more test of the same family compares the mean of the whole grid, where a small
//! bias everywhere shows that no single block can.

use std::fmt;

use crate::special::sidak;
use crate::stats::Moments;
use crate::ztest::{DEFAULT_THRESHOLD, MeanTest, welch};

/// Per-block moments of an image that was rendered in several independent batches.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockGrid {
    columns: usize,
    blocks: Vec<Moments>,
    /// Means over all blocks of each batch; empty where the grid was not made from batches.
    whole: Moments,
}

/// Why images or grids cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeError(String);

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ShapeError {}

impl ShapeError {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }
}

impl BlockGrid {
    /// An empty grid of `columns` x `rows` blocks.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self { columns, blocks: vec![Moments::default(); columns * rows], whole: Moments::default() }
    }

    /// A grid from moments in row order, e.g. read from a stored reference.
    pub fn from_blocks(columns: usize, blocks: Vec<Moments>) -> Result<Self, ShapeError> {
        if columns == 0 || blocks.is_empty() || !blocks.len().is_multiple_of(columns) {
            return Err(ShapeError::new(format!("{} blocks are no grid of {columns} columns", blocks.len())));
        }
        Ok(Self { columns, blocks, whole: Moments::default() })
    }

    /// Adds one batch: the mean of each block, in row order, of one independent rendering.
    pub fn add_batch(&mut self, block_means: &[f64]) -> Result<(), ShapeError> {
        if block_means.len() != self.blocks.len() {
            return Err(ShapeError::new(format!(
                "{} means for {} blocks",
                block_means.len(),
                self.blocks.len()
            )));
        }
        for (block, &mean) in self.blocks.iter_mut().zip(block_means) {
            block.add(mean);
        }
        self.whole.add(block_means.iter().sum::<f64>() / block_means.len() as f64);
        Ok(())
    }

    /// The moments of each block, in row order.
    pub fn blocks(&self) -> &[Moments] {
        &self.blocks
    }

    /// Moments of the mean over all blocks. From the batches where there are any: their blocks may be
    /// correlated, as those of a Markov chain are.
    fn whole(&self) -> Moments {
        if self.whole.count() > 1 { self.whole } else { pooled(&self.blocks) }
    }

    /// Blocks side by side.
    pub fn columns(&self) -> usize {
        self.columns
    }
}

/// How two grids are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZGrid {
    /// Probability of any alarm in the whole grid if the images agree. Default 1e-4.
    pub family_level: f64,
    /// Difference of a block, relative to the larger of the two, that rounding is allowed. Default
    /// 1e-6: some ulps of the kernel's single precision, far below any noise that matters.
    pub rounding: f64,
}

impl Default for ZGrid {
    fn default() -> Self {
        Self { family_level: DEFAULT_THRESHOLD, rounding: 1e-6 }
    }
}

/// The outcome of comparing two grids.
#[derive(Clone, Debug, PartialEq)]
pub struct ZGridResult {
    /// Blocks compared.
    pub tests: usize,
    /// Column and row of the block with the smallest p-value.
    pub worst_block: (usize, usize),
    /// Its test.
    pub worst: MeanTest,
    /// The test of the mean over all blocks.
    pub overall: MeanTest,
    /// How many blocks fell below the per-test level.
    pub failed_blocks: usize,
    /// Signed t of every block in row order, for a difference map.
    pub t: Vec<f64>,
}

impl ZGridResult {
    /// Whether no block, nor the whole, deviates more than chance explains.
    pub fn passed(&self) -> bool {
        self.worst.passed() && self.overall.passed()
    }
}

impl fmt::Display for ZGridResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} of {} blocks failed", self.failed_blocks, self.tests)?;
        writeln!(
            f,
            "worst block (column {}, row {}): {}",
            self.worst_block.0, self.worst_block.1, self.worst
        )?;
        write!(f, "whole image: {}", self.overall)
    }
}

impl ZGrid {
    /// Compares two grids of one shape.
    pub fn compare(&self, a: &BlockGrid, b: &BlockGrid) -> Result<ZGridResult, ShapeError> {
        if a.columns != b.columns || a.blocks.len() != b.blocks.len() || a.blocks.is_empty() {
            return Err(ShapeError::new(format!(
                "grids of {} and {} blocks, {} and {} columns",
                a.blocks.len(),
                b.blocks.len(),
                a.columns,
                b.columns
            )));
        }
        // The whole image is one more test of the family.
        let level = sidak(self.family_level, a.blocks.len() + 1);
        let tests: Vec<MeanTest> =
            a.blocks.iter().zip(&b.blocks).map(|(a, b)| self.test(a, b).at(level)).collect();
        let worst = least_likely(&tests);
        Ok(ZGridResult {
            tests: tests.len(),
            worst_block: (worst % a.columns, worst / a.columns),
            worst: tests[worst],
            overall: self.test(&a.whole(), &b.whole()).at(level),
            failed_blocks: tests.iter().filter(|test| !test.passed()).count(),
            t: tests.iter().map(|test| test.t).collect(),
        })
    }

    fn test(&self, a: &Moments, b: &Moments) -> MeanTest {
        welch(a, b, self.rounding * a.mean().abs().max(b.mean().abs()))
    }
}

/// Index of the smallest p-value.
fn least_likely(tests: &[MeanTest]) -> usize {
    (0..tests.len()).min_by(|&i, &j| tests[i].p.total_cmp(&tests[j].p)).unwrap_or(0)
}

/// Moments of the mean over all blocks, taken as independent. Splats and filters that reach over a
/// block's border correlate neighbours a little; blocks much larger than the filter keep that small.
fn pooled(blocks: &[Moments]) -> Moments {
    let n = blocks.len() as f64;
    let mean = blocks.iter().map(Moments::mean).sum::<f64>() / n;
    let variance_of_mean = blocks.iter().map(Moments::variance_of_mean).sum::<f64>() / (n * n);
    // Satterthwaite: the degrees of freedom of a sum of independent variance estimates.
    let squares: f64 = blocks
        .iter()
        .map(|b| (b.variance_of_mean() / (n * n)).powi(2) / b.count().saturating_sub(1).max(1) as f64)
        .sum();
    if squares == 0.0 {
        return Moments::exact(mean);
    }
    let dof = (variance_of_mean * variance_of_mean / squares).round().max(1.0);
    Moments::from_parts(dof as u64 + 1, mean, variance_of_mean * (dof + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;
    use crate::special::binomial_two_sided_p;

    /// A fake renderer: 8 x 6 blocks whose noise differs from block to block.
    fn render(rng: &mut Rng, batches: usize, value: impl Fn(usize) -> f64) -> BlockGrid {
        let mut grid = BlockGrid::new(8, 6);
        for _ in 0..batches {
            let means: Vec<f64> =
                (0..48).map(|i| value(i) * (1.0 + 0.02 * (1.0 + i as f64 % 5.0) * rng.normal())).collect();
            grid.add_batch(&means).unwrap();
        }
        grid
    }

    fn truth(block: usize) -> f64 {
        1.0 + block as f64
    }

    #[test]
    fn false_alarm_rate_of_the_family_is_as_stated() {
        let mut rng = Rng::new(21);
        let judge = ZGrid { family_level: 0.05, ..ZGrid::default() };
        let alarms = (0..2000)
            .filter(|_| {
                let (a, b) = (render(&mut rng, 8, truth), render(&mut rng, 12, truth));
                !judge.compare(&a, &b).unwrap().passed()
            })
            .count() as u64;
        let p = binomial_two_sided_p(alarms, 2000, 0.05);
        assert!(p > 1e-3, "{alarms} alarms in 2000 at a stated rate of 0.05: p = {p}");
    }

    #[test]
    fn one_wrong_block_is_caught_and_named() {
        let mut rng = Rng::new(22);
        for _ in 0..50 {
            let a = render(&mut rng, 32, truth);
            // Block 19 (column 3, row 2; 10% noise a batch) is 30% too bright: 10 standard errors.
            let b = render(&mut rng, 32, |i| truth(i) * if i == 19 { 1.3 } else { 1.0 });
            let result = ZGrid::default().compare(&a, &b).unwrap();
            assert!(!result.passed());
            assert_eq!(result.worst_block, (3, 2));
        }
    }

    #[test]
    fn a_small_bias_everywhere_is_caught_by_the_whole() {
        let mut rng = Rng::new(23);
        for _ in 0..50 {
            let a = render(&mut rng, 32, truth);
            // 3% everywhere: hardly two standard errors of a typical block, over ten of the whole.
            let b = render(&mut rng, 32, |i| truth(i) * 1.03);
            assert!(!ZGrid::default().compare(&a, &b).unwrap().overall.passed());
        }
    }

    #[test]
    fn exact_images_are_compared_to_rounding() {
        let constant = |value: f64| BlockGrid::from_blocks(2, vec![Moments::exact(value); 4]).unwrap();
        let judge = ZGrid::default();
        assert!(judge.compare(&constant(1.0), &constant(1.0 + 1e-7)).unwrap().passed());
        assert!(!judge.compare(&constant(1.0), &constant(1.0 + 1e-5)).unwrap().passed());
        assert!(!judge.compare(&constant(1.0), &constant(f64::NAN)).unwrap().passed());
    }

    #[test]
    fn shapes_that_differ_are_refused() {
        assert!(BlockGrid::from_blocks(3, vec![Moments::default(); 4]).is_err());
        assert!(BlockGrid::new(2, 2).add_batch(&[1.0; 3]).is_err());
        assert!(ZGrid::default().compare(&BlockGrid::new(2, 3), &BlockGrid::new(3, 2)).is_err());
    }
}
