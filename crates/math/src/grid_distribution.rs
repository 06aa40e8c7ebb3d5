//! Densities over the unit square that are constant within the cells of a grid.

use crate::{Real, Vec2};

/// A distribution over the unit square, constant within each of `width` by `height` equal cells.
///
/// Sampling inverts the cumulative distribution of the rows, then that of the row, so that near numbers
/// give near points: well-spread numbers stay spread, and small mutations small. What is stored is the
/// cumulative sums as the kernel rounds them, and densities are their differences: exactly what is drawn.
#[derive(Clone, Debug)]
pub struct GridDistribution {
    width: usize,
    height: usize,
    /// Cumulative probability of rows: 0 first, 1 last.
    rows: Vec<Real>,
    /// Cumulative probability along each row in turn: 0 first, 1 last.
    columns: Vec<Real>,
}

impl GridDistribution {
    /// From the weights of all cells, row by row (x runs fastest); negative ones and those that are not
    /// finite count as 0. Where all are 0, in a row or altogether, all are equally likely.
    ///
    /// # Panics
    /// If there are not `width · height` weights, or none.
    pub fn new(width: usize, height: usize, weights: &[f64]) -> Self {
        assert!(width > 0 && height > 0 && weights.len() == width * height, "one weight for each cell");
        let clean = |w: f64| if w.is_finite() && w > 0.0 { w } else { 0.0 };
        let mut columns = Vec::with_capacity((width + 1) * height);
        let mut sums = Vec::with_capacity(height);
        for row in weights.chunks_exact(width) {
            sums.push(cumulate(row.iter().map(|&w| clean(w)), width, &mut columns));
        }
        let mut rows = Vec::with_capacity(height + 1);
        cumulate(sums.into_iter(), height, &mut rows);
        Self { width, height, rows, columns }
    }

    /// A point of the square, and its density.
    #[inline]
    pub fn sample(&self, u: [Real; 2]) -> (Vec2, Real) {
        let (row, fy, py) = invert(&self.rows, u[1]);
        let (column, fx, px) = invert(self.row(row), u[0]);
        let at =
            Vec2::new((column as Real + fx) / self.width as Real, (row as Real + fy) / self.height as Real);
        (at, px * py * (self.width * self.height) as Real)
    }

    /// Density of a point of the square.
    #[inline]
    pub fn pdf(&self, at: Vec2) -> Real {
        let cell = |x: Real, n: usize| ((x * n as Real) as usize).min(n - 1);
        let (column, row) = (cell(at.x, self.width), cell(at.y, self.height));
        let along = self.row(row);
        let p = (along[column + 1] - along[column]) * (self.rows[row + 1] - self.rows[row]);
        p * (self.width * self.height) as Real
    }

    #[inline]
    fn row(&self, i: usize) -> &[Real] {
        let n = self.width + 1;
        &self.columns[i * n..(i + 1) * n]
    }
}

/// Means of a function of the place in the unit square, from (0, 0) to (1, 1), over the cells of a grid of so many
/// columns and rows, row by row: by the midpoint rule with so many points along each side of a cell.
pub fn cell_means([width, height]: [usize; 2], points: usize, f: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
    let at = |i: usize, k: usize, n: usize| (i as f64 + (k as f64 + 0.5) / points as f64) / n as f64;
    let mean = |cell: usize| {
        let (column, row) = (cell % width, cell / width);
        let point = |k: usize| f([at(column, k % points, width), at(row, k / points, height)]);
        (0..points * points).map(point).sum::<f64>() / (points * points) as f64
    };
    (0..width * height).map(mean).collect()
}

/// Appends the cumulative probabilities of `n` weights, and returns the weights' sum.
fn cumulate(weights: impl Iterator<Item = f64> + Clone, n: usize, to: &mut Vec<Real>) -> f64 {
    let sum: f64 = weights.clone().sum();
    let mut below = 0.0;
    to.push(0.0);
    for (i, w) in weights.enumerate() {
        below += if sum > 0.0 { w / sum } else { 1.0 / n as f64 };
        // The last is 1 whatever the sum's rounding, so that every number finds its cell.
        to.push(if i + 1 == n { 1.0 } else { below.min(1.0) as Real });
    }
    sum
}

