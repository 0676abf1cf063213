//! Four doubles: one 256-bit vector with AVX, else two 128-bit ones.
#[cfg(all(target_arch = "x86_64", target_feature = "avx", not(miri), not(feature = "scalar")))]
pub use avx::F64x4;
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx", not(miri), not(feature = "scalar"))))]
pub use halves::F64x4;

#[cfg(all(target_arch = "x86_64", target_feature = "avx", not(miri), not(feature = "scalar")))]
mod avx {
    use crate::fixed::F64x2;
    use core::arch::x86_64::{
        __m256d, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_pd, _mm256_and_pd, _mm256_andnot_pd, _mm256_blendv_pd,
        _mm256_cmp_pd, _mm256_div_pd, _mm256_max_pd, _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd,
        _mm256_set1_pd, _mm256_sqrt_pd, _mm256_sub_pd, _mm256_xor_pd,
    };

    /// An intrinsic of the vector unit that this module is compiled for.
    macro_rules! avx {
        ($call:expr) => {{
            // SAFETY: the module is compiled only with `target_feature = "avx"`; no memory is touched.
            #[allow(unused_unsafe)]
            unsafe {
                $call
            }
        }};
    }

    #[derive(Clone, Copy)]
    #[repr(transparent)]
    pub struct F64x4(__m256d);

    operators!(F64x4:
        Add add |a, b| Self(avx!(_mm256_add_pd(a.0, b.0))),
        Sub sub |a, b| Self(avx!(_mm256_sub_pd(a.0, b.0))),
        Mul mul |a, b| Self(avx!(_mm256_mul_pd(a.0, b.0))),
        Div div |a, b| Self(avx!(_mm256_div_pd(a.0, b.0)));
        |a| Self(avx!(_mm256_xor_pd(_mm256_set1_pd(-0.0), a.0))));

    impl F64x4 {
        #[inline(always)]
        pub const fn new(lanes: [f64; 4]) -> Self {
            // SAFETY: `[f64; 4]` and `__m256d` have the same size and every bit pattern is valid in both.
            Self(unsafe { core::mem::transmute::<[f64; 4], __m256d>(lanes) })
        }
        #[inline(always)]
        pub fn splat(x: f64) -> Self {
            Self(avx!(_mm256_set1_pd(x)))
        }
        #[inline(always)]
        pub const fn to_array(self) -> [f64; 4] {
            // SAFETY: as in `new`.
            unsafe { core::mem::transmute::<__m256d, [f64; 4]>(self.0) }
        }
        #[inline(always)]
        pub fn and(self, o: Self) -> Self {
            Self(avx!(_mm256_and_pd(self.0, o.0)))
        }
        #[inline(always)]
        pub fn xor(self, o: Self) -> Self {
            Self(avx!(_mm256_xor_pd(self.0, o.0)))
        }
        /// Mask: all bits where `self < o`.
        #[inline(always)]
        pub fn lt(self, o: Self) -> Self {
            Self(avx!(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, o.0)))
        }
        /// `yes` where the mask `self` is set, else `no`.
        #[inline(always)]
        pub fn select(self, yes: Self, no: Self) -> Self {
            Self(avx!(_mm256_blendv_pd(no.0, yes.0, self.0)))
        }
        /// As the method of two doubles: integer shifts of 256 bits need AVX2.
        #[inline(always)]
        fn by_halves(self, f: impl Fn(F64x2) -> F64x2) -> Self {
            let ([a, b, c, d], pack) = (self.to_array(), F64x2::pack);
            let ([a, b], [c, d]) = (f(pack(a, b)).to_array(), f(pack(c, d)).to_array());
            Self::new([a, b, c, d])
        }
        /// Mask: all bits where bit 0 of the number's representation is set.
        #[inline(always)]
        pub fn lowest_bit(self) -> Self {
            self.by_halves(F64x2::lowest_bit)
        }
        /// The sign bit where bit 1 of the number's representation is set, else 0.
        #[inline(always)]
        pub fn second_bit_as_sign(self) -> Self {
            self.by_halves(F64x2::second_bit_as_sign)
        }
        #[inline(always)]
        pub fn sqrt(self) -> Self {
            Self(avx!(_mm256_sqrt_pd(self.0)))
        }
        #[inline(always)]
        pub fn max(self, o: Self) -> Self {
            Self(avx!(_mm256_max_pd(self.0, o.0)))
        }
        #[inline(always)]
        pub fn min(self, o: Self) -> Self {
            Self(avx!(_mm256_min_pd(self.0, o.0)))
        }
        #[inline(always)]
        pub fn abs(self) -> Self {
            Self(avx!(_mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0)))
        }
        /// Bit i is set where `self < o`.
        #[inline(always)]
        pub fn lt_bits(self, o: Self) -> u32 {
            avx!(_mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, o.0))) as u32
        }
        /// Bit i is set where `self <= o`.
        #[inline(always)]
        pub fn le_bits(self, o: Self) -> u32 {
            avx!(_mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, o.0))) as u32
        }
    }
}

