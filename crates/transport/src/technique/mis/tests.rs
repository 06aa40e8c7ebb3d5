//! The recursion against explicit products of densities, on random paths.

use super::*;
use indigo_math::{Float, Vec3, rng::Rng};
use indigo_spectrum::{LANES, SampledSpectrum};

/// Densities of a path of vertices 0 (on the light, or a direction of the environment) to n − 1 (on the lens), all by lane where they may be.
struct Path {
    n: usize,
    is_distant: bool,
    /// Whether the camera's rays are.
    is_parallel: bool,
    /// Of the emission's point and direction, and of drawing the point for vertex 1 (1/m²); or of the emission's direction
    /// and place, and of drawing the direction (1/sr).
    first: Real,
    second: Real,
    drawn: Real,
    /// Of the camera's direction, and the lanes of its diffraction.
    camera: Real,
    lens: LanePdf,
    /// At each vertex the density (1/sr) of going on to the next one, as the light does, and back.
    onwards: Vec<LanePdf>,
    back: Vec<LanePdf>,
    is_delta: Vec<bool>,
    /// Reach of each vertex towards the one before and the one after it.
    reach: Vec<[LanePdf; 2]>,
    /// From each vertex to the next: squared distance, and the chance to get there unscattered.
    distance2: Vec<Real>,
    free: Vec<LanePdf>,
}

fn number(rng: &mut Rng) -> Real {
    // Over a decade either way.
    (10f64.powf(2.0 * rng.next_f64() - 1.0)) as Real
}

/// Positive for the hero, and now and then 0 in another lane.
fn lanes(rng: &mut Rng) -> LanePdf {
    LanePdf::from_fn(|lane| if lane > 0 && rng.next_f64() < 0.1 { 0.0 } else { number(rng) })
}

impl Path {
    fn random(rng: &mut Rng, n: usize) -> Self {
        let mut path = Self {
            n,
            is_distant: rng.next_f64() < 0.5,
            is_parallel: rng.next_f64() < 0.3,
            first: number(rng),
            second: number(rng),
            drawn: number(rng),
            camera: number(rng),
            lens: lanes(rng),
            onwards: (0..n).map(|_| lanes(rng)).collect(),
            back: (0..n).map(|_| lanes(rng)).collect(),
            is_delta: (0..n).map(|i| i > 0 && i < n - 1 && rng.next_f64() < 0.3).collect(),
            reach: (0..n).map(|_| [LanePdf::splat(number(rng)), LanePdf::splat(number(rng))]).collect(),
            distance2: (0..n).map(|_| number(rng)).collect(),
            free: (0..n).map(|_| lanes(rng)).collect(),
        };
        path.lens = path.lens.ratio_to_hero();
        // A direction of the environment is never that of parallel rays.
        path.is_parallel &= !(path.is_distant && n == 2);
        if path.is_distant {
            // What has no place has no distance, and no surface.
            path.distance2[0] = 1.0;
            path.reach[0][1] = LanePdf::ONE;
        }
        for i in 1..n - 1 {
            if path.is_delta[i] {
                // A mirror or glass is as likely to be left one way as the other.
                path.back[i] = path.onwards[i];
            } else if rng.next_f64() < 0.3 {
                // In a medium: the same coefficient both ways.
                path.reach[i] = [lanes(rng); 2];
            }
        }
        path
    }

    /// How vertex `j` is found by the light's path, and by the camera's.
    fn forwards(&self, j: usize, s: usize) -> LanePdf {
        let step = |density: LanePdf| density * self.reach[j][0] * self.free[j - 1] / self.distance2[j - 1];
        match j {
            0 if s == 1 => LanePdf::splat(self.drawn),
            0 => LanePdf::splat(self.first),
            1 => step(LanePdf::splat(self.second)),
            _ => step(self.onwards[j - 1]),
        }
    }

    /// Density of the camera's direction (1/sr); that of parallel rays is one over area.
    fn camera_pdf(&self) -> Real {
        if self.is_parallel { self.camera * self.distance2[self.n - 2] } else { self.camera }
    }

    fn backwards(&self, j: usize) -> LanePdf {
        if j == self.n - 1 {
            return self.lens;
        }
        let density = if j == self.n - 2 { LanePdf::splat(self.camera_pdf()) } else { self.back[j + 1] };
        density * self.reach[j][1] * self.free[j] / self.distance2[j]
    }

    /// The density of making it with `s` vertices of the light.
    fn density(&self, s: usize) -> [f64; LANES] {
        let mut p = [1.0; LANES];
        for j in 0..self.n {
            let factor = if j < s { self.forwards(j, s) } else { self.backwards(j) };
            for (p, f) in p.iter_mut().zip(factor.0) {
                *p *= f.to_f64();
            }
        }
        p
    }

    fn is_possible(&self, s: usize) -> bool {
        s == 0 || !(self.is_delta[s - 1] || self.is_delta[s])
    }

    fn strategies(&self) -> impl Iterator<Item = usize> {
        (0..self.n).filter(|&s| self.is_possible(s))
    }

