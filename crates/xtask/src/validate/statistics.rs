//! Means of independent renders, and how surprising it is that they differ.
//!
//! Written apart from the statistics of the renderer's own tests: what judges the pictures shares nothing with
//! what makes them.

/// Mean of independent estimates and what it is known to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// How many there were.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Its standard error: the square root of the unbiased sample variance over the count.
    pub error: f64,
}

impl Estimate {
    /// Of some values.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let error = if values.len() > 1 { (squares / (n - 1.0) / n).sqrt() } else { f64::INFINITY };
        Self { count: values.len(), mean, error }
    }

    /// Half of the interval that holds the truth with 95 % by Student's t.
    pub fn half_interval(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { quantile(0.05, (self.count.max(2) - 1) as f64) * self.error }
    }

    /// A number that is known.
    pub fn exact(value: f64) -> Self {
        Self { count: usize::MAX, mean: value, error: 0.0 }
    }
}

/// Two means compared by Welch's t-test (Welch 1947).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Difference over its standard error; infinite where nothing excuses a difference.
    pub t: f64,
    /// Standard error of the difference.
    pub error: f64,
    /// Degrees of freedom of Student's t.
    pub freedom: f64,
    /// Probability that means of one expectation differ as much, on either side.
    pub p: f64,
}

impl Comparison {
    /// Of two means; `allowance` is taken off the difference first: digits that an expectation was rounded to.
    pub fn of(a: &Estimate, b: &Estimate, allowance: f64) -> Self {
        let (va, vb) = (a.error.powi(2), b.error.powi(2));
        let error = (va + vb).sqrt();
        let difference = a.mean - b.mean;
        let excess = (difference.abs() - allowance).max(0.0).copysign(difference);
        let share = |v: f64, n: usize| if v > 0.0 { v * v / (n.max(2) - 1) as f64 } else { 0.0 };
        let freedom = (va + vb).powi(2) / (share(va, a.count) + share(vb, b.count));
        let freedom = if freedom.is_finite() { freedom } else { 1.0 };
        let (t, p) = match (difference.is_finite() && error.is_finite(), excess == 0.0, error > 0.0) {
            (false, ..) => (f64::NAN, 0.0),
            (_, true, _) => (0.0, 1.0),
            (_, _, true) => (excess / error, two_sided(excess / error, freedom)),
            (_, _, false) => (f64::INFINITY.copysign(difference), 0.0),
        };
        Self { t, error, freedom, p }
    }
}

/// Threshold of each of `tests` independent tests such that all of them together raise a false alarm with the
/// probability `family` (Šidák 1967).
pub fn sidak(family: f64, tests: usize) -> f64 {
    -((-family).ln_1p() / tests.max(1) as f64).exp_m1()
}

/// Probability that |t| of Student's distribution is at least so large: I_x(ν/2, 1/2) with x = ν/(ν + t²).
pub fn two_sided(t: f64, freedom: f64) -> f64 {
    incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5)
}

/// The |t| that is reached with a probability.
pub fn quantile(p: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while two_sided(high, freedom) > p && high < 1e12 {
        high *= 2.0;
    }
    // Sixty halvings exhaust double precision.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if two_sided(middle, freedom) > p { low = middle } else { high = middle }
    }
    high
}

/// How many times as large as it truly is a standard error may come out, with a probability: √(χ² / ν) of its degrees of freedom, by
/// Wilson and Hilferty's cube root (1931).
pub fn inflation(p: f64, freedom: f64) -> f64 {
    const NORMAL: f64 = 1e7;
    let spread = 2.0 / (9.0 * freedom);
    (1.0 - spread + quantile(2.0 * p, NORMAL) * spread.sqrt()).powf(1.5)
}

