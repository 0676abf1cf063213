//! What 512-bit registers add to the lanes in AVX registers.
#![allow(unsafe_code)]

use super::avx::{Avx, AvxDoubles, Registers};
use super::two::{Elementwise, Two};
#[allow(clippy::wildcard_imports)]
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Sub};

/// Registers of 512 bits: AVX-512 F and DQ.
#[derive(Clone, Copy)]
pub(crate) struct Of512;

impl Registers for Of512 {
    type Sixteen = Sixteen;
    type Eight = Eight;
}

/// Sixteen `f32` in one register. Values exist only inside functions that were entered through a check for AVX-512 F
/// and DQ.
#[derive(Clone, Copy)]
pub(crate) struct Sixteen(__m512);

/// Eight `f64` in one register. Values exist only where those of [`Sixteen`] do.
#[derive(Clone, Copy)]
pub(crate) struct Eight(__m512d);

macro_rules! operator {
    ($($type:ident: $operator:ident $method:ident $intrinsic:ident),*) => {$(
        impl $operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
operator!(Sixteen: Add add _mm512_add_ps, Sixteen: Sub sub _mm512_sub_ps, Sixteen: Mul mul _mm512_mul_ps);
operator!(Eight: Add add _mm512_add_pd, Eight: Sub sub _mm512_sub_pd, Eight: Mul mul _mm512_mul_pd);

impl Elementwise for Sixteen {
    type Scalar = f32;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_set1_ps(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_xor_ps(magnitude.0, _mm512_and_ps(sign.0, _mm512_set1_ps(-0.0))) })
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_GT_OQ>(left.0, right.0), no.0, yes.0) })
    }
}

impl Two<Avx<Of512>> for Sixteen {
    #[inline(always)]
    fn of(first: Avx<Of512>, second: Avx<Of512>) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_insertf32x8::<1>(_mm512_castps256_ps512(first.0), second.0) })
    }
    #[inline(always)]
    fn both(half: Avx<Of512>) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_broadcast_f32x8(half.0) })
    }
    #[inline(always)]
    fn first(self) -> Avx<Of512> {
        // SAFETY: the processor has AVX-512 (see the type).
        Avx::of(unsafe { _mm512_castps512_ps256(self.0) })
    }
    #[inline(always)]
    fn second(self) -> Avx<Of512> {
        // SAFETY: the processor has AVX-512 (see the type).
        Avx::of(unsafe { _mm512_extractf32x8_ps::<1>(self.0) })
    }
}

impl Elementwise for Eight {
    type Scalar = f64;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_xor_pd(magnitude.0, _mm512_and_pd(sign.0, _mm512_set1_pd(-0.0))) })
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(left.0, right.0), no.0, yes.0) })
    }
}

impl Two<AvxDoubles<Of512>> for Eight {
    #[inline(always)]
    fn of(first: AvxDoubles<Of512>, second: AvxDoubles<Of512>) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(first.0), second.0) })
    }
    #[inline(always)]
    fn both(half: AvxDoubles<Of512>) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        Self(unsafe { _mm512_broadcast_f64x4(half.0) })
    }
    #[inline(always)]
    fn first(self) -> AvxDoubles<Of512> {
        // SAFETY: the processor has AVX-512 (see the type).
        AvxDoubles::of(unsafe { _mm512_castpd512_pd256(self.0) })
    }
    #[inline(always)]
    fn second(self) -> AvxDoubles<Of512> {
        // SAFETY: the processor has AVX-512 (see the type).
        AvxDoubles::of(unsafe { _mm512_extractf64x4_pd::<1>(self.0) })
    }
}
