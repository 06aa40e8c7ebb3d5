//! From a point that a ray met to a vertex of a path.

use super::media::{World, sides};
use super::vertex::Vertex;
use indigo_geom::SurfacePoint;
use indigo_light::EmitterHit;
use indigo_math::{Real, Vec3};
use indigo_scatter::{Material, MediumStack, ShadingPoint, bumped_normal};
use indigo_scene::Scene;

/// What a surface is to a path.
#[expect(clippy::large_enum_variant, reason = "a path uses no heap, and takes this apart at once")]
pub(super) enum Surface {
    /// Light is scattered.
    Scatters(Vertex),
    /// Light passes as if nothing were there, into other media.
    Unseen(MediumStack),
}

/// A surface seen from `wo` by a path with `media` round it.
///
/// Where the medium is the same on both sides, since another one displaces that of the surface, there is no
/// interface, so none is seen (Schmidt & Budge 2002).
///
/// `choice`, in [0, 1), picks one of the materials of a blend with the probability of its share. A
/// blend is linear in its materials and the choice does not depend on directions, so one material at
/// a time has the right mean, and the probability is the same for every strategy that could have
/// made the path: it cancels in their weights.
#[inline]
pub(super) fn shade(
    world: &World,
    at: &SurfacePoint,
    wo: Vec3,
    media: &MediumStack,
    choice: Real,
) -> Surface {
    let scene = world.scene;
    let material = scene.material_at(at);
    let medium = if world.has_media() { material.internal_medium() } else { None };
    let (above, below) = sides(medium, media, wo.dot(at.n_g) < 0.0);
    if medium.is_some() && above.current() == below.current() {
        return Surface::Unseen(below);
    }
    let mut context = scene.material_context(world.lambda, world.interface(&above, &below), choice);
    context.is_front = wo.dot(at.n_g) > 0.0;
    let uv = |set| scene.accel.uv(at, set);
    let material = material.chosen(&context, &uv);
    match material.leaf(&context, uv) {
        Some(leaf) => {
            let shading = ShadingPoint::new(leaf, at.n_g, shading_normal(scene, at, material), wo);
            Surface::Scatters(Vertex::on_surface(at, &shading, above, below))
        }
        None => Surface::Unseen(below),
    }
}

/// The normal of the mesh, bent by the material's bump map.
#[inline]
fn shading_normal(scene: &Scene, at: &SurfacePoint, material: &Material) -> Vec3 {
    let Some(id) = material.bump_map() else { return at.n_s };
    let map = &scene.textures[id as usize];
    // Without coordinates that span the surface the map says nothing about its slope.
    let Some(derivatives) = scene.accel.uv_derivatives(at, map.uv_set) else { return at.n_s };
    let gradient = map.gradient(scene.accel.uv(at, map.uv_set));
    bumped_normal(at.n_s, at.n_g, gradient, derivatives)
}

/// The point as the lights know it.
#[inline]
pub fn emitter_hit(at: &SurfacePoint) -> EmitterHit {
    EmitterHit { object: at.object, triangle: at.primitive, bary: at.bary, p: at.p, n: at.n_g }
}
