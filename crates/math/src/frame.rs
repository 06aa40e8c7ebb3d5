//! Orthonormal frames round a normal.

use crate::{Real, Vec3};

/// A right-handed orthonormal frame; `n` is the local z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis.
    pub s: Vec3,
    /// Local y axis.
    pub t: Vec3,
    /// Local z axis.
    pub n: Vec3,
}

impl Frame {
    /// A frame round a unit normal, continuous but on the plane z = 0.
    ///
    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
    #[inline]
    pub fn from_normal(n: Vec3) -> Self {
        let sign = Real::copysign(1.0, n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// World to local.
    #[inline(always)]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.s), v.dot(self.t), v.dot(self.n))
    }

    /// Local to world.
    #[inline(always)]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64) {
            let Some(n) = Vec3::new(x, y, z).try_normalized() else { return Ok(()) };
            let n: Vec3 = n.cast();
            let f = Frame::from_normal(n);
            for (a, b) in [(f.s, f.t), (f.t, f.n), (f.n, f.s)] {
                prop_assert!(a.dot(b).abs() < 1e-6);
                prop_assert!((a.length() - 1.0).abs() < 1e-6);
            }
            prop_assert!((f.s.cross(f.t) - f.n).length() < 1e-6);
            let v: Vec3 = Vec3::new(0.3, -0.7, 0.2);
            prop_assert!((f.to_world(f.to_local(v)) - v).length() < 1e-6);
        }
    }
}
