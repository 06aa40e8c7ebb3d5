//! `oren_nayar` against what it models: V-shaped cavities of Lambertian facets, traced with all bounces by a few lines
//! that share nothing with it. The table of its module is computed anew.
//!
//! Cavities are long, symmetric and equally wide, turned evenly; the tops that have facets of slope angle θ take a share of
//! the surface in proportion to exp(−θ² / 2σ²) cos θ, per solid angle of the normal (Oren & Nayar 1994, section 4: the
//! distribution is of facets' areas, and the cosine makes tops of them).

mod common;

use common::{example, wavelengths};
use indigo_math::{Real, Vec3};
use indigo_scatter::{Crossing, Scatter};
use indigo_testkit::rng::Rng;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Paths for each direction of the light: values then scatter by 0.5 % or less, which adds nothing to the third digit of
/// a root mean square of 3 %.
const PATHS: u32 = 150_000;
/// Half of the last digit that is stated, and as much for chance.
const TOLERANCE: f64 = 0.002;

const LIGHTS: [f64; 3] = [15.0, 45.0, 75.0];
const VIEWS: [f64; 5] = [0.0, 20.0, 40.0, 60.0, 80.0];
const AZIMUTHS: [f64; 5] = [0.0, 45.0, 90.0, 135.0, 180.0];

type Vector = [f64; 3];

