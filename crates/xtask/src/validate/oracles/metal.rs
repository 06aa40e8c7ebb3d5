//! Smooth metal, bare and under a film.

use std::f64::consts::TAU;

use num_complex::Complex;

use super::super::check::{Check, PATH, Quantity, TECHNIQUES, Target};
use super::furnaces::sheet_in_even_light;
use super::{AROUND_NITS, colour, disc_mean, distant_ball, material};

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
    let balls = [(0.4241, 2.4721), (1.5, 7.6), (2.8, 3.3)].map(|(n, k)| ball(n, k));
    let films = [(2.4, 60.0, 0.0), (2.4, 150.0, 60.0), (1.4, 900.0, 30.0)].map(|(n, nm, d)| film(n, nm, d));
    balls.into_iter().chain(films).collect()
}

/// The metal below films, like titanium.
const BELOW: [f64; 2] = [2.7, 3.8];

/// A mirror of metal under a clear film, in which light interferes.
fn film(index: f64, thickness_nm: f64, degrees: f64) -> Check {
    let cos = degrees.to_radians().cos();
    let seen = colour::tristimulus(360.0, 830.0, |nm| filmed(cos, index, BELOW, thickness_nm / nm));
    let all = colour::tristimulus(360.0, 830.0, |_| 1.0);
    let kind = format!(
        "<coating><substrate_material_name>metal</substrate_material_name><ior>{index}</ior><interference>true</interference>\
         <thickness>{thickness_nm}e-9</thickness></coating>"
    );
    let metal = material("metal", "<phong><nk_data>metal.nk</nk_data><exponent>1e12</exponent></phong>");
    let about = format!(
        "A film of index {index}, {thickness_nm} nm thick, on n = {}, k = {}: all reflections summed by the film's characteristic matrix \
         (Born and Wolf, section 1.6.2), at each wavelength.",
        BELOW[0], BELOW[1]
    );
    let scene = sheet_in_even_light(degrees, &[metal, material("m", &kind)]);
    let check =
        Check::new(GROUP, format!("film of {thickness_nm} nm and index {index} at {degrees}°"), about, scene)
            .unit(AROUND_NITS)
            .is(seen[1] / all[1], 1e-5)
            .row("x / y", Quantity::XOverY, None, Target::Value(seen[0] / seen[1], 1e-5))
            .row("z / y", Quantity::ZOverY, None, Target::Value(seen[2] / seen[1], 1e-5))
            .by(PATH)
            .effort(1024, 1e-2)
            .quickly(64);
    Check { files: vec![("metal.nk".to_owned(), constant_nk(BELOW[0], BELOW[1]))], ..check }
}

/// Reflectance for unpolarised light of a clear film on a metal, by the cosine outside and the thickness in wavelengths.
fn filmed(cos: f64, index: f64, [n, k]: [f64; 2], thickness: f64) -> f64 {
    let sine2 = 1.0 - cos * cos;
    let squares = [Complex::from(1.0), Complex::from(index * index), Complex::new(n, k).powu(2)];
    let normal = squares.map(|square| (square - sine2).sqrt());
    let phase = normal[1] * (TAU * thickness);
    let of = |[outside, within, below]: [Complex<f64>; 3]| {
        let (cos, sin) = (phase.cos(), Complex::<f64>::i() * phase.sin());
        let (electric, magnetic) = (cos - sin * below / within, cos * below - sin * within);
        ((outside * electric - magnetic) / (outside * electric + magnetic)).norm_sqr()
    };
    0.5 * (of(normal) + of([0, 1, 2].map(|i| squares[i] / normal[i])))
}

/// Seen from so far away that rays are parallel, a mirroring ball's mean is 2 ∫ F(c) c dc.
fn ball(n: f64, k: f64) -> Check {
    let mean = disc_mean(|c| fresnel(c, n, k));
    // Facets that lean by a millionth: a mirror.
    let metal = material("m", "<phong><nk_data>metal.nk</nk_data><exponent>1e12</exponent></phong>");
    let (scene, value) = distant_ball(metal, |c| fresnel(c, n, k));
    let about = format!(
        "Fresnel's reflectance for unpolarised light, n = {n}, k = {k}: 2 ∫ F(c) c dc = {mean:.5} over the disc, and the \
         surroundings beside it."
    );
    let check = Check::new(GROUP, format!("smooth ball, n = {n}, k = {k}"), about, scene).unit(AROUND_NITS);
    let mut check = check.is(value, 2e-6).by(TECHNIQUES).effort(64, 1e-2).in_full(256, 1e-2);
    check.files.push(("metal.nk".to_owned(), constant_nk(n, k)));
    check
}
