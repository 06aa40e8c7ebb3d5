//! Where light goes that a leaning shading normal sends to the wrong side of its surface.

use indigo_math::angle::atan2_turns;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::{Real, Vec3};

/// The least lean (its sine) of a shading normal that counts as one: of what is scattered, the lobe of a matt surface
/// sends the share (1 - cos)/2 to the wrong side, here 6e-8, and rounding more.
const LEAST_LEAN: Real = 5e-4;

/// How a shading normal leans over its surface, and a map between the directions on the wrong side, which are in front
/// of the shading normal but behind the surface, and those on the right side.
///
/// Directions have an angle ψ round the line in which the planes of both normals meet: from 0, along the surface on the
/// side to which the normal leans by δ, to half a turn. The wrong side has -δ < ψ < 0. The map keeps what lies along
/// the line and stretches angles: ψ goes to ψ' = -ψ (1/2 turn) / δ, so that the wedge fills the right side. As the solid
/// angle is dψ times something that does not change, densities are divided by dψ'/dψ.
///
/// What comes out is the light of the wedge, spread so thin that nobody sees it: mirrored at the surface, as lobes are,
/// it would double the brightness of facets that a lamp grazes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WrongSide {
    /// Geometric normal, and the unit vector across it to which the shading normal leans.
    n_g: Vec3,
    lean: Vec3,
    /// δ, over half a turn.
    share: Real,
}

impl WrongSide {
    /// Of a geometric normal and a shading normal on its side; `None` where they are one, but for rounding.
    #[inline]
    pub fn new(n_g: Vec3, n_s: Vec3) -> Option<Self> {
        let cos = n_g.dot(n_s);
        let across = n_s - n_g * cos;
        let sin = across.length();
        (sin > LEAST_LEAN).then(|| Self { n_g, lean: across / sin, share: 2.0 * atan2_turns(sin, cos) })
    }

    /// The direction of the wrong side that a direction of the right side stands for, and how many times as dense it is
    /// there.
    #[inline]
    pub fn image(&self, l: Vec3) -> (Vec3, Real) {
        let (x, z) = (l.dot(self.lean), l.dot(self.n_g));
        let (sin, cos) = sin_cos_turns(atan2_turns(z, x) * self.share);
        (self.placed(l, [x, z], [cos, -sin]), self.share)
    }

    /// The direction of the right side that stands for one of the wrong side.
    #[inline]
    pub fn right(&self, l: Vec3) -> Vec3 {
        let (x, z) = (l.dot(self.lean), l.dot(self.n_g));
        let (sin, cos) = sin_cos_turns((atan2_turns(-z, x) / self.share).min(0.5));
        self.placed(l, [x, z], [cos, sin])
    }

    /// A direction with another angle: `from` are its coordinates in the plane of both normals, `to` the cosine and sine
    /// of the angle.
    #[inline]
    fn placed(&self, l: Vec3, [x, z]: [Real; 2], [cos, sin]: [Real; 2]) -> Vec3 {
        let r = (x * x + z * z).sqrt();
        l + self.lean * (r * cos - x) + self.n_g * (r * sin - z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vec3 = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

    /// The map and its inverse undo one another, lead to the other side, and take ends to ends.
    #[test]
    fn the_wedge_fills_the_right_side() {
        for turns in [0.002, 0.05, 0.2, 0.25] {
            let (sin, cos) = sin_cos_turns(turns);
            let n_s = Vec3::new(0.6 * sin, 0.8 * sin, cos);
            let map = WrongSide::new(UP, n_s).expect("a lean");
            for i in 1..40 {
                for y in [0.0, 0.5, -0.9] {
                    let (s, c) = sin_cos_turns(i as Real / 80.0);
                    let r = (1.0 - y * y as Real).sqrt();
                    let (x, along) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0));
                    let l = x * (r * c) + along * y + UP * (r * s);
                    let (there, density) = map.image(l);
                    assert!(there.z < 0.0 && there.dot(n_s) > -1e-6, "{turns} {i} {there:?}");
                    assert!((there.length() - 1.0).abs() < 1e-6);
                    assert!((density - 2.0 * turns).abs() < 1e-6);
                    let back = map.right(there);
                    assert!((back - l).length() < 2e-5 / turns, "{turns} {i} {y}: {l:?} {back:?}");
                }
            }
        }
        assert!(WrongSide::new(UP, UP).is_none());
    }
}
