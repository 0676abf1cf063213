//! wasm32 with simd128.
use core::arch::wasm32::{
    f64x2, f64x2_abs, f64x2_add, f64x2_div, f64x2_extract_lane, f64x2_le, f64x2_lt, f64x2_mul, f64x2_neg,
    f64x2_pmax, f64x2_pmin, f64x2_splat, f64x2_sqrt, f64x2_sub, i64x2_bitmask, i64x2_shl, i64x2_shr,
    i64x2_shuffle, u64x2_splat, v128, v128_and, v128_bitselect, v128_xor,
};

/// Two doubles. Comparisons with NaN are false; `max(a, b)` is `if a > b { a } else { b }`.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x2(v128);

operators!(F64x2:
    Add add |a, b| Self(f64x2_add(a.0, b.0)),
    Sub sub |a, b| Self(f64x2_sub(a.0, b.0)),
    Mul mul |a, b| Self(f64x2_mul(a.0, b.0)),
    Div div |a, b| Self(f64x2_div(a.0, b.0));
    |a| Self(f64x2_neg(a.0)));

impl F64x2 {
    #[inline(always)]
    pub const fn new(first: f64, second: f64) -> Self {
        Self(f64x2(first, second))
    }
    /// As [`Self::new`], for values known at run time only.
    #[inline(always)]
    pub fn pack(first: f64, second: f64) -> Self {
        Self(f64x2(first, second))
    }
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self(f64x2_splat(x))
    }
    #[inline(always)]
    pub const fn to_array(self) -> [f64; 2] {
        // SAFETY: `[f64; 2]` and `v128` have the same size and every bit pattern is valid in both.
        unsafe { core::mem::transmute::<v128, [f64; 2]>(self.0) }
    }
    #[inline(always)]
    pub fn first(self) -> f64 {
        f64x2_extract_lane::<0>(self.0)
    }
    #[inline(always)]
    pub fn second(self) -> f64 {
        f64x2_extract_lane::<1>(self.0)
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(f64x2_sqrt(self.0))
    }
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        // pmax(a, b) is `if a < b { b } else { a }`.
        Self(f64x2_pmax(o.0, self.0))
    }
    /// `if a < b { a } else { b }`.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        // pmin(a, b) is `if b < a { b } else { a }`.
        Self(f64x2_pmin(o.0, self.0))
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(f64x2_abs(self.0))
    }
    /// Negates the first number.
    #[inline(always)]
    pub fn neg_first(self) -> Self {
        Self(v128_xor(self.0, f64x2(-0.0, 0.0)))
    }
    #[inline(always)]
    pub fn swap(self) -> Self {
        Self(i64x2_shuffle::<1, 0>(self.0, self.0))
    }
    #[inline(always)]
    pub fn both_first(self) -> Self {
        Self(i64x2_shuffle::<0, 0>(self.0, self.0))
    }
    #[inline(always)]
    pub fn both_second(self) -> Self {
        Self(i64x2_shuffle::<1, 1>(self.0, self.0))
    }
    /// The first number of `self` and the second of `o`.
    #[inline(always)]
    pub fn first_and_second(self, o: Self) -> Self {
        Self(i64x2_shuffle::<0, 3>(self.0, o.0))
    }
    /// Mask: all bits where `self < o`.
    #[inline(always)]
    pub fn lt(self, o: Self) -> Self {
        Self(f64x2_lt(self.0, o.0))
    }
    /// Mask: all bits where `self <= o`.
    #[inline(always)]
    pub fn le(self, o: Self) -> Self {
        Self(f64x2_le(self.0, o.0))
    }
    #[inline(always)]
    pub fn and(self, o: Self) -> Self {
        Self(v128_and(self.0, o.0))
    }
    #[inline(always)]
    pub fn xor(self, o: Self) -> Self {
        Self(v128_xor(self.0, o.0))
    }
    /// `yes` where the mask `self` is set, else `no`.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        Self(v128_bitselect(yes.0, no.0, self.0))
    }
    /// Mask: all bits where bit 0 of the number's representation is set.
    #[inline(always)]
    pub fn lowest_bit(self) -> Self {
        Self(i64x2_shr(i64x2_shl(self.0, 63), 63))
    }
    /// The sign bit where bit 1 of the number's representation is set, else 0.
    #[inline(always)]
    pub fn second_bit_as_sign(self) -> Self {
        Self(v128_and(i64x2_shl(self.0, 62), u64x2_splat(1 << 63)))
    }
    /// The sign bits, first number in bit 0; of a mask, whether it is set.
    #[inline(always)]
    pub fn sign_bits(self) -> u32 {
        i64x2_bitmask(self.0) as u32
    }
}
