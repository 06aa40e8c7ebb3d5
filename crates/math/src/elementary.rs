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

#[cfg(test)]
mod tests {
    use super::*;

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
