//! Fits a sigmoid reflectance to an RGB triple by Gauss–Newton (Jakob & Hanika 2019, section 4,
//! with the squared difference in linear RGB under D65 as the aim).

use indigo_math::{Mat3, Real, Vec3d};

use super::clamp_unit;
use super::sigmoid::{SigmoidCoeffs, position};
use crate::adaptation::XYZ_TO_RGB;
use crate::grid::{COUNT, FIRST_NM};
use crate::illuminant::D65;
use crate::observer::CMF;

/// Bound on the coefficients: beyond it a sigmoid is a step as sharp as the colour matching
/// functions can tell.
const LARGEST: f64 = 200.0;
/// The residual, in RGB, at which a fit is done.
const ENOUGH: f64 = 1e-10;
/// Fits of colours within the gamut need under 20 steps.
const MOST_STEPS: usize = 60;

/// What the linear RGB of a reflectance under D65 is made of: its values at each grid point times these.
static RGB_WEIGHTS: [[f64; 3]; COUNT] = rgb_weights();

const fn rgb_weights() -> [[f64; 3]; COUNT] {
    let mut luminance = 0.0;
    let mut i = 0;
    while i < COUNT {
        luminance += CMF[i][1] * D65[i];
        i += 1;
    }
    let mut weights = [[0.0; 3]; COUNT];
    i = 0;
    while i < COUNT {
        let mut c = 0;
        while c < 3 {
            let row = 3 * c;
            let matched = XYZ_TO_RGB[row] * CMF[i][0]
                + XYZ_TO_RGB[row + 1] * CMF[i][1]
                + XYZ_TO_RGB[row + 2] * CMF[i][2];
            weights[i][c] = matched * D65[i] / luminance;
            c += 1;
        }
        i += 1;
    }
    weights
}

/// Linear Rec. 709 colour of a reflectance lit by D65; `reflectance` is called with each whole
/// wavelength from 360 to 830 nm.
pub fn rgb_under_d65(reflectance: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut rgb = [0.0; 3];
    for (i, weights) in RGB_WEIGHTS.iter().enumerate() {
        let s = reflectance(FIRST_NM + i as f64);
        for c in 0..3 {
            rgb[c] += weights[c] * s;
        }
    }
    rgb
}

/// The smooth reflectance whose colour under D65 is this linear Rec. 709 triple, each component
/// clamped to [0, 1]. A grey is flat. The colour returns within 1e-5 for colours inside the
/// gamut; within 1e-3 on its surface, where no sigmoid meets the colour exactly.
pub fn fit(rgb: [f64; 3]) -> SigmoidCoeffs {
    let rgb = clamp_unit(rgb);
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
        return SigmoidCoeffs::grey(rgb[0] as Real);
    }
    let mean = (rgb.iter().sum::<f64>() / 3.0).clamp(0.02, 0.98);
    let start = Vec3d::new(0.0, 0.0, (mean - 0.5) / (mean * (1.0 - mean)).sqrt());
    let coeffs = minimise(Vec3d::from(rgb), start);
    SigmoidCoeffs(coeffs.to_array().map(|c| c as Real))
}

/// Damped Gauss–Newton from `start`: a step that does not bring the colour nearer is halved.
fn minimise(target: Vec3d, start: Vec3d) -> Vec3d {
    let mut coeffs = start;
    let (mut residual, mut jacobian) = linearise(target, coeffs);
    for _ in 0..MOST_STEPS {
        if residual.length() < ENOUGH {
            break;
        }
        let Some(inverse) = jacobian.inverse() else { break };
        let mut step = inverse * residual;
        let improved = (0..12).find_map(|_| {
            let trial = bounded(coeffs + step);
            let (r, j) = linearise(target, trial);
            step *= 0.5;
            (r.length() < residual.length()).then_some((trial, r, j))
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
fn linearise(target: Vec3d, coeffs: Vec3d) -> (Vec3d, Mat3<f64>) {
    let mut colour = [0.0; 3];
    let mut change = [[0.0; 3]; 3];
    for (i, weights) in RGB_WEIGHTS.iter().enumerate() {
        let t = position(FIRST_NM + i as f64);
        let x = (coeffs.x * t + coeffs.y) * t + coeffs.z;
        let inverse_root = 1.0 / (1.0 + x * x).sqrt();
        let s = 0.5 + 0.5 * x * inverse_root;
        let slope = 0.5 * inverse_root * inverse_root * inverse_root;
        for c in 0..3 {
            let w = weights[c] * slope;
            colour[c] += weights[c] * s;
            change[c][0] += w * t * t;
            change[c][1] += w * t;
            change[c][2] += w;
        }
    }
    (target - Vec3d::from(colour), Mat3 { rows: change.map(Vec3d::from) })
}
