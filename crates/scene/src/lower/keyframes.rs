//! Places in time.

use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Motion, Pose, Vec3d};
use std::f64::consts::PI;

/// Where a camera or model stands, by its keyframes or its `pos`.
pub(super) fn motion(node: &Node) -> Motion {
    let keys: Vec<(f64, Pose)> =
        node.nodes("keyframe").map(|key| (key.real("time"), of_keyframe(key))).collect();
    if !keys.is_empty() {
        // It is told beside what else is wrong with them.
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

/// Tells of what is odd about the keyframes of something.
pub(super) fn warn_of_keys(node: &Node, sink: &mut Sink) {
    warn_of_pos(node, sink);
    warn_of_long_turns(node, sink);
}

/// Tells of a place beside keyframes: later versions write one or the other.
fn warn_of_pos(node: &Node, sink: &mut Sink) {
    if node.has("pos") && node.has("keyframe") {
        let message = format!("<pos> of the {} has no effect beside <keyframe>", node.block.name);
        let code = indigo_decl::codes::DUPLICATE_ELEMENT;
        sink.push_or_count(Diagnostic::warning(code, node.span_of("pos"), message));
    }
}

/// Tells of neighbouring keys whose angles about one axis are more than half a turn apart: the shorter way is taken.
fn warn_of_long_turns(node: &Node, sink: &mut Sink) {
    let turn = |key: &Node| -> Option<Vec3d> {
        let turn = key.node("rotation_quaternion")?;
        Some(Vec3d::from(turn.vec3("axis")).try_normalized()? * turn.real("angle"))
    };
    let mut keys: Vec<(f64, Vec3d)> =
        node.nodes("keyframe").map(|key| (key.real("time"), turn(key).unwrap_or(Vec3d::ZERO))).collect();
    keys.sort_by(|a, b| a.0.total_cmp(&b.0));
    let far = keys.windows(2).map(|pair| (pair[0], pair[1])).find_map(|((t0, a), (t1, b))| {
        let is_about_one_axis = a.cross(b).length() <= 1e-6 * a.length() * b.length();
        let angle = (b - a).length();
        // What half a turn is in few digits is not told of.
        (t0 < t1 && is_about_one_axis && angle > PI + 1e-3).then_some(angle)
    });
    if let Some(angle) = far {
        let message = format!(
            "between two keyframes the angle changes by {:.0} degrees, and the shorter way is taken",
            angle.to_degrees()
        );
        let warning = Diagnostic::warning(codes::LONG_TURN, node.span_of("keyframe"), message);
        sink.push_or_count(warning.hint("put a keyframe between them, at most half a turn from each"));
    }
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
