//! Vectors of two and three components and 3×3 matrices.
//!
//! Points, directions and normals share one type: what tells them apart is how a
//! [`Transform`](crate::Transform) moves them (`point`, `vector`, `normal`), and their names.

use crate::scalar::{Float, Real};
use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Neg, Sub, SubAssign};

/// A vector of two components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec2<T = Real> {
    /// First component.
    pub x: T,
    /// Second component.
    pub y: T,
}

/// A vector of three components: a point, a direction or a normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<T = Real> {
    /// First component.
    pub x: T,
    /// Second component.
    pub y: T,
    /// Third component.
    pub z: T,
}

/// A vector in double precision, for everything done once at load.
pub type Vec3d = Vec3<f64>;

impl<T> Vec2<T> {
    /// A vector from its components.
    #[inline(always)]
    pub const fn new(x: T, y: T) -> Self {
        Self { x, y }
    }
}

impl<T> From<[T; 2]> for Vec2<T> {
    #[inline(always)]
    fn from([x, y]: [T; 2]) -> Self {
        Self { x, y }
    }
}

impl<T: Float> Add for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y)
    }
}

impl<T: Float> Sub for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y)
    }
}

impl<T: Float> Mul<T> for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s)
    }
}

impl<T> Vec3<T> {
    /// A vector from its components.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl<T: Float> Vec3<T> {
    /// The origin, or no displacement.
    pub const ZERO: Self = Self::new(T::ZERO, T::ZERO, T::ZERO);

    /// A vector with three equal components.
    #[inline(always)]
    pub fn splat(v: T) -> Self {
        Self::new(v, v, v)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> T {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self::new(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Squared length.
    #[inline(always)]
    pub fn length2(self) -> T {
        self.dot(self)
    }

    /// Length.
    #[inline(always)]
    pub fn length(self) -> T {
        self.length2().sqrt()
    }

    /// The vector scaled to unit length; not finite for the zero vector.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        self * (T::ONE / self.length())
    }

    /// The vector scaled to unit length, or `None` where that has no meaning (zero, infinite, NaN).
    #[inline]
    pub fn try_normalized(self) -> Option<Self> {
        // Scale first, so that neither the square of a tiny nor of a huge component is lost.
        let m = self.abs().max_component();
        if !(m > T::ZERO && m.is_finite()) {
            return None;
        }
        let s = self / m;
        Some(s / s.length())
    }

    /// Componentwise absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Componentwise minimum.
    #[inline(always)]
    pub fn min(self, b: Self) -> Self {
        Self::new(self.x.min(b.x), self.y.min(b.y), self.z.min(b.z))
    }

    /// Componentwise maximum.
    #[inline(always)]
    pub fn max(self, b: Self) -> Self {
        Self::new(self.x.max(b.x), self.y.max(b.y), self.z.max(b.z))
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_component(self) -> T {
        self.x.max(self.y).max(self.z)
    }

    /// Componentwise product.
    #[inline(always)]
    pub fn scale_by(self, b: Self) -> Self {
        Self::new(self.x * b.x, self.y * b.y, self.z * b.z)
    }

    /// Whether all components are finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The same vector in another precision.
    #[inline(always)]
    pub fn cast<U: Float>(self) -> Vec3<U> {
        Vec3::new(U::from_f64(self.x.to_f64()), U::from_f64(self.y.to_f64()), U::from_f64(self.z.to_f64()))
    }

    /// The components as an array.
    #[inline(always)]
    pub fn to_array(self) -> [T; 3] {
        [self.x, self.y, self.z]
    }
}

impl<T> From<[T; 3]> for Vec3<T> {
    #[inline(always)]
    fn from([x, y, z]: [T; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T> Index<usize> for Vec3<T> {
    type Output = T;
    /// Component 0, 1 or 2.
    #[inline(always)]
    fn index(&self, i: usize) -> &T {
        match i {
            0 => &self.x,
            1 => &self.y,
            _ => {
                debug_assert!(i == 2, "a Vec3 has components 0, 1 and 2");
                &self.z
            }
        }
    }
}

impl<T: Float> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<T: Float> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Float> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<T: Float> SubAssign for Vec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Float> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl<T: Float> MulAssign<T> for Vec3<T> {
    #[inline(always)]
    fn mul_assign(&mut self, s: T) {
        *self = *self * s;
    }
}

impl<T: Float> Div<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, s: T) -> Self {
        Self::new(self.x / s, self.y / s, self.z / s)
    }
}

impl<T: Float> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

/// A 3×3 matrix, held by rows and applied to column vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<T = f64> {
    /// The three rows.
    pub rows: [Vec3<T>; 3],
}

impl<T: Float> Mat3<T> {
    /// The identity.
    pub const IDENTITY: Self = Self {
        rows: [
            Vec3::new(T::ONE, T::ZERO, T::ZERO),
            Vec3::new(T::ZERO, T::ONE, T::ZERO),
            Vec3::new(T::ZERO, T::ZERO, T::ONE),
        ],
    };

    /// From nine numbers in row-major order.
    pub fn from_rows(m: [T; 9]) -> Self {
        Self { rows: [Vec3::new(m[0], m[1], m[2]), Vec3::new(m[3], m[4], m[5]), Vec3::new(m[6], m[7], m[8])] }
    }

    /// A uniform scaling.
    pub fn scaling(s: T) -> Self {
        Self {
            rows: [
                Vec3::new(s, T::ZERO, T::ZERO),
                Vec3::new(T::ZERO, s, T::ZERO),
                Vec3::new(T::ZERO, T::ZERO, s),
            ],
        }
    }

    /// The transposed matrix.
    pub fn transposed(&self) -> Self {
        let [a, b, c] = self.rows;
        Self { rows: [Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z)] }
    }

    /// The determinant: the signed factor by which volumes grow.
    pub fn determinant(&self) -> T {
        self.rows[0].dot(self.rows[1].cross(self.rows[2]))
    }

    /// The inverse, or `None` where the matrix is singular or not finite.
    pub fn inverse(&self) -> Option<Self> {
        let [a, b, c] = self.rows;
        let (r0, r1, r2) = (b.cross(c), c.cross(a), a.cross(b));
        let det = a.dot(r0);
        if !(det.abs() > T::ZERO && det.is_finite()) {
            return None;
        }
        // The cross products are the columns of the adjugate.
        let inverse = Self { rows: [r0 / det, r1 / det, r2 / det] }.transposed();
        inverse.rows.iter().all(|r| r.is_finite()).then_some(inverse)
    }
}

impl<T: Float> Mul<Vec3<T>> for Mat3<T> {
    type Output = Vec3<T>;
    #[inline(always)]
    fn mul(self, v: Vec3<T>) -> Vec3<T> {
        Vec3::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }
}

impl<T: Float> Mul for Mat3<T> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let columns = b.transposed();
        Self {
            rows: self
                .rows
                .map(|r| Vec3::new(r.dot(columns.rows[0]), r.dot(columns.rows[1]), r.dot(columns.rows[2]))),
        }
    }
}
