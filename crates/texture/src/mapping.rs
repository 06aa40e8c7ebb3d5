//! Texture coordinates, transformed before a map is read.

use indigo_math::{Float, Real, Vec2};

/// An affine map of texture coordinates: `(m00 u + m01 v + t0, m10 u + m11 v + t1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapping {
    /// Row after row.
    pub matrix: [Real; 4],
    /// Added then.
    pub translation: [Real; 2],
}

impl Mapping {
    /// Changes nothing.
    pub const IDENTITY: Self = Self { matrix: [1.0, 0.0, 0.0, 1.0], translation: [0.0; 2] };

    /// Where the map is read for coordinates of the mesh.
    #[inline]
    pub fn of<T: Float>(&self, uv: Vec2<T>) -> Vec2<T> {
        let [a, b, c, d] = self.matrix.map(|v| T::from_f64(v.to_f64()));
        let [x, y] = self.translation.map(|v| T::from_f64(v.to_f64()));
        Vec2::new(a * uv.x + b * uv.y + x, c * uv.x + d * uv.y + y)
    }

    /// How what changes by `slope` along the coordinates of the map changes along those of the mesh.
    #[inline]
    pub(crate) fn slope(&self, [x, y]: [Real; 2]) -> [Real; 2] {
        let [a, b, c, d] = self.matrix;
        [a * x + c * y, b * x + d * y]
    }
}
