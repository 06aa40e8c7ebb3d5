//! Elementary functions with the same bits on every platform.
//!
//! The standard library leaves the last bits of `sin` and its kin to the platform, and a picture must
//! not depend on it. Polynomials are Taylor series cut where the remainder drops below half an ulp
//! of `f32` (of `f64` in the oracle build), evaluated by Horner's rule in `Real`.

use crate::Real;

const TAU: Real = std::f64::consts::TAU as Real;

/// Sine and cosine of an angle given in turns (1 = 360°); any finite argument.
///
/// Absolute error below 2e-7 in single precision.
#[inline]
pub fn sin_cos_turns(turns: Real) -> (Real, Real) {
    // To the nearest quarter turn: exact, since both numbers are near each other.
    let quarter = (turns * 4.0).round_ties_even();
    let x = (turns - quarter * 0.25) * TAU;
    let (s, c) = (sin_octant(x), cos_octant(x));
    match (quarter as i64) & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// sin x for |x| <= π/4.
#[inline]
fn sin_octant(x: Real) -> Real {
    let y = x * x;
    let p = if size_of::<Real>() == 4 {
        1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362_880.0))
    } else {
        1.0 / 120.0
            + y * (-1.0 / 5040.0
                + y * (1.0 / 362_880.0
                    + y * (-1.0 / 39_916_800.0 + y * (1.0 / 6_227_020_800.0 - y / 1_307_674_368_000.0))))
    };
    x + x * y * (-1.0 / 6.0 + y * p)
}

/// cos x for |x| <= π/4.
#[inline]
fn cos_octant(x: Real) -> Real {
    let y = x * x;
    let p = if size_of::<Real>() == 4 {
        1.0 / 24.0 + y * (-1.0 / 720.0 + y * (1.0 / 40_320.0 - y / 3_628_800.0))
    } else {
        1.0 / 24.0
            + y * (-1.0 / 720.0
                + y * (1.0 / 40_320.0
                    + y * (-1.0 / 3_628_800.0 + y * (1.0 / 479_001_600.0 - y / 87_178_291_200.0))))
    };
    1.0 + y * (-0.5 + y * p)
}

/// Arc cosine of a number, which is limited to [-1, 1] first; in radians.
///
/// Error below two units of the last place of π, 5e-7 in single precision.
#[inline]
pub fn acos(x: Real) -> Real {
    const PI: Real = std::f64::consts::PI as Real;
    let c = x.abs().min(1.0);
    // Near 1 by half the angle: acos c = 2 asin √((1 - c) / 2), where both series have arguments up to 1/2.
    let acute = if c > 0.5 { 2.0 * asin_small((0.5 * (1.0 - c)).sqrt()) } else { 0.5 * PI - asin_small(c) };
    if x < 0.0 { PI - acute } else { acute }
}

/// Terms of the series of asin for arguments up to 1/2: the next one is below half an ulp.
const ASIN_TERMS: usize = if size_of::<Real>() == 4 { 10 } else { 24 };

/// asin x = Σ (2k)! / (4^k k!² (2k + 1)) x^(2k + 1) for |x| <= 1/2.
#[inline]
fn asin_small(x: Real) -> Real {
    const COEFFICIENTS: [Real; ASIN_TERMS] = asin_coefficients();
    let y = x * x;
    x * COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * y + c)
}

const fn asin_coefficients() -> [Real; ASIN_TERMS] {
    let mut c = [0.0; ASIN_TERMS];
    let (mut binomial, mut k) = (1.0, 0);
    while k < ASIN_TERMS {
        c[k] = (binomial / (2 * k + 1) as f64) as Real;
        binomial *= (2 * k + 1) as f64 / (2 * k + 2) as f64;
        k += 1;
    }
    c
}

/// e^x: 0 from far below on, infinite from far above.
///
/// Relative error below 2e-7 in single precision.
#[inline]
pub fn exp(x: Real) -> Real {
    // Beyond these even double precision ends, and the quotient below stays small.
    if x < -745.0 {
        return 0.0;
    }
    if x > 710.0 {
        return Real::INFINITY;
    }
    // x = k ln 2 + r with |r| <= ln 2 / 2; the first part of ln 2 has so few bits that k times it is exact.
    let k = (x * std::f64::consts::LOG2_E as Real).round_ties_even();
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    // The remainder of the series is below half an ulp: r^8 / 8! = 5e-9, r^14 / 14! = 4e-18.
    let p = if size_of::<Real>() == 4 {
        horner(r, &[1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0])
    } else {
        horner(
            r,
            &[
                1.0 / 6_227_020_800.0,
                1.0 / 479_001_600.0,
                1.0 / 39_916_800.0,
                1.0 / 3_628_800.0,
                1.0 / 362_880.0,
                1.0 / 40_320.0,
                1.0 / 5040.0,
                1.0 / 720.0,
                1.0 / 120.0,
                1.0 / 24.0,
                1.0 / 6.0,
                0.5,
                1.0,
                1.0,
            ],
        )
    };
    // 2^k in two factors, so that neither leaves the range of double precision.
    let k = k as i64;
    let power = |k: i64| f64::from_bits(((k + 1023) as u64) << 52);
    (p as f64 * power(k / 2) * power(k - k / 2)) as Real
}

