//! What 512-bit registers add to the lanes in AVX registers.
#![allow(unsafe_code)]

use super::avx::{Avx, AvxDoubles, FIRST, Registers};
use super::register::register;
use super::two::{Bytes, Elementwise, Two};
#[allow(clippy::wildcard_imports)]
use core::arch::x86_64::*;
use core::ops::{Add, Mul, Sub};

/// Registers of 512 bits: AVX-512 F, BW and DQ.
#[derive(Clone, Copy)]
pub(super) struct Of512;

impl Registers for Of512 {
    type Sixteen = Sixteen;
    type Eight = Eight;
}

/// Sixteen `f32` in one register. Values exist only inside functions that were entered through a check for AVX-512 F,
/// BW and DQ.
#[derive(Clone, Copy)]
pub(super) struct Sixteen(__m512);

/// Eight `f64` in one register. Values exist only where those of [`Sixteen`] do.
#[derive(Clone, Copy)]
pub(super) struct Eight(__m512d);

/// Two halves of 256 bits.
macro_rules! halves {
    ($type:ident, $register:ty, $half:ident: $whole:ident $insert:ident $twice:ident $low:ident $high:ident) => {
        impl $type {
            #[inline(always)]
            const fn wrap(register: $register) -> Self {
                Self(register)
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
                $half::wrap(unsafe { $low(self.0) })
            }
            #[inline(always)]
            fn second(self) -> $half<Of512> {
                // SAFETY: the processor has AVX-512 (see the type).
                $half::wrap(unsafe { $high::<1>(self.0) })
            }
        }
    };
}

register!([] Sixteen, f32:
    _mm512_add_ps _mm512_sub_ps _mm512_mul_ps _mm512_set1_ps _mm512_max_ps _mm512_min_ps _mm512_xor_ps _mm512_and_ps,
    |x| _mm512_abs_ps(x),
    |left, right, yes, no| _mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_GT_OQ>(left, right), no, yes));
halves!(Sixteen, __m512, Avx: _mm512_castps256_ps512 _mm512_insertf32x8 _mm512_broadcast_f32x8 _mm512_castps512_ps256
    _mm512_extractf32x8_ps);
register!([] Eight, f64:
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_set1_pd _mm512_max_pd _mm512_min_pd _mm512_xor_pd _mm512_and_pd,
    |x| _mm512_abs_pd(x),
    |left, right, yes, no| _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(left, right), no, yes));
halves!(Eight, __m512d, AvxDoubles: _mm512_castpd256_pd512 _mm512_insertf64x4 _mm512_broadcast_f64x4
    _mm512_castpd512_pd256 _mm512_extractf64x4_pd);

impl Bytes for Sixteen {
    #[inline(always)]
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self {
        // SAFETY: the processor has AVX-512 (see the type).
        unsafe {
            // The place of the byte, of which each sign is a bit.
            let first = _mm512_broadcast_i32x4(_mm_set_epi32(FIRST[3], FIRST[2], FIRST[1], FIRST[0]));
            let flip = _mm512_srai_epi32::<31>(_mm512_castps_si512(flip.0));
            let flipped = _mm512_xor_si512(first, _mm512_and_si512(flip, _mm512_set1_epi32(3)));
            let x = _mm512_srai_epi32::<31>(_mm512_castps_si512(x.0));
            let of_x = _mm512_xor_si512(flipped, _mm512_and_si512(x, _mm512_set1_epi32(1)));
            let y = _mm512_srai_epi32::<31>(_mm512_castps_si512(y.0));
            let place = _mm512_xor_si512(of_x, _mm512_and_si512(y, _mm512_set1_epi32(2)));
            Self(_mm512_cvtepi32_ps(_mm512_shuffle_epi8(_mm512_castps_si512(self.0), place)))
        }
    }
}
