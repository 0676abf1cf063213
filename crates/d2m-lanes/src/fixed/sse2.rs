//! x86-64: SSE2 is part of the base instruction set.
use core::arch::x86_64::{
    __m128d, _mm_add_pd, _mm_and_pd, _mm_andnot_pd, _mm_castpd_si128, _mm_castsi128_pd, _mm_cmple_pd,
    _mm_cmplt_pd, _mm_cvtsd_f64, _mm_div_pd, _mm_max_pd, _mm_min_pd, _mm_movemask_pd, _mm_mul_pd, _mm_or_pd,
    _mm_set_pd, _mm_set1_pd, _mm_shuffle_epi32, _mm_shuffle_pd, _mm_slli_epi64, _mm_sqrt_pd, _mm_srai_epi32,
    _mm_sub_pd, _mm_unpackhi_pd, _mm_unpacklo_pd, _mm_xor_pd,
};

/// An intrinsic of the vector unit that this module is compiled for.
macro_rules! sse2 {
    ($call:expr) => {{
        // SAFETY: SSE2 is part of the x86-64 base instruction set; no memory is touched.
        #[allow(unused_unsafe)]
        unsafe {
            $call
        }
    }};
}

/// Two doubles. Comparisons with NaN are false; `max(a, b)` is `if a > b { a } else { b }`.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x2(__m128d);

operators!(F64x2:
    Add add |a, b| Self(sse2!(_mm_add_pd(a.0, b.0))),
    Sub sub |a, b| Self(sse2!(_mm_sub_pd(a.0, b.0))),
    Mul mul |a, b| Self(sse2!(_mm_mul_pd(a.0, b.0))),
    Div div |a, b| Self(sse2!(_mm_div_pd(a.0, b.0)));
    |a| Self(sse2!(_mm_xor_pd(_mm_set1_pd(-0.0), a.0))));

impl F64x2 {
    #[inline(always)]
    pub const fn new(first: f64, second: f64) -> Self {
        // SAFETY: `[f64; 2]` and `__m128d` have the same size and every bit pattern is valid in both.
        Self(unsafe { core::mem::transmute::<[f64; 2], __m128d>([first, second]) })
    }
    /// As [`Self::new`], for values known at run time only.
    #[inline(always)]
    pub fn pack(first: f64, second: f64) -> Self {
        Self(sse2!(_mm_set_pd(second, first)))
    }
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self(sse2!(_mm_set1_pd(x)))
    }
    #[inline(always)]
    pub const fn to_array(self) -> [f64; 2] {
        // SAFETY: as in `new`.
        unsafe { core::mem::transmute::<__m128d, [f64; 2]>(self.0) }
    }
    #[inline(always)]
    pub fn first(self) -> f64 {
        sse2!(_mm_cvtsd_f64(self.0))
    }
    #[inline(always)]
    pub fn second(self) -> f64 {
        sse2!(_mm_cvtsd_f64(_mm_unpackhi_pd(self.0, self.0)))
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(sse2!(_mm_sqrt_pd(self.0)))
    }
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        Self(sse2!(_mm_max_pd(self.0, o.0)))
    }
    /// `if a < b { a } else { b }`.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        Self(sse2!(_mm_min_pd(self.0, o.0)))
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(sse2!(_mm_andnot_pd(_mm_set1_pd(-0.0), self.0)))
    }
    /// Negates the first number.
    #[inline(always)]
    pub fn neg_first(self) -> Self {
        Self(sse2!(_mm_xor_pd(_mm_set_pd(0.0, -0.0), self.0)))
    }
    #[inline(always)]
    pub fn swap(self) -> Self {
        Self(sse2!(_mm_shuffle_pd::<1>(self.0, self.0)))
    }
    #[inline(always)]
    pub fn both_first(self) -> Self {
        Self(sse2!(_mm_unpacklo_pd(self.0, self.0)))
    }
    #[inline(always)]
    pub fn both_second(self) -> Self {
        Self(sse2!(_mm_unpackhi_pd(self.0, self.0)))
    }
    /// The first number of `self` and the second of `o`.
    #[inline(always)]
    pub fn first_and_second(self, o: Self) -> Self {
        Self(sse2!(_mm_shuffle_pd::<2>(self.0, o.0)))
    }
    /// Mask: all bits where `self < o`.
    #[inline(always)]
    pub fn lt(self, o: Self) -> Self {
        Self(sse2!(_mm_cmplt_pd(self.0, o.0)))
    }
    /// Mask: all bits where `self <= o`.
    #[inline(always)]
    pub fn le(self, o: Self) -> Self {
        Self(sse2!(_mm_cmple_pd(self.0, o.0)))
    }
    #[inline(always)]
    pub fn and(self, o: Self) -> Self {
        Self(sse2!(_mm_and_pd(self.0, o.0)))
    }
    #[inline(always)]
    pub fn xor(self, o: Self) -> Self {
        Self(sse2!(_mm_xor_pd(self.0, o.0)))
    }
    /// `yes` where the mask `self` is set, else `no`.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        Self(sse2!(_mm_or_pd(_mm_and_pd(self.0, yes.0), _mm_andnot_pd(self.0, no.0))))
    }
    /// Mask: all bits where bit 0 of the number's representation is set.
    #[inline(always)]
    pub fn lowest_bit(self) -> Self {
        let top = sse2!(_mm_srai_epi32::<31>(_mm_slli_epi64::<63>(_mm_castpd_si128(self.0))));
        Self(sse2!(_mm_castsi128_pd(_mm_shuffle_epi32::<0b11_11_01_01>(top))))
    }
    /// The sign bit where bit 1 of the number's representation is set, else 0.
    #[inline(always)]
    pub fn second_bit_as_sign(self) -> Self {
        let moved = sse2!(_mm_castsi128_pd(_mm_slli_epi64::<62>(_mm_castpd_si128(self.0))));
        Self(sse2!(_mm_and_pd(moved, _mm_set1_pd(-0.0))))
    }
    /// The sign bits, first number in bit 0; of a mask, whether it is set.
    #[inline(always)]
    pub fn sign_bits(self) -> u32 {
        sse2!(_mm_movemask_pd(self.0)) as u32
    }
}
