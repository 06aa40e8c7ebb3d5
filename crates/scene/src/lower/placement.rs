//! Where instances of meshes stand.

use super::keyframes;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_geom::Movement;
use indigo_math::{Mat3, Transform, Vec3d};

/// Object space to the world, of a `model`, `meshlight` or `exit_portal`, when the shutter opens; and how it moves, if it
/// does.
pub(super) fn placement(node: &Node, sink: &mut Sink) -> (Transform, Option<Movement>) {
    if !node.block.declares("keyframe") {
        let pos = Vec3d::from(node.vec3("pos"));
        let linear = linear(node);
        return (placed(node, linear, pos, sink), None);
    }
    let (linear, motion) = (linear(node), keyframes::motion(node));
    keyframes::warn_of_keys(node, sink);
    let pose = motion.at(0.0);
    let transform = placed(node, pose.rotation() * linear, pose.pos, sink);
    let movement = if motion.moves() { Movement::new(linear, motion) } else { None };
    (transform, movement)
}

/// Its scale and rotation.
fn linear(node: &Node) -> Mat3<f64> {
    let scale = Mat3::scaling(node.real("scale"));
    let rotation = node.node("rotation").and_then(|r| r.opt_matrix("matrix"));
    rotation.map_or(scale, |m| Mat3::from_rows(m.value) * scale)
}

fn placed(node: &Node, linear: Mat3<f64>, pos: Vec3d, sink: &mut Sink) -> Transform {
    Transform::new(linear, pos).unwrap_or_else(|| {
        let rotation = node.node("rotation").and_then(|r| r.opt_matrix("matrix"));
        let span = rotation.map_or(node.span, |m| m.span);
        sink.push(
            Diagnostic::error(codes::SINGULAR, span, "the matrix cannot be inverted")
                .expected("expected nine numbers whose determinant is not 0"),
        );
        Transform::translation(pos)
    })
}