/// The cell in which a cumulative distribution passes `u`, how far in it, and its probability.
#[inline]
fn invert(cumulative: &[Real], u: Real) -> (usize, Real, Real) {
    // The first entry above u ends the cell; its probability is then above 0.
    let end = cumulative.partition_point(|&c| c <= u).clamp(1, cumulative.len() - 1);
    let (low, high) = (cumulative[end - 1], cumulative[end]);
    let p = high - low;
    let within = if p > 0.0 { ((u - low) / p).clamp(0.0, 1.0 - Real::EPSILON) } else { 0.5 };
    (end - 1, within, p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Chi-square over 6 cells with weight, 5 degrees of freedom: the 1e-5 quantile is 30.9.
    #[test]
    fn points_follow_the_stated_density() {
        let weights = [1.0, 0.0, 3.0, 5.0, 0.5, 2.0, -1.0, f64::NAN, 4.0];
        let total = 15.5;
        let grid = GridDistribution::new(3, 3, &weights);
        let mut rng = Rng::new(3);
        let mut counts = [0.0; 9];
        let n = 100_000;
        for _ in 0..n {
            let (at, pdf) = grid.sample([rng.next_real(), rng.next_real()]);
            assert!((0.0..1.0).contains(&at.x) && (0.0..1.0).contains(&at.y));
            let cell = (at.y * 3.0) as usize * 3 + (at.x * 3.0) as usize;
            counts[cell] += 1.0;
            assert!((pdf as f64 - weights[cell] / total * 9.0).abs() < 1e-5);
            assert_eq!(pdf, grid.pdf(at));
        }
        let mut chi2 = 0.0;
        for (count, weight) in counts.iter().zip(weights) {
            if weight > 0.0 {
                let expected = weight / total * f64::from(n);
                chi2 += (count - expected) * (count - expected) / expected;
            } else {
                assert_eq!(*count, 0.0);
            }
        }
        assert!(chi2 < 30.9, "{chi2}");
    }

    /// Exact where the function is linear; x runs fastest.
    #[test]
    fn means_are_those_of_the_cells() {
        let means = cell_means([3, 2], 2, |[x, y]| 6.0 * x + 100.0 * y);
        let expected = [26.0, 28.0, 30.0, 76.0, 78.0, 80.0];
        assert!(means.iter().zip(expected).all(|(m, e)| (m - e).abs() < 1e-12), "{means:?}");
        // Midpoints of halves: (1/4)² and (3/4)².
        assert!((cell_means([1, 1], 2, |[x, _]| x * x)[0] - 0.3125).abs() < 1e-12);
    }

    #[test]
    fn near_numbers_give_near_points_and_ends_are_harmless() {
        let grid = GridDistribution::new(2, 1, &[1.0, 3.0]);
        assert!((grid.sample([0.125, 0.5]).0.x - 0.25).abs() < 1e-6);
        assert!((grid.sample([0.625, 0.5]).0.x - 0.75).abs() < 1e-6);
        let last = 1.0 - Real::EPSILON / 2.0;
        for u in [0.0, last] {
            let (at, pdf) = grid.sample([u, u]);
            assert!(pdf > 0.0 && (0.0..1.0).contains(&at.x) && (0.0..1.0).contains(&at.y));
        }
        // Without any weight all is equal; a cell without weight at the end is not drawn.
        assert_eq!(GridDistribution::new(2, 2, &[0.0; 4]).pdf(Vec2::new(0.9, 0.1)), 1.0);
        assert_eq!(GridDistribution::new(2, 1, &[1.0, 0.0]).sample([last, 0.5]).1, 2.0);
    }
}
