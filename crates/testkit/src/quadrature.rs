//! Adaptive Gauss-Kronrod quadrature over the domains that sampling works on.
//!
//! The 15-point Kronrod rule and its embedded 7-point Gauss rule (Kronrod 1965; nodes and weights as
//! tabulated in QUADPACK, Piessens et al. 1983) give a value and an error estimate from the same
//! evaluations; a cell whose estimate is too large is halved.

use std::f64::consts::{PI, TAU};

/// The positive nodes of the 15-point Kronrod rule on [-1, 1], descending; odd places are Gauss nodes.
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
/// Kronrod weights of [`NODES`].
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
/// Gauss weights of the odd places of [`NODES`] and of the centre.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// Halvings of a side before a cell is taken as it is: a jump is then placed to 2^-12 of the side.
const MAX_DEPTH: u32 = 12;
/// The same in one dimension, where a cell is cheap.
const MAX_DEPTH_1D: u32 = 40;

/// An integral and a bound, usually generous, on its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// Sum of the rule's error estimates over all cells.
    pub error: f64,
}

impl Integral {
    /// Whether refining is of no use: good enough, or not a number, which no halving mends.
    fn accepted(self, tolerance: f64) -> bool {
        self.error <= tolerance || !self.error.is_finite()
    }

    #[must_use]
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, error: self.error * factor.abs() }
    }
}

impl std::ops::Add for Integral {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }
}

/// ∫ f over [lo, hi], aiming at absolute error `tolerance`.
pub fn interval(lo: f64, hi: f64, tolerance: f64, f: impl Fn(f64) -> f64) -> Integral {
    interval_cell(lo, hi, tolerance, MAX_DEPTH_1D, &f)
}

fn interval_cell(lo: f64, hi: f64, tolerance: f64, depth: u32, f: &impl Fn(f64) -> f64) -> Integral {
    let estimate = rule(lo, hi, f);
    if estimate.accepted(tolerance) || depth == 0 {
        return estimate;
    }
    let mid = 0.5 * (lo + hi);
    interval_cell(lo, mid, 0.5 * tolerance, depth - 1, f)
        + interval_cell(mid, hi, 0.5 * tolerance, depth - 1, f)
}