/// Natural logarithm of a positive, finite and normal number.
///
/// Absolute error below 1e-7 of the larger of 1 and the result in single precision, and relative
/// error as small near x = 1.
#[inline]
pub fn ln(x: Real) -> Real {
    // x = m 2^k with m in [√½, √2).
    let bits = (x as f64).to_bits();
    let offset = bits.wrapping_sub(std::f64::consts::FRAC_1_SQRT_2.to_bits());
    let k = (offset as i64) >> 52;
    let m = f64::from_bits(bits.wrapping_sub((k as u64) << 52)) as Real;
    // ln m = 2 artanh s = 2 (s + s³/3 + s⁵/5 + …) with |s| < 0.1716; the first term left out is below
    // half an ulp: s^10 / 11 = 2e-9, s^20 / 21 = 2e-17 of the sum.
    let s = (m - 1.0) / (m + 1.0);
    let y = s * s;
    let series = if size_of::<Real>() == 4 {
        horner(y, &[1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0])
    } else {
        horner(
            y,
            &[
                1.0 / 19.0,
                1.0 / 17.0,
                1.0 / 15.0,
                1.0 / 13.0,
                1.0 / 11.0,
                1.0 / 9.0,
                1.0 / 7.0,
                1.0 / 5.0,
                1.0 / 3.0,
            ],
        )
    };
    k as Real * std::f64::consts::LN_2 as Real + (2.0 * s + 2.0 * s * y * series)
}

/// ln 2 rounded to 14 binary places, and the rest.
const LN_2_HIGH: Real = 11356.0 / 16384.0;
const LN_2_LOW: Real = (std::f64::consts::LN_2 - 11356.0 / 16384.0) as Real;

/// A polynomial with its coefficients from the highest power down.
#[inline(always)]
fn horner(x: Real, coefficients: &[Real]) -> Real {
    coefficients.iter().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two ulps of the kernel's scalar.
    const TOLERANCE: f64 = 2.0 * Real::EPSILON as f64;

    #[test]
    fn the_exponential_agrees_with_the_standard_library() {
        for i in -80_000..80_000 {
            let x = i as Real * 1e-3 + 1e-4;
            let exact = (x as f64).exp();
            assert!((exp(x) as f64 / exact - 1.0).abs() < TOLERANCE, "{x}: {} {exact}", exp(x));
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!([exp(Real::NEG_INFINITY), exp(-1e4)], [0.0, 0.0]);
        assert_eq!([exp(Real::INFINITY), exp(1e4)], [Real::INFINITY; 2]);
        assert!(exp(Real::NAN).is_nan());
    }

    #[test]
    fn the_logarithm_agrees_with_the_standard_library() {
        let mut x: Real = 1e-30;
        while x < 1e30 {
            let exact = (x as f64).ln();
            assert!(
                (ln(x) as f64 - exact).abs() < TOLERANCE * exact.abs().max(0.5),
                "{x}: {} {exact}",
                ln(x)
            );
            x *= 1.0137;
        }
        for i in 1..1000 {
            let x = 1.0 - i as Real * 1e-4;
            let exact = (x as f64).ln();
            assert!((ln(x) as f64 / exact - 1.0).abs() < TOLERANCE, "{x}: {} {exact}", ln(x));
        }
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn arc_cosine_agrees_with_the_standard_library() {
        for i in -2000..=2000 {
            let x = i as Real / 2000.0;
            assert!((acos(x) as f64 - (x as f64).acos()).abs() < 5e-7, "{x}: {}", acos(x));
        }
        assert_eq!((acos(1.0), acos(2.0)), (0.0, 0.0));
        assert_eq!(acos(-3.0), std::f64::consts::PI as Real);
    }

    #[test]
    fn agrees_with_the_standard_library() {
        for i in -4000..4000 {
            let t = i as Real / 1000.0 + 1e-4;
            let (s, c) = sin_cos_turns(t);
            let exact = (t as f64 * std::f64::consts::TAU).sin_cos();
            assert!((s as f64 - exact.0).abs() < 2e-7 && (c as f64 - exact.1).abs() < 2e-7, "{t}");
        }
        assert_eq!(sin_cos_turns(0.25), (1.0, 0.0));
        assert_eq!(sin_cos_turns(0.0), (0.0, 1.0));
    }
}
