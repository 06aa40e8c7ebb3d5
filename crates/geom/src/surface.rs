//! The surface at a hit: where it is, how sure that is, and which way it faces.

use crate::accel::Accel;
use crate::mesh::TriangleMesh;
use crate::object::Object;
use crate::ray::{Hit, Ray};
use crate::shapes::{onto_plane, onto_sphere};
use crate::soup::baked_vertex;
use indigo_math::{Bounds3, Float, Real, Transform, Vec3, Vec3d};
use std::borrow::Cow;

/// Half the distance between neighbouring numbers of the kernel's boxes and triangles, relative.
const ROUNDING: f64 = 0.5 * f32::EPSILON as f64;

/// How far, in roundings of a triangle's extent, the triangle test can find a plane beside itself.
///
/// The edge functions and the sum for t are a dozen operations on differences no larger than the
/// extent; γ₁₂ of each of three products bounds it (Pharr, Jakob, Humphreys, "Physically Based
/// Rendering", 4th ed., section 6.8, gives the calculus).
const TEST_ROUNDINGS: f64 = 36.0;
/// The same as a share of that extent.
const TESTED: f64 = TEST_ROUNDINGS * ROUNDING;

/// How far, in roundings of a ray's length, the test can find a plane beside itself at the ray's end.
const ALONG_ROUNDINGS: f64 = 12.0;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position in render space.
    pub p: Vec3,
    /// Absolute bound of the error of `p` and of the next ray's test, for each axis.
    pub p_error: Vec3,
    /// Unit geometric normal on the front side: winding on triangles, outwards on spheres.
    pub n_g: Vec3,
    /// Unit shading normal, smoothed where the mesh asks for it, on the side of `n_g`.
    pub n_s: Vec3,
    /// Barycentric coordinates of vertices 1 and 2 on triangles, else 0.
    pub bary: (Real, Real),
    /// The object.
    pub object: u32,
    /// The triangle of its mesh, else 0.
    pub primitive: u32,
    /// Material slot of the object.
    pub material_slot: u32,
    /// When it is there: see [`Ray::time`].
    pub time: Real,
}

/// Where to start a ray that leaves `p` in direction `dir`, clear of the surface's error.
///
/// `floor` is the least distance, metres (0: the bound alone). The result is moved along the normal
/// to the side that `dir` points to (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
/// section 6.8.6). Instead of rounding each coordinate away afterwards, the distance covers the
/// rounding u (|p| + distance) of the sum and that of the unit normal beforehand, with room to spare.
#[inline]
pub fn offset_origin(p: Vec3, p_error: Vec3, n_g: Vec3, dir: Vec3, floor: Real) -> Vec3 {
    let error = n_g.abs().dot(p_error + p.abs() * Real::EPSILON);
    let distance = (error * (1.0 + 8.0 * Real::EPSILON)).max(floor);
    p + n_g * distance.copysign(dir.dot(n_g))
}

/// Where to end a ray that comes to `p` from the far end of `back`, before the surface and clear of its error.
///
/// As [`offset_origin`], but the triangle test begins with differences as long as the ray here, and not only as the triangle: a
/// corner less the origin, its shear along the ray, its share of t. Those are some ten roundings of the ray's length along
/// each axis; what the edge functions round is still of the triangle's extent, since only differences of the corners'
/// depths multiply it.
#[inline]
pub fn offset_target(p: Vec3, p_error: Vec3, n_g: Vec3, back: Vec3, floor: Real) -> Vec3 {
    let along = back.abs() * Real::from_f64(ALONG_ROUNDINGS * ROUNDING);
    offset_origin(p, p_error + along, n_g, back, floor)
}

