//! Eight `f32` lanes: one AVX register, or a portable array with the same bits.
//!
//! Only + − × ÷ √, extrema, comparison and sign removal, each correctly rounded by IEEE 754, and no fused
//! multiply-add: every implementation returns the same bits. This module holds the only `unsafe` code of the crate.

use core::ops::{Add, Div, Mul, Sub};

/// Eight lanes of `f32`.
pub(crate) trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same value in each lane.
    fn splat(value: f32) -> Self;
    /// Lanes from memory.
    fn load(values: &[f32; 8]) -> Self;
    /// Lanes to memory.
    fn store(self) -> [f32; 8];
    /// Absolute value.
    fn abs(self) -> Self;
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Bit i is set when lane i of `self` is less than lane i of `other`.
    fn less_bits(self, other: Self) -> u32;
    /// `if self > other { self } else { other }` in each lane (so `other` when one is NaN).
    fn max(self, other: Self) -> Self;
    /// `if self < other { self } else { other }` in each lane (so `other` when one is NaN).
    fn min(self, other: Self) -> Self;
    /// max(`least`, `base` + the integer part) in each lane, with `least` for what is not a number; and the bits of
    /// the lanes where that is below `limit`. Lanes stay below 2³¹ − `base`.
    fn keys(self, base: i32, least: i32, limit: i32) -> ([i32; 8], u32);
    /// `magnitude` with its sign flipped where `sign` is negative (or −0).
    fn flip_sign(magnitude: Self, sign: Self) -> Self;
}

/// Portable lanes.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Portable([f32; 8]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(f32, f32) -> f32) -> Self {
        let mut out = [0.0; 8];
        for (i, value) in out.iter_mut().enumerate() {
            *value = op(self.0[i], other.0[i]);
        }
        Self(out)
    }
}

macro_rules! portable_operator {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }
    )*};
}
portable_operator!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 8])
    }
    #[inline(always)]
    fn load(values: &[f32; 8]) -> Self {
        Self(*values)
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn less_bits(self, other: Self) -> u32 {
        let mut bits = 0;
        for i in 0..8 {
            bits |= u32::from(self.0[i] < other.0[i]) << i;
        }
        bits
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn keys(self, base: i32, least: i32, limit: i32) -> ([i32; 8], u32) {
        let (mut out, mut bits) = ([0; 8], 0);
        for (lane, (key, x)) in out.iter_mut().zip(self.0).enumerate() {
            let whole = if x.is_nan() { i32::MIN } else { x as i32 };
            *key = base.wrapping_add(whole).max(least);
            bits |= u32::from(*key < limit) << lane;
        }
        (out, bits)
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        magnitude.zip(sign, |m, s| f32::from_bits(m.to_bits() ^ (s.to_bits() & 0x8000_0000)))
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use avx::Avx;

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod avx {
    use super::Lanes;
    #[allow(clippy::wildcard_imports)]
    use core::arch::x86_64::*;
    use core::ops::{Add, Div, Mul, Sub};

    /// One 256-bit register. Values exist only inside functions that were entered through a check for AVX2.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx(__m256);

    macro_rules! avx_operator {
        ($($operator:ident $method:ident $intrinsic:ident),*) => {$(
            impl $operator for Avx {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    // SAFETY: the processor has AVX (see the type).
                    Self(unsafe { $intrinsic(self.0, other.0) })
                }
            }
        )*};
    }
    avx_operator!(Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps, Div div _mm256_div_ps);

    impl Lanes for Avx {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_set1_ps(value) })
        }
        #[inline(always)]
        fn load(values: &[f32; 8]) -> Self {
            // SAFETY: eight floats are readable; no alignment is needed; AVX as above.
            Self(unsafe { _mm256_loadu_ps(values.as_ptr()) })
        }
        #[inline(always)]
        fn store(self) -> [f32; 8] {
            let mut out = [0.0; 8];
            // SAFETY: eight floats are writable; no alignment is needed; AVX as above.
            unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_sqrt_ps(self.0) })
        }
        #[inline(always)]
        fn less_bits(self, other: Self) -> u32 {
            // SAFETY: the processor has AVX (see the type).
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
        }
        #[inline(always)]
        fn abs(self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_max_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_min_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn keys(self, base: i32, least: i32, limit: i32) -> ([i32; 8], u32) {
            let mut out = [0; 8];
            // SAFETY: the processor has AVX2 (see the type); 32 bytes are writable and need no alignment.
            unsafe {
                let sum = _mm256_add_epi32(_mm256_cvttps_epi32(self.0), _mm256_set1_epi32(base));
                let keys = _mm256_max_epi32(sum, _mm256_set1_epi32(least));
                _mm256_storeu_si256(out.as_mut_ptr().cast(), keys);
                let below = _mm256_cmpgt_epi32(_mm256_set1_epi32(limit), keys);
                (out, _mm256_movemask_ps(_mm256_castsi256_ps(below)) as u32)
            }
        }
        #[inline(always)]
        fn flip_sign(magnitude: Self, sign: Self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_xor_ps(magnitude.0, _mm256_and_ps(sign.0, _mm256_set1_ps(-0.0))) })
        }
    }
}
