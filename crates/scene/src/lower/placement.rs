//! Where instances of meshes stand.

use super::keyframes::Pose;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_math::{Mat3, Transform, Vec3d};

/// Object space to the world, of a `model`, `meshlight` or `exit_portal`.
pub(super) fn transform(node: &Node, sink: &mut Sink) -> Transform {
    let is_movable = node.block.declares("keyframe");
    let (pos, turn) = if is_movable {
        let pose = Pose::of(node, sink);
        (pose.pos, pose.rotation())
    } else {
        (Vec3d::from(node.vec3("pos")), Mat3::IDENTITY)
    };
    let scale = Mat3::scaling(node.real("scale"));
    let rotation = node.node("rotation").and_then(|r| r.opt_matrix("matrix"));
    let linear = rotation.map_or(scale, |m| Mat3::from_rows(m.value) * scale);
    Transform::new(turn * linear, pos).unwrap_or_else(|| {
        let span = rotation.map_or(node.span, |m| m.span);
        sink.push(
            Diagnostic::error(codes::SINGULAR, span, "the matrix cannot be inverted")
                .expected("expected nine numbers whose determinant is not 0"),
        );
        Transform::translation(pos)
    })
}
