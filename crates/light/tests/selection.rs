//! Choosing among very many triangles of a lamp, some of which are hardly ever due.

use indigo_light::{AreaLight, EmitterHit, LightTable, Receiver};
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

/// How often each rare triangle was drawn scatters as chance has it: Σ (x − m)² / m over k Poisson numbers of means
/// m has the mean k and the variance Σ (2 + 1/m). 5 standard deviations, for its distribution is a little
/// skew: false alarms below 1e-5. Were the choice made by 24 digits, half of them would never be drawn.
#[track_caller]
fn assert_fair(what: &str, counts: &[u32], mean: impl Fn(usize) -> f64) {
    let rare = || (0..TRIANGLES).filter(|&i| is_rare(i)).map(|i| (f64::from(counts[i]), mean(i)));
    let k = rare().count() as f64;
    let statistic: f64 = rare().map(|(x, m)| (x - m) * (x - m) / m).sum();
    let bound = 5.0 * rare().map(|(_, m)| 2.0 + 1.0 / m).sum::<f64>().sqrt();
    assert!((statistic - k).abs() < bound, "{what}: {statistic} for {k}, bound {bound}");
    let (all, due) = rare().fold((0.0, 0.0), |(a, d), (x, m)| (a + x, d + m));
    assert!((all - due).abs() < 5.0 * due.sqrt(), "{what}: {all} of {due}");
}

/// Light leaves a triangle by its area, and is drawn for a receiver with the probability that is stated.
#[test]
fn rare_triangles_get_their_share() {
    let lamp = lamp();
    let total = lamp.area();
    let sphere = (Vec3d::ZERO, 300.0);
    let table = LightTable::new(vec![lamp], vec![], [Some(0)].into_iter(), sphere);
    let lambda = SampledWavelengths::sample(0.5);
    // Above the middle, so that every triangle shows its front.
    let to = Receiver::all_round(Vec3::new(0.0, 0.0, 50.0));
    let mut rng = Rng::new(77);
    let mut counts = [vec![0; TRIANGLES], vec![0; TRIANGLES]];
    for i in 0..DRAWS {
        let u = [0; 4].map(|_| rng.uniform_f32() as Real);
        let point = if i % 2 == 0 {
            table.sample(&to, u, &lambda).and_then(|light| light.point)
        } else {
            table.sample_emission(u, [0.5, 0.5], &lambda).and_then(|emission| emission.point)
        };
        counts[i as usize % 2][point.expect("the whole lamp is seen").triangle as usize] += 1;
    }
    let of_each = f64::from(DRAWS / 2);
    assert_fair("sent", &counts[1], |_| of_each * RARE * 0.5 / total);
    let (p, n) = (Vec3::ZERO, Vec3::new(0.0, 0.0, 1.0));
    assert_fair("drawn", &counts[0], |i| {
        // Over area, from the density over directions of a point 50 m below.
        let hit = EmitterHit { object: 0, triangle: i as u32, bary: (0.3, 0.3), p, n };
        of_each * RARE * 0.5 * f64::from(table.pdf_object(&hit, &to)) / (50.0 * 50.0)
    });
}
