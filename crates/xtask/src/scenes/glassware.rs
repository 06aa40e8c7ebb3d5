//! Glasses with something to drink in them, modelled by the rules of the manual for a liquid in a glass: the
//! liquid reaches into the wall, of which the medium has the higher precedence; its surface rises to a
//! meniscus where it meets the glass; all meshes are closed.
//!
//! The wine glass is there once more with explicit interfaces: the wine ends where the glass begins, at a surface that
//! is the one interface of both, and for that has the higher precedence; what closes the glass lies within the wine.

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
    /// How many points of the inside are below the level of a liquid.
    fn wetted(&self, level: f64) -> usize {
        self.inside.0.iter().take_while(|p| p[1] <= level).count()
    }

    /// The surface of a liquid with a meniscus of about 1 mm: from the middle of the wall, through its inside, to the
    /// level and the axis.
    fn surface(&self, level: f64) -> Vec<Point> {
        let last = self.wetted(level) - 1;
        let [edge, _] = self.inside.0[last];
        let [top, _] = self.inside.moved_out(0.5 * self.wall)[last];
        Profile(vec![[top, level + 0.0015]])
            .curve([[edge - 0.0002, level + 0.0006], [edge - 0.001, level], [edge - 0.003, level]], 16)
            .to([0.5 * edge, level])
            .to([0.0, level])
            .0
    }

    /// The liquid up to a height.
    fn liquid(&self, level: f64) -> Profile {
        let wall = &self.inside.moved_out(0.5 * self.wall)[..self.wetted(level)];
        let Contact { at, surface, .. } = self.contact(level);
        let [in_wall, free] = surface;
        Profile(wall.to_vec()).then(in_wall).to(at).then(free)
    }

    /// The liquid up to a height, which ends at the inside of the wall.
    fn liquid_within(&self, level: f64) -> Profile {
        let Contact { at, inside: [wetted, _], surface: [_, free] } = self.contact(level);
        Profile(wetted).to(at).to(at).then(free)
    }

    /// What closes a vessel that ends where a liquid begins: its inside from the lip down to there, and from there to
    /// the axis within the liquid.
    fn dry_inside(&self, level: f64) -> Vec<Point> {
        let Contact { at, inside: [_, dry], .. } = self.contact(level);
        // Steeper than the meniscus: a way above it would leave glass on the liquid.
        let below = [[at[0] - 0.001, level - 0.002], [0.5 * at[0], level - 0.01], [0.0, level - 0.01]];
        dry.into_iter().rev().chain([at, at]).chain(below).collect()
    }

    /// Where the surface of a liquid meets the inside.
    fn contact(&self, level: f64) -> Contact {
        let steps =
            |points: &[Point]| points.windows(2).map(|p| [p[0], p[1]]).enumerate().collect::<Vec<_>>();
        let surface = self.surface(level);
        let inside = steps(&self.inside.0);
        let meet = |&(k, step): &(usize, [Point; 2])| {
            let crossing = |&(i, wall): &(usize, [Point; 2])| Some((i, crossing(step, wall)?));
            let (i, at) = inside.iter().find_map(crossing)?;
            let parts = |points: &[Point], last: usize| {
                let (before, after) = points.split_at(last + 1);
                [before, after].map(<[Point]>::to_vec)
            };
            Some(Contact { at, inside: parts(&self.inside.0, i), surface: parts(&surface, k) })
        };
        steps(&surface).iter().find_map(meet).expect("the surface begins in the wall and ends on the axis")
    }

    /// The outside of the vessel and its lip: a `bottom` that goes on, over a control point, into the wall's outside at
    /// its point `from`.
    fn outside(&self, bottom: Profile, control: Point, from: usize) -> Profile {
        let outside = &self.inside.moved_out(self.wall)[from..];
        let [first, second] = [outside[0], outside[1]];
        // The curve arrives in the direction in which the wall goes on.
        let arrive = [0, 1].map(|k| first[k] - 3.0 * (second[k] - first[k]));
        let lip = [outside[outside.len() - 1], self.inside.0[self.inside.0.len() - 1]];
        bottom
            .curve([control, arrive, first], 16)
            .then(outside[1..].iter().copied())
            .then(rim(lip[0], lip[1], 8))
    }

    /// The whole vessel from its outside.
    fn glass(&self, outside: Profile) -> Profile {
        outside.then(self.inside.0.iter().rev().copied())
    }

    /// The same with a ring where a liquid's surface meets it, as the model that ends there has: what is smoothed between
    /// rings is then the same.
    fn glass_of(&self, outside: Profile, level: f64) -> Profile {
        let Contact { at, inside: [wetted, dry], .. } = self.contact(level);
        outside.then(dry.into_iter().rev()).to(at).then(wetted.into_iter().rev())
    }
}