fn direction(degrees: f64, azimuth: f64) -> Vector {
    let ((sin, cos), (sin_phi, cos_phi)) = (degrees.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    [sin * cos_phi, sin * sin_phi, cos]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A cavity along the y axis, from x = -1 to 1 at the top, where z = 0.
struct Cavity {
    tan: f64,
    /// Of the facet at the left, which looks to the right.
    normal: Vector,
}

impl Cavity {
    fn of_slope(angle: f64) -> Self {
        Self { tan: angle.tan(), normal: [angle.sin(), 0.0, angle.cos()] }
    }

    /// The normal of the facet at the left (-1) or right (1).
    fn normal(&self, side: f64) -> Vector {
        [-side * self.normal[0], 0.0, self.normal[2]]
    }

    /// Whether light from a point inside comes out at the top.
    fn comes_out([x, z]: [f64; 2], d: Vector) -> bool {
        d[2] > 0.0 && (x - d[0] * z / d[2]).abs() <= 1.0
    }

    /// Where a ray meets the facet of a side; `None` if not, or not before its other end.
    fn meet(&self, [x, z]: [f64; 2], d: Vector, side: f64) -> Option<[f64; 2]> {
        // The facet is z = (side x - 1) tan.
        let t = (self.tan * (side * x - 1.0) - z) / (d[2] - self.tan * side * d[0]);
        let x = x + t * d[0];
        (t > 0.0 && (0.0..=1.0).contains(&(side * x))).then_some([x, self.tan * (side * x - 1.0)])
    }
}

/// A slope angle: of density θ exp(−θ² / 2σ²), of which sin θ cos θ / θ are kept.
fn slope(sigma: f64, rng: &mut Rng) -> f64 {
    loop {
        let angle = sigma * (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
        if angle < FRAC_PI_2 && rng.uniform() * 2.0 * angle < (2.0 * angle).sin() {
            return angle;
        }
    }
}

/// The BRDF for light from `light` towards the views.
fn traced(sigma: f64, albedo: f64, light: Vector, views: &[Vector]) -> Vec<f64> {
    let mut rng = Rng::new(11);
    let mut sums = vec![0.0; views.len()];
    for _ in 0..PATHS {
        let cavity = Cavity::of_slope(slope(sigma, &mut rng));
        // The cavity stays, and all the rest is turned.
        let (sin, cos) = (TAU * rng.uniform()).sin_cos();
        let turned = |[x, y, z]: Vector| [cos * x - sin * y, sin * x + cos * y, z];
        let views: Vec<Vector> = views.iter().map(|&view| turned(view)).collect();
        let mut d = turned(light).map(|x| -x);
        let mut at = [2.0 * rng.uniform() - 1.0, 0.0];
        // The side whose facet light comes from: none as yet.
        let mut from = 0.0;
        let mut throughput = 1.0;
        loop {
            let mut sides =
                [-1.0, 1.0].into_iter().filter(|&side| side != from && dot(d, cavity.normal(side)) < 0.0);
            let Some((side, p)) = sides.find_map(|side| Some((side, cavity.meet(at, d, side)?))) else {
                break;
            };
            (from, at) = (side, p);
            throughput *= albedo;
            let n = cavity.normal(side);
            for (sum, &view) in sums.iter_mut().zip(&views) {
                if dot(n, view) > 0.0 && Cavity::comes_out(at, view) {
                    *sum += throughput * dot(n, view) / (PI * view[2]);
                }
            }
            // Lambert's law: the normal and a point of the unit sphere.
            let (z, phi) = (2.0 * rng.uniform() - 1.0, TAU * rng.uniform());
            let r = (1.0 - z * z).sqrt();
            let sum = [n[0] + r * phi.cos(), n[1] + r * phi.sin(), n[2] + z];
            d = sum.map(|x| x / dot(sum, sum).sqrt());
            if Cavity::comes_out(at, d) {
                break;
            }
        }
    }
    sums.iter().map(|sum| sum / f64::from(PATHS)).collect()
}

/// α, β and cos φ of the paper.
fn angles(light: Vector, view: Vector) -> [f64; 3] {
    let [i, r] = [light, view].map(|d| d[2].min(1.0).acos());
    let sines = i.sin() * r.sin();
    let cos_phi = if sines > 1e-9 { (light[0] * view[0] + light[1] * view[1]) / sines } else { 0.0 };
    [i.max(r), i.min(r), cos_phi]
}

/// Equation 30.
fn qualitative(sigma: f64, albedo: f64, light: Vector, view: Vector) -> f64 {
    let s2 = sigma * sigma;
    let [alpha, beta, cos_phi] = angles(light, view);
    let rough = 0.45 * s2 / (s2 + 0.09) * cos_phi.max(0.0) * alpha.sin() * beta.tan();
    albedo / PI * (1.0 - 0.5 * s2 / (s2 + 0.33) + rough)
}

/// Equations 27 and 29.
fn functional(sigma: f64, albedo: f64, light: Vector, view: Vector) -> f64 {
    let s2 = sigma * sigma;
    let [alpha, beta, cos_phi] = angles(light, view);
    let rough = s2 / (s2 + 0.09);
    let back = if cos_phi < 0.0 { (2.0 * beta / PI).powi(3) } else { 0.0 };
    let c2 = 0.45 * rough * (alpha.sin() - back);
    let c3 = 0.125 * rough * (4.0 * alpha * beta / (PI * PI)).powi(2);
    let once = 1.0 - 0.5 * s2 / (s2 + 0.33)
        + cos_phi * c2 * beta.tan()
        + (1.0 - cos_phi.abs()) * c3 * (0.5 * (alpha + beta)).tan();
    let twice = 0.17 * s2 / (s2 + 0.13) * (1.0 - cos_phi * (2.0 * beta / PI).powi(2));
    albedo / PI * (once + albedo * twice)
}

/// The model of the renderer.
fn ours(sigma: f64, albedo: f64) -> impl Fn(Vector, Vector) -> f64 {
    let text = format!(
        "<oren_nayar><sigma>{sigma}</sigma><albedo_spectrum><uniform><value>{albedo}</value></uniform></albedo_spectrum></oren_nayar>"
    );
    let leaf = example(text.leak()).remove(0).leaf(&wavelengths(0.4));
    let vec = |d: Vector| Vec3::from(d.map(|x| x as Real));
    move |light, view| leaf.f(vec(view), vec(light), Crossing::Reflect).hero() as f64
}

#[test]
fn errors_against_cavities_are_as_stated() {
    const FILE: &str = include_str!("../src/materials/oren_nayar.rs");
    let cells = |line: &str| -> Vec<f64> {
        line.split(['|', ',']).filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    let rows: Vec<Vec<f64>> = FILE
        .lines()
        .filter(|line| line.starts_with("//! |"))
        .map(cells)
        .filter(|row| row.len() == 6)
        .collect();
    assert_eq!(rows.len(), 6);
    let views: Vec<Vector> = VIEWS.iter().flat_map(|&t| AZIMUTHS.map(|phi| direction(t, phi))).collect();
    let mut faults = vec![];
    for row in rows {
        let (sigma, albedo) = (row[0], row[1]);
        let ours = ours(sigma, albedo);
        let mut squares = [0.0; 4];
        for light in LIGHTS.map(|degrees| direction(degrees, 0.0)) {
            for (&view, exact) in views.iter().zip(traced(sigma, albedo, light, &views)) {
                let models = [
                    ours(light, view),
                    functional(sigma, albedo, light, view),
                    qualitative(sigma, albedo, light, view),
                    albedo / PI,
                ];
                for (sum, model) in squares.iter_mut().zip(models) {
                    *sum += (model / exact - 1.0).powi(2);
                }
            }
        }
        let errors = squares.map(|sum| (sum / (LIGHTS.len() * views.len()) as f64).sqrt());
        if errors.iter().zip(&row[2..]).any(|(error, stated)| (error - stated).abs() > TOLERANCE) {
            faults.push(format!("{row:?}: {errors:.3?}"));
        }
        assert!(errors[0] < errors[1], "the paper's own is nearer: {errors:?}");
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// In a cavity as good as flat light is scattered once, by Lambert's law; white facets of any slope lose nothing.
#[test]
fn cavities_themselves_are_sound() {
    let light = direction(45.0, 0.0);
    for f in traced(0.001, 0.7, light, &[direction(0.0, 0.0), direction(60.0, 90.0)]) {
        assert!((f * PI - 0.7).abs() < 2e-3, "{f}");
    }
    let views = even_views();
    let white = traced(0.8, 1.0, light, &views);
    let albedo = PI * white.iter().sum::<f64>() / views.len() as f64;
    assert!((albedo - 1.0).abs() < 5e-3, "{albedo}");
}

/// Views of which each stands for as much of the cosine: at equal steps of the squared sine and of the azimuth.
fn even_views() -> Vec<Vector> {
    let ring = |i: u32| {
        let degrees = ((f64::from(i) + 0.5) / 40.0).sqrt().asin().to_degrees();
        (0..8).map(move |k| direction(degrees, 22.5 * (f64::from(k) + 0.5)))
    };
    (0..40).flat_map(ring).collect()
}

/// What the module says of equation 29, by the light that white surfaces of all roughnesses scatter from up to 85°.
#[test]
fn the_papers_own_light_between_facets_loses_and_makes_light() {
    let views = even_views();
    let [mut least, mut most] = [1.0f64; 2];
    for (sigma, degrees) in
        (1..=20).flat_map(|s| (0..=17).map(move |d| (f64::from(s) * 0.05, f64::from(d) * 5.0)))
    {
        let light = direction(degrees, 0.0);
        let sum: f64 = views.iter().map(|&view| functional(sigma, 1.0, light, view)).sum();
        let albedo = PI * sum / views.len() as f64;
        (least, most) = (least.min(albedo), most.max(albedo));
    }
    assert!((least - 0.775).abs() < 0.002 && (most - 1.03).abs() < 0.002, "{least} to {most}");
}
