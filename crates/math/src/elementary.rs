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

#[cfg(test)]
mod tests {
    use super::*;

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
