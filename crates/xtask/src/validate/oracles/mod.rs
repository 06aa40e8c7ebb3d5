//! Scenes whose pictures are known: by a closed form, by quadrature, or by tables of other programs.

mod camera;
mod colour;
#[cfg(test)]
mod daylight;
mod defaults;
mod direct;
mod dispersion;
mod frosted;
mod furnaces;
mod glass;
mod gloss;
mod lamps;
mod lens;
mod media;
mod metal;
mod orientation;
mod patch;
mod reference;
mod sky;

use super::check::Check;
use super::shapes::Point;
use super::text::{ONE_PIXEL, background, flat_camera, scene_file, settings, sphere, uniform};
pub use metal::constant_nk;

/// Luminance of spectral radiance 1 W m^-3 sr^-1 at all wavelengths, cd/m²: 683.002 · 1e-9 · ∫ȳ dλ,
/// with ∫ȳ = 106.85692 nm over 360 to 830 nm (CIE 1931, 1 nm table).
pub const NITS_PER_UNIFORM: f64 = 683.002e-9 * 106.85692;
/// X, Y and Z of light of one radiance at all wavelengths, over Y: sums of the same table.
pub const EVEN_LIGHT: [f64; 3] = [1.000_079_443, 1.0, 1.000_327_853];
/// Spectral radiance of even surroundings, W m^-3 sr^-1; far from 1 so that no unit cancels.
pub const AROUND: f64 = 3.0e4;
/// The same in cd/m².
const AROUND_NITS: f64 = AROUND * NITS_PER_UNIFORM;
/// Side of the pictures.
const SIDE: u32 = 16;

/// All of them.
pub fn all() -> Vec<Check> {
    [
        furnaces::checks(),
        direct::checks(),
        lamps::checks(),
        glass::checks(),
        frosted::checks(),
        dispersion::checks(),
        gloss::checks(),
        metal::checks(),
        media::checks(),
        colour::checks(),
        lens::checks(),
        camera::checks(),
        defaults::checks(),
        sky::checks(),
        orientation::checks(),
        reference::checks(),
    ]
    .concat()
}

/// Rays start at the surface that they leave, and not a tenth of a millimetre above it, from where an opening 2 m away is 10⁻⁴ larger.
const AT_THE_SURFACE: &str = "<ray_origin_nudge_distance>0</ray_origin_nudge_distance>";

/// Settings of a small picture that keeps each sample in its own pixel.
fn head(more: &str) -> String {
    settings(SIDE, &format!("{ONE_PIXEL}{AT_THE_SURFACE}{more}"))
}

/// Objects before a camera that sees a width of ±`tangent`, in light that is the same from everywhere.
fn in_even_light(pos: Point, tangent: f64, parts: &[String]) -> String {
    looking(pos, [0.0, 1.0, 0.0], tangent, "", &[parts, &[background(&uniform(AROUND))]].concat())
}

/// A scene seen from a point.
fn looking(pos: Point, forwards: Point, tangent: f64, more: &str, parts: &[String]) -> String {
    scene_file(&[&[head(more), flat_camera(pos, forwards, tangent)], parts].concat())
}

/// A material of a kind.
pub fn material(name: &str, kind: &str) -> String {
    format!("<material><name>{name}</name>{kind}</material>")
}

/// Integral over an interval by the midpoint rule.
fn integral(from: f64, to: f64, steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let h = (to - from) / f64::from(steps);
    (0..steps).map(|i| f(from + (f64::from(i) + 0.5) * h)).sum::<f64>() * h
}

/// ∫ dx / (a + x²)² from 0 to x.
fn strip(a: f64, x: f64) -> f64 {
    0.5 / a * (x / (a + x * x) + (x / a.sqrt()).atan() / a.sqrt())
}

/// A ball "m" of a mirroring kind in even light, from so far away that rays are parallel; and the mean of the picture, of which the disc has
/// 2 ∫ R(c) c dc by the reflectance at a cosine and covers π/16.
fn distant_ball(material: String, reflectance: impl Fn(f64) -> f64) -> (String, f64) {
    let scene = in_even_light([0.0, -1000.0, 0.0], 2e-3, &[material, sphere([0.0; 3], 1.0, "m")]);
    let share = std::f64::consts::PI / 16.0;
    (scene, 1.0 - share + share * disc_mean(reflectance))
}

/// The mean over the disc of a mirroring ball.
fn disc_mean(reflectance: impl Fn(f64) -> f64) -> f64 {
    integral(0.0, 1.0, 100_000, |c| 2.0 * reflectance(c) * c)
}
