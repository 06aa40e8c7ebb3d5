//! Rigid motion between poses: places move in a straight line at an even speed, and what turns does so at an even speed
//! about one axis.

use crate::angle::atan2_turns;
use crate::elementary::sin_cos_turns;
use crate::{Float, Mat3, Real, Vec3d};

/// Where something stands, and how it is turned besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The place of its origin.
    pub pos: Vec3d,
    /// The turn: a unit quaternion, its real part and the others.
    pub turn: (f64, Vec3d),
}

impl Pose {
    /// Not turned.
    pub const NO_TURN: (f64, Vec3d) = (1.0, Vec3d::ZERO);

    /// The turn as a matrix.
    pub fn rotation(&self) -> Mat3<f64> {
        let (w, v) = self.turn;
        let (xx, yy, zz) = (v.x * v.x, v.y * v.y, v.z * v.z);
        let (xy, xz, yz) = (v.x * v.y, v.x * v.z, v.y * v.z);
        let (wx, wy, wz) = (w * v.x, w * v.y, w * v.z);
        Mat3::from_rows([
            1.0 - 2.0 * (yy + zz),
            2.0 * (xy - wz),
            2.0 * (xz + wy),
            2.0 * (xy + wz),
            1.0 - 2.0 * (xx + zz),
            2.0 * (yz - wx),
            2.0 * (xz - wy),
            2.0 * (yz + wx),
            1.0 - 2.0 * (xx + yy),
        ])
    }
}

/// The product of two quaternions: the turn `b`, and then `a`.
fn product(a: (f64, Vec3d), b: (f64, Vec3d)) -> (f64, Vec3d) {
    (a.0 * b.0 - a.1.dot(b.1), b.1 * a.0 + a.1 * b.0 + a.1.cross(b.1))
}

/// A motion through poses. Before the first and after the last it stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// When it begins.
    start: f64,
    first: Pose,
    last: Pose,
    legs: Box<[Leg]>,
}

/// From one pose to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leg {
    start: f64,
    end: f64,
    from: Pose,
    to: Vec3d,
    /// About what it turns, in its own frame, and half of how far, in turns of 360°.
    axis: Vec3d,
    half_turns: f64,
}

impl Leg {
    fn new((start, from): (f64, Pose), (end, to): (f64, Pose)) -> Self {
        let back = (from.turn.0, -from.turn.1);
        let (w, v) = product(back, to.turn);
        // The shorter way (K. Shoemake 1985, "Animating Rotation with Quaternion Curves").
        let (w, v) = if w < 0.0 { (-w, -v) } else { (w, v) };
        let half_turns = atan2_turns(Real::from_f64(v.length()), Real::from_f64(w)).to_f64();
        Self { start, end, from, to: to.pos, axis: v.try_normalized().unwrap_or(Vec3d::ZERO), half_turns }
    }

    fn at(&self, time: f64) -> Pose {
        let s = ((time - self.start) / (self.end - self.start)).clamp(0.0, 1.0);
        let (sin, cos) = sin_cos_turns(Real::from_f64(self.half_turns * s));
        let (w, v) = product(self.from.turn, (cos.to_f64(), self.axis * sin.to_f64()));
        // Sine and cosine are rounded, and things must not grow by that.
        let length = (w * w + v.length2()).sqrt();
        Pose { pos: self.from.pos + (self.to - self.from.pos) * s, turn: (w / length, v / length) }
    }
}

impl Motion {
    /// Through poses at times, in any order; of several at one time the last one in the list counts from then on. `None`
    /// without poses.
    pub fn new(mut keys: Vec<(f64, Pose)>) -> Option<Self> {
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (start, first) = *keys.first()?;
        let (_, last) = *keys.last()?;
        let legs = keys.windows(2).filter(|w| w[0].0 < w[1].0).map(|w| Leg::new(w[0], w[1])).collect();
        Some(Self { start, first, last, legs })
    }

    /// No motion.
    pub fn still(pose: Pose) -> Self {
        Self { start: 0.0, first: pose, last: pose, legs: Box::default() }
    }

    /// The pose at a time.
    pub fn at(&self, time: f64) -> Pose {
        if time < self.start {
            return self.first;
        }
        let after = self.legs.partition_point(|leg| leg.end <= time);
        self.legs.get(after).map_or(self.last, |leg| leg.at(time))
    }

    /// Whether it is not the same pose from time 0 to 1.
    pub fn moves(&self) -> bool {
        let start = self.at(0.0);
        self.poses(1.0).iter().any(|pose| *pose != start)
    }

    /// Poses from time 0 to 1, between neighbours of which it turns by no more than `most_turns` of 360° and its place moves
    /// on a line, or jumps: both ends, and of each leg what is left before a jump, too.
    pub fn poses(&self, most_turns: f64) -> Vec<Pose> {
        let mut poses = vec![self.at(0.0)];
        if self.start > 0.0 && self.start < 1.0 {
            poses.push(self.first);
        }
        for leg in &self.legs {
            let (start, end) = (leg.start.max(0.0), leg.end.min(1.0));
            if start < end {
                let turns = 2.0 * leg.half_turns * (end - start) / (leg.end - leg.start);
                let steps = (turns / most_turns).ceil().max(1.0);
                poses
                    .extend((0..=steps as u32).map(|i| leg.at(start + (end - start) * f64::from(i) / steps)));
            }
        }
        poses.push(self.at(1.0));
        poses
    }

