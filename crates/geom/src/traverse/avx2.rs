//! Lanes as AVX2 registers.
#![allow(unsafe_code)]

use super::kernel::{self, Lanes, RawHit, Specials, View};
use crate::ray::Ray;
use crate::wide::Child;
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_cmp_ps, _mm256_div_ps, _mm256_loadu_ps,
    _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_set1_ps, _mm256_storeu_ps,
    _mm256_sub_ps,
};

/// Eight floats in a register. Used only inside [`walk`], below a check for AVX2.
#[derive(Clone, Copy)]
struct Register(__m256);

// SAFETY of every block below: the type is private and reached only through `walk`, which runs only
// where `Avx2::is_available` said that the processor has AVX2; everything is inlined into it.
impl Lanes for Register {
    type Scalar = f32;
    #[inline(always)]
    fn splat(v: f32) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_set1_ps(v) })
    }
    #[inline(always)]
    fn load(v: &[f32; 8]) -> Self {
        // SAFETY: AVX2 is there, and the array holds the eight floats that are read.
        Self(unsafe { _mm256_loadu_ps(v.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: AVX2 is there, and the array has room for the eight floats that are written.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_add_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_sub_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_mul_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_div_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_min_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        // SAFETY: AVX2 is there, see above.
        Self(unsafe { _mm256_max_ps(self.0, b.0) })
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        // SAFETY: AVX2 is there, see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, b.0)) as u32 }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        // SAFETY: AVX2 is there, see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, b.0)) as u32 }
    }
}

/// The kernel in AVX2.
pub(crate) struct Avx2;

impl Avx2 {
    /// Whether the processor has what the kernel was compiled for.
    pub(crate) fn is_available() -> bool {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt")
    }
}

impl super::Kernel for Avx2 {
    type Scalar = f32;
    #[inline(always)]
    fn walk<const ANY: bool, S: Specials<f32>>(
        view: View,
        root: Child,
        ray: &Ray,
        hit: &mut RawHit<f32>,
        specials: &S,
    ) -> bool {
        // SAFETY: an `Accel` chooses this kernel only where `is_available` holds.
        unsafe { walk::<ANY, S>(view, root, ray, hit, specials) }
    }
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
#[inline(never)]
fn walk<const ANY: bool, S: Specials<f32>>(
    view: View,
    root: Child,
    ray: &Ray,
    hit: &mut RawHit<f32>,
    specials: &S,
) -> bool {
    kernel::walk::<Register, ANY, S>(view, root, ray, hit, specials)
}
