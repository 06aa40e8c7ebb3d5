//! 15,000 models of two meshes, laid out like the seeds of a sunflower (Vogel 1979).

use std::io::{self, Write};

use super::igs::{
    View, write_background, write_diffuse, write_head, write_mesh, write_model, write_panel, write_tail,
};
use super::noise::uniform;
use super::sphere::{Mesh, displaced};
use super::vector::Vector;

const MODELS: u32 = 15_000;
/// Radius of the whole field in metres.
const FIELD: f64 = 5.0;

/// Writes the scene.
pub fn write_scene(out: &mut dyn Write) -> io::Result<()> {
    let view = View {
        size: [800, 500],
        from: [0.0, -10.5, 6.8],
        at: [0.0, -0.4, 0.0],
        lens_sensor_dist: 0.036,
        focus: 11.5,
        pre_scale: 0.5,
    };
    write_head(&view, out)?;
    write_background(1.5e5, out)?;
    write_diffuse("ground", [0.25, 0.24, 0.22], out)?;
    write_diffuse("bead", [0.05, 0.18, 0.45], out)?;
    write_diffuse("seed", [0.80, 0.33, 0.04], out)?;
    write_mesh("ground", false, "ground", &ground(), out)?;
    write_mesh("bead", true, "bead", &displaced(8, |d| d), out)?;
    write_mesh("seed", true, "seed", &displaced(8, |d| [0.7 * d[0], 0.7 * d[1], 2.2 * d[2]]), out)?;
    write_model("ground", [0.0; 3], 1.0, None, out)?;
    for i in 0..MODELS {
        write_seed(i, out)?;
    }
    write_panel([-6.0, -3.0, 8.0], [0.0; 3], 1.5, 1e7, out)?;
    write_tail(out)
}

/// The i-th seed: the golden angle from the one before, at a radius that keeps the density even.
fn write_seed(i: u32, out: &mut dyn Write) -> io::Result<()> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let angle = f64::from(i) * golden_angle;
    let r = FIELD * ((f64::from(i) + 0.5) / f64::from(MODELS)).sqrt();
    let size = 0.03 * (0.8 + 0.4 * uniform(20, u64::from(i)));
    // A low dome in the middle, with a ripple towards the edge.
    let dome = 0.9 * (-(r / 2.2).powi(2)).exp() + 0.06 * (2.5 * r).sin();
    let at = [r * angle.cos(), r * angle.sin(), dome + 0.1];
    // A Fibonacci number in the modulus makes the kinds follow the spirals that the eye sees.
    let mesh = if i % 34 < 13 { "seed" } else { "bead" };
    write_model(mesh, at, size, Some(leaning(angle, 0.2 * r)), out)
}

/// A rotation that tilts the z axis by `tilt` radians outwards, towards the azimuth `angle`.
fn leaning(angle: f64, tilt: f64) -> [Vector; 3] {
    let ((s, c), (st, ct)) = (angle.sin_cos(), tilt.sin_cos());
    [[c * ct, -s, c * st], [s * ct, c, s * st], [-st, 0.0, ct]]
}

/// A square large enough to fill the view.
fn ground() -> Mesh {
    let corner = |x: f64, y: f64| [16.0 * x, 16.0 * y, -0.1];
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::vector::{cross, dot, sub};

    #[test]
    fn leaning_is_a_rotation_that_moves_the_axis_outwards() {
        let [x, y, z] = leaning(0.7, 0.3);
        assert!(dot(x, y).abs() < 1e-12 && dot(y, z).abs() < 1e-12 && (dot(x, x) - 1.0).abs() < 1e-12);
        assert!(sub(cross(x, y), z).iter().all(|error| error.abs() < 1e-12), "a reflection");
        // The image of the z axis is the third column.
        let axis = [x[2], y[2], z[2]];
        assert!((axis[0].atan2(axis[1]) - 0.7f64.cos().atan2(0.7f64.sin())).abs() < 1e-12 && axis[2] > 0.9);
    }

    #[test]
    fn the_scene_has_all_its_models() {
        let mut bytes = Vec::new();
        write_scene(&mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.matches("<model>").count(), MODELS as usize + 1);
        assert_eq!(text.matches("</model>").count(), MODELS as usize + 1);
    }
}