impl Accel {
    /// The surface at a hit of a ray, both of this geometry.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let along = ray.o.cast::<f64>() + ray.d.cast::<f64>() * hit.t.to_f64();
        match self.objects[hit.object as usize] {
            Object::Sphere { center, radius } => {
                let (p, n) = onto_sphere(along, center, radius);
                shape_point(p, center.abs() + Vec3d::splat(radius), n, hit.object)
            }
            Object::Plane { normal, dist, .. } => {
                let (p, n) = onto_plane(along, normal, dist);
                shape_point(p, along.abs(), n, hit.object)
            }
            Object::Mesh { .. } => self
                .triangle_point_at(hit.object, hit.primitive, (hit.u, hit.v), ray.time)
                .unwrap_or_else(|| shape_point(along, along.abs(), -ray.d.cast(), hit.object)),
        }
    }

    /// The surface at barycentric coordinates (of vertices 1 and 2) of a triangle; `None` where the
    /// object is not a mesh or has no such triangle. When the shutter opens, if it moves.
    pub fn triangle_point(&self, object: u32, triangle: u32, bary: (Real, Real)) -> Option<SurfacePoint> {
        self.triangle_point_at(object, triangle, bary, 0.0)
    }

    fn triangle_point_at(
        &self,
        object: u32,
        triangle: u32,
        bary: (Real, Real),
        time: Real,
    ) -> Option<SurfacePoint> {
        let placed = self.placed(object, triangle, time)?;
        let p = mix(&placed.corners, bary);
        let n_g = placed.normal();
        Some(SurfacePoint {
            p: p.cast(),
            p_error: placed.error(p),
            n_g: n_g.cast(),
            n_s: placed.smooth_normal(bary, n_g).cast(),
            bary,
            object,
            primitive: triangle,
            material_slot: placed.mesh.material_slot(triangle),
            time,
        })
    }

    /// Bounds, for each axis, how far beside a triangle a ray that leaves it may find it; 0 where the object is not a mesh or
    /// has no such triangle.
    pub fn test_error(&self, object: u32, triangle: u32) -> Vec3 {
        self.placed(object, triangle, 0.0).map_or(Vec3::ZERO, |placed| placed.test_error().cast())
    }

    /// The corners of a triangle in render space; `None` where the object is not a mesh or has no
    /// such triangle. When the shutter opens, if it moves.
    pub fn corners(&self, object: u32, triangle: u32) -> Option<[Vec3d; 3]> {
        Some(self.placed(object, triangle, 0.0)?.corners)
    }

    /// A triangle where its object puts it at a time.
    pub(crate) fn placed(&self, object: u32, triangle: u32, time: Real) -> Option<PlacedTriangle<'_>> {
        let Object::Mesh { mesh, transform } = self.objects.get(object as usize)? else { return None };
        let transform = match self.movement(object) {
            None => Cow::Borrowed(transform),
            Some(movement) => Cow::Owned(movement.at(time)),
        };
        let baked = self.is_baked(*mesh);
        let mesh = &self.meshes[*mesh as usize];
        if triangle as usize >= mesh.triangles().len() {
            return None;
        }
        let local = mesh.corners(triangle);
        // The tree has baked corners in single precision; an instance's are exact in its own space.
        let corner = |p: [f32; 3]| {
            if baked {
                Vec3::<f32>::from(baked_vertex(&transform, p)).cast()
            } else {
                transform.point(Vec3::<f32>::from(p).cast::<f64>())
            }
        };
        let corners = local.map(corner);
        Some(PlacedTriangle { mesh, triangle, transform, local, corners, baked })
    }
}

/// A triangle with its corners in render space, as nearly as the tree has them.
pub(crate) struct PlacedTriangle<'a> {
    pub mesh: &'a TriangleMesh,
    pub triangle: u32,
    pub transform: Cow<'a, Transform>,
    pub corners: [Vec3d; 3],
    local: [[f32; 3]; 3],
    baked: bool,
}

impl PlacedTriangle<'_> {
    /// The unit normal of the front.
    ///
    /// From the object's own corners: baked ones are rounded, and slivers would show it.
    fn normal(&self) -> Vec3d {
        let [a, b, c] = self.local.map(|p| Vec3d::from(p.map(f64::from)));
        let n = self.transform.normal((b - a).cross(c - a));
        n.try_normalized().unwrap_or(Vec3d::new(0.0, 0.0, 1.0))
    }

    /// The interpolated vertex normal on the side of `n_g`, or `n_g` where there is none.
    fn smooth_normal(&self, bary: (Real, Real), n_g: Vec3d) -> Vec3d {
        let smooth = self.mesh.corner_normals(self.triangle).and_then(|normals| {
            let unit = normals.map(|n| n.try_normalized().unwrap_or(Vec3d::ZERO));
            self.transform.normal(mix(&unit, bary)).try_normalized()
        });
        match smooth {
            Some(n) if n.dot(n_g) < 0.0 => -n,
            Some(n) => n,
            None => n_g,
        }
    }

    /// Bounds how far `p`, once rounded, and the next ray's test of the tree's triangle are off.
    fn error(&self, p: Vec3d) -> Vec3 {
        (p.abs() * ROUNDING + self.test_error()).cast()
    }

    /// Bounds how far the next ray's test of the tree's triangle is off.
    fn test_error(&self) -> Vec3d {
        if self.baked {
            return Vec3d::splat(TESTED * extent(&self.corners));
        }
        // In the instance's own space, where the ray is rounded once more.
        let local = self.local.map(|c| Vec3d::from(c.map(f64::from)));
        let size = local.iter().fold(Vec3d::ZERO, |m, c| m.max(c.abs())) * ROUNDING;
        let off = size + Vec3d::splat(TESTED * extent(&local));
        let rows = self.transform.linear().rows;
        Vec3d::from(rows.map(|row| row.abs().dot(off)))
    }
}

/// The longest side of the box round three points.
fn extent(corners: &[Vec3d; 3]) -> f64 {
    let b = Bounds3::of_points(*corners);
    b.size().max_component()
}

/// Interpolation between three corners.
pub(crate) fn mix(corners: &[Vec3d; 3], bary: (Real, Real)) -> Vec3d {
    let (u, v) = (bary.0.to_f64(), bary.1.to_f64());
    let [a, b, c] = *corners;
    a + (b - a) * u + (c - a) * v
}

/// A point of a sphere or plane; `size` bounds the numbers that went into `p`.
fn shape_point(p: Vec3d, size: Vec3d, n: Vec3d, object: u32) -> SurfacePoint {
    // Rounding to single precision, and a few roundings of the double precision before it.
    let p_error = p.abs() * ROUNDING + size * (8.0 * f64::EPSILON);
    let n = n.cast();
    SurfacePoint {
        p: p.cast(),
        p_error: p_error.cast(),
        n_g: n,
        n_s: n,
        bary: (0.0, 0.0),
        object,
        primitive: 0,
        material_slot: 0,
        // Only meshes move.
        time: 0.0,
    }
}
