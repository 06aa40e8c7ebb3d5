//! Running mean and variance that can be merged.

/// Count, mean and sum of squared deviations of a stream of numbers.
///
/// Updated by Welford's method (Welford 1962) and merged by the formula of Chan, Golub and LeVeque
/// (1979): no cancellation even where the variance is tiny beside the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    /// Sum of (x - mean)².
    m2: f64,
}

impl Moments {
    /// The moments of all numbers of an iterator.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut moments = Self::default();
        for value in values {
            moments.add(value);
        }
        moments
    }

    /// Moments known from elsewhere: a number of values, their mean and their unbiased variance.
    pub fn from_parts(count: u64, mean: f64, variance: f64) -> Self {
        Self { count, mean, m2: variance * count.saturating_sub(1) as f64 }
    }

    /// An exactly known value: its mean has no uncertainty, whatever the count of the other side.
    pub fn exact(value: f64) -> Self {
        Self { count: u64::MAX, mean: value, m2: 0.0 }
    }

    /// Adds one number.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let delta = value - self.mean;
        self.mean += delta / self.count as f64;
        self.m2 += delta * (value - self.mean);
    }

    /// Adds all numbers of `other`.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (n_a, n_b) = (self.count as f64, other.count as f64);
        let n = n_a + n_b;
        let delta = other.mean - self.mean;
        self.mean += delta * (n_b / n);
        self.m2 += other.m2 + delta * delta * (n_a * n_b / n);
        self.count = self.count.saturating_add(other.count);
    }

    /// How many numbers were added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The arithmetic mean; 0 of nothing.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased sample variance (divisor n - 1); 0 of fewer than two numbers.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.m2 / (self.count - 1) as f64 }
    }

    /// The variance of the mean: variance / n.
    pub fn variance_of_mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.variance() / self.count as f64 }
    }

    /// The standard error of the mean.
    pub fn std_error(&self) -> f64 {
        self.variance_of_mean().sqrt()
    }
}

/// The moments of `batches` means of equally many consecutive numbers each.
///
/// Single path contributions are anything but normal; means of many are nearly so, and a test that
/// assumes normal data is honest on them. Numbers that fill no whole batch are left out.
pub fn batch_means(values: &[f64], batches: usize) -> Moments {
    let size = (values.len() / batches.max(1)).max(1);
    Moments::of(values.chunks_exact(size).take(batches).map(|batch| batch.iter().sum::<f64>() / size as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn closed_form_of_one_to_ten() {
        let moments = Moments::of((1..=10).map(f64::from));
        assert_eq!(moments.count(), 10);
        assert!((moments.mean() - 5.5).abs() < 1e-15);
        assert!((moments.variance() - 55.0 / 6.0).abs() < 1e-14);
    }

    #[test]
    fn no_cancellation_beside_a_large_mean() {
        let moments = Moments::of([1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0]);
        assert_eq!(moments.variance(), 30.0);
    }

    #[test]
    fn merging_equals_adding_in_any_split() {
        let mut rng = Rng::new(3);
        let values: Vec<f64> = (0..1000).map(|_| rng.normal() * 3.0 + 7.0).collect();
        let whole = Moments::of(values.iter().copied());
        for split in [0, 1, 17, 500, 999, 1000] {
            let mut left = Moments::of(values[..split].iter().copied());
            left.merge(&Moments::of(values[split..].iter().copied()));
            assert_eq!(left.count(), whole.count());
            assert!((left.mean() - whole.mean()).abs() < 1e-12);
            assert!((left.variance() - whole.variance()).abs() < 1e-11);
        }
    }

    #[test]
    fn parts_round_trip() {
        let moments = Moments::of([1.0, 2.0, 4.0]);
        let again = Moments::from_parts(moments.count(), moments.mean(), moments.variance());
        assert!((again.variance() - moments.variance()).abs() < 1e-15);
    }

    #[test]
    fn batch_means_have_a_batch_s_variance() {
        let mut rng = Rng::new(4);
        let values: Vec<f64> = (0..64_000).map(|_| rng.normal()).collect();
        let batched = batch_means(&values, 640);
        assert_eq!(batched.count(), 640);
        // Variance 1/100 with relative standard deviation sqrt(2/639) = 5.6%; five of them.
        assert!((batched.variance() * 100.0 - 1.0).abs() < 0.28, "{}", batched.variance());
    }
}