/// One application of the rule.
fn rule(lo: f64, hi: f64, f: &impl Fn(f64) -> f64) -> Integral {
    let (centre, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for_each_node(|node, k, g| {
        let value = f(centre + half * node);
        kronrod += k * value;
        gauss += g * value;
    });
    Integral { value: kronrod * half, error: ((kronrod - gauss) * half).abs() }
}

/// Visits the 15 nodes with their Kronrod and Gauss weights (the latter 0 where Gauss has no node).
fn for_each_node(mut visit: impl FnMut(f64, f64, f64)) {
    for (i, (&node, &k)) in NODES.iter().zip(&KRONROD).enumerate() {
        let g = if i % 2 == 1 { GAUSS[i / 2] } else { 0.0 };
        visit(node, k, g);
        if node > 0.0 {
            visit(-node, k, g);
        }
    }
}

/// ∫∫ f(u, v) over the rectangle `[u0, u1] x [v0, v1]`, aiming at absolute error `tolerance`.
pub fn rectangle(u: [f64; 2], v: [f64; 2], tolerance: f64, f: impl Fn(f64, f64) -> f64) -> Integral {
    rectangle_cell(u, v, tolerance, MAX_DEPTH, &f)
}

fn rectangle_cell(
    u: [f64; 2],
    v: [f64; 2],
    tolerance: f64,
    depth: u32,
    f: &impl Fn(f64, f64) -> f64,
) -> Integral {
    let estimate = product_rule(u, v, f);
    if estimate.accepted(tolerance) || depth == 0 {
        return estimate;
    }
    let (um, vm) = (0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
    // Errors of the quarters have either sign and rarely all add up: half, not a quarter, each.
    let cell = |u, v| rectangle_cell(u, v, 0.5 * tolerance, depth - 1, f);
    cell([u[0], um], [v[0], vm])
        + cell([um, u[1]], [v[0], vm])
        + cell([u[0], um], [vm, v[1]])
        + cell([um, u[1]], [vm, v[1]])
}

fn product_rule(u: [f64; 2], v: [f64; 2], f: &impl Fn(f64, f64) -> f64) -> Integral {
    let (cu, hu) = (0.5 * (u[0] + u[1]), 0.5 * (u[1] - u[0]));
    let (cv, hv) = (0.5 * (v[0] + v[1]), 0.5 * (v[1] - v[0]));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for_each_node(|nu, ku, gu| {
        for_each_node(|nv, kv, gv| {
            let value = f(cu + hu * nu, cv + hv * nv);
            kronrod += ku * kv * value;
            gauss += gu * gv * value;
        });
    });
    let area = hu * hv;
    Integral { value: kronrod * area, error: ((kronrod - gauss) * area).abs() }
}

/// ∫ f dω over the unit sphere; `f` takes a unit direction.
pub fn sphere(tolerance: f64, f: impl Fn([f64; 3]) -> f64) -> Integral {
    spherical_zone([-1.0, 1.0], tolerance, f)
}

/// ∫ f dω over the hemisphere z >= 0; `f` takes a unit direction.
pub fn hemisphere(tolerance: f64, f: impl Fn([f64; 3]) -> f64) -> Integral {
    spherical_zone([0.0, 1.0], tolerance, f)
}

/// Equal areas of (z, φ) are equal solid angles (Archimedes), so the Jacobian is 1. Four sectors, so
/// that the first estimate of a narrow lobe has nodes near every axis.
fn spherical_zone(z: [f64; 2], tolerance: f64, f: impl Fn([f64; 3]) -> f64) -> Integral {
    let integrand = |z: f64, phi: f64| f(direction(z, phi));
    sectors(|phi| rectangle(z, phi, 0.25 * tolerance, integrand))
}

/// ∫ f dA over the unit disk; `f` takes (x, y).
pub fn disk(tolerance: f64, f: impl Fn(f64, f64) -> f64) -> Integral {
    let integrand = |r2: f64, phi: f64| {
        let r = r2.sqrt();
        f(r * phi.cos(), r * phi.sin())
    };
    // r dr = d(r²)/2.
    sectors(|phi| rectangle([0.0, 1.0], phi, 0.5 * tolerance, integrand)).scaled(0.5)
}

fn sectors(part: impl Fn([f64; 2]) -> Integral) -> Integral {
    (0..4)
        .map(|i| part([f64::from(i) * 0.5 * PI, f64::from(i + 1) * 0.5 * PI]))
        .fold(Integral::default(), |sum, part| sum + part)
}

/// The unit vector at height `z` and azimuth `phi`.
pub fn direction(z: f64, phi: f64) -> [f64; 3] {
    let r = (1.0 - z * z).max(0.0).sqrt();
    [r * phi.cos(), r * phi.sin(), z]
}

/// Height and azimuth, the latter in [0, 2π), of a unit vector.
pub fn height_and_azimuth(d: [f64; 3]) -> (f64, f64) {
    let phi = d[1].atan2(d[0]);
    (d[2], if phi < 0.0 { phi + TAU } else { phi })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(integral: Integral, expected: f64, tolerance: f64) {
        assert!((integral.value - expected).abs() <= tolerance, "{integral:?} is not {expected}");
    }

    #[test]
    fn rule_is_exact_for_polynomials_of_degree_22() {
        close(rule(-1.0, 1.0, &|x| x.powi(22)), 2.0 / 23.0, 1e-15);
        close(rule(0.0, 2.0, &|x| x.powi(21)), 2f64.powi(22) / 22.0, 1e-9);
        assert!((KRONROD.iter().sum::<f64>() * 2.0 - KRONROD[7] - 2.0).abs() < 1e-15);
        assert!((GAUSS.iter().sum::<f64>() * 2.0 - GAUSS[3] - 2.0).abs() < 1e-15);
    }

    #[test]
    fn intervals_smooth_singular_and_stepped() {
        close(interval(0.0, PI, 1e-12, f64::sin), 2.0, 1e-12);
        close(interval(0.0, 1.0, 1e-10, |x| 1.0 / x.sqrt()), 2.0, 1e-5);
        close(interval(0.0, 1.0, 1e-12, |x| f64::from(x < 1.0 / 3.0)), 1.0 / 3.0, 1e-11);
        close(interval(-5.0, 5.0, 1e-12, |x| (-100.0 * x * x).exp()), (PI / 100.0).sqrt(), 1e-12);
    }

    #[test]
    fn sphere_and_hemisphere_against_solid_angles() {
        close(sphere(1e-10, |_| 1.0), 4.0 * PI, 1e-10);
        close(sphere(1e-10, |d| d[0] * d[0]), 4.0 * PI / 3.0, 1e-10);
        close(hemisphere(1e-10, |d| d[2]), PI, 1e-10);
        // A narrow cosine lobe around +x: 2π/(n+1).
        close(sphere(1e-8, |d| d[0].max(0.0).powi(400)), TAU / 401.0, 1e-7);
    }

    #[test]
    fn disk_against_closed_forms() {
        close(disk(1e-10, |_, _| 1.0), PI, 1e-10);
        close(disk(1e-10, |x, y| x * x + y * y), 0.5 * PI, 1e-10);
        // The half disk, whose straight edge crosses the cells.
        close(disk(1e-5, |x, y| f64::from(x + 0.3 * y > 0.0)), 0.5 * PI, 1e-3);
    }

    #[test]
    fn reported_error_bounds_the_true_one() {
        let stepped = rectangle([0.0, 1.0], [0.0, 1.0], 1e-5, |u, v| f64::from(u * u + v * v < 1.0));
        assert!((stepped.value - 0.25 * PI).abs() <= stepped.error + 1e-12, "{stepped:?}");
    }

    #[test]
    fn azimuth_inverts_direction() {
        for (z, phi) in [(0.3, 0.1), (-0.9, 3.0), (0.0, 6.2), (0.5, 4.0)] {
            let (z2, phi2) = height_and_azimuth(direction(z, phi));
            assert!((z - z2).abs() < 1e-15 && (phi - phi2).abs() < 1e-14);
        }
    }
}
