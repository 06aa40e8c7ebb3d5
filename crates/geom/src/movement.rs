//! Instances that move while the shutter is open.

use indigo_math::{Bounds3, Float, Mat3, Motion, Pose, Real, Transform, Vec3d};

/// Between two places that the box round something that turns is made of, it turns no farther than this, in turns of 360°.
const TURN: f64 = 1.0 / 64.0;

/// How a mesh that is placed by a linear map moves: the map, and then the motion's turn and place.
#[derive(Clone, Debug, PartialEq)]
pub struct Movement {
    linear: Mat3<f64>,
    motion: Motion,
    /// At time 0.
    still: Transform,
}

impl Movement {
    /// `None` where the map cannot be inverted.
    pub fn new(linear: Mat3<f64>, motion: Motion) -> Option<Self> {
        let still = placed(linear, &motion.at(0.0))?;
        Some(Self { linear, motion, still })
    }

    /// Object to render space at a time: the shutter is open from 0 to 1.
    pub fn at(&self, time: Real) -> Transform {
        // Turns do not make a map singular.
        placed(self.linear, &self.motion.at(time.to_f64())).unwrap_or(self.still)
    }

    /// The same movement elsewhere.
    #[must_use]
    pub fn moved_by(self, by: Vec3d) -> Self {
        Self { motion: self.motion.moved_by(by), still: self.still.then_translate(by), ..self }
    }

    /// Object to render space along its way while the shutter is open: where it starts, turns, jumps and ends.
    pub fn places(&self) -> impl Iterator<Item = Transform> {
        // Turns do not make a map singular.
        let placed = |pose: Pose| placed(self.linear, &pose).unwrap_or(self.still);
        self.motion.poses(TURN).into_iter().map(placed)
    }

    /// A box round what is in a box of the object's own space, wherever it comes from time 0 to 1.
    pub fn bounds(&self, own: &Bounds3<f64>) -> Bounds3<f64> {
        let corners = own.corners();
        let images = self.places().flat_map(|place| corners.map(|corner| place.point(corner)));
        let chords = Bounds3::of_points(images);
        // Between two places a point at a distance r from the centre leaves the straight line between its places by no more
        // than the largest acceleration allows, r δ² / 8 for a turn by δ.
        let farthest = corners.map(|corner| (self.linear * corner).length()).into_iter().fold(0.0, f64::max);
        let turn = TURN * std::f64::consts::TAU;
        let margin = Vec3d::splat(farthest * turn * turn / 8.0);
        Bounds3 { lo: chords.lo - margin, hi: chords.hi + margin }
    }
}

fn placed(linear: Mat3<f64>, pose: &Pose) -> Option<Transform> {
    Transform::new(pose.rotation() * linear, pose.pos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_holds_what_turns_and_moves_at_all_times() {
        let turned = |angle: f64, pos: [f64; 3]| Pose {
            pos: pos.into(),
            turn: ((angle / 2.0).cos(), Vec3d::new(0.6, 0.0, 0.8) * (angle / 2.0).sin()),
        };
        let keys = vec![
            (-0.3, turned(0.0, [0.0; 3])),
            (0.4, turned(2.5, [3.0, 1.0, 0.0])),
            (0.7, turned(2.5, [3.0, 6.0, 0.0])),
            (0.7, turned(3.0, [3.0, 1.0, 0.0])),
            (2.0, turned(4.5, [3.0, -4.0, 1.0])),
        ];
        let linear = Mat3::from_rows([2.0, 0.0, 0.3, 0.0, 1.0, 0.0, 0.0, -0.5, 1.0]);
        let movement =
            Movement::new(linear, Motion::new(keys).expect("poses")).expect("a map that can be inverted");
        let own = Bounds3 { lo: Vec3d::new(-1.0, -2.0, -0.5), hi: Vec3d::new(1.0, 0.5, 3.0) };
        let bounds = movement.bounds(&own);
        let mut touched = Bounds3::of_points([]);
        for i in 0..=1000u16 {
            let transform = movement.at(Real::from(i) / 1000.0);
            for corner in own.corners() {
                let p = transform.point(corner);
                assert!(bounds.contains(p), "{i}: {p:?} is not in {bounds:?}");
                touched = touched.with_point(p);
            }
        }
        // The box is no wider than it need be: by twice the margin, of a thousandth.
        assert!((bounds.size() - touched.size()).max_component() < 0.02, "{bounds:?} {touched:?}");
    }
}
