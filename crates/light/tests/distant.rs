//! The laws that every distant light keeps: what it draws, with what density, and how much light it gives.
//!
//! Statistical tests share a false-alarm probability of 1e-4; seeds are fixed.

use indigo_light::{Distant, DistantLight};
use indigo_math::{Real, Vec3, Vec3d};
use indigo_spectrum::SampledWavelengths;
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::{MeanTest, welch};

const UP: Vec3 = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

/// Receivers that the laws of distant lights are tried with: all round, level and upright.
const NORMALS: [Vec3; 3] = [Vec3::ZERO, UP, Vec3 { x: 0.6, y: -0.8, z: 0.0 }];

/// Bands of height and sectors of azimuth in which directions are counted.
const BINS: [usize; 2] = [8, 12];

fn bin(d: Vec3) -> usize {
    let part = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
    let azimuth = (d.y as f64).atan2(d.x as f64) / std::f64::consts::TAU + 0.5;
    part(0.5 * (1.0 + d.z as f64), BINS[0]) * BINS[1] + part(azimuth, BINS[1])
}

fn any_direction(rng: &mut Rng) -> Vec3 {
    let (z, turns) = (2.0 * rng.uniform() - 1.0, rng.uniform() * std::f64::consts::TAU);
    let r = (1.0 - z * z).sqrt();
    Vec3d::new(r * turns.cos(), r * turns.sin(), z).cast()
}

/// A distant light draws directions with the density that it states, for all receivers. Densities jump,
/// which quadrature takes badly: their mean over even directions of a bin is compared with the bin's
/// share of the draws instead.
#[test]
fn distant_lights_follow_their_densities() {
    let examples = DistantLight::examples();
    let bins = BINS[0] * BINS[1];
    let level = 1e-4 / (examples.len() * NORMALS.len() * (bins + 1)) as f64;
    for (i, (kind, light)) in examples.iter().enumerate() {
        for (j, n) in NORMALS.into_iter().enumerate() {
            let mut rng = Rng::new(70 + (NORMALS.len() * i + j) as u64);
            let mut drawn = vec![0.0; bins + 1];
            let count = 100_000;
            for _ in 0..count {
                let u = [0; 2].map(|_| rng.uniform_f32() as Real);
                let Some(d) = light.sample(n, u) else { continue };
                assert!((d.length() - 1.0).abs() < 1e-5, "{kind}: {d:?}");
                drawn[bin(d)] += 1.0;
                drawn[bins] += 1.0;
            }
            let mut stated = vec![Moments::default(); bins + 1];
            for _ in 0..3 * count {
                let d = any_direction(&mut rng);
                let density = light.pdf(n, d) as f64 * 4.0 * std::f64::consts::PI;
                let hit = bin(d);
                (0..bins).for_each(|k| stated[k].add(if k == hit { density } else { 0.0 }));
                stated[bins].add(density);
            }
            for (k, (drawn, stated)) in drawn.iter().zip(&stated).enumerate() {
                let share: f64 = drawn / f64::from(count);
                let drawn = Moments::from_parts(count as u64, share, share * (1.0 - share));
                let test: MeanTest = welch(&drawn, stated, 1e-5).at(level);
                assert!(test.passed(), "{kind}, example {i}, receiver {j}, bin {k} of {bins}: {test}");
            }
        }
    }
}

/// What shines can be drawn, by a receiver that looks at it.
#[test]
fn distant_light_is_drawn_from_wherever_it_shines() {
    let mut rng = Rng::new(8);
    for (kind, light) in DistantLight::examples() {
        for _ in 0..20_000 {
            let d = any_direction(&mut rng);
            let radiance = light.radiance(d, &SampledWavelengths::sample(rng.uniform_f32() as Real));
            assert!(radiance.min_lane() >= 0.0 && radiance.is_finite(), "{kind}: {radiance:?}");
            for n in NORMALS {
                let counts = n == Vec3::ZERO || n.dot(d) > 1e-3;
                assert!(radiance.is_black() || !counts || light.pdf(n, d) > 0.0, "{kind}: {d:?}");
            }
        }
    }
}

/// The stated total is the luminance that drawn directions add up to: mean of luminance over density.
#[test]
fn distant_lights_state_their_total() {
    let examples = DistantLight::examples();
    for (kind, light) in &examples {
        let mut rng = Rng::new(9);
        let estimates = Moments::of((0..200_000).map(|_| {
            let [u, v, w] = [0; 3].map(|_| rng.uniform_f32() as Real);
            let lambda = SampledWavelengths::sample(w);
            let Some(d) = light.sample(Vec3::ZERO, [u, v]) else { return 0.0 };
            let y = indigo_spectrum::observer::xyz_weights(&lambda)[1];
            let radiance = light.radiance(d, &lambda);
            let luminance: f64 = radiance.0.iter().zip(y).map(|(l, y)| (l * y) as f64).sum();
            luminance / light.pdf(Vec3::ZERO, d) as f64
        }));
        let expected = light.total_luminance();
        // The stated total serves to choose among lights; it need be no better than a table's cells.
        let test: MeanTest =
            welch(&estimates, &Moments::exact(expected), 2e-3 * expected).at(1e-4 / examples.len() as f64);
        assert!(test.passed() && test.std_error < 5e-3 * expected, "{kind}: {test}");
    }
}
