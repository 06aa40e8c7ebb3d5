//! Walking a ray through a tree.
//!
//! [`kernel`] says what is done, once, over an abstract register of eight lanes; [`portable`] makes
//! lanes of plain arrays, [`avx2`] of AVX2 registers. Both do the same operations in the same order
//! without fused multiply-add, so they give the same hits to the last bit.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod kernel;
mod portable;
mod raw;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
pub(crate) use kernel::{RawHit, Specials, View};
pub(crate) use portable::Portable;

use crate::ray::Ray;
use crate::wide::Child;
use indigo_math::Float;

/// A way to walk: the lanes and the instruction set they need.
pub(crate) trait Kernel {
    /// The scalar that it computes in.
    type Scalar: Float;

    /// Looks for hits below `root` that come before `hit.t`; with `ANY` the first found is enough.
    ///
    /// Returns whether `hit` was changed.
    fn walk<const ANY: bool, S: Specials<Self::Scalar>>(
        view: View,
        root: Child,
        ray: &Ray,
        hit: &mut RawHit<Self::Scalar>,
        specials: &S,
    ) -> bool;
}

/// The specials of a tree that has none.
pub(crate) struct NoSpecials;

impl<T> Specials<T> for NoSpecials {
    const PRESENT: bool = false;
    fn test<const ANY: bool>(&self, _number: u32, _hit: &mut RawHit<T>) -> bool {
        false
    }
}
