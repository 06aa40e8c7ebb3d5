//! The angle of a point in the plane, with the same bits on every platform.

use crate::Real;

/// The angle of the point (x, y) from the x axis, in turns (1 = 360°) within [0, 1]; 0 at the origin.
///
/// Absolute error below 1e-7 in single precision. A full turn comes out only by rounding, just below the axis.
#[inline]
pub fn atan2_turns(y: Real, x: Real) -> Real {
    let (ax, ay) = (x.abs(), y.abs());
    if ax == 0.0 && ay == 0.0 {
        return 0.0;
    }
    // Folded to the first octant, where the quotient is at most 1.
    let octant = if ay <= ax { atan_turns(ay / ax) } else { 0.25 - atan_turns(ax / ay) };
    let half = if x < 0.0 { 0.5 - octant } else { octant };
    if y < 0.0 { 1.0 - half } else { half }
}

/// atan t / 2π for t in [0, 1].
#[inline]
fn atan_turns(t: Real) -> Real {
    const INV_TAU: Real = (1.0 / std::f64::consts::TAU) as Real;
    /// tan(π/8): beyond it, by the angle that is left to 45°, so that the series converges fast.
    const TAN_EIGHTH: Real = 0.414_213_562_373_095_05_f64 as Real;
    if t > TAN_EIGHTH { 0.125 - series((1.0 - t) / (1.0 + t)) * INV_TAU } else { series(t) * INV_TAU }
}

/// Terms of the series for |s| <= tan(π/8): the next is below half an ulp (s^17/17 = 2e-8, s^43/43 = 8e-19).
const TERMS: usize = if size_of::<Real>() == 4 { 8 } else { 21 };

/// atan s = s − s³/3 + s⁵/5 − …
#[inline]
fn series(s: Real) -> Real {
    let y = -s * s;
    s * (0..TERMS).rev().fold(0.0, |sum, k| sum * y + 1.0 / (2 * k + 1) as Real)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        for i in 0..4000 {
            let angle = f64::from(i) / 4000.0 * std::f64::consts::TAU;
            for r in [1e-12, 0.7, 3e5] {
                let (x, y) = ((r * angle.cos()) as Real, (r * angle.sin()) as Real);
                let exact = (y as f64).atan2(x as f64) / std::f64::consts::TAU;
                let exact = if exact < 0.0 { exact + 1.0 } else { exact };
                assert!((atan2_turns(y, x) as f64 - exact).abs() < 1e-7, "{x} {y}");
            }
        }
        assert_eq!((atan2_turns(0.0, 1.0), atan2_turns(1.0, 0.0), atan2_turns(0.0, -1.0)), (0.0, 0.25, 0.5));
        assert_eq!((atan2_turns(0.0, 0.0), atan2_turns(-1.0, 0.0)), (0.0, 0.75));
    }
}
