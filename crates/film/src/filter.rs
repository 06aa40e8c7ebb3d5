//! The separable reconstruction filters that both splatting and downsizing use.

use crate::FilmError;
use std::fmt;

/// A separable filter. Distances are in internal pixels where the filter splats, and in output
/// pixels where it downsizes. Each has the integral 1 along each axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Filter {
    /// 1 up to half a pixel from the centre.
    Box,
    /// A Gaussian of standard deviation 0.35, cut where it falls to 1e-5 and scaled to integral 1.
    #[default]
    Gaussian,
    /// The cubic of Mitchell and Netravali, "Reconstruction Filters in Computer Graphics",
    /// SIGGRAPH 1988, equation 8. It has negative lobes where `ring` is positive.
    MitchellNetravali {
        /// The parameter B of the paper; best between 0 and 1.
        blur: f64,
        /// The parameter C of the paper; best between 0 and 1.
        ring: f64,
    },
}

/// Standard deviation of [`Filter::Gaussian`] in pixels.
const GAUSSIAN_SD: f64 = 0.35;
/// Where the Gaussian density is cut.
const GAUSSIAN_CUT: f64 = 1e-5;
/// The integral of the Gaussian between its cuts: erf(4.825725/√2), where 4.825725 standard
/// deviations are the radius. The tests integrate it numerically.
const GAUSSIAN_MASS: f64 = 0.999_998_605_048_546;

impl fmt::Display for Filter {
    /// By the names that scenes use.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Box => f.write_str("box"),
            Self::Gaussian => f.write_str("gaussian"),
            Self::MitchellNetravali { blur, ring } => write!(f, "mn_cubic with blur {blur}, ring {ring}"),
        }
    }
}

impl Filter {
    /// No filter reaches farther than this from its centre (pixels).
    pub const MAX_RADIUS: f64 = 2.0;

    /// Mitchell-Netravali with the parameters that a scene has by default: blur 0.6, ring 0.2.
    pub const MN_DEFAULT: Self = Self::MitchellNetravali { blur: 0.6, ring: 0.2 };

    /// Whether the parameters are usable: numbers between -10 and 10.
    pub fn check(&self) -> Result<(), FilmError> {
        match *self {
            Self::MitchellNetravali { blur, ring } if !(blur.abs() <= 10.0 && ring.abs() <= 10.0) => {
                Err(FilmError::FilterParameters { blur, ring })
            }
            _ => Ok(()),
        }
    }

    /// Beyond this distance from its centre (pixels) the filter is zero.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Box => 0.5,
            // exp(-r²/2σ²)/(σ√2π) = cut, solved for r.
            Self::Gaussian => {
                GAUSSIAN_SD * (-2.0 * (GAUSSIAN_CUT * GAUSSIAN_SD * std::f64::consts::TAU.sqrt()).ln()).sqrt()
            }
            Self::MitchellNetravali { .. } => 2.0,
        }
    }

    /// The filter along one axis at a distance `x` from its centre (pixels); its integral is 1.
    pub fn eval(&self, x: f64) -> f64 {
        let x = x.abs();
        if x > self.radius() {
            return 0.0;
        }
        match *self {
            Self::Box => 1.0,
            Self::Gaussian => gaussian(x) / GAUSSIAN_MASS,
            Self::MitchellNetravali { blur, ring } => mitchell_netravali(x, blur, ring),
        }
    }
}

/// The normal density of standard deviation [`GAUSSIAN_SD`].
fn gaussian(x: f64) -> f64 {
    let z = x / GAUSSIAN_SD;
    (-0.5 * z * z).exp() / (GAUSSIAN_SD * std::f64::consts::TAU.sqrt())
}

/// Mitchell and Netravali 1988, equation 8, for 0 ≤ x ≤ 2.
fn mitchell_netravali(x: f64, b: f64, c: f64) -> f64 {
    let sixfold = if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x + (-18.0 + 12.0 * b + 6.0 * c)) * x * x + (6.0 - 2.0 * b)
    } else {
        (((-b - 6.0 * c) * x + (6.0 * b + 30.0 * c)) * x + (-12.0 * b - 48.0 * c)) * x + (8.0 * b + 24.0 * c)
    };
    sixfold / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral over the filter's support by the midpoint rule.
    fn integral(filter: Filter) -> f64 {
        let n = 400_000;
        let h = 2.0 * filter.radius() / f64::from(n);
        (0..n).map(|i| filter.eval(-filter.radius() + (f64::from(i) + 0.5) * h)).sum::<f64>() * h
    }

    #[test]
    fn integrals_are_one() {
        for filter in [
            Filter::Box,
            Filter::Gaussian,
            Filter::MN_DEFAULT,
            Filter::MitchellNetravali { blur: 1.0, ring: 0.0 },
            Filter::MitchellNetravali { blur: 0.0, ring: 1.0 },
        ] {
            assert!((integral(filter) - 1.0).abs() < 1e-9, "{filter:?}: {}", integral(filter));
        }
    }

    #[test]
    fn closed_forms() {
        // The Gaussian's density at its radius is the cut.
        assert!((gaussian(Filter::Gaussian.radius()) - 1e-5).abs() < 1e-12);
        assert!((Filter::Gaussian.radius() - 1.689_003_617).abs() < 1e-9);
        // B-spline (B 1, C 0): 2/3, 1/6 and 0 at 0, 1 and 2. Catmull-Rom (0, 1/2): 1, 0, 0.
        let spline = Filter::MitchellNetravali { blur: 1.0, ring: 0.0 };
        let catmull = Filter::MitchellNetravali { blur: 0.0, ring: 0.5 };
        for (x, s, c) in [(0.0, 2.0 / 3.0, 1.0), (1.0, 1.0 / 6.0, 0.0), (-2.0, 0.0, 0.0)] {
            assert!((spline.eval(x) - s).abs() < 1e-15);
            assert!((catmull.eval(x) - c).abs() < 1e-15);
        }
        assert_eq!(Filter::Box.eval(0.51), 0.0);
    }

    #[test]
    fn absurd_parameters_are_refused() {
        for (blur, ring) in [(f64::NAN, 0.0), (0.0, f64::INFINITY), (11.0, 0.0)] {
            assert!(Filter::MitchellNetravali { blur, ring }.check().is_err());
        }
        assert!(Filter::MN_DEFAULT.check().is_ok());
    }
}
