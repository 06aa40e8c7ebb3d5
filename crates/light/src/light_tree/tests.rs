use super::*;
use crate::profile::Profile;
use indigo_math::{Real, Vec3, Vec3d};
use indigo_spectrum::Spectrum;
use indigo_testkit::rng::Rng;

fn vector(rng: &mut Rng) -> Vec3d {
    let mut number = || 2.0 * rng.uniform() - 1.0;
    Vec3d::new(number(), number(), number())
}

/// Triangles of some size in a cube of half side 3.
fn triangles(n: usize, size: f64, rng: &mut Rng) -> Vec<[Vec3d; 3]> {
    (0..n)
        .map(|_| {
            let at = vector(rng) * 3.0;
            [(); 3].map(|()| at + vector(rng) * size)
        })
        .collect()
}

/// Matt lamps of one to forty triangles, of fluxes that differ by thousands, and photometric ones: a spot, and one that
/// shines to both sides. One is black.
fn lamps() -> Vec<AreaLight> {
    let mut rng = Rng::new(2);
    let mut lamps: Vec<AreaLight> = (0..12)
        .map(|i: i32| {
            let radiance = if i == 5 { 0.0 } else { 3f64.powi(i) };
            let triangles = triangles(if i % 3 == 0 { 40 } else { 1 }, 0.3, &mut rng);
            AreaLight::new(Spectrum::uniform(radiance), &triangles)
        })
        .collect();
    let up = Vec3d::new(0.0, 0.0, 1.0);
    for (angles, candela) in [([0.0, 20.0, 90.0], [1e3, 0.0, 0.0]), ([0.0, 90.0, 180.0], [9.0, 5.0, 50.0])] {
        let lamp = AreaLight::new(Spectrum::uniform(1.0), &triangles(2, 0.2, &mut rng));
        lamps.extend(lamp.with_profile(Profile::new(&angles, &[0.0], &candela), up));
    }
    lamps
}

fn receiver(rng: &mut Rng) -> Receiver {
    let (p, n) = ((vector(rng) * 4.0).cast(), vector(rng).normalized().cast());
    match (rng.uniform() * 3.0) as u32 {
        0 => Receiver::all_round(p),
        1 => Receiver::lit_through(p, n),
        _ => Receiver::facing(p, n),
    }
}

/// All triangles by lamp and number.
fn all(lamps: &[AreaLight]) -> Vec<(usize, u32)> {
    let of_lamp = |(i, lamp): (usize, &AreaLight)| (0..lamp.len() as u32).map(move |t| (i, t));
    lamps.iter().enumerate().flat_map(of_lamp).collect()
}

/// Draws that find nothing are left out of both.
#[test]
fn triangles_are_drawn_with_the_stated_probabilities() {
    let lamps = lamps();
    let tree = LightTree::new(&lamps);
    let all = all(&lamps);
    let mut rng = Rng::new(3);
    let n = 40_000;
    for _ in 0..12 {
        let to = receiver(&mut rng);
        let expected: Vec<f64> = all.iter().map(|&(lamp, t)| tree.probability(lamp, t, &to)).collect();
        let mut counts = vec![0.0; all.len()];
        for _ in 0..n {
            let Some((slot, probability)) = tree.sample(&to, rng.uniform()) else { continue };
            let i = all.iter().position(|&a| a == (slot.lamp as usize, slot.triangle)).expect("one of them");
            assert!((probability / expected[i] - 1.0).abs() < 1e-9, "{probability} {}", expected[i]);
            counts[i] += 1.0;
        }
        assert!(expected.iter().sum::<f64>() < 1.0 + 1e-6);
        // Those that are due less than five times are one together.
        let (mut rare, mut chi2, mut cells) = ([0.0; 2], 0.0, 0.0);
        for (count, probability) in counts.iter().zip(&expected) {
            let due = probability * f64::from(n);
            if due < 5.0 {
                rare = [rare[0] + count, rare[1] + due];
            } else {
                chi2 += (count - due).powi(2) / due;
                cells += 1.0;
            }
        }
        // 5 standard deviations of chi-square and of a Poisson number, for each of 12: false alarms below 1e-4.
        assert!(chi2 - cells < 5.0 * f64::sqrt(2.0 * cells) + 5.0, "{to:?}: {chi2} for {cells}");
        assert!((rare[0] - rare[1]).abs() < 5.0 * rare[1].sqrt() + 5.0, "{to:?}: {rare:?}");
    }
}

