//! Choosing among very many triangles of a lamp, some of which are hardly ever due.

use indigo_light::{AreaLight, LightTable, Receiver};
use indigo_math::{Real, Vec3, Vec3d};
use indigo_spectrum::{SampledWavelengths, Spectrum};
use indigo_testkit::rng::Rng;

const TRIANGLES: usize = 100_000;
/// Every so many triangles there is a rare one.
const EVERY: usize = 10;
/// Area of a rare triangle over that of another: its probability is 3·10⁻⁸, half of the smallest step of a number
/// with 24 digits.
const RARE: f64 = 0.003;
const DRAWS: u32 = 8_000_000;

fn is_rare(i: usize) -> bool {
    i.is_multiple_of(EVERY)
}

/// Triangles side by side in a plane that looks up.
fn lamp() -> AreaLight {
    let corners: Vec<[Vec3d; 3]> = (0..TRIANGLES)
        .map(|i| {
            let at = Vec3d::new((i % 400) as f64 - 200.0, (i / 400) as f64 - 125.0, 0.0);
            let length = if is_rare(i) { RARE } else { 1.0 };
            [at, at + Vec3d::new(length, 0.0, 0.0), at + Vec3d::new(0.0, 1.0, 0.0)]
        })
        .collect();
    AreaLight::new(Spectrum::uniform(1.0), &corners)
}

/// How often each rare triangle was drawn scatters as chance has it: Σ (x − m)² / m over k Poisson numbers of mean
/// m has the mean k and the variance k (2 + 1/m). 5 standard deviations, for its distribution is a little
/// skew: false alarms below 1e-5. Were the choice made by 24 digits, half of them would never be drawn.
#[track_caller]
fn assert_fair(counts: &[u32], total_area: f64) {
    let mean = f64::from(DRAWS) * RARE * 0.5 / total_area;
    let rare: Vec<f64> =
        counts.iter().enumerate().filter(|(i, _)| is_rare(*i)).map(|(_, &c)| f64::from(c)).collect();
    let k = rare.len() as f64;
    let statistic: f64 = rare.iter().map(|x| (x - mean) * (x - mean) / mean).sum();
    let bound = 5.0 * (k * (2.0 + 1.0 / mean)).sqrt();
    assert!((statistic - k).abs() < bound, "{statistic} for {k} of mean {mean}, bound {bound}");
    let all: f64 = rare.iter().sum();
    assert!((all - k * mean).abs() < 5.0 * (k * mean).sqrt(), "{all} of {}", k * mean);
}

#[test]
fn rare_triangles_get_their_share() {
    let lamp = lamp();
    let area = lamp.area();
    let sphere = (Vec3d::ZERO, 300.0);
    let table = LightTable::new(vec![lamp], vec![], [Some(0)].into_iter(), sphere);
    let lambda = SampledWavelengths::sample(0.5);
    // Above the middle, so that every triangle shows its front.
    let to = Receiver::all_round(Vec3::new(0.0, 0.0, 50.0));
    let mut rng = Rng::new(77);
    let mut counts = vec![0; TRIANGLES];
    for i in 0..DRAWS {
        let u = [0; 4].map(|_| rng.uniform_f32() as Real);
        let point = if i % 2 == 0 {
            table.sample(&to, u, &lambda).and_then(|light| light.point)
        } else {
            table.sample_emission(u, [0.5, 0.5], &lambda).and_then(|emission| emission.point)
        };
        counts[point.expect("the whole lamp is seen").triangle as usize] += 1;
    }
    assert_fair(&counts, area);
}