/// Regularised incomplete beta function by its continued fraction (Abramowitz and Stegun 26.5.8), evaluated from the
/// front by the recurrence of Wallis with numerators and denominators kept near one.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges quickly below the mean alone.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(1.0 - x, b, a);
    }
    let front = (a * x.ln() + b * (-x).ln_1p() - a.ln() - ln_beta(a, b)).exp();
    let (mut p0, mut q0, mut p1, mut q1) = (1.0, 0.0, 1.0, 1.0);
    let mut value = 1.0;
    for i in 1..500 {
        let m = f64::from(i / 2);
        let coefficient = if i % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        let (p2, q2) = (p1 + coefficient * p0, q1 + coefficient * q0);
        (p0, q0, p1, q1) = (p1 / q2, q1 / q2, p2 / q2, 1.0);
        if i > 4 && (p1 / value - 1.0).abs() < 1e-15 {
            value = p1;
            break;
        }
        value = p1;
    }
    front / value
}

fn ln_beta(a: f64, b: f64) -> f64 {
    ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b)
}

/// Stirling's series (Abramowitz and Stegun 6.1.41) after the argument was raised above 10, where its first five
/// terms leave less than 1e-13.
fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut product) = (x, 1.0);
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let y = 1.0 / (x * x);
    let series = (1.0 / 12.0 - y * (1.0 / 360.0 - y * (1.0 / 1260.0 - y * (1.0 / 1680.0 - y / 1188.0)))) / x;
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series - f64::ln(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms_of_student() {
        // One degree of freedom is Cauchy's distribution, two have 1 - t / √(2 + t²).
        for t in [0.1f64, 1.0, 3.0, 40.0] {
            let cauchy = 1.0 - 2.0 / std::f64::consts::PI * t.atan();
            assert!((two_sided(t, 1.0) / cauchy - 1.0).abs() < 1e-10, "{t}");
            let two = 1.0 - t / (2.0 + t * t).sqrt();
            assert!((two_sided(t, 2.0) - two).abs() < 1e-12, "{t}");
        }
        // Tabulated: 2.131 has 5 % with 15 degrees of freedom; the normal distribution has 1.95996.
        assert!((quantile(0.05, 15.0) - 2.13145).abs() < 1e-5);
        assert!((quantile(0.05, 1e7) - 1.959_96).abs() < 1e-5);
    }

    /// Tabulated: 2.131 standard errors of 16 values, and 1.96 of very many.
    #[test]
    fn intervals_are_student_s() {
        let half = |count: usize| Estimate { count, mean: 5.0, error: 2.0 }.half_interval();
        assert!((half(16) - 4.262_9).abs() < 1e-3 && (half(10_000_000) - 3.919_93).abs() < 1e-3);
        assert_eq!(Estimate::exact(1.0).half_interval(), 0.0);
    }

    #[test]
    fn a_shifted_mean_is_surprising_and_a_right_one_is_not() {
        let values: Vec<f64> = (0..16).map(|i| 1.0 + 0.01 * f64::from(i % 4) - 0.015).collect();
        let estimate = Estimate::of(&values);
        assert!(Comparison::of(&estimate, &Estimate::exact(1.0), 0.0).p > 0.9);
        assert!(Comparison::of(&estimate, &Estimate::exact(1.05), 0.0).p < 1e-6);
        assert_eq!(Comparison::of(&estimate, &Estimate::exact(1.05), 0.06).p, 1.0);
        assert_eq!(Comparison::of(&Estimate::exact(f64::NAN), &estimate, 0.0).p, 0.0);
    }

    /// Tabulated: 37.697 and 103.442 are χ² of 15 and 63 degrees of freedom that are passed with 0.001.
    #[test]
    fn standard_errors_come_out_large_by_chance() {
        for (freedom, chi_square) in [(15.0, 37.697), (63.0, 103.442)] {
            let tabulated = f64::sqrt(chi_square / freedom);
            assert!((inflation(1e-3, freedom) / tabulated - 1.0).abs() < 2e-3, "{freedom}");
        }
    }

    #[test]
    fn many_tests_share_one_probability() {
        assert!((sidak(0.05, 1) - 0.05).abs() < 1e-15);
        assert!((1.0 - (1.0 - sidak(1e-3, 300)).powi(300) - 1e-3).abs() < 1e-12);
    }
}
