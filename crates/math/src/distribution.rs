//! Discrete distributions.

use crate::{Float, Real};

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
    /// In double precision: in single precision the product of `u` and a large number of indices would
    /// be rounded to less than its digits. What remains is that `u` itself has 24 bits, so that an
    /// index of n is picked with its probability to n / 2²⁴ of it.
    #[inline]
    pub fn sample(&self, u: Real) -> (usize, Real, Real) {
        let n = self.columns.len();
        let x = u.to_f64() * n as f64;
        let i = (x as usize).min(n - 1);
        let c = self.columns[i];
        let (f, keep) = (x - i as f64, f64::from(c.keep));
        let (picked, rest) =
            if f < keep { (i, f / keep) } else { (c.alias as usize, (f - keep) / (1.0 - keep)) };
        (picked, self.columns[picked].probability as Real, (rest as Real).clamp(0.0, 1.0 - Real::EPSILON))
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
            let (i, p, rest) = table.sample(rng.next_real());
            assert!((p as f64 - weights[i] / 9.5).abs() < 1e-6);
            counts[i] += 1;
            rest_sum += rest as f64;
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

    /// Every number of 24 bits once: the part of them that goes to each half of a million indices.
    #[test]
    fn many_indices_are_picked_with_the_stated_probabilities() {
        let n = 1_000_000;
        let weights: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { 1.0 } else { 19.0 }).collect();
        let table = AliasTable::new(&weights);
        let all = 1u32 << 24;
        let rare = (0..all).filter(|&u| table.sample(u as Real / all as Real).0.is_multiple_of(2)).count();
        let share = rare as f64 / f64::from(all);
        assert!((share - 0.05).abs() < 1e-4, "{share}");
    }

    #[test]
    fn odd_weights_are_harmless() {
        assert!(AliasTable::new(&[]).is_empty());
        assert_eq!(AliasTable::new(&[0.0, 0.0]).probability(1), 0.5);
        assert_eq!(AliasTable::new(&[f64::NAN, 2.0, f64::INFINITY]).sample(0.999).0, 1);
        assert_eq!(AliasTable::new(&[-1.0, 2.0]).sample(0.0).0, 1);
    }
}
