//! Spheres and planes, in double precision throughout.
//!
//! A sphere of 1 km radius seen from 1 mm leaves f32 without one right digit, and these are few
//! beside triangles, so the precision costs nothing that can be measured.

use crate::Ray;
use indigo_math::{Real, Vec3d};

/// The first `t` inside the ray's interval at which it meets the sphere.
///
/// The roots follow Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection" (Ray Tracing Gems, 2019, eqs. 5 to 8): discriminant from the perpendicular, and
/// the root that would cancel from the product of both.
pub(crate) fn hit_sphere(ray: &Ray, center: Vec3d, radius: f64, t_max: Real) -> Option<Real> {
    let d = ray.d.cast::<f64>();
    let from_center = ray.o.cast::<f64>() - center;
    let a = d.length2();
    let half_b = -from_center.dot(d);
    let perpendicular = from_center + d * (half_b / a);
    let discriminant = radius * radius - perpendicular.length2();
    if discriminant.is_nan() || discriminant < 0.0 {
        return None;
    }
    let distance = from_center.length();
    let c = (distance - radius) * (distance + radius);
    let q = half_b + (discriminant * a).sqrt().copysign(half_b);
    let (r0, r1) = (c / q, q / a);
    first_inside(ray, t_max, r0.min(r1)).or_else(|| first_inside(ray, t_max, r0.max(r1)))
}

/// The `t` at which the ray meets the plane `normal · p = dist`, if inside its interval.
pub(crate) fn hit_plane(ray: &Ray, normal: Vec3d, dist: f64, t_max: Real) -> Option<Real> {
    let t = (dist - normal.dot(ray.o.cast())) / normal.dot(ray.d.cast());
    first_inside(ray, t_max, t)
}

fn first_inside(ray: &Ray, t_max: Real, t: f64) -> Option<Real> {
    let t = t as Real;
    (t > ray.t_min.max(0.0) && t < t_max).then_some(t)
}

/// The point of a sphere nearest to `p`, and the outward unit normal there.
pub(crate) fn onto_sphere(p: Vec3d, center: Vec3d, radius: f64) -> (Vec3d, Vec3d) {
    let n = (p - center).try_normalized().unwrap_or(Vec3d::new(0.0, 0.0, 1.0));
    (center + n * radius, n)
}

/// The point of a plane with a unit normal nearest to `p`, and that normal.
pub(crate) fn onto_plane(p: Vec3d, normal: Vec3d, dist: f64) -> (Vec3d, Vec3d) {
    (p - normal * (normal.dot(p) - dist), normal)
}