/// What sends light to a receiver can be drawn for it.
#[test]
fn no_light_is_left_out() {
    let lamps = lamps();
    let tree = LightTree::new(&lamps);
    let mut rng = Rng::new(4);
    let lambda = indigo_spectrum::SampledWavelengths::sample(0.5);
    let mut lit = 0;
    for _ in 0..400 {
        let to = receiver(&mut rng);
        for &(lamp, triangle) in &all(&lamps) {
            let at = [0; 2].map(|_| rng.uniform() as Real);
            let point = lamps[lamp].sample_point_of(triangle as usize, at);
            let wi = (point.p - to.p).normalized();
            let is_seen = lamps[lamp].is_two_sided() || -wi.dot(point.n) > 1e-4;
            let is_lit = is_seen && to.cos_arriving(wi).is_none_or(|cos| cos > 1e-4);
            if is_lit && !lamps[lamp].emitted(triangle, point.bary, -wi, &lambda).is_black() {
                lit += 1;
                assert!(tree.probability(lamp, triangle, &to) > 0.0, "lamp {lamp}, {to:?}");
            }
        }
    }
    assert!(lit > 1000);
}

fn square(at: Vec3d, half: f64, flux: f64) -> AreaLight {
    let corner = |x: f64, y: f64| at + Vec3d::new(x * half, y * half, 0.0);
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    AreaLight::new(Spectrum::uniform(1.0), &[[a, b, c], [a, c, d]]).with_flux(flux).expect("a lamp")
}

/// Lamps that look down: the share of each is by flux, squared distance and both cosines, to what its extent leaves open.
#[test]
fn small_lamps_are_drawn_by_what_they_give() {
    let lamps =
        [([0.0, 0.0, 2.0], 10.0), ([3.0, 0.0, 2.0], 40.0), ([50.0, 0.0, 2.0], 1e6), ([0.0, 0.0, -1.0], 1e9)];
    let given = lamps.map(|(at, flux)| {
        let at = Vec3d::from(at);
        let distance2 = at.length2();
        if at.z > 0.0 { flux * at.z * at.z / (distance2 * distance2) } else { 0.0 }
    });
    let tree = LightTree::new(&lamps.map(|(at, flux)| square(Vec3d::from(at), 1e-4, flux)));
    let to = Receiver::facing(Vec3::ZERO, Vec3::new(0.0, 0.0, 1.0));
    // Not exactly, for what two share a node is known of both together: by a factor of 3.
    let share = |i: usize| (0..2).map(|t| tree.probability(i, t, &to)).sum::<f64>();
    let total: f64 = given.iter().sum();
    for (i, g) in given.iter().enumerate() {
        let due = g / total;
        assert!(share(i) >= due / 3.0 && share(i) <= due * 3.0, "{i}: {} of {due}", share(i));
    }
}

/// A lamp as its corners know it: of a hundred thousand triangles none is drawn that lies across the hall.
#[test]
fn the_near_parts_of_a_large_lamp_are_drawn() {
    let n = 224;
    let at = |i: usize| (i as f64 / n as f64 - 0.5) * 100.0;
    let corner = |x: usize, y: usize| Vec3d::new(at(x), at(y), 3.0);
    let faces = (0..n * n).flat_map(|i| {
        let (x, y) = (i % n, i / n);
        let [a, b, c, d] = [corner(x, y), corner(x, y + 1), corner(x + 1, y + 1), corner(x + 1, y)];
        [[a, b, c], [a, c, d]]
    });
    let lamps = [AreaLight::new(Spectrum::uniform(1.0), &faces.collect::<Vec<_>>())];
    let tree = LightTree::new(&lamps);
    // The memory that the decision on the tree states for a triangle.
    let bytes = tree.nodes.len() * size_of::<Node>() + tree.slots.len() * (size_of::<Slot>() + 4);
    assert!(bytes < 100 * lamps[0].len(), "{bytes}");
    let to = Receiver::facing(Vec3::new(20.0, 30.0, 0.0), Vec3::new(0.0, 0.0, 1.0));
    let mut rng = Rng::new(6);
    let mut near = 0;
    for _ in 0..1000 {
        let (slot, _) = tree.sample(&to, rng.uniform()).expect("all of it is seen");
        let p = lamps[0].sample_point_of(slot.triangle as usize, [0.5; 2]).p;
        near += u32::from((p - to.p).length() < 9.0);
    }
    // From within 9 m comes 8/9 of the light of an endless ceiling 3 m up: r² / (r² + h²), r² = 72. By power it would be
    // drawn some 23 times.
    assert!(near > 300, "{near}");
}
