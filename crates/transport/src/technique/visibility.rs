//! Rays between vertices: leaving a surface, passing through what is invisible.

use indigo_geom::{Hit, Ray, SurfacePoint, offset_origin};
use indigo_light::LightSample;
use indigo_math::Vec3;
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
        ray = continue_beyond(scene, &ray, &hit, &at);
    }
    false
}

/// The rest of a ray behind a surface that it passes through.
///
/// Origin and far end stay where they are and the ray on its line: an offset along the normal would
/// shift it a little at every surface, and many of them would bend the way to a light.
#[inline]
pub fn continue_beyond(scene: &Scene, ray: &Ray, hit: &Hit, at: &SurfacePoint) -> Ray {
    let step = at.p_error.length().max(scene.nudge_m) / ray.d.length();
    // However short the step, `t` moves on, so that this ends.
    Ray { t_min: (hit.t + step).max(hit.t.next_up()), ..*ray }
}
