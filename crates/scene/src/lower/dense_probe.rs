//! Looks for media so dense that rounding shows.
//!
//! Rays start a little off the surface that they leave, by as much as rounding may have moved it: about a millionth of its
//! triangles' size or of its distance. In a medium which light cannot cross that way unscattered, what lies there is lost, and the medium is
//! too dark. What tells is the way after which light has forgotten its direction, 1 / (σ (1 - g)).

use super::Context;
use crate::Scene;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::Diagnostic;
use indigo_geom::{Object, SurfacePoint, offset_origin};
use indigo_math::Real;
use indigo_scatter::Medium;

/// A distance off the surface of so much of that way is told: of an isotropic medium with an albedo of 0.98 under smooth glass of
/// index 1.4 a sixth of it made 3 % (measured), and so this about 1 %.
const LARGEST_SHARE: f64 = 0.05;
/// Triangles of a mesh that are looked at, evenly spaced.
const TRIANGLES: usize = 256;
/// Blue, green and red light, nm.
const COLOURS_NM: [f64; 3] = [450.0, 550.0, 650.0];

/// A surface of a material: how far rays keep off it, and the way in the medium behind it, metres.
#[derive(Clone, Copy)]
struct Found {
    off: f64,
    way: f64,
}

/// Warns of materials on whose surfaces that is so.
pub(super) fn warn_of_dense_media(root: &Node, scene: &Scene, context: &mut Context) {
    if scene.media.iter().all(|medium| way(medium).is_infinite()) {
        return;
    }
    let mut worst: Vec<Option<Found>> = vec![None; scene.materials.len()];
    for object in 0..scene.accel.objects().len() as u32 {
        for point in points(scene, object) {
            let slot = scene.first_slot[object as usize] + point.material_slot;
            let material = scene.slots[slot as usize] as usize;
            let Some(medium) = scene.materials[material].internal_medium() else { continue };
            let Some(medium) = scene.media.get(medium.index()) else { continue };
            let start = offset_origin(point.p, point.p_error, point.n_g, point.n_g, 0.0);
            let found = Found { off: f64::from((start - point.p).length()), way: way(medium) };
            let is_worse = |before: &Found| found.off / found.way > before.off / before.way;
            if worst[material].as_ref().is_none_or(is_worse) {
                worst[material] = Some(found);
            }
        }
    }
    for (name, found) in scene.names.materials.iter().zip(&worst) {
        let Some(Found { off, way }) = *found else { continue };
        if off > LARGEST_SHARE * way {
            let called = |node: &&Node| node.opt_text("name").is_some_and(|n| n.value == *name);
            let span = root.nodes("material").find(called).map_or(root.span, |node| node.span);
            let message = format!(
                "the medium inside {name} is too dense for its size: rays start {:.2} µm off the surface, {:.0} % of the {:.2} µm \
                 after which light has lost its direction, and it will be too dark",
                1e6 * off,
                100.0 * off / way,
                1e6 * way
            );
            let hint = "make it of smaller triangles, or nearer to the camera, or scatter less";
            context.sink.push_or_count(Diagnostic::warning(codes::TOO_DENSE, span, message).hint(hint));
        }
    }
}

/// Points of an object's surface.
fn points(scene: &Scene, object: u32) -> impl Iterator<Item = SurfacePoint> {
    let count = match scene.accel.objects()[object as usize] {
        Object::Mesh { mesh, .. } => scene.accel.meshes()[mesh as usize].triangles().len(),
        // Points of spheres and planes are exact but for their last digit.
        Object::Sphere { .. } | Object::Plane { .. } => 0,
    };
    let step = count.div_ceil(TRIANGLES).max(1);
    let third = 1.0 / 3.0;
    (0..count)
        .step_by(step)
        .filter_map(move |triangle| scene.accel.triangle_point(object, triangle as u32, (third, third)))
}

/// The shortest way after which light of any colour has forgotten its direction, metres; infinite where nothing scatters, and
/// where the surface does not refract: there rays go on as they came.
fn way(medium: &Medium) -> f64 {
    let refracts = COLOURS_NM.iter().any(|&nm| medium.ior.at(nm as Real) != 1.0);
    let reduced = |nm: f64| medium.scattering.at(nm) * (1.0 - medium.phase.mean_cosine(nm));
    let most = COLOURS_NM.map(reduced).into_iter().fold(0.0, f64::max);
    if refracts && most > 0.0 { 1.0 / most } else { f64::INFINITY }
}
