//! Places in time.

use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Motion, Pose, Vec3d};

/// Where a camera or model stands, by its keyframes or its `pos`.
pub(super) fn motion(node: &Node) -> Motion {
    let keys: Vec<(f64, Pose)> =
        node.nodes("keyframe").map(|key| (key.real("time"), of_keyframe(key))).collect();
    if !keys.is_empty() {
        // Later versions write one or the other.
        node.disregard_field("pos");
    }
    let still = || Pose { pos: node.vec3("pos").into(), turn: Pose::NO_TURN };
    Motion::new(keys).unwrap_or_else(|| Motion::still(still()))
}

/// Says that something that moves does not: what stands in is where it is when the shutter opens.
pub(super) fn warn_of_standing(node: &Node, why: &str, sink: &mut Sink) {
    let name = node.block.name;
    sink.push_or_count(Diagnostic::warning(
        codes::STANDS_STILL,
        node.span_of("keyframe"),
        format!("motion is not rendered of {why}: the {name} stands where it is when the shutter opens"),
    ));
}

fn of_keyframe(key: &Node) -> Pose {
    let turn = key.node("rotation_quaternion").map_or(Pose::NO_TURN, |turn| {
        // Clockwise: the other way round from the right-handed sense.
        let half = -0.5 * turn.real("angle");
        let axis = Vec3d::from(turn.vec3("axis")).try_normalized();
        axis.map_or(Pose::NO_TURN, |axis| (half.cos(), axis * half.sin()))
    });
    Pose { pos: key.vec3("pos").into(), turn }
}
