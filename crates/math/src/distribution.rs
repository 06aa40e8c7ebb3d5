//! Discrete distributions.

use crate::{Float, Real};

/// Leading digits of a number from which [`refined`] makes one of double precision.
const DIGITS: f64 = (1u64 << 24) as f64;

/// One even number in [0, 1) from two: the first 24 binary digits of `coarse`, and then those of `fine`.
///
/// A number of a primary sample has 24 digits alone, which are too few where a choice is made among many: of
/// a million equal indices each would get 16 or 17 of the 2²⁴ numbers. Near numbers `coarse` give near results.
#[inline]
pub fn refined(coarse: Real, fine: Real) -> f64 {
    ((coarse.to_f64() * DIGITS).floor() + fine.to_f64()) / DIGITS
}

/// Picks an index with given probabilities in constant time (Walker 1977; construction of Vose 1991).
#[derive(Clone, Debug, Default)]
pub struct AliasTable {
    /// For each column: the chance to stay in it, the other index, and the index's own probability.
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    keep: f32,
    alias: u32,
    probability: f32,
}

impl AliasTable {
    /// A table of weights; negative and non-finite ones count as 0. Where all are 0 all are equally likely.
    pub fn new(weights: &[f64]) -> Self {
        let clean: Vec<f64> =
            weights.iter().map(|&w| if w.is_finite() && w > 0.0 { w } else { 0.0 }).collect();
        let sum: f64 = clean.iter().sum();
        let n = clean.len();
        let p: Vec<f64> = clean.iter().map(|&w| if sum > 0.0 { w / sum } else { 1.0 / n as f64 }).collect();
        let mut columns: Vec<Column> = p
            .iter()
            .enumerate()
            .map(|(i, &q)| Column { keep: 1.0, alias: i as u32, probability: q as f32 })
            .collect();
        let mut scaled: Vec<f64> = p.iter().map(|q| q * n as f64).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| scaled[i] < 1.0);
        while let (Some(&s), Some(&l)) = (small.last(), large.last()) {
            small.pop();
            columns[s].keep = scaled[s] as f32;
            columns[s].alias = l as u32;
            scaled[l] -= 1.0 - scaled[s];
            if scaled[l] < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        Self { columns }
    }

    /// How many indices there are.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether there is nothing to pick.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Picks an index; also gives its probability and a fresh number in [0, 1) left over from `u`.
    ///
    /// In double precision, for [`refined`] numbers: what is left over has log₂ n digits less than `u` had.
    #[inline]
    pub fn sample(&self, u: f64) -> (usize, Real, f64) {
        let n = self.columns.len();
        let x = u * n as f64;
        let i = (x as usize).min(n - 1);
        let c = self.columns[i];
        let (f, keep) = (x - i as f64, f64::from(c.keep));
        let (picked, rest) =
            if f < keep { (i, f / keep) } else { (c.alias as usize, (f - keep) / (1.0 - keep)) };
        (picked, self.columns[picked].probability as Real, rest.clamp(0.0, 1.0 - f64::EPSILON))
    }

    /// Probability of an index.
    #[inline]
    pub fn probability(&self, i: usize) -> Real {
        self.columns[i].probability as Real
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Chi-square over the 4 cells of positive weight, 3 degrees of freedom: 1e-5 quantile is 25.9.
    #[test]
    fn picks_with_the_stated_probabilities() {
        let weights = [1.0, 0.0, 3.0, 5.0, 0.5];
        let table = AliasTable::new(&weights);
        let n = 100_000;
        let mut counts = [0usize; 5];
        let mut rest_sum = 0.0;
        let mut rng = Rng::new(3);
        for _ in 0..n {
            let (i, p, rest) = table.sample(rng.next_real().to_f64());
            assert!((p as f64 - weights[i] / 9.5).abs() < 1e-6);
            counts[i] += 1;
            rest_sum += rest;
        }
        assert_eq!(counts[1], 0);
        let chi2: f64 = [0, 2, 3, 4]
            .iter()
            .map(|&i| {
                let e = weights[i] / 9.5 * n as f64;
                (counts[i] as f64 - e).powi(2) / e
            })
            .sum();
        assert!(chi2 < 25.9, "{chi2}");
        assert!((rest_sum / n as f64 - 0.5).abs() < 4.4 / (12.0 * n as f64).sqrt());
    }

    /// Of 100,000 indices each hundredth has a probability of 10⁻⁷, which is 1.7 of the numbers that have 24
    /// digits. An index is met in a run of numbers; how long the runs are is found by halving steps.
    #[test]
    fn rare_indices_among_many_are_picked_with_the_stated_probabilities() {
        let n = 100_000;
        let rare = |i: usize| i.is_multiple_of(100);
        let weights: Vec<f64> = (0..n).map(|i| if rare(i) { 1e-7 } else { 1e-5 }).collect();
        let sum: f64 = weights.iter().sum();
        let table = AliasTable::new(&weights);
        let steps = 1u64 << 24;
        let digits = |x: f64| {
            let coarse = (x * steps as f64).floor();
            ((coarse / steps as f64) as Real, (x * steps as f64 - coarse) as Real)
        };
        let picked = |x: f64| {
            let (coarse, fine) = digits(x);
            table.sample(refined(coarse, fine)).0
        };
        for i in (0..n).filter(|&i| rare(i)) {
            let (start, next) = (i as f64 / n as f64, (i + 1) as f64 / n as f64);
            let (mut inside, mut outside) = (start + 1e-10, next - 1e-10);
            assert!(picked(inside) == i && picked(outside) != i);
            while outside - inside > 1e-13 {
                let middle = f64::midpoint(inside, outside);
                if picked(middle) == i { inside = middle } else { outside = middle }
            }
            let share = (outside - start) / (weights[i] / sum);
            assert!((share - 1.0).abs() < 1e-5, "{i}: {share}");
        }
    }

    #[test]
    fn refined_numbers_are_in_order_and_below_one() {
        let last = 1.0 - Real::EPSILON / 2.0;
        assert!(refined(last, last) < 1.0 && refined(0.0, 0.0) == 0.0);
        assert!(refined(0.25, last) < refined(0.25 + 1.0 / (1 << 24) as Real, 0.0));
    }

    #[test]
    fn odd_weights_are_harmless() {
        assert!(AliasTable::new(&[]).is_empty());
        assert_eq!(AliasTable::new(&[0.0, 0.0]).probability(1), 0.5);
        assert_eq!(AliasTable::new(&[f64::NAN, 2.0, f64::INFINITY]).sample(0.999).0, 1);
        assert_eq!(AliasTable::new(&[-1.0, 2.0]).sample(0.0).0, 1);
    }
}
