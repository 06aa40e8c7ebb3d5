//! The domains that samplers work on, each mapped from the unit square with equal measure.

use std::f64::consts::{PI, TAU};

use crate::quadrature::{direction, height_and_azimuth};

/// A point this far outside its domain is no rounding error of a single-precision sampler.
const OUTSIDE: f64 = 1e-5;

/// What is sampled. Points are `[x, y, z]` with unused coordinates 0; densities are with respect to
/// the domain's own measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// Numbers from the first to the second (length).
    Interval(f64, f64),
    /// The unit square `[0, 1)²` (area).
    Square,
    /// The unit disk in x and y (area).
    Disk,
    /// Unit directions with z >= 0 (solid angle).
    Hemisphere,
    /// Unit directions (solid angle).
    Sphere,
}

impl Domain {
    /// The point at coordinates in the unit square, by an equal-measure map.
    pub(crate) fn point(self, u: f64, v: f64) -> [f64; 3] {
        match self {
            Self::Interval(lo, hi) => [lo + (hi - lo) * u, 0.0, 0.0],
            Self::Square => [u, v, 0.0],
            Self::Disk => [u.sqrt() * (TAU * v).cos(), u.sqrt() * (TAU * v).sin(), 0.0],
            Self::Hemisphere => direction(u, TAU * v),
            Self::Sphere => direction(2.0 * u - 1.0, TAU * v),
        }
    }

    /// The inverse of [`Self::point`]; `None` outside the domain.
    pub(crate) fn coordinates(self, p: [f64; 3]) -> Option<(f64, f64)> {
        let (_, phi) = height_and_azimuth(p);
        let length_error = (p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs();
        let (u, v) = match self {
            Self::Interval(lo, hi) => ((p[0] - lo) / (hi - lo), 0.0),
            Self::Square => (p[0], p[1]),
            Self::Disk => (p[0] * p[0] + p[1] * p[1], phi / TAU),
            Self::Hemisphere if length_error < OUTSIDE => (p[2], phi / TAU),
            Self::Sphere if length_error < OUTSIDE => (0.5 * (p[2] + 1.0), phi / TAU),
            Self::Hemisphere | Self::Sphere => return None,
        };
        let inside = |x: f64| (-OUTSIDE..=1.0 + OUTSIDE).contains(&x);
        (inside(u) && inside(v)).then_some((u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)))
    }

    /// The domain's whole measure.
    pub(crate) fn measure(self) -> f64 {
        match self {
            Self::Interval(lo, hi) => hi - lo,
            Self::Square => 1.0,
            Self::Disk => PI,
            Self::Hemisphere => TAU,
            Self::Sphere => 2.0 * TAU,
        }
    }

    pub(crate) fn default_cells(self) -> [usize; 2] {
        match self {
            Self::Interval(..) => [256, 1],
            Self::Square => [20, 20],
            Self::Disk | Self::Hemisphere => [12, 32],
            Self::Sphere => [16, 32],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_invert_points() {
        for domain in
            [Domain::Interval(1.0, 3.0), Domain::Square, Domain::Disk, Domain::Hemisphere, Domain::Sphere]
        {
            let (u, v) = domain.coordinates(domain.point(0.3, 0.7)).unwrap();
            let expected_v = if matches!(domain, Domain::Interval(..)) { 0.0 } else { 0.7 };
            assert!((u - 0.3).abs() < 1e-12 && (v - expected_v).abs() < 1e-12, "{domain:?}: {u} {v}");
        }
    }
}
