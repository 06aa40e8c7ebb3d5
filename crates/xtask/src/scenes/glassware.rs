//! Glasses with something to drink in them, modelled by the rules of the manual for a liquid in a glass: the
//! liquid reaches into the wall, of which the medium has the higher precedence; its surface rises to a
//! meniscus where it meets the glass; all meshes are closed.

use std::io::{self, Write};

use super::igs::{write_mesh, write_model};
use super::lathe::{Point, Profile, rim};

/// Steps of a turn: 256 of them are 1.4 degrees each.
const TURN: u32 = 256;
/// Height of the foot above the table, within the rules' 0.2 to 1 mm.
const ABOVE_TABLE: f64 = 0.0005;

/// What the inside of a vessel is, from the middle of its bottom up to its lip, and its wall.
struct Vessel {
    inside: Profile,
    /// Thickness of the wall, metres. The liquid ends in the middle of it.
    wall: f64,
}

impl Vessel {
    /// The liquid up to a height, with a meniscus of about 1 mm.
    fn liquid(&self, level: f64) -> Profile {
        let within = |p: &Point| p[1] <= level;
        let wetted = self.inside.0.iter().take_while(|p| within(p)).count();
        let wall = &self.inside.moved_out(0.5 * self.wall)[..wetted];
        // The surface falls from the middle of the wall, through its inside, to the level.
        let [edge, _] = self.inside.0[wetted - 1];
        let top = wall[wetted - 1][0];
        let wall_end = [top, level + 0.0015];
        let meniscus = Profile(vec![wall_end])
            .curve([[edge - 0.0002, level + 0.0006], [edge - 0.001, level], [edge - 0.003, level]], 16);
        Profile(wall.to_vec()).then(meniscus.0).to([0.5 * edge, level]).to([0.0, level])
    }

    /// The whole vessel: a `bottom` that goes on, over a control point, into the wall's outside at its point `from`.
    fn glass(&self, bottom: Profile, control: Point, from: usize) -> Profile {
        let outside = &self.inside.moved_out(self.wall)[from..];
        let [first, second] = [outside[0], outside[1]];
        // The curve arrives in the direction in which the wall goes on.
        let arrive = [0, 1].map(|k| first[k] - 3.0 * (second[k] - first[k]));
        let lip = [outside[outside.len() - 1], self.inside.0[self.inside.0.len() - 1]];
        bottom
            .curve([control, arrive, first], 16)
            .then(outside[1..].iter().copied())
            .then(rim(lip[0], lip[1], 8))
            .then(self.inside.0.iter().rev().copied())
    }
}

/// The bowl of a wine glass, 0.1 m above the table, closing a little towards its lip.
fn bowl() -> Vessel {
    let inside = Profile(vec![[0.0, 0.100]])
        .curve([[0.030, 0.100], [0.041, 0.122], [0.041, 0.150]], 48)
        .curve([[0.041, 0.176], [0.033, 0.200], [0.031, 0.215]], 32);
    Vessel { inside, wall: 0.0012 }
}

/// The glass round the bowl: foot, stem and wall.
fn wine_glass() -> Profile {
    let foot = Profile(vec![[0.0, ABOVE_TABLE], [0.010, ABOVE_TABLE], [0.034, ABOVE_TABLE]])
        .curve([[0.0365, ABOVE_TABLE], [0.0365, 0.0028], [0.034, 0.0028]], 10)
        .curve([[0.020, 0.0042], [0.0040, 0.0048], [0.0036, 0.022]], 32)
        .curve([[0.0033, 0.045], [0.0030, 0.075], [0.0036, 0.090]], 24);
    // The stem opens into the wall; below there, the glass is solid.
    bowl().glass(foot, [0.0040, 0.097], 14)
}

