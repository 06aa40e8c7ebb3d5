//! The picture of a lamp behind an aperture, against theory.

use super::spread::Spread;
use super::{Diffraction, Kernel, NEAR, SPACING};
use crate::Region;
use crate::convolution::Room;
use indigo_camera::{Aperture, Blades, FarField, Pupil};
use indigo_film::{FilmSize, XyzImage};
use indigo_spectrum::observer::cmf;
use indigo_testkit::fit::lowest_point;
use std::sync::{Arc, LazyLock};

static CIRCLE: LazyLock<FarField> = LazyLock::new(|| far_field(Aperture::Circular));

fn far_field(aperture: Aperture) -> FarField {
    Pupil::new(aperture, None).far_field().unwrap()
}

fn blades(count: i64, start_angle: f64) -> FarField {
    far_field(Aperture::generated(&Blades::new(count, start_angle, 0.4, 1e3).unwrap()))
}

/// What a lamp of one pixel looks like: offsets up to `reach` pixels, x to the right and y up, with X, Y and
/// Z. A cycle at 550 nm is so many pixels wide.
fn kernel(field: &FarField, pixels_per_cycle: f64, reach: usize) -> Vec<([f64; 2], [f64; 3])> {
    let kernel = Kernel::new(field, [reach + 1; 2], [pixels_per_cycle / 550.0; 2]);
    let reach = reach as i64;
    let offsets = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
    offsets.map(|(x, y)| ([x as f64, y as f64], kernel.at(x, -y))).collect()
}

/// Bessel's function of order n by its integral, (1/π) ∫ cos(n t - x sin t) dt over [0, π]; the
/// trapezoidal rule is exact to rounding once it has more points than x.
fn bessel(n: f64, x: f64) -> f64 {
    let points = 64 + 2 * x.abs() as usize;
    let at = |k: usize| {
        let t = std::f64::consts::PI * k as f64 / points as f64;
        let weight = if k == 0 || k == points { 0.5 } else { 1.0 };
        weight * (n * t - x * t.sin()).cos()
    };
    (0..=points).map(at).sum::<f64>() / points as f64
}

/// The part of white light of component `c` within a distance in cycles of 550 nm, behind a circle.
fn airy_within(c: usize, cycles: f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for lambda in (360..=830).step_by(2).map(f64::from) {
        let x = std::f64::consts::PI * cycles * 550.0 / lambda;
        let weight = cmf(lambda)[c];
        sum += weight * (1.0 - bessel(0.0, x).powi(2) - bessel(1.0, x).powi(2));
        weights += weight;
    }
    sum / weights
}

/// Sums of the picture within a distance in pixels, and what theory says for each of X, Y and Z.
fn assert_airy(pixels_per_cycle: f64, reach: usize, radii: &[f64]) {
    let kernel = kernel(&CIRCLE, pixels_per_cycle, reach);
    for &radius in radii {
        for c in 0..3 {
            let inside = kernel.iter().filter(|([x, y], _)| x.hypot(*y) <= radius);
            let within: f64 = inside.map(|(_, p)| p[c]).sum();
            let exact = airy_within(c, radius / pixels_per_cycle);
            assert!(
                ((1.0 - within) / (1.0 - exact) - 1.0).abs() < 0.02 && (within / exact - 1.0).abs() < 0.01,
                "component {c} within {radius} pixels at {pixels_per_cycle}: {within} instead of {exact}"
            );
        }
    }
}

/// The core, wide as seen in pixels.
#[test]
fn a_small_circle_makes_a_large_airy_disc() {
    assert_airy(12.0, 150, &[10.0, 14.64, 20.0, 40.0, 120.0]);
}

/// The tail, far out as seen in cycles: some of the rings of the far field, and what lies beyond them.
#[test]
fn a_large_circle_makes_a_tail() {
    // 0.2 pixels a cycle: the last ring of the far field lies at 100 pixels for green light.
    assert_airy(0.2, 300, &[5.5, 15.5, 23.5, 26.5, 60.5, 120.5, 280.5]);
}

