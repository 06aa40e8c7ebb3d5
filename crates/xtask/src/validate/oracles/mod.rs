//! Scenes whose pictures are known: by a closed form, by quadrature, or by tables of other programs.

mod camera;
mod colour;
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
use super::text::{ONE_PIXEL, background, flat_camera, scene_file, settings, uniform};
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

/// Settings of a small picture that keeps each sample in its own pixel.
fn head(more: &str) -> String {
    settings(SIDE, &format!("{ONE_PIXEL}{more}"))
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
