//! Affine transforms that know how points, vectors and normals move.

use crate::{Float, Mat3, Vec3, Vec3d};

/// An invertible affine map `p ↦ linear · p + translation`, in double precision, with its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    linear: Mat3<f64>,
    inverse_linear: Mat3<f64>,
    translation: Vec3d,
}

impl Transform {
    /// The transform that moves nothing.
    pub const IDENTITY: Self =
        Self { linear: Mat3::IDENTITY, inverse_linear: Mat3::IDENTITY, translation: Vec3::ZERO };

    /// From a linear part and a translation; `None` where the linear part cannot be inverted.
    pub fn new(linear: Mat3<f64>, translation: Vec3d) -> Option<Self> {
        let inverse_linear = linear.inverse()?;
        translation.is_finite().then_some(Self { linear, inverse_linear, translation })
    }

    /// A pure translation.
    pub fn translation(by: Vec3d) -> Self {
        Self { translation: by, ..Self::IDENTITY }
    }

    /// The linear part.
    pub fn linear(&self) -> Mat3<f64> {
        self.linear
    }

    /// The image of the origin.
    pub fn origin(&self) -> Vec3d {
        self.translation
    }

    /// The same transform followed by a translation.
    #[must_use]
    pub fn then_translate(&self, by: Vec3d) -> Self {
        Self { translation: self.translation + by, ..*self }
    }

    /// Moves a point.
    #[inline]
    pub fn point<T: Float>(&self, p: Vec3<T>) -> Vec3<T> {
        (self.linear * p.cast::<f64>() + self.translation).cast()
    }

    /// Moves a direction or displacement.
    #[inline]
    pub fn vector<T: Float>(&self, v: Vec3<T>) -> Vec3<T> {
        (self.linear * v.cast::<f64>()).cast()
    }

    /// Moves a surface normal (by the inverse transpose); the result is not normalised.
    ///
    /// Under a reflection the result keeps the side that the surface's front had.
    #[inline]
    pub fn normal<T: Float>(&self, n: Vec3<T>) -> Vec3<T> {
        (self.inverse_linear.transposed() * n.cast::<f64>()).cast()
    }

    /// Moves a point of the image back.
    #[inline]
    pub fn inverse_point<T: Float>(&self, p: Vec3<T>) -> Vec3<T> {
        (self.inverse_linear * (p.cast::<f64>() - self.translation)).cast()
    }

    /// Moves a direction of the image back.
    #[inline]
    pub fn inverse_vector<T: Float>(&self, v: Vec3<T>) -> Vec3<T> {
        (self.inverse_linear * v.cast::<f64>()).cast()
    }

    /// The inverse of the linear part.
    pub fn inverse_linear(&self) -> Mat3<f64> {
        self.inverse_linear
    }

    /// Whether the transform turns right-handed into left-handed.
    pub fn is_reflection(&self) -> bool {
        self.linear.determinant() < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number() -> impl Strategy<Value = f64> {
        -10.0..10.0
    }

    proptest! {
        #[test]
        fn inverse_undoes_point_and_vector(m in proptest::array::uniform9(number()), t in proptest::array::uniform3(number()), p in proptest::array::uniform3(number())) {
            let linear = Mat3::from_rows(m);
            prop_assume!(linear.determinant().abs() > 1.0);
            let x = Transform::new(linear, t.into()).unwrap();
            let p = Vec3d::from(p);
            prop_assert!((x.inverse_point(x.point(p)) - p).length() < 1e-7);
            prop_assert!((x.inverse_vector(x.vector(p)) - p).length() < 1e-7);
        }

        #[test]
        fn a_normal_stays_perpendicular_to_its_surface(m in proptest::array::uniform9(number()), a in proptest::array::uniform3(number()), b in proptest::array::uniform3(number())) {
            let linear = Mat3::from_rows(m);
            prop_assume!(linear.determinant().abs() > 1.0);
            let x = Transform::new(linear, Vec3::ZERO).unwrap();
            let (a, b) = (Vec3d::from(a), Vec3d::from(b));
            let n = x.normal(a.cross(b));
            prop_assert!(n.dot(x.vector(a)).abs() < 1e-8 * (1.0 + n.length() * x.vector(a).length()));
            prop_assert!(n.dot(x.vector(b)).abs() < 1e-8 * (1.0 + n.length() * x.vector(b).length()));
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        assert!(
            Transform::new(Mat3::from_rows([1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 0.0, 0.0, 1.0]), Vec3::ZERO)
                .is_none()
        );
        assert!(Transform::new(Mat3::scaling(f64::NAN), Vec3::ZERO).is_none());
    }
}
