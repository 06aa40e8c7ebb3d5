//! A cratered moon of a million triangles: relief at every scale, in light that grazes it.

use std::io::{self, Write};

use super::igs::{
    View, write_background, write_diffuse, write_head, write_mesh, write_model, write_panel, write_tail,
};
use super::noise::{fractal, uniform};
use super::ply;
use super::sphere::{Mesh, displaced};
use super::vector::{Vector, dot, scale};

/// Squares along an edge of the cube that the moon is blown up from: 12 x 289² = 1,002,252 triangles.
const GRID: u32 = 289;
const _: () = assert!(12 * GRID * GRID >= 1_000_000);
const CRATERS: u64 = 900;
/// Angular radii of the craters, in radians.
const SMALLEST: f64 = 0.012;
const LARGEST: f64 = 0.3;

/// An impact: its centre, angular radius and depth.
struct Crater {
    centre: Vector,
    radius: f64,
    depth: f64,
}

/// The mesh, of about unit radius.
fn moon() -> Mesh {
    let craters: Vec<Crater> = (0..CRATERS).map(crater).collect();
    displaced(GRID, |d| scale(1.0 + height(d, &craters), d))
}

/// Craters strike anywhere; the number larger than r falls as r^-2, as on real airless bodies.
fn crater(index: u64) -> Crater {
    let (z, phi) = (2.0 * uniform(10, index) - 1.0, std::f64::consts::TAU * uniform(11, index));
    let r = (1.0 - z * z).sqrt();
    let cut = 1.0 - (SMALLEST / LARGEST).powi(2);
    let radius = SMALLEST / (1.0 - cut * uniform(12, index)).sqrt();
    // Large craters are relatively shallow: their floors rebound and fill.
    let depth = 0.2 * radius / (1.0 + 6.0 * radius);
    Crater { centre: [r * phi.cos(), r * phi.sin(), z], radius, depth }
}

/// Height above the unit sphere: gentle highlands and the craters on them.
fn height(d: Vector, craters: &[Crater]) -> f64 {
    let land = 0.018 * fractal(scale(2.0, d), 7);
    land + craters.iter().map(|crater| crater_height(crater, d)).sum::<f64>()
}

/// A bowl, flat in its middle, with a raised rim that falls off outside.
fn crater_height(crater: &Crater, d: Vector) -> f64 {
    let cosine = dot(crater.centre, d);
    // No crater is felt beyond twice its radius; skip the arc cosine for nearly all of them.
    if cosine < 1.0 - 2.0 * crater.radius * crater.radius {
        return 0.0;
    }
    let x = cosine.clamp(-1.0, 1.0).acos() / crater.radius;
    let bowl = if x < 1.0 { -(1.0 - x * x).min(0.75) } else { 0.0 };
    let rim = 0.3 * (-((x - 1.0) / 0.22).powi(2)).exp();
    crater.depth * (bowl + rim)
}

fn write_scene(mesh: impl Fn(&mut dyn Write) -> io::Result<()>, out: &mut dyn Write) -> io::Result<()> {
    let view = View {
        size: [600, 600],
        from: [0.0, -4.2, 0.6],
        at: [0.0; 3],
        lens_sensor_dist: 0.064,
        focus: 3.3,
        pre_scale: 0.038,
    };
    write_head(&view, out)?;
    write_background(3e2, out)?;
    // External meshes of this format name their material so.
    write_diffuse("default", [0.42, 0.40, 0.37], out)?;
    mesh(out)?;
    write_model("moon", [0.0; 3], 1.0, None, out)?;
    write_panel([-4.0, -2.2, 2.2], [0.0; 3], 0.7, 1e7, out)?;
    write_tail(out)
}

/// The scene with its mesh in `million.ply`.
pub fn write_external_scene(out: &mut dyn Write) -> io::Result<()> {
    let mesh = "<mesh>\n<name>moon</name>\n<normal_smoothing>true</normal_smoothing>\n\
        <external><path>million.ply</path></external>\n</mesh>";
    write_scene(|out| writeln!(out, "{mesh}"), out)
}

/// The scene with its mesh inside.
pub fn write_embedded_scene(out: &mut dyn Write) -> io::Result<()> {
    write_scene(|out| write_mesh("moon", true, "default", &moon(), out), out)
}

/// The mesh alone.
pub fn write_ply(out: &mut dyn Write) -> io::Result<()> {
    ply::write(&moon(), out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn craters_are_bowls_with_rims() {
        let crater = Crater { centre: [0.0, 0.0, 1.0], radius: 0.1, depth: 0.02 };
        let at = |angle: f64| crater_height(&crater, [angle.sin(), 0.0, angle.cos()]);
        assert!(at(0.0) < -0.01 && at(0.1) > 0.004 && at(0.05) < 0.0);
        // Where the shortcut cuts it off, next to nothing is left.
        assert!(at(0.199).abs() < 1e-6 && at(0.25) == 0.0);
    }
}
