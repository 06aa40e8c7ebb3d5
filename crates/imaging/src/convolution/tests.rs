//! Convolution against the sum that defines it.

use super::*;
use crate::Region;
use indigo_film::FilmSize;

fn kernel(plane: &Plane, value: impl Fn(i64, i64) -> f64 + Sync) -> Spectrum {
    let [spectrum] = plane.spectra(Symmetry::Opposite, &mut Room::default(), |x, y| [value(x, y)]);
    spectrum
}

/// A picture of a plane's size, convolved with its borders.
fn convolve(plane: &Plane, kernel: &Spectrum, value: impl Fn(usize, usize) -> f32) -> Vec<f32> {
    let size = FilmSize::new(plane.width as u32, plane.height as u32, 1).unwrap();
    let at = |i: usize| [value(i % plane.width, i / plane.width); 4];
    let pixels: Vec<_> = (0..size.pixels()).map(at).collect();
    let mut image = XyzImage { size, missing: vec![false; pixels.len()], pixels };
    plane.convolve(
        &mut image,
        Window::of(size, Region::whole(size)),
        [kernel; 3],
        &mut Room::default(),
        |_, _, v| v,
    );
    image.pixels.iter().map(|p| p[1]).collect()
}

/// Falls off in no symmetric way but the one through the middle.
fn lopsided(x: i64, y: i64) -> f64 {
    let (x, y) = (x as f64, y as f64);
    1.0 / (1.0 + x * x + 0.5 * x * y + 2.0 * y * y)
}

#[test]
fn it_is_the_sum_over_all_pixels() {
    let (width, height) = (13usize, 6usize);
    let plane = Plane::new(width, height);
    let spectrum = kernel(&plane, lopsided);
    let picture = |x: usize, y: usize| ((x * 7 + y * 3) % 11) as f32;
    for (i, got) in convolve(&plane, &spectrum, picture).iter().enumerate() {
        let (x, y) = (i % width, i / width);
        let (mut sum, mut inside) = (0.0, 0.0);
        for (u, v) in (0..height).flat_map(|v| (0..width).map(move |u| (u, v))) {
            let k = lopsided(x as i64 - u as i64, y as i64 - v as i64);
            sum += k * f64::from(picture(u, v));
            inside += k;
        }
        let want = sum + (1.0 - inside) * f64::from(picture(x, y));
        assert!((f64::from(*got) - want).abs() < 1e-5 * sum, "{x} {y}: {got} instead of {want}");
    }
}

/// What is the same to the left and to the right may be said to be so, and is convolved alike.
#[test]
fn mirrored_kernels_are_made_of_a_half() {
    let plane = Plane::new(13, 6);
    let value = |x: i64, y: i64| 1.0 / (1.0 + (x * x + 2 * y * y) as f64);
    let [mirrored] = plane.spectra(Symmetry::Mirror, &mut Room::default(), |x, y| {
        assert!(x >= 0 && y >= 0);
        [value(x, y)]
    });
    let whole = kernel(&plane, value);
    assert!(mirrored.values == whole.values && mirrored.outside == whole.outside);
}

#[test]
fn an_even_picture_stays_even() {
    let plane = Plane::new(9, 17);
    let spectrum = kernel(&plane, lopsided);
    for v in convolve(&plane, &spectrum, |_, _| 3.0) {
        assert!((v - 3.0).abs() < 1e-5, "{v}");
    }
}

/// What a lamp adds to others does not depend on how close to the border it is.
#[test]
fn a_lamp_at_the_border_shines_no_farther() {
    let plane = Plane::new(21, 21);
    let spectrum = kernel(&plane, lopsided);
    let lamp = |at: [usize; 2]| convolve(&plane, &spectrum, move |x, y| f32::from(u8::from([x, y] == at)));
    let (middle, corner) = (lamp([10, 10]), lamp([0, 0]));
    for (x, y) in (0..11).flat_map(|y| (0..11).map(move |x| (x, y))).skip(1) {
        let (a, b) = (middle[(10 + y) * 21 + 10 + x], corner[y * 21 + x]);
        assert!((a - b).abs() < 1e-6, "{x} {y}: {b} instead of {a}");
    }
}

/// One pixel 10⁹ times as bright as the rest leaves what it does not reach as it was.
#[test]
fn a_lamp_does_not_drown_the_dark() {
    let plane = Plane::new(300, 40);
    let spectrum = kernel(&plane, |x, y| if x.abs() + y.abs() < 2 { 0.2 } else { 0.0 });
    let got = convolve(&plane, &spectrum, |x, y| if (x, y) == (5, 20) { 1e9 } else { 1.0 });
    let worst = got.iter().skip(30).step_by(300).map(|v| (v - 1.0).abs()).fold(0.0, f32::max);
    assert!(worst < 1e-5, "{worst}");
}

#[test]
fn periods_are_even_and_of_small_factors() {
    assert_eq!([1, 2, 11, 13, 127, 1199, 3839].map(smooth), [2, 2, 12, 14, 128, 1200, 3840]);
}
