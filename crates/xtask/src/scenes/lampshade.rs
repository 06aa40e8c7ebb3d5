//! A lamp on a table: foot, shade and bulb.

use std::io::{self, Write};

use super::igs::{write_mesh, write_model};
use super::lathe::Profile;

const TURN: u32 = 128;

fn foot() -> Profile {
    Profile(vec![[0.0, 0.0005], [0.02, 0.0005], [0.07, 0.0005]])
        .curve([[0.076, 0.0005], [0.076, 0.010], [0.070, 0.011]], 10)
        .curve([[0.030, 0.015], [0.012, 0.022], [0.012, 0.050]], 24)
        .curve([[0.012, 0.080], [0.044, 0.080], [0.044, 0.115]], 24)
        .curve([[0.044, 0.150], [0.011, 0.145], [0.009, 0.185]], 24)
        .curve([[0.009, 0.195], [0.005, 0.200], [0.0, 0.200]], 10)
}

/// One sheet: light passes its cloth, not a solid.
fn shade() -> Profile {
    Profile(vec![[0.145, 0.185]]).curve([[0.130, 0.235], [0.110, 0.290], [0.095, 0.345]], 16)
}

/// A ball of 3 cm round the origin.
fn bulb() -> Profile {
    const K: f64 = 0.015 * 0.5523; // a quarter of a circle as a Bézier curve
    Profile(vec![[0.0, -0.015]])
        .curve([[K, -0.015], [0.015, -K], [0.015, 0.0]], 12)
        .curve([[0.015, K], [K, 0.015], [0.0, 0.015]], 12)
}

/// The meshes `foot`, `shade` and `bulb`, of which the last is left to be a light, and models.
pub fn write_meshes(out: &mut dyn Write) -> io::Result<()> {
    for (name, profile) in [("foot", foot()), ("shade", shade()), ("bulb", bulb())] {
        write_mesh(name, true, name, &profile.turned(TURN), out)?;
    }
    write_model("foot", [0.0; 3], 1.0, None, out)?;
    write_model("shade", [0.0; 3], 1.0, None, out)
}

#[cfg(test)]
mod tests {
    use super::super::lathe::tests::assert_solid;
    use super::*;

    #[test]
    fn the_bulb_is_a_ball() {
        assert_solid(&bulb().turned(TURN), 4.0 / 3.0 * std::f64::consts::PI * 0.015f64.powi(3));
    }
}
