//! Numbers that a path carries for each of its wavelengths: values of a spectrum, and densities.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

use indigo_math::Real;

/// Wavelengths that one path carries: 4, or 1 or 8 under the features `lanes-1` and `lanes-8`.
pub const LANES: usize = if cfg!(feature = "lanes-8") {
    8
} else if cfg!(feature = "lanes-1") {
    1
} else {
    4
};

/// One value per lane: radiance, reflectance, throughput, a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledSpectrum(pub [Real; LANES]);

/// The density of one event in each lane's own measure: equal lanes where the event was sampled
/// without regard to wavelength, zero in the lanes in which it could not have happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanePdf(pub [Real; LANES]);

macro_rules! operator {
    ($t:ident: $op:ident::$f:ident, $assign:ident::$g:ident) => {
        impl $op for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Self) -> Self {
                Self(from_fn(|i| $op::$f(self.0[i], b.0[i])))
            }
        }
        impl $op<Real> for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Real) -> Self {
                Self(from_fn(|i| $op::$f(self.0[i], b)))
            }
        }
        impl $assign for $t {
            #[inline(always)]
            fn $g(&mut self, b: Self) {
                *self = $op::$f(*self, b);
            }
        }
        impl $assign<Real> for $t {
            #[inline(always)]
            fn $g(&mut self, b: Real) {
                *self = $op::$f(*self, b);
            }
        }
    };
}

macro_rules! lanes {
    ($t:ident) => {
        impl $t {
            /// 0 in each lane.
            pub const ZERO: Self = Self([0.0; LANES]);
            /// 1 in each lane.
            pub const ONE: Self = Self([1.0; LANES]);

            /// The same number in each lane.
            #[inline(always)]
            pub const fn splat(v: Real) -> Self {
                Self([v; LANES])
            }

            /// Lane by lane from a function of the lane's index.
            #[inline(always)]
            pub fn from_fn(f: impl FnMut(usize) -> Real) -> Self {
                Self(from_fn(f))
            }

            /// A function applied to each lane.
            #[inline(always)]
            #[must_use]
            pub fn map(self, f: impl FnMut(Real) -> Real) -> Self {
                Self(self.0.map(f))
            }

            /// The lane of the hero wavelength.
            #[inline(always)]
            pub const fn hero(self) -> Real {
                self.0[0]
            }

            /// Sum of the lanes.
            #[inline(always)]
            pub fn sum(self) -> Real {
                self.0.iter().sum()
            }

            /// Mean of the lanes.
            #[inline(always)]
            pub fn mean(self) -> Real {
                self.sum() / LANES as Real
            }

            /// The largest lane.
            #[inline(always)]
            pub fn max_lane(self) -> Real {
                self.0.iter().fold(self.0[0], |a, &b| a.max(b))
            }

            /// The smallest lane.
            #[inline(always)]
            pub fn min_lane(self) -> Real {
                self.0.iter().fold(self.0[0], |a, &b| a.min(b))
            }

            /// Whether every lane is exactly 0.
            #[inline(always)]
            pub fn is_zero(self) -> bool {
                self.0.iter().all(|&v| v == 0.0)
            }

            /// Whether no lane is infinite or NaN.
            #[inline(always)]
            pub fn is_finite(self) -> bool {
                self.0.iter().all(|v| v.is_finite())
            }

            /// Quotient per lane, 0 in the lanes whose divisor is 0: the value of an event that
            /// cannot happen there.
            #[inline(always)]
            #[must_use]
            pub fn over(self, density: LanePdf) -> Self {
                Self(from_fn(|i| if density.0[i] == 0.0 { 0.0 } else { self.0[i] / density.0[i] }))
            }
        }

        impl Default for $t {
            fn default() -> Self {
                Self::ZERO
            }
        }

        impl Index<usize> for $t {
            type Output = Real;
            #[inline(always)]
            fn index(&self, lane: usize) -> &Real {
                &self.0[lane]
            }
        }

        impl IndexMut<usize> for $t {
            #[inline(always)]
            fn index_mut(&mut self, lane: usize) -> &mut Real {
                &mut self.0[lane]
            }
        }

        operator!($t: Add::add, AddAssign::add_assign);
        operator!($t: Sub::sub, SubAssign::sub_assign);
        operator!($t: Mul::mul, MulAssign::mul_assign);
        operator!($t: Div::div, DivAssign::div_assign);

        impl Mul<$t> for Real {
            type Output = $t;
            #[inline(always)]
            fn mul(self, b: $t) -> $t {
                b * self
            }
        }
    };
}
lanes!(SampledSpectrum);
lanes!(LanePdf);

impl SampledSpectrum {
    /// Whether nothing is carried: every lane exactly 0.
    #[inline(always)]
    pub fn is_black(self) -> bool {
        self.is_zero()
    }

    /// Each lane limited to `[lo, hi]`.
    #[inline(always)]
    #[must_use]
    pub fn clamp(self, lo: Real, hi: Real) -> Self {
        self.map(|v| v.max(lo).min(hi))
    }

    /// Value times density, lane by lane.
    #[inline(always)]
    #[must_use]
    pub fn times(self, density: LanePdf) -> Self {
        Self(from_fn(|i| self.0[i] * density.0[i]))
    }
}

impl Neg for SampledSpectrum {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

impl LanePdf {
    /// Ratio r = p_lane / p_hero, 0 in every lane where the hero's density is 0. A path's value in
    /// a lane is its throughput over the mean of its ratios (balance heuristic over the lanes,
    /// Wilkie et al. 2014, eq. 6).
    #[inline(always)]
    #[must_use]
    pub fn ratio_to_hero(self) -> Self {
        self.over(Self::splat(self.0[0]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(scale: Real) -> SampledSpectrum {
        SampledSpectrum::from_fn(|i| scale * (i + 1) as Real)
    }

    #[test]
    fn arithmetic_is_lane_by_lane() {
        let (a, b) = (ramp(1.0), ramp(2.0));
        assert_eq!(a + b, ramp(3.0));
        assert_eq!(b - a, a);
        assert_eq!(b / a, SampledSpectrum::splat(2.0));
        assert_eq!(a * b, SampledSpectrum::from_fn(|i| 2.0 * ((i + 1) * (i + 1)) as Real));
        assert_eq!(2.0 * a, b);
        assert_eq!(-a, ramp(-1.0));
    }

    #[test]
    fn sums_and_extremes() {
        let n = LANES as Real;
        assert_eq!(ramp(1.0).sum(), n * (n + 1.0) / 2.0);
        assert_eq!(ramp(1.0).mean(), Real::midpoint(n, 1.0));
        assert_eq!((ramp(1.0).min_lane(), ramp(1.0).max_lane()), (1.0, n));
        assert!(SampledSpectrum::ZERO.is_black() && !ramp(1.0).is_black());
        assert!(!(ramp(1.0) / 0.0).is_finite() && ramp(1.0).is_finite());
    }

    #[test]
    fn an_impossible_event_has_value_zero() {
        let mut p = LanePdf::splat(2.0);
        p[LANES - 1] = 0.0;
        assert_eq!(ramp(2.0).over(p)[LANES - 1], 0.0);
        assert_eq!(LanePdf::ZERO.ratio_to_hero(), LanePdf::ZERO);
        if LANES > 1 {
            assert_eq!(ramp(2.0).over(p)[0], 1.0);
            assert_eq!(p.ratio_to_hero()[0], 1.0);
        }
    }
}
