//! Media in which light is scattered thousands of times before it is absorbed.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near, assert_same};
use super::common::shapes::{Mesh, model};
use super::common::text::{
    background, basic, flat_camera, henyey_greenstein, medium, scattering, scene_file, settings, specular,
    sphere, uniform,
};
use super::common::{MODES, luminance_in_mode, scene};
use indigo_film::FilmState;
use indigo_scene::Scene;
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_transport::driver::Driver;
use std::f64::consts::TAU;

const AROUND: f64 = 3.0e4;
const SIDE: u32 = 8;

fn in_even_light(ior: f64, [absorption, coefficient]: [f64; 2], phase: &str, object: &str) -> Scene {
    let coefficient = scattering(&uniform(coefficient), phase);
    scene(&scene_file(&[
        settings(SIDE, ""),
        flat_camera([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 1e-4),
        background(&uniform(AROUND)),
        medium("m", 10, &basic(ior, &uniform(absorption), &coefficient)),
        specular("surface", "m"),
        object.to_owned(),
    ]))
}

/// Chandrasekhar's H function of isotropic scattering at μ, by iteration of
/// 1/H(μ) = √(1 - ϖ) + ϖ/2 ∫ μ' H(μ')/(μ + μ') dμ' (1950, "Radiative Transfer", section 37).
fn h_function(albedo: f64, mu: f64) -> f64 {
    let n = 400;
    // μ = s² spreads the nodes towards grazing directions.
    let nodes: Vec<[f64; 2]> = (0..n)
        .map(|i| (f64::from(i) + 0.5) / f64::from(n))
        .map(|s| [s * s, 2.0 * s / f64::from(n)])
        .collect();
    let next = |h: &[f64], mu: f64| {
        let sum: f64 = nodes.iter().zip(h).map(|([x, w], h)| w * x * h / (mu + x)).sum();
        1.0 / ((1.0 - albedo).sqrt() + 0.5 * albedo * sum)
    };
    let mut h = vec![1.0; nodes.len()];
    for _ in 0..2000 {
        h = nodes.iter().zip(&h).map(|([x, _], old)| 0.5 * (old + next(&h, *x))).collect();
    }
    next(&h, mu)
}

/// A half-space shows its plane albedo 1 - H(1) √(1 - ϖ) by reciprocity, also where a path is scattered a hundred
/// times on average. A slab a thousand mean free paths thick stands for it: twenty-four diffusion lengths.
#[test]
fn a_half_space_of_the_albedo_of_milk_shows_its_plane_albedo() {
    // The reference's table, by its own program.
    for (albedo, known) in [(0.9, 0.414_947_5), (0.99, 0.752_720_7), (0.999, 0.912_845_3)] {
        let plane = 1.0 - h_function(albedo, 1.0) * (1.0 - albedo).sqrt();
        assert!((plane - known).abs() < 2e-5, "{albedo}: {plane}");
    }
    let slab = Mesh::cube(1.0).placed([90.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 90.0], 1.0, [0.0, 0.5, 0.0]);
    let slab = slab.text("slab", "surface") + &model("slab");
    for (albedo, max_depth, passes, tolerance) in [(0.99, 10_000, 320, 5e-3), (0.9998, 1_000_000, 40, 1.5e-2)]
    {
        let coefficients = [1000.0 * (1.0 - albedo), 1000.0 * albedo];
        let mut scene = in_even_light(1.0, coefficients, "<uniform/>", &slab);
        scene.transport.max_depth = max_depth;
        let expected = 1.0 - h_function(albedo, 1.0) * (1.0 - albedo).sqrt();
        let measured = luminance_in_mode(&mut scene, MODES[0], 16, passes);
        assert_is(&format!("albedo {albedo}"), &measured, AROUND * NITS_PER_UNIFORM * expected, tolerance);
    }
}

/// Milk in a ball of 1 cm: the library's green coefficients and mean cosine.
const MILK: [f64; 2] = [4.6, 20_382.6];
const G: f64 = 0.714;
const ETA: f64 = 1.333;
const RADIUS: f64 = 0.005;

/// What another Monte Carlo finds of a view through the middle of the ball: radiance over that of the
/// surroundings for at most so many scattering events, and events of paths, those at the surface included. Events count
/// as much as what is left of the light: Russian roulette ends that share of a renderer's paths.
fn milk(paths: u64, max_depth: u32) -> (Moments, f64) {
    let mut rng = Rng::new(5);
    let [absorption, coefficient] = MILK;
    let mut events = 0.0;
    let radiance = Moments::of((0..paths).map(|_| {
        // Into the ball through its foremost point, or mirrored there.
        let mirrored = ((ETA - 1.0) / (ETA + 1.0)).powi(2);
        events += 1.0;
        if rng.uniform() < mirrored {
            return 1.0;
        }
        let (mut p, mut d) = ([0.0, -RADIUS, 0.0], [0.0, 1.0, 0.0]);
        let mut survival = 1.0;
        for _ in 1..max_depth {
            let along = dot(p, d);
            let to_surface = -along + (along * along - dot(p, p) + RADIUS * RADIUS).max(0.0).sqrt();
            let free = -(1.0 - rng.uniform()).ln() / coefficient;
            let step = free.min(to_surface);
            survival *= (-absorption * step).exp();
            p = [0, 1, 2].map(|k| p[k] + step * d[k]);
            events += survival;
            if free < to_surface {
                d = scattered(d, rng.uniform(), rng.uniform());
                continue;
            }
            let n = p.map(|x| -x / RADIUS);
            let cos = -dot(d, n);
            let cos2 = 1.0 - ETA * ETA * (1.0 - cos * cos);
            if cos2 > 0.0 && rng.uniform() >= reflectance(cos, cos2.sqrt()) {
                return survival;
            }
            d = [0, 1, 2].map(|k| d[k] + 2.0 * cos * n[k]);
        }
        0.0
    }));
    (radiance, events / paths as f64)
}

/// What a half-space of an albedo under a smooth surface shows along its normal, by a walk of depths and cosines alone:
/// radiance over that of even surroundings.
fn half_space(paths: u64, albedo: f64) -> Moments {
    let mut rng = Rng::new(6);
    let mirrored = ((ETA - 1.0) / (ETA + 1.0)).powi(2);
    Moments::of((0..paths).map(|_| {
        let (mut depth, mut mu, mut survival) = (0.0, 1.0, 1.0);
        if rng.uniform() < mirrored {
            return 1.0;
        }
        while survival > 1e-6 {
            depth -= mu * (1.0 - rng.uniform()).ln();
            while depth < 0.0 {
                let cos: f64 = -mu;
                let cos2 = 1.0 - ETA * ETA * (1.0 - cos * cos);
                if cos2 > 0.0 && rng.uniform() >= reflectance(cos, cos2.sqrt()) {
                    return survival;
                }
                // What is left of the way goes down again.
                (depth, mu) = (-depth, -mu);
            }
            survival *= albedo;
            mu = 2.0 * rng.uniform() - 1.0;
        }
        0.0
    }))
}

/// Light is scattered twice on average before it is as far as rays start from surfaces: what it passes there counts.
#[test]
fn a_medium_denser_than_rays_keep_from_surfaces_is_as_bright_as_any() {
    let albedo = 0.98;
    let slab =
        Mesh::cube(1.0).placed([0.02, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.02], 1.0, [0.0, 0.01, 0.0]);
    let slab = slab.text("slab", "surface") + &model("slab");
    let mut scene = in_even_light(ETA, [2e4 * (1.0 - albedo), 2e4 * albedo], "<uniform/>", &slab);
    assert!(scene.nudge_m > 0.99e-4);
    let expected = half_space(400_000, albedo);
    let measured = luminance_in_mode(&mut scene, MODES[0], 16, 160);
    assert_near("half-space", &measured, AROUND * NITS_PER_UNIFORM * expected.mean(), 1e-2);
}

/// Mean number of rays that path tracing casts for a sample.
fn rays_per_sample(scene: &Scene, passes: u64) -> f64 {
    let driver = Driver::new(scene, 3);
    let mut delta = FilmState::new(scene.film.size, driver.layers()).delta();
    let mut tracer = driver.tracer();
    for unit in 0..driver.units(passes) {
        driver.render_unit(scene, unit, &mut tracer, &mut delta);
    }
    tracer.rays() as f64 / (passes * u64::from(SIDE * SIDE)) as f64
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// From inside, by the cosines inside and outside.
fn reflectance(cos: f64, outside: f64) -> f64 {
    let s = (ETA * cos - outside) / (ETA * cos + outside);
    let p = (cos - ETA * outside) / (cos + ETA * outside);
    0.5 * (s * s + p * p)
}

/// Henyey and Greenstein: turned from `d`.
fn scattered(d: [f64; 3], u: f64, v: f64) -> [f64; 3] {
    let root = (1.0 - G * G) / (1.0 - G + 2.0 * G * u);
    let cos = (1.0 + G * G - root * root) / (2.0 * G);
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (s, c) = (TAU * v).sin_cos();
    // Two directions across (Duff et al. 2017).
    let sign = 1.0f64.copysign(d[2]);
    let (a, b) = (-1.0 / (sign + d[2]), -d[0] * d[1] / (sign + d[2]));
    let x = [1.0 + sign * d[0] * d[0] * a, sign * b, -sign * d[0]];
    let y = [b, sign + d[1] * d[1] * a, -d[1]];
    let w = [0, 1, 2].map(|k| cos * d[k] + sin * (c * x[k] + s * y[k]));
    let length = dot(w, w).sqrt();
    w.map(|x| x / length)
}

/// The default `max_depth` of 10,000 neither overflows nor changes the picture, and a smaller one cuts what it says.
#[test]
fn a_ball_of_milk_is_what_another_monte_carlo_finds() {
    let ball = sphere([0.0; 3], RADIUS, "surface");
    for max_depth in [10_000, 100] {
        let mut scene = in_even_light(ETA, MILK, &henyey_greenstein(G), &ball);
        scene.transport.max_depth = max_depth;
        let (expected, events) = milk(6000, max_depth);
        // What the other program counts: most light comes back soon, and the rest stays for long.
        let (least, most) = if max_depth == 100 { (52.0, 64.0) } else { (210.0, 265.0) };
        assert!(events > least && events < most, "{events} events a path");
        // The renderer's paths are as long: a ray to each event and one away, and none to lights, of which there are
        // none to draw in even light. Lengths scatter by 2.2 times their mean, which leaves 4 % here.
        let rays = rays_per_sample(&scene, 100);
        assert!((rays / (events + 1.0) - 1.0).abs() < 0.14, "{rays} rays for {events} events");
        let measured = luminance_in_mode(&mut scene, MODES[0], 16, 8);
        let over_surroundings = Moments::from_parts(
            measured.count(),
            measured.mean() / (AROUND * NITS_PER_UNIFORM),
            measured.variance() / (AROUND * NITS_PER_UNIFORM).powi(2),
        );
        assert_near("milk", &over_surroundings, expected.mean(), 0.05);
        assert_same("milk", &over_surroundings, &expected);
    }
}

/// The third table of `docs/theory/rough-glass.md`: what a white body of fog under a rough surface shows of even light,
/// seen through its middle, and the same body without the fog.
#[test]
fn white_bodies_under_rough_surfaces_are_as_dark_as_stated() {
    const PAGE: &str = include_str!("../../../../docs/theory/rough-glass.md");
    let table = PAGE.split("<!-- table -->").nth(3).expect("three tables");
    let cells =
        |line: &str| line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect::<Vec<f64>>();
    let rows = table.lines().map(cells).filter(|row| row.len() == 3);
    let (mut count, mut faults) = (0, vec![]);
    for row in rows {
        let &[exponent, clear, white] = row.as_slice() else { continue };
        for (coefficient, stated) in [(0.0, clear), (2000.0, white)] {
            let surface = format!(
                "<material><name>rough</name><glossy_transparent><internal_medium_name>m</internal_medium_name>\
                 <exponent>{exponent}</exponent></glossy_transparent></material>"
            );
            let ball = surface + &sphere([0.0; 3], RADIUS, "rough");
            let mut scene = in_even_light(1.4, [0.0, coefficient], "<uniform/>", &ball);
            let measured = luminance_in_mode(&mut scene, MODES[0], 16, 48);
            let share = measured.mean() / (AROUND * NITS_PER_UNIFORM);
            let what = format!("exponent {exponent}, {coefficient}/m: {share:.4}, and not {stated}");
            let error = measured.std_error() / (AROUND * NITS_PER_UNIFORM);
            assert!(error < 2.5e-3, "{what}, ±{error:.1e}");
            // Half of the last digit, and four standard errors.
            if (share - stated).abs() > 0.005 + 4.0 * error {
                faults.push(what);
            }
        }
        count += 1;
    }
    assert_eq!(count, 4);
    assert!(faults.is_empty(), "{faults:#?}");
}