    /// The same motion elsewhere.
    #[must_use]
    pub fn moved_by(mut self, by: Vec3d) -> Self {
        self.first.pos += by;
        self.last.pos += by;
        for leg in &mut self.legs {
            leg.from.pos += by;
            leg.to += by;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn pose(x: f64, angle: f64) -> Pose {
        let half = 0.5 * angle;
        Pose { pos: Vec3d::new(x, 0.0, 0.0), turn: (half.cos(), Vec3d::new(0.0, 0.0, half.sin())) }
    }

    /// Rounding of a half angle to 1e-7 turns, and of its sine.
    fn close(a: Vec3d, b: Vec3d) -> bool {
        (a - b).length() < 2e-6
    }

    #[test]
    fn between_poses_it_moves_evenly_and_beyond_them_it_stands() {
        let motion = Motion::new(vec![(3.0, pose(4.0, PI / 2.0)), (-1.0, pose(0.0, 0.0))]).expect("poses");
        let x = Vec3d::new(1.0, 0.0, 0.0);
        for (time, place, angle) in [
            (-5.0, 0.0, 0.0),
            (-1.0, 0.0, 0.0),
            (1.0, 2.0, PI / 4.0),
            (3.0, 4.0, PI / 2.0),
            (9.0, 4.0, PI / 2.0),
        ] {
            let at = motion.at(time);
            assert!((at.pos.x - place).abs() < 1e-12, "{time}: {at:?}");
            assert!(close(at.rotation() * x, Vec3d::new(angle.cos(), angle.sin(), 0.0)), "{time}: {at:?}");
            let (w, v) = at.turn;
            assert!((w * w + v.length2() - 1.0).abs() < 1e-14);
        }
        // A third of the way is a third of the angle.
        let third = motion.at(-1.0 + 4.0 / 3.0).rotation() * x;
        assert!((third.x - (PI / 6.0).cos()).abs() < 2e-6);
        assert!(motion.moves());
    }

    #[test]
    fn turns_go_the_shorter_way_from_wherever_they_begin() {
        // From 170° to −170° about z, after a turn about x.
        let tilt = (0.5f64.sqrt(), Vec3d::new(0.5f64.sqrt(), 0.0, 0.0));
        let turned = |angle: f64| Pose { turn: product(pose(0.0, angle).turn, tilt), ..pose(0.0, 0.0) };
        let (from, to) = (turned(170.0 * PI / 180.0), turned(-170.0 * PI / 180.0));
        let motion = Motion::new(vec![(0.0, from), (1.0, to)]).expect("poses");
        let middle = turned(PI).rotation();
        let v = Vec3d::new(0.3, -0.5, 0.8);
        assert!(close(motion.at(0.5).rotation() * v, middle * v));
        assert!(close(motion.at(1.0).rotation() * v, to.rotation() * v));
        assert_eq!(motion.poses(1.0 / 30.0).len(), 2 + 3);
    }

    #[test]
    fn only_what_happens_while_the_shutter_is_open_is_motion() {
        let moves = |keys: Vec<(f64, Pose)>| Motion::new(keys).expect("poses").moves();
        assert!(!moves(vec![(0.0, pose(1.0, 0.5))]));
        assert!(!moves(vec![(0.0, pose(1.0, 0.5)), (5.0, pose(1.0, 0.5))]));
        assert!(!moves(vec![(1.0, pose(1.0, 0.0)), (2.0, pose(3.0, 0.0))]));
        assert!(moves(vec![(0.0, pose(1.0, 0.0)), (5.208, pose(3.0, 0.0))]));
        assert!(moves(vec![(0.0, pose(1.0, 0.0)), (0.5, pose(3.0, 0.0)), (1.0, pose(1.0, 0.0))]));
        // In no time, from one place to another: where it was is a place that it had.
        let jump = vec![
            (0.0, pose(-2.0, 0.0)),
            (0.5, pose(2.0, 0.0)),
            (0.5, pose(-2.0, 0.0)),
            (1.0, pose(-2.0, 0.0)),
        ];
        assert!(moves(jump.clone()));
        let jumping = Motion::new(jump).expect("poses");
        assert!(jumping.poses(1.0).contains(&pose(2.0, 0.0)));
        assert_eq!((jumping.at(0.25).pos.x, jumping.at(0.5).pos.x), (0.0, -2.0));
        // The last in the list counts from then on, at both ends too.
        let twice =
            |time: f64| Motion::new(vec![(time, pose(-2.0, 0.0)), (time, pose(2.0, 0.0))]).expect("poses");
        assert_eq!([-0.1, 0.0, 0.5].map(|time| twice(0.0).at(time).pos.x), [-2.0, 2.0, 2.0]);
        assert!(!twice(0.0).moves() && twice(0.5).moves() && !twice(2.0).moves());
        assert_eq!(twice(0.5).poses(1.0), [-2.0, -2.0, 2.0].map(|x| pose(x, 0.0)));
        assert!(Motion::new(vec![]).is_none());
        let shifted = Motion::new(vec![(0.0, pose(1.0, 0.0)), (1.0, pose(3.0, 0.0))]).expect("poses");
        assert_eq!(shifted.moved_by(Vec3d::new(0.0, 2.0, 0.0)).at(0.5).pos, Vec3d::new(2.0, 2.0, 0.0));
    }
}