#[cfg(not(all(target_arch = "x86_64", target_feature = "avx", not(miri), not(feature = "scalar"))))]
mod halves {
    use crate::fixed::F64x2;

    #[derive(Clone, Copy)]
    pub struct F64x4(F64x2, F64x2);

    operators!(F64x4:
        Add add |a, b| Self(a.0 + b.0, a.1 + b.1),
        Sub sub |a, b| Self(a.0 - b.0, a.1 - b.1),
        Mul mul |a, b| Self(a.0 * b.0, a.1 * b.1),
        Div div |a, b| Self(a.0 / b.0, a.1 / b.1);
        |a| Self(-a.0, -a.1));

    impl F64x4 {
        #[inline(always)]
        pub const fn new(lanes: [f64; 4]) -> Self {
            Self(F64x2::new(lanes[0], lanes[1]), F64x2::new(lanes[2], lanes[3]))
        }
        #[inline(always)]
        pub fn splat(x: f64) -> Self {
            Self(F64x2::splat(x), F64x2::splat(x))
        }
        #[inline(always)]
        pub const fn to_array(self) -> [f64; 4] {
            let ([a, b], [c, d]) = (self.0.to_array(), self.1.to_array());
            [a, b, c, d]
        }
        #[inline(always)]
        pub fn and(self, o: Self) -> Self {
            Self(self.0.and(o.0), self.1.and(o.1))
        }
        #[inline(always)]
        pub fn xor(self, o: Self) -> Self {
            Self(self.0.xor(o.0), self.1.xor(o.1))
        }
        /// Mask: all bits where `self < o`.
        #[inline(always)]
        pub fn lt(self, o: Self) -> Self {
            Self(self.0.lt(o.0), self.1.lt(o.1))
        }
        /// `yes` where the mask `self` is set, else `no`.
        #[inline(always)]
        pub fn select(self, yes: Self, no: Self) -> Self {
            Self(self.0.select(yes.0, no.0), self.1.select(yes.1, no.1))
        }
        /// Mask: all bits where bit 0 of the number's representation is set.
        #[inline(always)]
        pub fn lowest_bit(self) -> Self {
            Self(self.0.lowest_bit(), self.1.lowest_bit())
        }
        /// The sign bit where bit 1 of the number's representation is set, else 0.
        #[inline(always)]
        pub fn second_bit_as_sign(self) -> Self {
            Self(self.0.second_bit_as_sign(), self.1.second_bit_as_sign())
        }
        #[inline(always)]
        pub fn sqrt(self) -> Self {
            Self(self.0.sqrt(), self.1.sqrt())
        }
        #[inline(always)]
        pub fn max(self, o: Self) -> Self {
            Self(self.0.max(o.0), self.1.max(o.1))
        }
        #[inline(always)]
        pub fn min(self, o: Self) -> Self {
            Self(self.0.min(o.0), self.1.min(o.1))
        }
        #[inline(always)]
        pub fn abs(self) -> Self {
            Self(self.0.abs(), self.1.abs())
        }
        /// Bit i is set where `self < o`.
        #[inline(always)]
        pub fn lt_bits(self, o: Self) -> u32 {
            self.0.lt(o.0).sign_bits() | self.1.lt(o.1).sign_bits() << 2
        }
        /// Bit i is set where `self <= o`.
        #[inline(always)]
        pub fn le_bits(self, o: Self) -> u32 {
            self.0.le(o.0).sign_bits() | self.1.le(o.1).sign_bits() << 2
        }
    }
}