    fn drawn_at(&self, i: usize, density: LanePdf, reverse: LanePdf) -> Scattered {
        Scattered {
            wi: Vec3::ZERO,
            weight: SampledSpectrum::ONE,
            pdf: density,
            pdf_rev: reverse,
            is_delta: self.is_delta[i],
            is_transmitted: false,
        }
    }

    /// The light's prefix at vertex `k` of at least 1.
    fn light_prefix(&self, k: usize) -> Prefix {
        let cos = self.reach[0][1].hero();
        let mut step = Step::from_light(self.first, self.second, cos);
        for j in 1.. {
            let (reach, free) = (self.reach[j][0], self.free[j - 1]);
            let mut prefix = if self.is_distant && j == 1 {
                step.arrive_from_environment(reach, free)
            } else {
                step.arrive(self.distance2[j - 1], reach, free)
            };
            if j == 1 {
                prefix.before *= self.drawn / self.first;
            }
            if j == k {
                return prefix;
            }
            step = prefix.step(&self.drawn_at(j, self.onwards[j], self.back[j]), self.reach[j][1]);
        }
        unreachable!()
    }

    /// The camera's prefix at vertex `k` of at most n − 2.
    fn camera_prefix(&self, k: usize) -> Prefix {
        let mut step = Step::from_camera(self.camera, self.lens, self.is_parallel);
        for j in (0..self.n - 1).rev() {
            let prefix = if self.is_distant && j == 0 {
                step.arrive_at_environment(self.free[j])
            } else {
                step.arrive(self.distance2[j], self.reach[j][1], self.free[j])
            };
            if j == k {
                return prefix;
            }
            step = prefix.step(&self.drawn_at(j, self.back[j], self.onwards[j]), self.reach[j][0]);
        }
        unreachable!()
    }

    /// The weight of strategy `s` as the technique gets it.
    fn weight(&self, s: usize) -> Weight {
        if s == 0 {
            let prefix = self.camera_prefix(0);
            let others = if self.n == 2 {
                prefix.others_at_seen_light(self.drawn)
            } else {
                prefix.others_at_light(self.drawn, self.first, self.second)
            };
            return Weight::new(prefix.ratio, others);
        }
        // The joined vertices are s − 1 and s.
        let free = self.free[s - 1] / self.distance2[s - 1];
        if s == 1 {
            let in_angle = self.drawn * self.distance2[0] / self.reach[0][1].hero();
            if self.n == 2 {
                return Weight::straight(self.lens, self.free[0] * self.camera_pdf(), in_angle);
            }
            let prefix = self.camera_prefix(1);
            let found = self.reach[1][0] * free * self.second;
            let met = self.back[1] * self.free[0] / in_angle;
            let others = prefix.others(found, self.onwards[1]);
            return Weight::drawn_light(prefix.ratio, met, others, self.first / self.drawn);
        }
        let light = self.light_prefix(s - 1);
        let to_camera = if s == self.n - 1 { LanePdf::splat(self.camera_pdf()) } else { self.back[s] };
        let others_light = light.others(to_camera * self.reach[s - 1][1] * free, self.back[s - 1]);
        if s == self.n - 1 {
            return Weight::joint(light.ratio, others_light, self.lens, LanePdf::ZERO);
        }
        let camera = self.camera_prefix(s);
        let found = self.onwards[s - 1] * self.reach[s][0] * free;
        let others_camera = camera.others(found, self.onwards[s]);
        Weight::joint(light.ratio, others_light, camera.ratio, others_camera)
    }
}

#[test]
fn weights_are_those_of_explicit_products_and_sum_to_one() {
    let mut rng = Rng::new(20);
    let power = |p: f64| if SQUARED { p * p } else { p };
    let mut compared = 0;
    for case in 0..3000 {
        let path = Path::random(&mut rng, 2 + case % 8);
        let densities: Vec<_> = path.strategies().map(|s| (s, path.density(s))).collect();
        let sum: f64 = densities.iter().flat_map(|(_, p)| p).map(|p| power(*p)).sum();
        let mut total = 0.0;
        for (s, p) in &densities {
            let expected = p.iter().map(|p| power(*p)).sum::<f64>() / sum;
            let Weight { weight, mean_ratio } = path.weight(*s);
            let (weight, mean_ratio) = (weight.to_f64(), mean_ratio.to_f64());
            // Some thirty roundings of single precision, squared.
            let near = |a: f64, b: f64| (a - b).abs() <= 2e-5 * b.abs().max(1e-6);
            assert!(near(weight, expected), "case {case}, strategy {s}: {weight} instead of {expected}");
            let mean = p.iter().sum::<f64>() / LANES as f64 / p[0];
            assert!(
                near(mean_ratio, mean),
                "case {case}, strategy {s}: ratio {mean_ratio} instead of {mean}"
            );
            total += weight;
            compared += 1;
        }
        assert!((total - 1.0).abs() < 1e-4, "case {case}: weights sum to {total}");
    }
    assert!(compared > 9_000, "{compared} strategies are few");
}
