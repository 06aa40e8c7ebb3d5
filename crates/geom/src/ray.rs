//! Rays and hits.

use indigo_math::{Real, Vec3};

/// A half-line, or a part of one: the points `o + t d` with `t_min < t < t_max`.
///
/// A ray with a component that is infinite or NaN, or without a direction, hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, metres.
    pub o: Vec3,
    /// Direction; need not have unit length, `t` counts in its lengths.
    pub d: Vec3,
    /// Hits at or before this `t` do not count; below 0 it is taken as 0.
    pub t_min: Real,
    /// Hits at or beyond this `t` do not count; may be infinite.
    pub t_max: Real,
    /// When it is traced: the shutter opens at 0 and closes at 1.
    pub time: Real,
}

impl Ray {
    /// The whole half-line from `o` along `d`, when the shutter opens.
    #[inline]
    pub fn new(o: Vec3, d: Vec3) -> Self {
        Self { o, d, t_min: 0.0, t_max: Real::INFINITY, time: 0.0 }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: Real) -> Vec3 {
        self.o + self.d * t
    }

    /// The rest of the ray behind a hit at `t`, clear of it by `clearance` metres: the error of the point, and no more,
    /// since what would be skipped beside it may be the other side of the same object.
    ///
    /// Origin and far end stay where they are and the ray on its line: an offset along the surface's normal
    /// would shift it a little at every surface, and many of them would bend the way.
    #[inline]
    pub fn beyond(&self, t: Real, clearance: Real) -> Self {
        let step = clearance / self.d.length();
        // However short the step, `t` moves on, so that a walk through surfaces ends.
        Self { t_min: (t + step).max(t.next_up()), ..*self }
    }

    /// Whether the ray can hit anything at all.
    #[inline]
    pub(crate) fn is_sound(&self) -> bool {
        let (o, d) = (self.o, self.d);
        // 0 times infinity or NaN is NaN, and so is every sum with it.
        let zero = (o.x * 0.0 + o.y * 0.0) + (o.z * 0.0 + d.x * 0.0) + (d.y * 0.0 + d.z * 0.0);
        let directed = d.x != 0.0 || d.y != 0.0 || d.z != 0.0;
        zero == 0.0 && directed && self.t_max > self.t_min
    }
}

/// Where a ray met an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter of the ray.
    pub t: Real,
    /// On a triangle the barycentric coordinate of vertex 1; 0 on spheres and planes.
    pub u: Real,
    /// On a triangle the barycentric coordinate of vertex 2; 0 on spheres and planes.
    pub v: Real,
    /// Index of the object in the list given to [`Accel::build`](crate::Accel::build).
    pub object: u32,
    /// Index of the triangle in its mesh; 0 on spheres and planes.
    pub primitive: u32,
}
