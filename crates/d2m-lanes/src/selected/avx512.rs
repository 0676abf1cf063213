//! What 512-bit registers add to the lanes in AVX registers.
#![allow(unsafe_code)]

use super::avx::{Avx, AvxDoubles, Registers};
use super::two::{Bytes, Elementwise, Two};
#[allow(clippy::wildcard_imports)]
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Sub};

/// Registers of 512 bits: AVX-512 F and DQ.
#[derive(Clone, Copy)]
pub(super) struct Of512;

impl Registers for Of512 {
    type Sixteen = Sixteen;
    type Eight = Eight;
}

/// Sixteen `f32` in one register. Values exist only inside functions that were entered through a check for AVX-512 F
/// and DQ.
#[derive(Clone, Copy)]
pub(super) struct Sixteen(__m512);

/// Eight `f64` in one register. Values exist only where those of [`Sixteen`] do.
#[derive(Clone, Copy)]
pub(super) struct Eight(__m512d);

/// The operations of one kind of register: both kinds have the same ones, under other names.
macro_rules! register {
    (
        $type:ident of $scalar:ty, two times $half:ident:
        $add:ident $sub:ident $mul:ident $splat:ident $abs:ident $max:ident $min:ident
        $xor:ident $and:ident $greater:ident $blend:ident
        $whole:ident $insert:ident $twice:ident $low:ident $high:ident
    ) => {
        register!($type: Add add $add, Sub sub $sub, Mul mul $mul);

        impl Elementwise for $type {
            type Scalar = $scalar;

            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $splat(value) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $abs(self.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $max(self.0, other.0) })
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $min(self.0, other.0) })
            }
            #[inline(always)]
            fn flip_sign(magnitude: Self, sign: Self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $xor(magnitude.0, $and(sign.0, $splat(-0.0))) })
            }
            #[inline(always)]
            fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $blend($greater::<_CMP_GT_OQ>(left.0, right.0), no.0, yes.0) })
            }
        }

        impl Two<$half<Of512>> for $type {
            #[inline(always)]
            fn of(first: $half<Of512>, second: $half<Of512>) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $insert::<1>($whole(first.0), second.0) })
            }
            #[inline(always)]
            fn both(half: $half<Of512>) -> Self {
                // SAFETY: the processor has AVX-512 (see the type).
                Self(unsafe { $twice(half.0) })
            }
            #[inline(always)]
            fn first(self) -> $half<Of512> {
                // SAFETY: the processor has AVX-512 (see the type).
                $half::of(unsafe { $low(self.0) })
            }
            #[inline(always)]
            fn second(self) -> $half<Of512> {
                // SAFETY: the processor has AVX-512 (see the type).
                $half::of(unsafe { $high::<1>(self.0) })
            }
        }
    };
    ($type:ident: $($operator:ident $method:ident $intrinsic:ident),*) => {$(
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

register!(Sixteen of f32, two times Avx:
    _mm512_add_ps _mm512_sub_ps _mm512_mul_ps _mm512_set1_ps _mm512_abs_ps _mm512_max_ps _mm512_min_ps
    _mm512_xor_ps _mm512_and_ps _mm512_cmp_ps_mask _mm512_mask_blend_ps
    _mm512_castps256_ps512 _mm512_insertf32x8 _mm512_broadcast_f32x8 _mm512_castps512_ps256 _mm512_extractf32x8_ps);
register!(Eight of f64, two times AvxDoubles:
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_set1_pd _mm512_abs_pd _mm512_max_pd _mm512_min_pd
    _mm512_xor_pd _mm512_and_pd _mm512_cmp_pd_mask _mm512_mask_blend_pd
    _mm512_castpd256_pd512 _mm512_insertf64x4 _mm512_broadcast_f64x4 _mm512_castpd512_pd256 _mm512_extractf64x4_pd);

impl Bytes for Sixteen {
    #[inline(always)]
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        unsafe {
            let x_is_negative = _mm512_movepi32_mask(_mm512_castps_si512(_mm512_xor_ps(x.0, flip.0)));
            let y_is_negative = _mm512_movepi32_mask(_mm512_castps_si512(_mm512_xor_ps(y.0, flip.0)));
            let four = _mm512_castps_si512(self.0);
            let two = _mm512_mask_srli_epi32::<8>(four, x_is_negative, four);
            let one = _mm512_mask_srli_epi32::<16>(two, y_is_negative, two);
            Self(_mm512_cvtepi32_ps(_mm512_and_si512(one, _mm512_set1_epi32(255))))
        }
    }
}
