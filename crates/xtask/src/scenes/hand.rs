//! Hands of skin: an open hand, its palm towards the camera, of epidermis over dermis.
//!
//! The hand is a field of distances in millimetres, x from the thumb to the little finger, y into the palm's back, z along the
//! fingers: round cones for bones and flesh, which run into one another smoothly.

use std::io::{self, Write};

use super::igs::{write_mesh, write_model};
use super::isosurface::{Lattice, isosurface};
use super::noise::value_noise;
use super::sphere::Mesh;
use super::vector::{Vector, add, dot, normalize, scale, sub};

/// Of a life-size hand: that of a small child, whose fingers are thin enough for light to come through.
const SIZE: f64 = 0.45;
/// Thickness of the epidermis, millimetres.
const EPIDERMIS: f64 = 0.25;
/// From point to point of the lattice, millimetres of the hand in its size.
const STEP: f64 = 1.0;

/// A finger: its knuckle, the angle in degrees that it is spread by, its three bones' lengths, and its radii at their ends.
struct Finger {
    knuckle: Vector,
    spread: f64,
    bones: [f64; 3],
    radii: [f64; 4],
}

const FINGERS: [Finger; 4] = [
    Finger {
        knuckle: [-28.0, 0.0, 92.0],
        spread: -9.0,
        bones: [42.0, 25.0, 18.0],
        radii: [10.0, 9.0, 8.0, 6.6],
    },
    Finger {
        knuckle: [-9.0, 1.0, 97.0],
        spread: -2.0,
        bones: [46.0, 28.0, 19.0],
        radii: [10.2, 9.2, 8.2, 6.8],
    },
    Finger {
        knuckle: [10.0, 0.5, 94.0],
        spread: 5.0,
        bones: [42.0, 26.0, 19.0],
        radii: [9.7, 8.8, 7.8, 6.5],
    },
    Finger {
        knuckle: [28.0, -1.0, 84.0],
        spread: 14.0,
        bones: [33.0, 20.0, 16.0],
        radii: [8.6, 7.6, 6.8, 5.7],
    },
];
/// How far each bone of a finger is bent towards the palm against the one before, degrees.
const BENDS: [f64; 3] = [5.0, 9.0, 8.0];

/// Joints of the thumb and the radii there.
const THUMB: [(Vector, f64); 4] = [
    ([-21.0, -4.0, 20.0], 13.0),
    ([-43.0, -10.0, 52.0], 10.8),
    ([-57.0, -14.0, 79.0], 9.4),
    ([-65.0, -17.0, 102.0], 7.2),
];

/// The lines of the palm, by x and z.
const LINES: [&[[f64; 2]]; 3] = [
    &[[36.0, 70.0], [22.0, 66.0], [4.0, 67.0], [-10.0, 74.0], [-17.0, 86.0]],
    &[[-38.0, 67.0], [-22.0, 62.0], [-2.0, 56.0], [16.0, 45.0]],
    &[[-38.0, 65.0], [-22.0, 56.0], [-10.0, 42.0], [-6.0, 26.0], [-10.0, 8.0]],
];

/// The smaller of two distances, rounded off where they differ by less than `k`.
fn join(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0);
    a.min(b) - h * h / (4.0 * k)
}

/// Distance from a stretch with a radius at each end.
fn cone(p: Vector, (a, ra): (Vector, f64), (b, rb): (Vector, f64)) -> f64 {
    let [ap, ab] = [sub(p, a), sub(b, a)];
    let t = (dot(ap, ab) / dot(ab, ab)).clamp(0.0, 1.0);
    let off = sub(ap, scale(t, ab));
    dot(off, off).sqrt() - (ra + (rb - ra) * t)
}

impl Finger {
    fn joints(&self) -> [(Vector, f64); 4] {
        let (spread, mut bend) = (self.spread.to_radians(), 0.0f64);
        let mut at = self.knuckle;
        let mut joints = [(at, self.radii[0]); 4];
        for i in 0..3 {
            bend += BENDS[i].to_radians();
            let along = [spread.sin() * bend.cos(), -bend.sin(), spread.cos() * bend.cos()];
            at = add(at, scale(self.bones[i], along));
            joints[i + 1] = (at, self.radii[i + 1]);
        }
        joints
    }
}

/// Bones under flesh that is fuller between the joints on the side of the palm, and creased at them.
fn digit(p: Vector, joints: &[(Vector, f64)]) -> f64 {
    let mut d = f64::INFINITY;
    for pair in joints.windows(2) {
        let [(a, ra), (b, rb)] = [pair[0], pair[1]];
        d = join(d, cone(p, (a, ra), (b, rb)), 1.0);
        let pad = |t: f64, r: f64| (add(add(a, scale(t, sub(b, a))), [0.0, -0.22 * ra, 0.0]), 0.86 * r);
        d = join(d, cone(p, pad(0.28, ra), pad(0.8, rb)), 2.0);
    }
    for pair in joints.windows(2) {
        let ((joint, r), along) = (pair[0], normalize(sub(pair[1].0, pair[0].0)));
        let off = sub(p, joint);
        let palm_side = (-off[1] / r).clamp(0.0, 1.0);
        d += 0.7 * palm_side * (-(dot(off, along) / 0.9).powi(2)).exp();
    }
    d
}

