//! The distribution functions that p-values come from.

use std::f64::consts::{PI, SQRT_2};

/// A term smaller than this part of its sum changes nothing.
const EPSILON: f64 = 1e-16;
/// Keeps Lentz's continued fractions from dividing by zero.
const TINY: f64 = 1e-300;
/// Series and fractions here converge in about sqrt(parameter) steps; this suffices for 10^9.
const MAX_STEPS: u32 = 200_000;

/// ln Γ(x) for x > 0, to about 1e-14 (Lanczos 1964, with g = 7 and nine coefficients).
pub fn ln_gamma(x: f64) -> f64 {
    const G: f64 = 7.0;
    const C: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    if x < 0.5 {
        // Reflection keeps the series in the half plane where it is accurate.
        return (PI / (PI * x).sin()).ln() - ln_gamma(1.0 - x);
    }
    let x = x - 1.0;
    let t = x + G + 0.5;
    let sum = C.iter().enumerate().skip(1).fold(C[0], |sum, (i, c)| sum + c / (x + i as f64));
    0.5 * (2.0 * PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

/// Q(a, x) = Γ(a, x) / Γ(a), the upper regularised incomplete gamma function, a > 0, x >= 0.
///
/// Series below x = a + 1, continued fraction above (Abramowitz and Stegun 6.5.29 and 6.5.31).
pub fn gamma_q(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 { 1.0 - front * gamma_series(a, x) } else { front * gamma_fraction(a, x) }
}

/// Σ x^n / (a (a+1) ... (a+n)).
fn gamma_series(a: f64, x: f64) -> f64 {
    let mut term = 1.0 / a;
    let mut sum = term;
    for n in 1..MAX_STEPS {
        term *= x / (a + f64::from(n));
        sum += term;
        if term < sum * EPSILON {
            break;
        }
    }
    sum
}

/// 1/(x+1-a- 1(1-a)/(x+3-a- 2(2-a)/(x+5-a- ...))) by the modified Lentz method.
fn gamma_fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..MAX_STEPS {
        let i = f64::from(i);
        let numerator = -i * (i - a);
        b += 2.0;
        d = 1.0 / non_zero(numerator * d + b);
        c = non_zero(b + numerator / c);
        h *= d * c;
        if (d * c - 1.0).abs() < EPSILON * 10.0 {
            break;
        }
    }
    h
}

fn non_zero(x: f64) -> f64 {
    if x.abs() < TINY { TINY } else { x }
}

/// P(χ² >= statistic) with `dof` degrees of freedom.
pub fn chi2_p(statistic: f64, dof: f64) -> f64 {
    gamma_q(0.5 * dof, 0.5 * statistic)
}

/// P(|Z| >= |z|) of a standard normal Z.
pub fn normal_two_sided_p(z: f64) -> f64 {
    // erfc(|z| / sqrt 2) = Q(1/2, z²/2).
    gamma_q(0.5, 0.5 * z * z)
}

/// P(Z >= z) of a standard normal Z.
pub fn normal_upper_p(z: f64) -> f64 {
    let two_sided = normal_two_sided_p(z);
    if z >= 0.0 { 0.5 * two_sided } else { 1.0 - 0.5 * two_sided }
}

/// P(|T| >= |t|) of Student's t with `dof` > 0 degrees of freedom (not necessarily whole).
pub fn student_two_sided_p(t: f64, dof: f64) -> f64 {
    if dof > 1e8 {
        return normal_two_sided_p(t);
    }
    beta_i(0.5 * dof, 0.5, dof / (dof + t * t))
}

/// I_x(a, b), the regularised incomplete beta function, 0 <= x <= 1 (Abramowitz and Stegun 26.5.8).
pub fn beta_i(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    let ln_front = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p();
    // The fraction converges fast on the near side of the mean; reflect from the far side.
    if x < (a + 1.0) / (a + b + 2.0) {
        ln_front.exp() * beta_fraction(a, b, x) / a
    } else {
        1.0 - ln_front.exp() * beta_fraction(b, a, 1.0 - x) / b
    }
}

fn beta_fraction(a: f64, b: f64, x: f64) -> f64 {
    let mut c = 1.0;
    let mut d = 1.0 / non_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut h = d;
    for m in 1..MAX_STEPS {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut step = 1.0;
        for coefficient in [even, odd] {
            d = 1.0 / non_zero(1.0 + coefficient * d);
            c = non_zero(1.0 + coefficient / c);
            step = d * c;
            h *= step;
        }
        if (step - 1.0).abs() < EPSILON * 10.0 {
            break;
        }
    }
    h
}

/// P(X >= k) for X Poisson with this mean.
pub fn poisson_upper_p(k: u64, mean: f64) -> f64 {
    if k == 0 { 1.0 } else { 1.0 - gamma_q(k as f64, mean) }
}

/// P(X >= k) for X binomial with `n` trials of probability `p`.
pub fn binomial_upper_p(k: u64, n: u64, p: f64) -> f64 {
    if k == 0 { 1.0 } else { beta_i(k as f64, (n - k + 1) as f64, p) }
}

/// The smaller tail of the binomial distribution at `k`, doubled and cut at 1: a two-sided p-value.
pub fn binomial_two_sided_p(k: u64, n: u64, p: f64) -> f64 {
    let upper = binomial_upper_p(k, n, p);
    let lower = if k >= n { 1.0 } else { 1.0 - binomial_upper_p(k + 1, n, p) };
    (2.0 * upper.min(lower)).min(1.0)
}

/// Šidák's per-test level: `tests` independent tests at this level raise any false alarm with
/// probability `family` (Šidák 1967); fewer, if the tests are positively dependent.
pub fn sidak(family: f64, tests: usize) -> f64 {
    // -expm1(ln1p(-f)/m) keeps its digits where 1 - (1 - f)^(1/m) loses them all.
    -((-family).ln_1p() / tests.max(1) as f64).exp_m1()
}

/// The error function's complement for any x; here for callers that compare with closed forms.
pub fn erfc(x: f64) -> f64 {
    2.0 * normal_upper_p(x * SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not {expected}");
    }

    #[test]
    fn ln_gamma_at_known_points() {
        close(ln_gamma(0.5), PI.sqrt().ln(), 1e-13);
        close(ln_gamma(5.0), 24f64.ln(), 1e-13);
        close(ln_gamma(0.1), 2.252_712_651_734_206, 1e-13);
        close(ln_gamma(101.0), 363.739_375_555_563_5, 1e-13);
        assert!(ln_gamma(1.0).abs() < 1e-14);
    }

    #[test]
    fn gamma_q_against_closed_forms() {
        // Q(1, x) = e^-x; Q(n, x) is a Poisson sum; Q(1/2, x) = erfc(sqrt x).
        for x in [0.01, 0.5, 1.9, 2.1, 10.0, 50.0f64] {
            close(gamma_q(1.0, x), (-x).exp(), 1e-12);
            close(gamma_q(3.0, x), (-x).exp() * (1.0 + x + 0.5 * x * x), 1e-12);
        }
        close(gamma_q(0.5, 1.0), 0.157_299_207_050_285_13, 1e-12);
    }

    #[test]
    fn chi_square_critical_values_of_the_tables() {
        // Abramowitz and Stegun, table 26.8: the 5% and 0.1% points, the former with more digits.
        close(chi2_p(3.841_458_820_694_124, 1.0), 0.05, 1e-12);
        close(chi2_p(18.307_038_053_275_146, 10.0), 0.05, 1e-12);
        close(chi2_p(149.449, 100.0), 0.001, 1e-4);
    }

    #[test]
    fn chi_square_of_many_degrees_is_nearly_normal() {
        // Median of χ² with k degrees: k (1 - 2/(9k))³ to O(1/k).
        let k = 1e6f64;
        let median = k * (1.0 - 2.0 / (9.0 * k)).powi(3);
        close(chi2_p(median, k), 0.5, 1e-6);
    }

    #[test]
    fn normal_and_student_points_of_the_tables() {
        close(normal_two_sided_p(1.959_963_984_540_054), 0.05, 1e-12);
        close(normal_upper_p(5.0), 2.866_515_718_791_939e-7, 1e-10);
        close(normal_upper_p(-1.0), 0.841_344_746_068_542_9, 1e-12);
        close(student_two_sided_p(12.706_204_736_432_1, 1.0), 0.05, 1e-10);
        close(student_two_sided_p(2.228_138_851_964_94, 10.0), 0.05, 1e-10);
        // One degree of freedom is the Cauchy distribution.
        close(student_two_sided_p(3.0, 1.0), 1.0 - 2.0 / PI * 3f64.atan(), 1e-12);
        close(student_two_sided_p(2.0, 1e7), normal_two_sided_p(2.0), 1e-5);
    }

    #[test]
    fn erfc_at_known_points() {
        close(erfc(1.0), 0.157_299_207_050_285_13, 1e-12);
        close(erfc(-0.5), 1.520_499_877_813_046_5, 1e-12);
    }

    #[test]
    fn incomplete_beta_against_closed_forms() {
        // I_x(1, b) = 1 - (1-x)^b; I_x(2, 2) = x²(3-2x); I_x(a,b) = 1 - I_{1-x}(b,a).
        for x in [0.05, 0.3, 0.5, 0.9] {
            close(beta_i(1.0, 4.0, x), 1.0 - (1.0 - x).powi(4), 1e-12);
            close(beta_i(2.0, 2.0, x), x * x * (3.0 - 2.0 * x), 1e-12);
            close(beta_i(3.5, 7.25, x), 1.0 - beta_i(7.25, 3.5, 1.0 - x), 1e-11);
        }
    }

    #[test]
    fn binomial_tails_by_summation() {
        // P(X >= 2), n = 5, p = 0.3: 1 - 0.7^5 - 5 0.3 0.7^4.
        close(binomial_upper_p(2, 5, 0.3), 1.0 - 0.7f64.powi(5) - 1.5 * 0.7f64.powi(4), 1e-12);
        close(binomial_two_sided_p(5, 5, 0.5), 2.0 / 32.0, 1e-12);
        close(binomial_two_sided_p(0, 5, 0.5), 2.0 / 32.0, 1e-12);
    }

    #[test]
    fn poisson_tails_by_summation() {
        close(poisson_upper_p(1, 0.5), -(-0.5f64).exp_m1(), 1e-12);
        close(poisson_upper_p(3, 2.0), 1.0 - 5.0 * (-2f64).exp(), 1e-12);
        assert_eq!(poisson_upper_p(0, 2.0), 1.0);
        assert_eq!(poisson_upper_p(1, 0.0), 0.0);
    }

    #[test]
    fn sidak_restores_the_family_level() {
        for tests in [1usize, 7, 10_000] {
            let level = sidak(1e-4, tests);
            close(-((-level).ln_1p() * tests as f64).exp_m1(), 1e-4, 1e-12);
        }
        assert_eq!(sidak(0.05, 0), sidak(0.05, 1));
    }
}