/// A plain glass of a quarter of a litre.
fn tumbler() -> Vessel {
    let inside = Profile(vec![[0.0, 0.010], [0.010, 0.010], [0.025, 0.010]])
        .curve([[0.029, 0.010], [0.031, 0.012], [0.0312, 0.017]], 16)
        .curve([[0.0325, 0.050], [0.0338, 0.083], [0.035, 0.115]], 32);
    Vessel { inside, wall: 0.0025 }
}

fn tumbler_glass() -> Profile {
    let bottom = Profile(vec![[0.0, ABOVE_TABLE], [0.010, ABOVE_TABLE], [0.029, ABOVE_TABLE]])
        .curve([[0.0325, ABOVE_TABLE], [0.0330, 0.002], [0.0332, 0.005]], 12);
    tumbler().glass(bottom, [0.0334, 0.008], 19)
}

/// A glass and, in it, a liquid up to a height: meshes of a name each.
fn write_drink(
    [glass, liquid]: [&str; 2],
    profiles: &[Profile; 2],
    material: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    for (name, profile, material) in [(glass, &profiles[0], "glass"), (liquid, &profiles[1], material)] {
        write_mesh(name, true, material, &profile.turned(TURN), out)?;
    }
    Ok(())
}

/// The meshes of a wine glass, `glass` and `wine`, and models of them.
pub fn write_wine_glass(out: &mut dyn Write) -> io::Result<()> {
    write_drink(["glass", "wine"], &[wine_glass(), bowl().liquid(0.152)], "wine", out)?;
    write_model("glass", [0.0; 3], 1.0, None, out)?;
    write_model("wine", [0.0; 3], 1.0, None, out)
}

/// The same glass with nothing in it.
pub fn write_empty_glass(out: &mut dyn Write) -> io::Result<()> {
    write_mesh("glass", true, "glass", &wine_glass().turned(TURN), out)?;
    write_model("glass", [0.0; 3], 1.0, None, out)
}

/// Three tumblers side by side, with materials `milk`, `beer` and `wine` in them.
pub fn write_drinks(out: &mut dyn Write) -> io::Result<()> {
    write_mesh("glass", true, "glass", &tumbler_glass().turned(TURN), out)?;
    for (material, x) in [("milk", -0.095), ("beer", 0.0), ("wine", 0.095)] {
        write_mesh(material, true, material, &tumbler().liquid(0.092).turned(TURN), out)?;
        write_model("glass", [x, 0.0, 0.0], 1.0, None, out)?;
        write_model(material, [x, 0.0, 0.0], 1.0, None, out)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::lathe::tests::assert_solid;
    use super::*;

    /// Volumes by Pappus' rule over the profile: 2π ∫ r²/2 dz.
    fn volume(profile: &Profile) -> f64 {
        let slab = |pair: &[Point]| {
            let ([r, z], [s, w]) = (pair[0], pair[1]);
            std::f64::consts::PI / 3.0 * (r * r + r * s + s * s) * (w - z)
        };
        profile.0.windows(2).map(slab).sum()
    }

    #[test]
    fn glasses_and_liquids_are_closed_and_face_outwards() {
        for profile in [wine_glass(), bowl().liquid(0.152), tumbler_glass(), tumbler().liquid(0.092)] {
            assert_solid(&profile.turned(TURN), volume(&profile));
        }
        assert!(wine_glass().turned(TURN).triangles.len() >= 40_000);
    }

    /// Side and bottom of the liquid lie within the wall, and more than 0.2 mm from both its faces.
    #[test]
    fn the_liquid_reaches_into_the_wall() {
        for (vessel, level) in [(bowl(), 0.152), (tumbler(), 0.092)] {
            for p in vessel.liquid(level).0.iter().take_while(|p| p[1] < level) {
                let distance = |q: &Point| (p[0] - q[0]).hypot(p[1] - q[1]);
                let inside = vessel.inside.0.iter().map(distance).fold(f64::INFINITY, f64::min);
                assert!(inside > 0.0002 && inside < vessel.wall - 0.0002 || p[0] < 0.025, "{p:?}: {inside}");
            }
        }
    }
}
