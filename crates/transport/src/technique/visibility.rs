//! Rays between vertices: leaving a surface, passing through what is invisible.

use indigo_geom::{Ray, SurfacePoint, offset_origin};
use indigo_light::LightSample;
use indigo_math::{Real, Vec3};
use indigo_scene::Scene;

/// A ray from a surface in a direction, clear of the surface's own error.
#[inline]
pub fn spawn(scene: &Scene, from: &SurfacePoint, direction: Vec3) -> Ray {
    Ray::new(offset_origin(from.p, from.p_error, from.n_g, direction, scene.nudge_m), direction)
}

/// Whether nothing stands between a surface point and the light that was drawn for it.
#[inline]
pub fn is_lit(scene: &Scene, from: &SurfacePoint, light: &LightSample) -> bool {
    let ray = match &light.point {
        None => spawn(scene, from, light.wi),
        Some(to) => {
            let origin = offset_origin(from.p, from.p_error, from.n_g, light.wi, scene.nudge_m);
            let target = offset_origin(to.p, to.p_error, to.n, -light.wi, scene.nudge_m);
            // t = 1 is the target itself, which does not count.
            Ray { o: origin, d: target - origin, t_min: 0.0, t_max: 1.0 }
        }
    };
    !is_blocked(scene, &ray)
}

/// Whether a visible surface is hit between the ray's ends.
#[inline]
fn is_blocked(scene: &Scene, ray: &Ray) -> bool {
    if !scene.has_invisible_surfaces {
        return scene.accel.occluded(ray);
    }
    if !scene.accel.occluded(ray) {
        return false;
    }
    let mut ray = *ray;
    while let Some(hit) = scene.accel.intersect(&ray) {
        let at = scene.accel.surface(&ray, &hit);
        if !scene.material_at(&at).is_invisible() {
            return true;
        }
        ray = continue_beyond(scene, &ray, &at);
    }
    false
}

/// The rest of a ray behind a surface that it passes through. The parameter keeps its meaning as a
/// multiple of the direction; the far end stays where it was.
#[inline]
pub fn continue_beyond(scene: &Scene, ray: &Ray, at: &SurfacePoint) -> Ray {
    let origin = offset_origin(at.p, at.p_error, at.n_g, ray.d, scene.nudge_m);
    let travelled: Real = (origin - ray.o).dot(ray.d) / ray.d.length2();
    Ray { o: origin, d: ray.d, t_min: 0.0, t_max: ray.t_max - travelled }
}
