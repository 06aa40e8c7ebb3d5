//! Texture coordinates and how the surface moves with them.

use crate::accel::Accel;
use crate::object::Object;
use crate::surface::SurfacePoint;
use indigo_math::{Float, Frame, Vec2, Vec3, Vec3d};
use std::f64::consts::{PI, TAU};

impl Accel {
    /// Texture coordinates at a point.
    ///
    /// Meshes: the given set, or (0, 0) where the mesh lacks it. Spheres: longitude from +x towards
    /// +y and colatitude from +z, both scaled to 0..1, whatever the set. Planes: metres along the
    /// two axes of the frame round the normal, from the point nearest to a given one.
    pub fn uv(&self, point: &SurfacePoint, set: u32) -> Vec2 {
        let uv = match self.objects[point.object as usize] {
            Object::Mesh { .. } => self.mesh_uv(point, set).unwrap_or(Vec2::new(0.0, 0.0)),
            Object::Sphere { .. } => {
                let n = point.n_g.cast::<f64>();
                let longitude = n.y.atan2(n.x);
                let turned = if longitude < 0.0 { longitude + TAU } else { longitude };
                Vec2::new(turned / TAU, n.z.clamp(-1.0, 1.0).acos() / PI)
            }
            Object::Plane { uv_origin, .. } => {
                let frame = Frame::from_normal(point.n_g);
                let p = point.p.cast::<f64>() - uv_origin;
                Vec2::new(p.dot(frame.s.cast()), p.dot(frame.t.cast()))
            }
        };
        Vec2::new(Float::from_f64(uv.x), Float::from_f64(uv.y))
    }

    /// How the position moves with u and with v of a set, metres per unit: (∂p/∂u, ∂p/∂v).
    ///
    /// `None` where the set is missing or does not span the surface.
    pub fn uv_derivatives(&self, point: &SurfacePoint, set: u32) -> Option<(Vec3, Vec3)> {
        let (du, dv) = match self.objects[point.object as usize] {
            Object::Mesh { .. } => self.mesh_derivatives(point, set)?,
            Object::Sphere { radius, .. } => sphere_derivatives(point.n_g.cast(), radius)?,
            Object::Plane { .. } => {
                let frame = Frame::from_normal(point.n_g);
                (frame.s.cast(), frame.t.cast())
            }
        };
        Some((du.cast(), dv.cast()))
    }

    fn mesh_uv(&self, point: &SurfacePoint, set: u32) -> Option<Vec2<f64>> {
        let placed = self.placed(point.object, point.primitive, point.time)?;
        let [a, b, c] = placed.mesh.corner_uvs(point.primitive, set)?;
        Some(a + (b - a) * point.bary.0.to_f64() + (c - a) * point.bary.1.to_f64())
    }

    fn mesh_derivatives(&self, point: &SurfacePoint, set: u32) -> Option<(Vec3d, Vec3d)> {
        let placed = self.placed(point.object, point.primitive, point.time)?;
        let [a, b, c] = placed.mesh.corner_uvs(point.primitive, set)?;
        let (e1, e2) = (placed.corners[1] - placed.corners[0], placed.corners[2] - placed.corners[0]);
        let (d1, d2) = (b - a, c - a);
        let det = d1.x * d2.y - d1.y * d2.x;
        let du = (e1 * d2.y - e2 * d1.y) / det;
        let dv = (e2 * d1.x - e1 * d2.x) / det;
        (du.is_finite() && dv.is_finite()).then_some((du, dv))
    }
}

/// Derivatives by longitude and colatitude, both scaled to 0..1; `None` at the poles.
fn sphere_derivatives(n: Vec3d, radius: f64) -> Option<(Vec3d, Vec3d)> {
    let from_axis = (n.x * n.x + n.y * n.y).sqrt();
    if from_axis == 0.0 {
        return None;
    }
    let du = Vec3d::new(-n.y, n.x, 0.0) * (TAU * radius);
    let dv = Vec3d::new(n.z * n.x / from_axis, n.z * n.y / from_axis, -from_axis) * (PI * radius);
    Some((du, dv))
}
