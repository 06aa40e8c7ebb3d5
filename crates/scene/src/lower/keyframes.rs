//! Places in time: of what moves, where it is when the shutter opens.

use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Mat3, Vec3d};

/// Where something stands, and how it is turned besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) pos: Vec3d,
    /// A unit quaternion: its real part, and the others.
    turn: (f64, Vec3d),
}

impl Pose {
    /// Of a camera or model: by its keyframes, or its `pos`.
    pub(super) fn of(node: &Node, sink: &mut Sink) -> Self {
        let mut keys: Vec<(f64, Self)> =
            node.nodes("keyframe").map(|key| (key.real("time"), Self::of_keyframe(key))).collect();
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(_, first)) = keys.first() else {
            return Self { pos: node.vec3("pos").into(), turn: (1.0, Vec3d::ZERO) };
        };
        // Later versions write one or the other.
        node.disregard_field("pos");
        if keys.iter().any(|(_, pose)| *pose != first) {
            sink.push_or_count(Diagnostic::warning(
                codes::STANDS_STILL,
                node.span_of("keyframe"),
                format!(
                    "motion is not rendered: the {} stands where it is when the shutter opens",
                    node.block.name
                ),
            ));
        }
        Self::at(0.0, &keys).unwrap_or(first)
    }

    fn of_keyframe(key: &Node) -> Self {
        let turn = key.node("rotation_quaternion").map_or((1.0, Vec3d::ZERO), |turn| {
            // Clockwise: the other way round from the right-handed sense.
            let half = -0.5 * turn.real("angle");
            let axis = Vec3d::from(turn.vec3("axis")).try_normalized();
            axis.map_or((1.0, Vec3d::ZERO), |axis| (half.cos(), axis * half.sin()))
        });
        Self { pos: key.vec3("pos").into(), turn }
    }

    /// At a time, between keys in order of time; `None` without keys.
    fn at(time: f64, keys: &[(f64, Self)]) -> Option<Self> {
        let after = keys.partition_point(|(t, _)| *t <= time);
        let Some(before) = after.checked_sub(1) else { return keys.first().map(|(_, pose)| *pose) };
        let (t0, a) = keys[before];
        let Some(&(t1, b)) = keys.get(after) else { return Some(a) };
        let s = (time - t0) / (t1 - t0);
        Some(Self { pos: a.pos + (b.pos - a.pos) * s, turn: slerp(a.turn, b.turn, s) })
    }

    /// The turn as a matrix.
    pub(super) fn rotation(&self) -> Mat3<f64> {
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

/// Between two unit quaternions at an even speed, the shorter way (K. Shoemake 1985, "Animating Rotation with Quaternion
/// Curves").
fn slerp(a: (f64, Vec3d), b: (f64, Vec3d), s: f64) -> (f64, Vec3d) {
    let dot = a.0 * b.0 + a.1.dot(b.1);
    let (b, dot) = if dot < 0.0 { ((-b.0, -b.1), -dot) } else { (b, dot) };
    let angle = dot.min(1.0).acos();
    // Below this the sines lose what the straight line between them keeps.
    let (wa, wb) = if angle < 1e-6 {
        (1.0 - s, s)
    } else {
        (((1.0 - s) * angle).sin() / angle.sin(), (s * angle).sin() / angle.sin())
    };
    (wa * a.0 + wb * b.0, a.1 * wa + b.1 * wb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn pose(x: f64, angle: f64) -> Pose {
        let half = 0.5 * angle;
        Pose { pos: Vec3d::new(x, 0.0, 0.0), turn: (half.cos(), Vec3d::new(0.0, 0.0, half.sin())) }
    }

    #[test]
    fn between_keys_it_moves_evenly_and_beyond_them_it_stands() {
        let keys = [(-1.0, pose(0.0, 0.0)), (3.0, pose(4.0, PI / 2.0))];
        let at = |time: f64| Pose::at(time, &keys).expect("there are keys");
        assert_eq!((at(-5.0), at(9.0)), (keys[0].1, keys[1].1));
        let middle = at(1.0);
        assert!((middle.pos.x - 2.0).abs() < 1e-12);
        let turned = middle.rotation() * Vec3d::new(1.0, 0.0, 0.0);
        let half = (PI / 4.0).sin();
        assert!((turned - Vec3d::new(half, half, 0.0)).length() < 1e-12, "{turned:?}");
        // A third of the way is a third of the angle.
        let third = at(-1.0 + 4.0 / 3.0).rotation() * Vec3d::new(1.0, 0.0, 0.0);
        assert!((third.x - (PI / 6.0).cos()).abs() < 1e-12);
    }
}
