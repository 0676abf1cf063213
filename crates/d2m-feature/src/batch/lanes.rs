//! Four `f64` lanes: one AVX register, or a portable array with the same bits.
//!
//! Only + − ×, √, comparison and sign removal, each correctly rounded by IEEE 754, and no fused multiply-add: every
//! implementation returns the same bits. This module holds the only `unsafe` code of the crate.
use core::ops::{Add, Mul, Sub};

/// Four lanes of `f64`.
pub(super) trait Lanes: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same value in each lane.
    fn splat(value: f64) -> Self;
    /// Lanes from memory.
    fn load(values: &[f64; 4]) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Bit i is set when lane i of `self` is greater than lane i of `other` (never when one is NaN).
    fn greater_bits(self, other: Self) -> u32;
}

/// Portable lanes.
#[derive(Clone, Copy)]
pub(super) struct Portable([f64; 4]);

macro_rules! portable_operator {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                let (a, b) = (self.0, o.0);
                Self([a[0] $symbol b[0], a[1] $symbol b[1], a[2] $symbol b[2], a[3] $symbol b[3]])
            }
        }
    )*};
}
portable_operator!(Add add +, Sub sub -, Mul mul *);

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn load(values: &[f64; 4]) -> Self {
        Self(*values)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn greater_bits(self, o: Self) -> u32 {
        let (a, b) = (self.0, o.0);
        u32::from(a[0] > b[0])
            | u32::from(a[1] > b[1]) << 1
            | u32::from(a[2] > b[2]) << 2
            | u32::from(a[3] > b[3]) << 3
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx::Avx;

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod avx {
    use super::Lanes;
    #[allow(clippy::wildcard_imports)]
    use core::arch::x86_64::*;
    use core::ops::{Add, Mul, Sub};

    /// One 256-bit register. Values exist only inside functions that were entered through a check for AVX2.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx(__m256d);

    macro_rules! avx_operator {
        ($($operator:ident $method:ident $intrinsic:ident),*) => {$(
            impl $operator for Avx {
                type Output = Self;
                #[inline(always)]
                fn $method(self, o: Self) -> Self {
                    // SAFETY: the processor has AVX (see the type).
                    Self(unsafe { $intrinsic(self.0, o.0) })
                }
            }
        )*};
    }
    avx_operator!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd);

    impl Lanes for Avx {
        #[inline(always)]
        fn splat(value: f64) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_set1_pd(value) })
        }
        #[inline(always)]
        fn load(values: &[f64; 4]) -> Self {
            // SAFETY: four numbers are readable; no alignment is needed; AVX as above.
            Self(unsafe { _mm256_loadu_pd(values.as_ptr()) })
        }
        #[inline(always)]
        fn abs(self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: the processor has AVX (see the type).
            Self(unsafe { _mm256_sqrt_pd(self.0) })
        }
        #[inline(always)]
        fn greater_bits(self, o: Self) -> u32 {
            // SAFETY: the processor has AVX (see the type).
            unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, o.0)) as u32 }
        }
    }
}