/// The profile has no step where sums over points end.
#[test]
fn near_and_far_meet() {
    for pixels_per_cycle in [0.1, 1.0] {
        let kernel = kernel(&CIRCLE, pixels_per_cycle, 50);
        let mean = |lo: f64, hi: f64| {
            let ring = kernel.iter().filter(|([x, y], _)| (lo..=hi).contains(&x.abs().max(y.abs())));
            let values: Vec<f64> = ring.map(|([x, y], p)| p[1] * x.hypot(*y).powi(3)).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let (near, far) = (mean(22.0, 24.0), mean(25.0, 27.0));
        assert!((near / far - 1.0).abs() < 0.03, "{pixels_per_cycle}: {near} and {far}");
    }
}

/// All light goes somewhere.
#[test]
fn light_is_kept() {
    for pixels_per_cycle in [0.01, 0.3, 3.0] {
        let kernel = kernel(&CIRCLE, pixels_per_cycle, 200);
        for c in 0..3 {
            let sum: f64 = kernel.iter().map(|(_, p)| p[c]).sum();
            // A square holds more than the circle in it; what lies beyond falls with the distance.
            let lost = 1.0 - airy_within(c, 200.0 / pixels_per_cycle);
            assert!(sum <= 1.0 + 1e-6 && sum >= 1.0 - lost - 1e-6, "{pixels_per_cycle}: {sum}, {lost}");
        }
        assert!(kernel.iter().all(|(_, p)| p.iter().all(|v| *v >= 0.0)));
    }
}

/// Neither an aperture of a nanometre nor pixels a thousand times as wide as high take more than a few points for each
/// sector of the far field and each pixel.
#[test]
fn absurd_cameras_take_no_longer() {
    for [x, y] in [[1.0, 1.0], [1e6, 1e6], [1e12, 1e12], [1.0, 1e-3]] {
        let cycle: [f64; 2] = [x / 550.0, y / 550.0];
        let spread = Spread::new(&CIRCLE, 40.0 * (1.0 / cycle[0]).hypot(1.0 / cycle[1]));
        let sectors = spread.sectors(cycle, (NEAR + 1) as f64);
        let rings = spread.radii.len() - 1;
        let mut points = 0u64;
        spread.for_each_point(0..rings, &sectors, SPACING, |_, _| points += 1);
        let cells = (rings * sectors.len()) as u64;
        assert!(points < 2 * cells + 1_000_000, "{x} and {y} pixels a cycle: {points} points");
        let kernel = Kernel::new(&CIRCLE, [40, 40], cycle);
        let sum: f64 =
            (-39..40).flat_map(|y| (-39..40).map(move |x| (x, y))).map(|(x, y)| kernel.at(x, y)[1]).sum();
        // Far from the middle a pixel has the density in its own middle, which is no mean over one so wide.
        assert!((0.0..1.1).contains(&sum), "{x} and {y} pixels a cycle: {sum}");
    }
}

/// Number of bright directions at a distance, and that of the brightest, in turns from the right.
fn streaks(kernel: &[([f64; 2], [f64; 3])], radius: f64) -> (usize, f64) {
    let bins = 360;
    let mut sums = vec![0.0; bins];
    for ([x, y], p) in kernel.iter().filter(|([x, y], _)| (x.hypot(*y) / radius - 1.0).abs() < 0.2) {
        let turn = (y.atan2(*x) / std::f64::consts::TAU).rem_euclid(1.0);
        sums[(turn * bins as f64) as usize % bins] += p[1];
    }
    let mean = sums.iter().sum::<f64>() / bins as f64;
    let is_peak = |i: &usize| {
        let around =
            (1..8).all(|k| sums[*i] >= sums[(i + k) % bins] && sums[*i] > sums[(i + bins - k) % bins]);
        around && sums[*i] > 3.0 * mean
    };
    let brightest = (0..bins).max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    ((0..bins).filter(is_peak).count(), brightest as f64 / bins as f64)
}

#[test]
fn five_blades_make_ten_streaks_and_six_make_six() {
    for (n, count) in [(5, 10), (6, 6), (7, 14), (8, 8)] {
        let kernel = kernel(&blades(n, 0.1), 0.1, 200);
        for radius in [20.0, 60.0, 140.0] {
            assert_eq!(streaks(&kernel, radius).0, count, "{n} blades at {radius}");
        }
    }
}

/// Streaks stand across edges: with four blades at 0.35 rad one of them points there, in a picture whose
/// rows count downwards.
#[test]
fn streaks_turn_with_the_blades() {
    let kernel = kernel(&blades(4, 0.35), 0.1, 200);
    for radius in [20.0, 140.0] {
        let (count, brightest) = streaks(&kernel, radius);
        let off = (brightest - 0.35 / std::f64::consts::TAU) * 4.0;
        assert!(count == 4 && (off - off.round()).abs() < 0.03, "{count} streaks, at {brightest} turns");
    }
}

/// Red light is spread more than blue, so a white lamp's halo is red outside its blue.
#[test]
fn halos_are_red_outside() {
    let kernel = kernel(&CIRCLE, 4.0, 64);
    let sum = |c: usize| {
        let far = kernel.iter().filter(|([x, y], _)| x.hypot(*y) > 8.0);
        far.map(|(_, p)| p[c]).sum::<f64>()
    };
    assert!(sum(0) > 1.15 * sum(2), "{} {}", sum(0), sum(2));
}

#[test]
fn only_the_region_is_touched() {
    let size = FilmSize::new(32, 24, 2).unwrap();
    let pixels: Vec<[f32; 4]> = (0..size.internal_pixels()).map(|i| [(i % 7) as f32; 4]).collect();
    let before = XyzImage { size, missing: vec![false; pixels.len()], pixels };
    let mut after = before.clone();
    let region = Region::new([4, 2], [20, 22], size).unwrap();
    let pupil = Pupil::new(Aperture::Circular, None);
    Diffraction::new(pupil, [2e-4, 2e-4]).apply(&mut after, region);
    let mut changed = 0;
    for (i, (a, b)) in before.pixels.iter().zip(&after.pixels).enumerate() {
        let (x, y) = (i % 64, i / 64);
        if (8..40).contains(&x) && (4..44).contains(&y) {
            changed += usize::from(a[1] != b[1]);
            assert_eq!(a[3], b[3], "coverage is no light");
        } else {
            assert_eq!(a, b);
        }
    }
    assert!(changed > 900, "{changed}");
}

/// The picture of lamps behind an aperture, a cycle at 550 nm being so many pixels wide.
fn shine(aperture: Aperture, pixels_per_cycle: f64, side: u32, light: impl Fn([f64; 2]) -> f32) -> XyzImage {
    let size = FilmSize::new(side, side, 1).unwrap();
    let middle = f64::from(side / 2);
    let at = |i: u32| [f64::from(i % side) - middle, f64::from(i / side) - middle];
    let pixels: Vec<_> = (0..side * side).map(|i| [light(at(i)); 4]).collect();
    let mut image = XyzImage { size, missing: vec![false; pixels.len()], pixels };
    let cycle = pixels_per_cycle / 550.0 / f64::from(side);
    Diffraction::new(Pupil::new(aperture, None), [cycle; 2]).apply(&mut image, Region::whole(size));
    image
}

/// The first two dark rings of the picture of a point, where they are by theory: for Y, whose wavelengths are near enough
/// to each other for dark rings in white light. r³ takes out that rings become darker with the distance.
#[test]
fn the_pictures_rings_have_their_radii() {
    let (scale, side) = (16.0, 121u32);
    let image = shine(Aperture::Circular, scale, side, |[x, y]| f32::from(u8::from(x == 0.0 && y == 0.0)));
    let radius = |i: usize| (i as f64 % 121.0 - 60.0).hypot((i / 121) as f64 - 60.0);
    let picture =
        image.pixels.iter().enumerate().map(|(i, p)| (radius(i), radius(i).powi(3) * f64::from(p[1])));
    let theory = (1..1000).map(|i| {
        let r = f64::from(i) * 0.06;
        let density = (360..=830).step_by(2).map(f64::from).map(|lambda| {
            let x = std::f64::consts::PI * r / scale * 550.0 / lambda;
            cmf(lambda)[1] * (bessel(1.0, x) / x / lambda).powi(2)
        });
        (r, r.powi(3) * density.sum::<f64>())
    });
    for near in [1.22, 2.23] {
        let reach = 0.2 * scale;
        let want = lowest_point(theory.clone(), near * scale, reach).expect("a dark ring");
        let got = lowest_point(picture.clone(), near * scale, reach).expect("a dark ring");
        // Y is at its most at 555 nm, and reaches a little farther to the red.
        assert!((want / (near * scale) - 1.0).abs() < 0.05, "{want}");
        assert!((got / want - 1.0).abs() < 0.02, "a dark ring at {got} pixels instead of {want}");
    }
}

#[test]
fn the_sun_has_as_many_streaks_as_its_aperture() {
    for (n, count) in [(5, 10), (6, 6), (7, 14)] {
        let aperture = Aperture::generated(&Blades::new(n, 0.1, 0.4, 1e3).unwrap());
        let sun = shine(aperture, 0.1, 301, |[x, y]| if x.hypot(y) < 4.0 { 1e9 } else { 1.0 });
        let around: Vec<_> = sun
            .pixels
            .iter()
            .enumerate()
            .map(|(i, p)| {
                let at = [(i % 301) as f64 - 150.0, 150.0 - (i / 301) as f64];
                (at, [0, 1, 2].map(|c| f64::from(p[c])))
            })
            .collect();
        assert_eq!(streaks(&around, 120.0).0, count, "{n} blades");
    }
}

/// A lamp of one internal pixel: each output pixel gets what theory says that it gets of light that was even over the
/// lamp's own, nothing is negative, and an even picture stays even.
#[test]
fn super_sampled_pictures_have_the_right_means() {
    let (side, factor) = (40u32, 3u32);
    let size = FilmSize::new(side, side, factor).unwrap();
    let cycle_per_nm = [0.7 / 550.0 / f64::from(side); 2];
    let diffraction = Diffraction::new(
        Pupil::new(Aperture::generated(&Blades::new(5, 0.3, 0.4, 1e3).unwrap()), None),
        cycle_per_nm,
    );
    let with = |light: &dyn Fn(usize, usize) -> f32| {
        let wide = (side * factor) as usize;
        let pixels: Vec<[f32; 4]> = (0..wide * wide).map(|i| [light(i % wide, i / wide); 4]).collect();
        let mut image = XyzImage { size, missing: vec![false; pixels.len()], pixels };
        diffraction.apply(&mut image, Region::whole(size));
        image
    };
    let lamp = with(&|x, y| if (x, y) == (61, 58) { 9.0 } else { 0.0 });
    let kernel = Kernel::new(&blades(5, 0.3), [40, 40], [0.7 / 550.0; 2]);
    let outside = |c: usize| {
        let offsets = (0..40).flat_map(|y| (0..40).map(move |x| (x - 20, y - 19)));
        1.0 - offsets.map(|(x, y)| kernel.at(x, y)[c]).sum::<f64>()
    };
    for (x, y) in (0..40usize).flat_map(|y| (0..40).map(move |x| (x, y))) {
        for c in 0..3 {
            let block = (0..9).map(|i| lamp.pixels[(3 * y + i / 3) * 120 + 3 * x + i % 3][c]);
            let mean = block.clone().map(f64::from).sum::<f64>() / 9.0;
            let own = if (x, y) == (20, 19) { outside(c) } else { 0.0 };
            let want = kernel.at(x as i64 - 20, y as i64 - 19)[c] + own;
            assert!((mean - want).abs() < 1e-6, "{x} {y} {c}: {mean} instead of {want}");
            assert!(block.clone().all(|v| v >= -1e-6), "{x} {y}");
        }
    }
    // The light that stays is in the lamp's own pixel.
    let [own, beside] = [61, 62].map(|x| lamp.pixels[58 * 120 + x][1]);
    assert!(own - beside > 1.0, "{own} {beside}");
    let even = with(&|_, _| 3.0);
    assert!(even.pixels.iter().flatten().all(|v| (v - 3.0).abs() < 1e-5));
}

/// Kernels of the two sizes used last are made once.
#[test]
fn two_sizes_are_held() {
    let diffraction = Diffraction::new(Pupil::new(Aperture::Circular, None), [2e-4, 2e-4]);
    let prepared = |side: u32| {
        let size = FilmSize::new(side, side, 1).unwrap();
        diffraction.prepared([side as usize; 2], size, &mut Room::default()).unwrap()
    };
    let [a, b] = [8, 12].map(prepared);
    assert!(Arc::ptr_eq(&a, &prepared(8)) && Arc::ptr_eq(&b, &prepared(12)));
    assert_eq!((a.plane.width, b.plane.width), (8, 12));
    // In advance, too.
    diffraction.prepare(FilmSize::new(16, 16, 1).unwrap(), Region::whole(FilmSize::new(16, 16, 1).unwrap()));
    assert_eq!(diffraction.prepared.lock().unwrap()[0].plane.width, 16);
    assert!(Arc::ptr_eq(&b, &prepared(12)) && !Arc::ptr_eq(&a, &prepared(8)));
}
