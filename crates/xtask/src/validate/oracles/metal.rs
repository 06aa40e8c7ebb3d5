//! Smooth metal.

use std::f64::consts::PI;

use super::super::check::{Check, TECHNIQUES};
use super::super::text::sphere;
use super::{AROUND_NITS, in_even_light, integral, material};

const GROUP: &str = "Metal";

/// Reflectance of unpolarised light by a conductor of index n + ik, by the cosine outside.
fn fresnel(cos: f64, n: f64, k: f64) -> f64 {
    let sine2 = 1.0 - cos * cos;
    let real = n * n - k * k - sine2;
    let length = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (length + real)).sqrt();
    let s = (length - 2.0 * a * cos + cos * cos) / (length + 2.0 * a * cos + cos * cos);
    let p = (cos * cos * length - 2.0 * a * cos * sine2 + sine2 * sine2)
        / (cos * cos * length + 2.0 * a * cos * sine2 + sine2 * sine2);
    0.5 * s * (1.0 + p)
}

/// A file of one complex index for all wavelengths.
pub fn constant_nk(n: f64, k: f64) -> Vec<u8> {
    format!("4 360 830 1\n{n} {k}\n{n} {k}\n").into_bytes()
}

/// All of them.
pub fn checks() -> Vec<Check> {
    [(0.4241, 2.4721), (1.5, 7.6), (2.8, 3.3)].map(|(n, k)| ball(n, k)).into()
}

/// Seen from so far away that rays are parallel, a mirroring ball's mean is 2 ∫ F(c) c dc.
fn ball(n: f64, k: f64) -> Check {
    let mean = integral(0.0, 1.0, 100_000, |c| 2.0 * fresnel(c, n, k) * c);
    // Facets that lean by a millionth: a mirror.
    let metal = material("m", "<phong><nk_data>metal.nk</nk_data><exponent>1e12</exponent></phong>");
    let scene = in_even_light([0.0, -1000.0, 0.0], 2e-3, &[metal, sphere([0.0; 3], 1.0, "m")]);
    // The ball covers π/16 of the picture; even light shows beside it.
    let share = PI / 16.0;
    let about = format!(
        "Fresnel's reflectance for unpolarised light, n = {n}, k = {k}: 2 ∫ F(c) c dc = {mean:.5} over the disc, and the \
         surroundings beside it."
    );
    let check = Check::new(GROUP, format!("smooth ball, n = {n}, k = {k}"), about, scene).unit(AROUND_NITS);
    let mut check =
        check.is(1.0 - share + share * mean, 2e-6).by(TECHNIQUES).effort(64, 1e-2).in_full(256, 1e-2);
    check.files.push(("metal.nk".to_owned(), constant_nk(n, k)));
    check
}
