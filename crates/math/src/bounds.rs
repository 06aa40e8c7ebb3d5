//! Axis-aligned boxes.

use crate::{Float, Real, Vec3};

/// An axis-aligned box; empty where `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3<T = Real> {
    /// Least corner.
    pub lo: Vec3<T>,
    /// Greatest corner.
    pub hi: Vec3<T>,
}

impl<T: Float> Bounds3<T> {
    /// The box that holds nothing.
    pub fn empty() -> Self {
        Self { lo: Vec3::splat(T::from_f64(f64::INFINITY)), hi: Vec3::splat(T::from_f64(f64::NEG_INFINITY)) }
    }

    /// The smallest box round some points.
    pub fn of_points(points: impl IntoIterator<Item = Vec3<T>>) -> Self {
        points.into_iter().fold(Self::empty(), Self::with_point)
    }

    /// The smallest box that also holds `p`.
    #[must_use]
    #[inline]
    pub fn with_point(self, p: Vec3<T>) -> Self {
        Self { lo: self.lo.min(p), hi: self.hi.max(p) }
    }

    /// The smallest box that holds both.
    #[must_use]
    #[inline]
    pub fn union(self, b: Self) -> Self {
        Self { lo: self.lo.min(b.lo), hi: self.hi.max(b.hi) }
    }

    /// Whether the box holds no point.
    pub fn is_empty(&self) -> bool {
        !(self.lo.x <= self.hi.x && self.lo.y <= self.hi.y && self.lo.z <= self.hi.z)
    }

    /// The middle.
    pub fn center(&self) -> Vec3<T> {
        (self.lo + self.hi) * T::from_f64(0.5)
    }

    /// The lengths of the sides.
    pub fn size(&self) -> Vec3<T> {
        self.hi - self.lo
    }

    /// Half the surface area; 0 for an empty box.
    #[inline]
    pub fn half_area(&self) -> T {
        if self.is_empty() {
            return T::ZERO;
        }
        let d = self.size();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3<T>; 8] {
        std::array::from_fn(|i| {
            let along = |axis: usize| if i >> axis & 1 == 0 { self.lo[axis] } else { self.hi[axis] };
            Vec3::new(along(0), along(1), along(2))
        })
    }

    /// Whether two boxes have a point in common.
    pub fn overlaps(&self, b: &Self) -> bool {
        (0..3).all(|i| self.lo[i] <= b.hi[i] && b.lo[i] <= self.hi[i])
    }

    /// Whether a point lies in the box or on its border.
    pub fn contains(&self, p: Vec3<T>) -> bool {
        (0..3).all(|i| self.lo[i] <= p[i] && p[i] <= self.hi[i])
    }
}
