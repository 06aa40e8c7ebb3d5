//! Rays between vertices: leaving a surface, passing through what is invisible.

use indigo_geom::{Hit, Ray, SurfacePoint, offset_origin};
use indigo_light::{EmitterPoint, LightSample};
use indigo_math::Vec3;
use indigo_scene::Scene;

/// An end of a straight way.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    p: Vec3,
    p_error: Vec3,
    /// Normal of the surface that it lies on; zero in free space.
    n: Vec3,
}

impl Point {
    /// On a surface.
    #[inline]
    pub fn of_surface(at: &SurfacePoint) -> Self {
        Self { p: at.p, p_error: at.p_error, n: at.n_g }
    }

    /// On a lamp.
    #[inline]
    pub fn of_light(at: &EmitterPoint) -> Self {
        Self { p: at.p, p_error: at.p_error, n: at.n }
    }

    /// In free space.
    #[inline]
    pub fn free(p: Vec3) -> Self {
        Self { p, p_error: Vec3::ZERO, n: Vec3::ZERO }
    }

    /// Where a ray begins that leaves in a direction, clear of the surface's own error.
    #[inline]
    fn leave(&self, scene: &Scene, direction: Vec3) -> Vec3 {
        offset_origin(self.p, self.p_error, self.n, direction, scene.nudge_m)
    }

    /// The ray that leaves in a direction.
    #[inline]
    pub fn spawn(&self, scene: &Scene, direction: Vec3) -> Ray {
        Ray::new(self.leave(scene, direction), direction)
    }
}

/// A ray from a surface in a direction, clear of the surface's own error.
#[inline]
pub fn spawn(scene: &Scene, from: &SurfacePoint, direction: Vec3) -> Ray {
    Point::of_surface(from).spawn(scene, direction)
}

/// Whether nothing stands between a surface point and the light that was drawn for it.
#[inline]
pub fn is_lit(scene: &Scene, from: &SurfacePoint, light: &LightSample) -> bool {
    match &light.point {
        None => !is_blocked(scene, &spawn(scene, from, light.wi)),
        Some(to) => is_unblocked(scene, &Point::of_surface(from), &Point::of_light(to)),
    }
}

/// Whether nothing stands between two points.
#[inline]
pub fn is_unblocked(scene: &Scene, from: &Point, to: &Point) -> bool {
    let way = to.p - from.p;
    let origin = from.leave(scene, way);
    let target = to.leave(scene, -way);
    // t = 1 is the target itself, which does not count.
    !is_blocked(scene, &Ray { o: origin, d: target - origin, t_min: 0.0, t_max: 1.0 })
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
