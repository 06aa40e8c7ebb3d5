//! Fits a sigmoid to an RGB triple by Gauss–Newton (Jakob & Hanika 2019, section 4,
//! with the squared difference in linear RGB under D65 as the aim).

use indigo_math::{Mat3, Real, Vec3d};

use super::nodes::{FINE, Nodes};
use super::sigmoid::SigmoidCoeffs;
use crate::grid;

/// Bound on the coefficients: beyond it a sigmoid is a step as sharp as the colour matching
/// functions can tell.
const LARGEST: f64 = 200.0;
/// Largest number of steps; a colour inside the gamut needs under 20.
const MOST_STEPS: usize = 60;
/// A step must shrink the residual at least to this part of it: a colour at the edge of the gamut is approached for ever.
const WORTHWHILE: f64 = 0.98;
/// The residual, in RGB, at which the fit of a constant is done.
const ENOUGH: f64 = 1e-11;

/// Linear Rec. 709 colour of a reflectance lit by D65; `reflectance` is called with each whole
/// wavelength, in nm, from 360 to 830.
pub fn rgb_under_d65(reflectance: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut rgb = [0.0; 3];
    for (i, lambda) in grid::wavelengths().enumerate() {
        let s = reflectance(lambda);
        for (sum, weight) in rgb.iter_mut().zip(FINE.weights(i)) {
            *sum += weight * s;
        }
    }
    rgb
}

/// The sigmoid whose colour under D65 comes nearest to this linear Rec. 709 triple.
pub fn sigmoid(rgb: [f64; 3]) -> SigmoidCoeffs {
    let coeffs = minimise(&FINE, Vec3d::from(rgb), flat_start(rgb), ENOUGH);
    SigmoidCoeffs(coeffs.to_array().map(|c| c as Real))
}

/// The flat curve of the triple's mean.
pub(super) fn flat_start(rgb: [f64; 3]) -> Vec3d {
    let mean = (rgb.iter().sum::<f64>() / 3.0).clamp(0.02, 0.98);
    Vec3d::new(0.0, 0.0, (mean - 0.5) / (mean * (1.0 - mean)).sqrt())
}

/// Damped Gauss–Newton from `start` until the colour is within `enough` of the target: a step that
/// does not bring the colour nearer is halved.
pub(super) fn minimise<const N: usize>(nodes: &Nodes<N>, target: Vec3d, start: Vec3d, enough: f64) -> Vec3d {
    let mut coeffs = start;
    let (mut residual, mut jacobian) = linearise(nodes, target, coeffs);
    for _ in 0..MOST_STEPS {
        if residual.length() < enough {
            break;
        }
        let Some(inverse) = jacobian.inverse() else { break };
        let mut step = inverse * residual;
        let improved = (0..12).find_map(|_| {
            let trial = bounded(coeffs + step);
            let (r, j) = linearise(nodes, target, trial);
            step *= 0.5;
            (r.length() < WORTHWHILE * residual.length()).then_some((trial, r, j))
        });
        let Some(better) = improved else { break };
        (coeffs, residual, jacobian) = better;
    }
    coeffs
}

/// Coefficients scaled down to the bound, which keeps the shape of the polynomial.
fn bounded(coeffs: Vec3d) -> Vec3d {
    let largest = coeffs.abs().max_component();
    if largest > LARGEST { coeffs * (LARGEST / largest) } else { coeffs }
}

/// What is missing from the target colour, and the change of the colour with each coefficient.
fn linearise<const N: usize>(nodes: &Nodes<N>, target: Vec3d, coeffs: Vec3d) -> (Vec3d, Mat3<f64>) {
    let (colour, change) = nodes.linearise(coeffs.to_array());
    (target - Vec3d::from(colour), Mat3 { rows: change.map(Vec3d::from) })
}
