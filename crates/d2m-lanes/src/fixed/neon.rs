//! aarch64 with NEON.
use core::arch::aarch64::{
    float64x2_t, uint64x2_t, vabsq_f64, vaddq_f64, vandq_u64, vbslq_f64, vcgtq_f64, vcleq_f64, vcltq_f64,
    vcopyq_laneq_f64, vdivq_f64, vdupq_laneq_f64, vdupq_n_f64, vdupq_n_u64, veorq_u64, vextq_f64,
    vgetq_lane_f64, vgetq_lane_u64, vmulq_f64, vnegq_f64, vreinterpretq_f64_s64, vreinterpretq_f64_u64,
    vreinterpretq_s64_f64, vreinterpretq_u64_f64, vshlq_n_s64, vshlq_n_u64, vshrq_n_s64, vsqrtq_f64,
    vsubq_f64,
};

/// An intrinsic of the vector unit that this module is compiled for.
macro_rules! neon {
    ($call:expr) => {{
        // SAFETY: the module is compiled only with `target_feature = "neon"`; no memory is touched.
        #[allow(unused_unsafe)]
        unsafe {
            $call
        }
    }};
}

/// Two doubles. Comparisons with NaN are false; `max(a, b)` is `if a > b { a } else { b }`.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x2(float64x2_t);

operators!(F64x2:
    Add add |a, b| Self(neon!(vaddq_f64(a.0, b.0))),
    Sub sub |a, b| Self(neon!(vsubq_f64(a.0, b.0))),
    Mul mul |a, b| Self(neon!(vmulq_f64(a.0, b.0))),
    Div div |a, b| Self(neon!(vdivq_f64(a.0, b.0)));
    |a| Self(neon!(vnegq_f64(a.0))));

impl F64x2 {
    #[inline(always)]
    pub const fn new(first: f64, second: f64) -> Self {
        // SAFETY: `[f64; 2]` and `float64x2_t` have the same size and every bit pattern is valid in both.
        Self(unsafe { core::mem::transmute::<[f64; 2], float64x2_t>([first, second]) })
    }
    /// As [`Self::new`], for values known at run time only.
    #[inline(always)]
    pub fn pack(first: f64, second: f64) -> Self {
        Self::new(first, second)
    }
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self(neon!(vdupq_n_f64(x)))
    }
    #[inline(always)]
    pub const fn to_array(self) -> [f64; 2] {
        // SAFETY: as in `new`.
        unsafe { core::mem::transmute::<float64x2_t, [f64; 2]>(self.0) }
    }
    #[inline(always)]
    fn bits(self) -> uint64x2_t {
        neon!(vreinterpretq_u64_f64(self.0))
    }
    #[inline(always)]
    fn from_bits(bits: uint64x2_t) -> Self {
        Self(neon!(vreinterpretq_f64_u64(bits)))
    }
    #[inline(always)]
    pub fn first(self) -> f64 {
        neon!(vgetq_lane_f64::<0>(self.0))
    }
    #[inline(always)]
    pub fn second(self) -> f64 {
        neon!(vgetq_lane_f64::<1>(self.0))
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(neon!(vsqrtq_f64(self.0)))
    }
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        // Not `fmax`: it treats NaN and signed zeros in another way than the other back ends.
        Self(neon!(vbslq_f64(vcgtq_f64(self.0, o.0), self.0, o.0)))
    }
    /// `if a < b { a } else { b }`.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        Self(neon!(vbslq_f64(vcltq_f64(self.0, o.0), self.0, o.0)))
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(neon!(vabsq_f64(self.0)))
    }
    /// Negates the first number.
    #[inline(always)]
    pub fn neg_first(self) -> Self {
        Self::from_bits(neon!(veorq_u64(self.bits(), Self::new(-0.0, 0.0).bits())))
    }
    #[inline(always)]
    pub fn swap(self) -> Self {
        Self(neon!(vextq_f64::<1>(self.0, self.0)))
    }
    #[inline(always)]
    pub fn both_first(self) -> Self {
        Self(neon!(vdupq_laneq_f64::<0>(self.0)))
    }
    #[inline(always)]
    pub fn both_second(self) -> Self {
        Self(neon!(vdupq_laneq_f64::<1>(self.0)))
    }
    /// The first number of `self` and the second of `o`.
    #[inline(always)]
    pub fn first_and_second(self, o: Self) -> Self {
        Self(neon!(vcopyq_laneq_f64::<1, 1>(self.0, o.0)))
    }
    /// Mask: all bits where `self < o`.
    #[inline(always)]
    pub fn lt(self, o: Self) -> Self {
        Self::from_bits(neon!(vcltq_f64(self.0, o.0)))
    }
    /// Mask: all bits where `self <= o`.
    #[inline(always)]
    pub fn le(self, o: Self) -> Self {
        Self::from_bits(neon!(vcleq_f64(self.0, o.0)))
    }
    #[inline(always)]
    pub fn and(self, o: Self) -> Self {
        Self::from_bits(neon!(vandq_u64(self.bits(), o.bits())))
    }
    #[inline(always)]
    pub fn xor(self, o: Self) -> Self {
        Self::from_bits(neon!(veorq_u64(self.bits(), o.bits())))
    }
    /// `yes` where the mask `self` is set, else `no`.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        Self(neon!(vbslq_f64(self.bits(), yes.0, no.0)))
    }
    /// Mask: all bits where bit 0 of the number's representation is set.
    #[inline(always)]
    pub fn lowest_bit(self) -> Self {
        let top = neon!(vshlq_n_s64::<63>(vreinterpretq_s64_f64(self.0)));
        Self(neon!(vreinterpretq_f64_s64(vshrq_n_s64::<63>(top))))
    }
    /// The sign bit where bit 1 of the number's representation is set, else 0.
    #[inline(always)]
    pub fn second_bit_as_sign(self) -> Self {
        Self::from_bits(neon!(vandq_u64(vshlq_n_u64::<62>(self.bits()), vdupq_n_u64(1 << 63))))
    }
    /// The sign bits, first number in bit 0; of a mask, whether it is set.
    #[inline(always)]
    pub fn sign_bits(self) -> u32 {
        let bits = self.bits();
        let (first, second) = (neon!(vgetq_lane_u64::<0>(bits)), neon!(vgetq_lane_u64::<1>(bits)));
        (first >> 63) as u32 | ((second >> 63) as u32) << 1
    }
}
