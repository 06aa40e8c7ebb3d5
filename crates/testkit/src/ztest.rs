//! Does the mean of samples agree with an exact value, or with another mean?

use std::fmt;

use crate::special::student_two_sided_p;
use crate::stats::Moments;

/// A mean has failed when its p-value falls below this, unless the test says otherwise.
pub const DEFAULT_THRESHOLD: f64 = 1e-4;

/// Two means, how far apart they are and how surprising that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanTest {
    /// Mean of the samples.
    pub mean: f64,
    /// What it is compared with.
    pub expected: f64,
    /// Standard error of the difference.
    pub std_error: f64,
    /// Difference / standard error; infinite where a difference has no error to excuse it, NaN (and
    /// p = 0) where a mean is not a number.
    pub t: f64,
    /// Degrees of freedom of Student's t.
    pub dof: f64,
    /// Two-sided p-value.
    pub p: f64,
    /// The p-value below which the test fails.
    pub threshold: f64,
}

impl MeanTest {
    /// Whether the deviation is one that chance explains.
    pub fn passed(&self) -> bool {
        self.p >= self.threshold
    }

    /// The same test judged at another threshold.
    #[must_use]
    pub fn at(self, threshold: f64) -> Self {
        Self { threshold, ..self }
    }
}

impl fmt::Display for MeanTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "mean {:.6e} against {:.6e}: difference {:+.3e} = {:+.2} standard errors of {:.2e} \
             ({:.0} degrees of freedom), p = {:.3e}, {} at {:.1e}",
            self.mean,
            self.expected,
            self.mean - self.expected,
            self.t,
            self.std_error,
            self.dof,
            self.p,
            if self.passed() { "passed" } else { "FAILED" },
            self.threshold
        )
    }
}

/// Two-sided one-sample t-test: samples with these moments against an exact value.
///
/// Student's t, not the normal distribution, so that few samples are not held to more than they know.
/// It is exact for normal data and good for means of many samples: give it batch means
/// ([`crate::stats::batch_means`]), not single path contributions, whose skew it knows nothing of.
pub fn mean_against(samples: &Moments, exact: f64) -> MeanTest {
    welch(samples, &Moments::exact(exact), 0.0)
}

/// Welch's t-test: do two sets of samples have one mean, whatever their variances (Welch 1947)?
///
/// `rounding` is a difference that is nobody's fault (the arithmetic's own error, in the samples'
/// unit); it is taken off the difference before judging. 0 judges every bit.
pub fn welch(a: &Moments, b: &Moments, rounding: f64) -> MeanTest {
    let (var_a, var_b) = (a.variance_of_mean(), b.variance_of_mean());
    let variance = var_a + var_b;
    let difference = a.mean() - b.mean();
    let excess = (difference.abs() - rounding).max(0.0).copysign(difference);
    let dof = welch_dof([var_a, var_b], [a.count(), b.count()]);
    let (t, p) = if difference.is_nan() || variance.is_nan() {
        // `max` above loses a NaN; it must not pass.
        (f64::NAN, 0.0)
    } else if variance > 0.0 {
        let t = excess / variance.sqrt();
        (t, student_two_sided_p(t, dof))
    } else if excess == 0.0 {
        (0.0, 1.0)
    } else {
        // Constants that differ.
        (f64::INFINITY.copysign(difference), 0.0)
    };
    MeanTest {
        mean: a.mean(),
        expected: b.mean(),
        std_error: variance.sqrt(),
        t,
        dof,
        p,
        threshold: DEFAULT_THRESHOLD,
    }
}

/// Welch and Satterthwaite's effective degrees of freedom.
fn welch_dof(variance_of_mean: [f64; 2], counts: [u64; 2]) -> f64 {
    let total = variance_of_mean[0] + variance_of_mean[1];
    let denominator: f64 = variance_of_mean
        .iter()
        .zip(counts)
        .map(|(v, n)| (v / total).powi(2) / n.saturating_sub(1).max(1) as f64)
        .sum();
    if total > 0.0 { 1.0 / denominator } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;
    use crate::special::binomial_two_sided_p;
    use crate::stats::batch_means;

    /// Runs 2,000 nulls; the count of alarms must be one that a binomial of the stated rate gives.
    fn false_alarms_are_as_stated(seed: u64, rate: f64, mut null_p: impl FnMut(&mut Rng) -> f64) {
        let mut rng = Rng::new(seed);
        let alarms = (0..2000).filter(|_| null_p(&mut rng) < rate).count() as u64;
        let p = binomial_two_sided_p(alarms, 2000, rate);
        assert!(p > 1e-3, "{alarms} alarms in 2000 at a stated rate of {rate}: p = {p}");
    }

    #[test]
    fn false_alarm_rate_with_few_normal_samples() {
        // Five samples: the normal distribution would alarm at 12% instead of 5%.
        for (seed, rate) in [(11, 0.05), (12, 0.01)] {
            false_alarms_are_as_stated(seed, rate, |rng| {
                mean_against(&Moments::of((0..5).map(|_| 2.0 + rng.normal())), 2.0).p
            });
        }
    }

    #[test]
    fn false_alarm_rate_with_batches_of_skewed_samples() {
        // Exponential samples, as skewed as a diffuse path's; 32 batches of 64.
        false_alarms_are_as_stated(13, 0.02, |rng| {
            let samples: Vec<f64> = (0..2048).map(|_| -(1.0 - rng.uniform()).ln()).collect();
            mean_against(&batch_means(&samples, 32), 1.0).p
        });
    }

    #[test]
    fn false_alarm_rate_of_welch_with_unequal_variances() {
        false_alarms_are_as_stated(14, 0.02, |rng| {
            let a = Moments::of((0..8).map(|_| 1.0 + rng.normal()));
            let b = Moments::of((0..12).map(|_| 1.0 + 5.0 * rng.normal()));
            welch(&a, &b, 0.0).p
        });
    }

    #[test]
    fn a_bias_of_one_percent_is_caught() {
        // 10,000 exponential samples of mean 1.01 in 100 batches against 1: one standard error only;
        // a million samples: ten. The latter must be caught nearly always.
        let mut rng = Rng::new(15);
        let caught = (0..20)
            .filter(|_| {
                let samples: Vec<f64> = (0..1_000_000).map(|_| -1.01 * (1.0 - rng.uniform()).ln()).collect();
                !mean_against(&batch_means(&samples, 100), 1.0).passed()
            })
            .count();
        assert_eq!(caught, 20);
    }

    #[test]
    fn constants_must_agree_to_rounding() {
        let seven = Moments::from_parts(4, 7.0, 0.0);
        assert!(mean_against(&seven, 7.0).passed());
        assert!(!mean_against(&seven, 7.000_001).passed());
        assert!(welch(&seven, &Moments::exact(7.000_001), 1e-5).passed());
        assert!(!mean_against(&Moments::from_parts(4, f64::NAN, 0.0), 7.0).passed());
        assert!(!mean_against(&Moments::from_parts(4, f64::NAN, f64::NAN), 7.0).passed());
    }

    #[test]
    fn display_says_everything() {
        let text = mean_against(&Moments::of([1.0, 2.0, 3.0]), 2.5).at(0.01).to_string();
        for part in ["mean 2.0", "against 2.5", "2 degrees", "p = ", "passed at 1.0e-2"] {
            assert!(text.contains(part), "{text} lacks {part}");
        }
    }
}