fn palm(p: Vector) -> f64 {
    let mut d = join(
        cone(p, ([-11.0, 2.0, -75.0], 21.0), ([-10.0, 2.0, 4.0], 16.5)),
        cone(p, ([11.0, 2.0, -75.0], 21.0), ([10.0, 2.0, 4.0], 16.5)),
        12.0,
    );
    for (finger, wrist) in FINGERS.iter().zip([-13.0, -4.0, 5.0, 13.0]) {
        d = join(d, cone(p, ([wrist, 2.0, 6.0], 13.5), (finger.knuckle, finger.radii[0] + 0.8)), 9.0);
    }
    // What lies across the knuckles, the balls of thumb and little finger, and pads under the fingers.
    d = join(d, cone(p, ([-26.0, 0.0, 84.0], 11.0), ([27.0, -1.0, 76.0], 10.0)), 8.0);
    d = join(d, cone(p, ([-19.0, -7.0, 20.0], 14.0), ([-33.0, -9.0, 48.0], 12.5)), 9.0);
    d = join(d, cone(p, ([20.0, -4.0, 18.0], 14.0), ([28.0, -3.5, 58.0], 11.5)), 9.0);
    for [a, b] in [[0, 1], [1, 2], [2, 3]] {
        let between = scale(0.5, add(FINGERS[a].knuckle, FINGERS[b].knuckle));
        d = join(
            d,
            cone(p, (add(between, [0.0, -4.5, -9.0]), 7.0), (add(between, [0.0, -4.5, -14.0]), 6.5)),
            5.0,
        );
    }
    d
}

/// Distance from the lines of the palm, seen from its front.
fn lines(p: Vector) -> f64 {
    let stretches = LINES.iter().flat_map(|line| line.windows(2));
    let flat = |[x, z]: [f64; 2]| ([x, 0.0, z], 0.0);
    stretches.map(|s| cone([p[0], 0.0, p[2]], flat(s[0]), flat(s[1]))).fold(f64::INFINITY, f64::min)
}

/// About the distance in millimetres from a life-size hand, negative inside.
fn hand(p: Vector) -> f64 {
    let mut d = join(palm(p), digit(p, &THUMB), 7.0);
    if p[1] < 0.0 {
        let fade = (-p[1] / 6.0).min(1.0);
        d += 0.9 * fade * (-(lines(p) / 1.1).powi(2)).exp();
    }
    let fingers = FINGERS.iter().map(|finger| digit(p, &finger.joints()));
    let fingers = fingers.fold(f64::INFINITY, |a, b| join(a, b, 1.5));
    // Relief of a fifth of a millimetre, so that the highlights are those of skin.
    join(d, fingers, 5.0) + 0.2 * value_noise(scale(1.0 / 3.5, p))
}

/// The surface so many millimetres below that of the skin; in metres.
fn layer(depth: f64) -> Mesh {
    let lattice = Lattice::over([-78.0, -34.0, -100.0], [56.0, 28.0, 198.0], STEP / SIZE);
    let mut mesh = isosurface(&lattice, |p| hand(p) + depth / SIZE);
    for p in &mut mesh.positions {
        *p = scale(1e-3 * SIZE, *p);
    }
    mesh
}

/// Three hands, of materials `epidermis` and `dermis` that end in `dark`, `medium` and `fair`.
pub fn write_hands(out: &mut dyn Write) -> io::Result<()> {
    for (name, mesh) in [("epidermis", layer(0.0)), ("dermis", layer(EPIDERMIS))] {
        for (kind, x) in [("dark", -0.062), ("medium", 0.0), ("fair", 0.062)] {
            let name = format!("{name} {kind}");
            write_mesh(&name, true, &name, &mesh, out)?;
            write_model(&name, [x, 0.0, 0.0], 1.0, None, out)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// That neither layer reaches the lattice's border, and one lies below the other. (Within each tetrahedron both are
    /// level planes of one linear field, so that they never cross.)
    #[test]
    fn the_dermis_lies_below_the_epidermis() {
        let [skin, dermis] = [layer(0.0), layer(EPIDERMIS)];
        for mesh in [&skin, &dermis] {
            let mut edges = std::collections::HashSet::new();
            for &[a, b, c] in &mesh.triangles {
                assert!([[a, b], [b, c], [c, a]].into_iter().all(|edge| edges.insert(edge)));
            }
            assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])), "a hole");
        }
        // Creases are finer than the lattice, so single points may be off.
        let depths = dermis.positions.iter().step_by(97).map(|&p| -SIZE * hand(scale(1e3 / SIZE, p)));
        let off: Vec<f64> = depths.map(|depth| (depth - EPIDERMIS).abs()).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        assert!(mean < 0.1 * EPIDERMIS, "{mean} mm on average");
    }
}