/// Where a liquid's surface meets the inside of its vessel: the point, and the points of both before it and after it.
struct Contact {
    at: Point,
    inside: [Vec<Point>; 2],
    surface: [Vec<Point>; 2],
}

/// Where two steps cross.
fn crossing([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let cross = |p: Point, q: Point| p[0] * q[1] - p[1] * q[0];
    let [ab, cd, ac] = [[a, b], [c, d], [a, c]].map(|[p, q]| [q[0] - p[0], q[1] - p[1]]);
    let area = cross(ab, cd);
    let [t, u] = [cross(ac, cd) / area, cross(ac, ab) / area];
    let within = |x: f64| (0.0..1.0).contains(&x);
    (within(t) && within(u)).then(|| [a[0] + t * ab[0], a[1] + t * ab[1]])
}

/// The bowl of a wine glass, 0.1 m above the table, closing a little towards its lip.
fn bowl() -> Vessel {
    let inside = Profile(vec![[0.0, 0.100]])
        .curve([[0.030, 0.100], [0.041, 0.122], [0.041, 0.150]], 48)
        .curve([[0.041, 0.176], [0.033, 0.200], [0.031, 0.215]], 32);
    Vessel { inside, wall: 0.0012 }
}

/// How high the wine stands.
const WINE: f64 = 0.152;

/// Foot, stem and wall round the bowl.
fn wine_glass_outside() -> Profile {
    let foot = Profile(vec![[0.0, ABOVE_TABLE], [0.010, ABOVE_TABLE], [0.034, ABOVE_TABLE]])
        .curve([[0.0365, ABOVE_TABLE], [0.0365, 0.0028], [0.034, 0.0028]], 10)
        .curve([[0.020, 0.0042], [0.0040, 0.0048], [0.0036, 0.022]], 32)
        .curve([[0.0033, 0.045], [0.0030, 0.075], [0.0036, 0.090]], 24);
    // The stem opens into the wall; below there, the glass is solid.
    bowl().outside(foot, [0.0040, 0.097], 14)
}

fn wine_glass() -> Profile {
    bowl().glass(wine_glass_outside())
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
    tumbler().glass(tumbler().outside(bottom, [0.0334, 0.008], 19))
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

/// The meshes of a wine glass, `glass` and `wine` of materials of these names, and models of them. The medium of the glass
/// is to have the higher precedence.
///
/// # Errors
/// Those of `out`.
pub fn write_wine_glass(out: &mut dyn Write) -> io::Result<()> {
    let rules = "By the rules of the manual's Appendix A: the wine reaches into the wall of the glass, which displaces it.";
    let glass = bowl().glass_of(wine_glass_outside(), WINE);
    write_wine_glass_of(&[glass, bowl().liquid(WINE)], rules, out)
}

/// The same with explicit interfaces; here the wine is to have the higher precedence.
///
/// # Errors
/// Those of `out`.
pub fn write_explicit_wine_glass(out: &mut dyn Write) -> io::Result<()> {
    let glass = wine_glass_outside().then(bowl().dry_inside(WINE));
    let rules = "Explicit interfaces: where glass and wine meet, one surface divides them, that of the wine.";
    write_wine_glass_of(&[glass, bowl().liquid_within(WINE)], rules, out)
}

fn write_wine_glass_of(profiles: &[Profile; 2], rules: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "<!-- {rules} -->")?;
    write_drink(["glass", "wine"], profiles, "wine", out)?;
    write_model("glass", [0.0; 3], 1.0, None, out)?;
    write_model("wine", [0.0; 3], 1.0, None, out)
}

/// The same glass with nothing in it.
///
/// # Errors
/// Those of `out`.
pub fn write_empty_glass(out: &mut dyn Write) -> io::Result<()> {
    write_mesh("glass", true, "glass", &wine_glass().turned(TURN), out)?;
    write_model("glass", [0.0; 3], 1.0, None, out)
}

/// Of a tumbler: that of a small glass for spirits, inside 1.4 cm wide.
const SMALL: f64 = 0.22;

/// Three small tumblers side by side, with materials `milk`, `beer` and `wine` in them. A red wine as it was measured lets no
/// light through a wider one.
///
/// # Errors
/// Those of `out`.
pub fn write_drinks(out: &mut dyn Write) -> io::Result<()> {
    write_mesh("glass", true, "glass", &tumbler_glass().turned(TURN), out)?;
    for (material, x) in [("milk", -0.021), ("beer", 0.0), ("wine", 0.021)] {
        write_mesh(material, true, material, &tumbler().liquid(0.092).turned(TURN), out)?;
        write_model("glass", [x, 0.0, 0.0], SMALL, None, out)?;
        write_model(material, [x, 0.0, 0.0], SMALL, None, out)?;
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
        let explicit = [wine_glass_outside().then(bowl().dry_inside(WINE)), bowl().liquid_within(WINE)];
        let filled = bowl().glass_of(wine_glass_outside(), WINE);
        let others = [filled, wine_glass(), bowl().liquid(WINE), tumbler_glass(), tumbler().liquid(0.092)];
        for profile in explicit.into_iter().chain(others) {
            assert_solid(&profile.turned(TURN), volume(&profile));
        }
        assert!(wine_glass().turned(TURN).triangles.len() >= 40_000);
    }

    /// The surface meets the wall a little above the level, and the liquid that ends there lacks what is in the wall.
    #[test]
    fn liquids_of_both_kinds_have_one_surface() {
        let contact = bowl().contact(WINE);
        assert!((contact.at[1] - WINE - 0.0007).abs() < 0.0004, "{:?}", contact.at);
        let [a, b] = [bowl().liquid(WINE), bowl().liquid_within(WINE)];
        assert!(volume(&b) < volume(&a) && volume(&b) > 0.95 * volume(&a));
        let surface = [vec![contact.at], contact.surface[1].clone()].concat();
        assert!(a.0.ends_with(&surface) && b.0.ends_with(&surface));
    }

    /// Where both models have a surface, it has one normal: also where the explicit ones have their edge.
    #[test]
    fn models_of_both_kinds_have_the_same_normals() {
        let at = bowl().contact(WINE).at;
        let normal_of = |profile: &Profile, k: usize| {
            let i = (0..profile.0.len()).filter(|&i| profile.0[i] == at).nth(k).expect("it meets there");
            profile.normal(i)
        };
        let glass = bowl().glass_of(wine_glass_outside(), WINE);
        let explicit = wine_glass_outside().then(bowl().dry_inside(WINE));
        let [liquid, within] = [bowl().liquid(WINE), bowl().liquid_within(WINE)];
        let inside = normal_of(&glass, 0);
        let pairs = [
            (inside, normal_of(&explicit, 0), "dry wall"),
            (inside.map(|x| -x), normal_of(&within, 0), "wetted wall"),
            (normal_of(&liquid, 0), normal_of(&within, 1), "surface"),
        ];
        for (a, b, what) in pairs {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9, "{what}: {a:?}, {b:?}");
        }
    }

    /// What closes the explicit glass is not to be seen, for the liquid is all round it.
    #[test]
    fn what_closes_the_glass_lies_within_the_liquid() {
        let liquid = bowl().liquid_within(WINE).0;
        let at = bowl().contact(WINE).at;
        let dry = bowl().dry_inside(WINE);
        let edge = dry.iter().rposition(|p| *p == at).expect("it begins where the liquid ends");
        // By the parity of the liquid's outline to the right, away from the axis.
        let is_within = |[r, z]: Point| {
            let crosses = |pair: &&[Point]| {
                let ([a, u], [b, v]) = (pair[0], pair[1]);
                (u > z) != (v > z) && a + (z - u) / (v - u) * (b - a) > r
            };
            liquid.windows(2).filter(crosses).count() % 2 == 1
        };
        for (i, pair) in dry[edge..].windows(2).enumerate() {
            for k in usize::from(i == 0)..200 {
                let t = k as f64 / 200.0;
                let p = [0, 1].map(|c| pair[0][c] + t * (pair[1][c] - pair[0][c]));
                assert!(is_within(p), "{p:?}");
            }
        }
    }

    /// Side and bottom of the liquid lie within the wall, and more than 0.2 mm from both its faces.
    #[test]
    fn the_liquid_reaches_into_the_wall() {
        for (vessel, level) in [(bowl(), WINE), (tumbler(), 0.092)] {
            for p in vessel.liquid(level).0.iter().take_while(|p| p[1] < level) {
                let distance = |q: &Point| (p[0] - q[0]).hypot(p[1] - q[1]);
                let inside = vessel.inside.0.iter().map(distance).fold(f64::INFINITY, f64::min);
                assert!(inside > 0.0002 && inside < vessel.wall - 0.0002 || p[0] < 0.025, "{p:?}: {inside}");
            }
        }
    }
}
