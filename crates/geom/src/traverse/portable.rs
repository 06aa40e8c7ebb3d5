//! Lanes as plain arrays, for every processor and for the double precision oracle.

use super::kernel::{self, KeyBits, Lanes, RawHit, Specials, View};
use crate::ray::Ray;
use crate::wide::Child;
use indigo_math::Float;
use std::marker::PhantomData;

/// Eight scalars in an array.
#[derive(Clone, Copy)]
struct Array<T>([T; 8]);

impl<T: Float> Array<T> {
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(T, T) -> T) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], b.0[i])))
    }

    #[inline(always)]
    fn mask(self, b: Self, f: impl Fn(T, T) -> bool) -> u32 {
        (0..8).fold(0, |m, i| m | u32::from(f(self.0[i], b.0[i])) << i)
    }
}

impl<T: KeyBits> Lanes for Array<T> {
    type Scalar = T;
    #[inline(always)]
    fn splat(v: T) -> Self {
        Self([v; 8])
    }
    #[inline(always)]
    fn load(v: &[f32; 8]) -> Self {
        Self(v.map(|x| T::from_f64(f64::from(x))))
    }
    #[inline(always)]
    fn to_array(self) -> [T; 8] {
        self.0
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self.zip(b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self.zip(b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self.zip(b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.zip(b, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        self.zip(b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        self.zip(b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        self.mask(b, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        self.mask(b, |a, b| a < b)
    }
}

/// The kernel without intrinsics.
pub(crate) struct Portable<T>(PhantomData<T>);

impl<T: KeyBits> super::Kernel for Portable<T> {
    type Scalar = T;
    #[inline(never)]
    fn walk<const ANY: bool, S: Specials<T>>(
        view: View,
        root: Child,
        ray: &Ray,
        hit: &mut RawHit<T>,
        specials: &S,
    ) -> bool {
        kernel::walk::<Array<T>, ANY, S>(view, root, ray, hit, specials)
    }
}
