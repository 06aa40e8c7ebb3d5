//! From a point that a ray met to a scattering model that a path can use.

use indigo_geom::SurfacePoint;
use indigo_light::EmitterHit;
use indigo_math::{Real, Vec3};
use indigo_scatter::{Interface, ShadingPoint};
use indigo_scene::Scene;
use indigo_spectrum::SampledWavelengths;

/// The scattering model at a point seen from `wo`; `None` where light passes as if nothing were there.
///
/// `choice`, in [0, 1), picks one of the materials of a blend with the probability of its share. A
/// blend is linear in its materials and the choice does not depend on directions, so one material at
/// a time has the right mean, and the probability is the same for every strategy that could have
/// made the path: it cancels in their weights.
#[inline]
pub fn shade(
    scene: &Scene,
    at: &SurfacePoint,
    wo: Vec3,
    lambda: &SampledWavelengths,
    choice: Real,
) -> Option<ShadingPoint> {
    let context = scene.material_context(lambda, Interface::NONE, choice);
    let leaf = scene.material_at(at).leaf(&context, |set| scene.accel.uv(at, set))?;
    Some(ShadingPoint::new(leaf, at.n_g, at.n_s, wo))
}

/// The point as the lights know it.
#[inline]
pub fn emitter_hit(at: &SurfacePoint) -> EmitterHit {
    EmitterHit { object: at.object, triangle: at.primitive, bary: at.bary, p: at.p, n: at.n_g }
}
