//! Looks for openings that no exit portal covers.
//!
//! Paths from the camera are followed until they leave the interior, by a portal or into empty space. They bounce off
//! what they meet; what may let light through they pass, straight on, half of the times. One that leaves beside all
//! portals has found an opening; one that passes the back of a portal shows that its triangles are wound the wrong
//! way. Such light is not lost, but found by chance alone.

use super::Context;
use crate::Scene;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::Diagnostic;
use indigo_geom::{Ray, offset_origin};
use indigo_light::{Passage, Portals};
use indigo_math::rng::{Rng, key};
use indigo_math::warp::uniform_sphere;
use indigo_math::{Real, Vec2, Vec3, Vec3d};

/// Paths that are followed, and how many bounces each.
const PATHS: u32 = 1024;
const BOUNCES: u32 = 6;

/// How a path left the interior, and where from.
struct Exit {
    passage: Passage,
    p: Vec3,
    direction: Vec3,
}

/// Warns of openings through which paths from the camera, at the origin of render space, leave beside the
/// portals.
pub(super) fn warn_of_openings(root: &Node, scene: &Scene, origin: Vec3d, context: &mut Context) {
    let (Some(portals), Some(node)) = (scene.lights.portals(), root.nodes("exit_portal").next()) else {
        return;
    };
    let mut rng = Rng::new(key(&[u64::from(PATHS)]));
    let exits: Vec<Exit> = (0..PATHS).filter_map(|_| follow(scene, portals, &mut rng)).collect();
    let mut warn = |passage: Passage, what: &str, hint: &str| {
        let count = exits.iter().filter(|e| e.passage == passage).count();
        let Some(exit) = exits.iter().find(|e| e.passage == passage) else { return };
        let words = |v: Vec3d| v.to_array().map(|x| format!("{x:.3}")).join(" ");
        let from = words(exit.p.cast::<f64>() + origin);
        let message = format!("{count} of {PATHS} paths from the camera leave the scene {what}");
        let place = format!("one of them from ({from}) towards ({})", words(exit.direction.cast()));
        context.sink.push(Diagnostic::warning(codes::UNCOVERED, node.span, message).note(place).hint(hint));
    };
    warn(
        Passage::Beside,
        "beside the exit portals; the light that comes that way is found by chance alone",
        "cover every opening with a portal",
    );
    warn(
        Passage::Back,
        "through the back of an exit portal, which finds no light for them",
        "turn the winding of its triangles, so that the front faces the interior",
    );
}

/// A path from the camera until it leaves the interior; `None` if it does not in time.
fn follow(scene: &Scene, portals: &Portals, rng: &mut Rng) -> Option<Exit> {
    let mut p = Vec3::ZERO;
    let mut direction = uniform_sphere(Vec2::new(rng.next_real(), rng.next_real()));
    for _ in 0..BOUNCES {
        let ray = Ray::new(p, direction);
        let hit = scene.accel.intersect(&ray);
        let passage = portals.passage(p, direction, hit.as_ref().map_or(Real::INFINITY, |hit| hit.t));
        // What stands outside, before a window, is not the interior's.
        let Some(hit) = hit.filter(|_| passage == Passage::Beside) else {
            return Some(Exit { passage, p, direction });
        };
        let at = scene.accel.surface(&ray, &hit);
        if !scene.material_at(&at).may_transmit() || rng.next_real() < 0.5 {
            let n = if direction.dot(at.n_g) > 0.0 { -at.n_g } else { at.n_g };
            let any = uniform_sphere(Vec2::new(rng.next_real(), rng.next_real()));
            direction = if any.dot(n) < 0.0 { -any } else { any };
        }
        p = offset_origin(at.p, at.p_error, at.n_g, direction, 0.0);
    }
    None
}
