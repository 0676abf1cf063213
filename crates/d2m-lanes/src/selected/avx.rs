//! The lanes in AVX registers; the functions that may use them are entered through a check of the processor (`dispatch`).
#![allow(unsafe_code)]

use super::eight::{Keys, Lanes, Rows, SingleSide, WideSide};
use super::quad::{Doubles, Quad};
use super::register::register;
use super::two::{Both, Bytes, Elementwise, Two};
#[allow(clippy::wildcard_imports)]
use core::arch::x86_64::*;
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Sub};

/// Which registers there are besides those of 256 bits.
pub(super) trait Registers: Copy {
    /// Two times eight lanes.
    type Sixteen: Two<Avx<Self>> + Bytes;
    /// Two times four doubles.
    type Eight: Two<AvxDoubles<Self>>;
}

/// Registers of 256 bits only.
#[derive(Clone, Copy)]
pub(super) struct Of256;

impl Registers for Of256 {
    type Sixteen = Both<Avx<Self>>;
    type Eight = Both<AvxDoubles<Self>>;
}

/// One 256-bit register. Values exist only inside functions that were entered through a check for AVX2, and for what
/// `R` needs.
#[derive(Clone, Copy)]
pub(super) struct Avx<R>(pub(super) __m256, PhantomData<R>);

impl<R> Avx<R> {
    #[inline(always)]
    pub(super) const fn wrap(register: __m256) -> Self {
        Self(register, PhantomData)
    }
}

/// Numbers of the lanes whose bits are set, in their order: byte k of entry `bits` is the k-th.
const ORDER: [u64; 256] = {
    let mut order = [0; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut place) = (0, 0);
        while lane < 8 {
            if bits >> lane & 1 == 1 {
                order[bits] |= lane << (8 * place);
                place += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    order
};

/// Places of bytes in 16 of them: the first one of each four, and three that are zero.
pub(super) const FIRST: [i32; 4] = {
    let zeros = i32::from_le_bytes([0, 0x80, 0x80, 0x80]);
    [zeros, zeros + 4, zeros + 8, zeros + 12]
};

register!([<R: Registers>] Avx<R>, f32:
    _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_set1_ps _mm256_max_ps _mm256_min_ps _mm256_xor_ps _mm256_and_ps,
    |x| _mm256_andnot_ps(_mm256_set1_ps(-0.0), x),
    |left, right, yes, no| _mm256_blendv_ps(no, yes, _mm256_cmp_ps::<_CMP_GT_OQ>(left, right)));
register!([<R: Registers>] Avx<R>: Div div _mm256_div_ps);

impl<R: Registers> Bytes for Avx<R> {
    #[inline(always)]
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self {
        // SAFETY: the processor has AVX2 (see the type).
        unsafe {
            // The place of the byte, of which each sign is a bit.
            let x = _mm256_castps_si256(x.0);
            let y = _mm256_castps_si256(y.0);
            let flip = _mm256_castps_si256(flip.0);
            let first = _mm256_broadcastsi128_si256(_mm_set_epi32(FIRST[3], FIRST[2], FIRST[1], FIRST[0]));
            let flips = _mm256_and_si256(_mm256_srai_epi32::<31>(flip), _mm256_set1_epi32(3));
            let (of_x, of_y) = (_mm256_srli_epi32::<31>(x), _mm256_srli_epi32::<31>(y));
            let flipped = _mm256_xor_si256(_mm256_xor_si256(first, flips), of_x);
            let place = _mm256_xor_si256(flipped, _mm256_add_epi32(of_y, of_y));
            let byte = _mm256_shuffle_epi8(_mm256_castps_si256(self.0), place);
            Self::wrap(_mm256_cvtepi32_ps(byte))
        }
    }
}

impl<R: Registers> Lanes for Avx<R> {
    type Doubles = AvxDoubles<R>;
    type Two = R::Sixteen;

    #[inline(always)]
    fn load(values: &[f32; 8]) -> Self {
        // SAFETY: eight floats are readable; no alignment is needed; AVX as above.
        Self::wrap(unsafe { _mm256_loadu_ps(values.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: eight floats are writable; no alignment is needed; AVX as above.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn narrowed([low, high]: [AvxDoubles<R>; 2]) -> Self {
        // SAFETY: the processor has AVX (see the type).
        Self::wrap(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(high.0), _mm256_cvtpd_ps(low.0)) })
    }
    #[inline(always)]
    fn widened(self) -> [AvxDoubles<R>; 2] {
        // SAFETY: the processor has AVX (see the type).
        unsafe {
            let (low, high) = (_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            [AvxDoubles::wrap(_mm256_cvtps_pd(low)), AvxDoubles::wrap(_mm256_cvtps_pd(high))]
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor has AVX (see the type).
        Self::wrap(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn less_bits(self, other: Self) -> u32 {
        // SAFETY: the processor has AVX (see the type).
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn keys(self, base: i32, least: i32, limit: i32) -> Keys {
        let mut out = [0; 8];
        // SAFETY: the processor has AVX2 (see the type); 32 bytes are writable and need no alignment.
        unsafe {
            let sum = _mm256_add_epi32(_mm256_cvttps_epi32(self.0), _mm256_set1_epi32(base));
            let keys = _mm256_max_epi32(sum, _mm256_set1_epi32(least));
            _mm256_storeu_si256(out.as_mut_ptr().cast(), keys);
            let below = _mm256_cmpgt_epi32(_mm256_set1_epi32(limit), keys);
            Keys { keys: out, below: _mm256_movemask_ps(_mm256_castsi256_ps(below)) as u32 }
        }
    }
    #[inline(always)]
    fn larger(self, wide: WideSide<'_>, single: SingleSide) -> [u32; 8] {
        let mut out = [0; 8];
        // SAFETY: the processor has AVX2 (see the type); 32 bytes are readable and writable, without alignment.
        unsafe {
            let larger = _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_set1_ps(single.size));
            let children = _mm256_loadu_si256(wide.children.as_ptr().cast());
            let larger = _mm256_andnot_si256(_mm256_srai_epi32::<31>(children), _mm256_castps_si256(larger));
            let flagged = _mm256_or_si256(children, _mm256_set1_epi32(wide.flag as i32));
            let other = _mm256_set1_epi32(single.tag as i32);
            let open = _mm256_blendv_epi8(other, flagged, larger);
            _mm256_storeu_si256(out.as_mut_ptr().cast(), open);
        }
        out
    }
    #[inline(always)]
    fn pack(rows: &Rows, list: &mut [[u32; 4]; 8]) -> usize {
        // SAFETY: the processor has AVX2 (see the type). Keys and tags are eight words each, the list is four times 32
        // writable bytes. No alignment is needed.
        unsafe {
            let order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(ORDER[rows.wanted as usize & 255] as i64));
            let counting = _mm256_add_epi32(_mm256_set1_epi32(rows.counting as i32), order);
            let constant = _mm256_set1_epi32(rows.constant as i32);
            let swap = _mm256_set1_epi32(-i32::from(rows.counting_is_third));
            let a = _mm256_blendv_epi8(counting, constant, swap);
            let b = _mm256_blendv_epi8(constant, counting, swap);
            let key = _mm256_permutevar8x32_epi32(_mm256_loadu_si256(rows.keys.as_ptr().cast()), order);
            let tag = _mm256_permutevar8x32_epi32(_mm256_loadu_si256(rows.tags.as_ptr().cast()), order);
            // Rows 0, 1 | 4, 5 and 2, 3 | 6, 7: first and second half; then each row whole.
            let (low, high) = (_mm256_unpacklo_epi32(key, a), _mm256_unpackhi_epi32(key, a));
            let (low_rest, high_rest) = (_mm256_unpacklo_epi32(b, tag), _mm256_unpackhi_epi32(b, tag));
            let (i04, i15) = (_mm256_unpacklo_epi64(low, low_rest), _mm256_unpackhi_epi64(low, low_rest));
            let (i26, i37) = (_mm256_unpacklo_epi64(high, high_rest), _mm256_unpackhi_epi64(high, high_rest));
            let out: *mut __m256i = list.as_mut_ptr().cast();
            _mm256_storeu_si256(out, _mm256_permute2x128_si256::<0x20>(i04, i15));
            _mm256_storeu_si256(out.add(1), _mm256_permute2x128_si256::<0x20>(i26, i37));
            _mm256_storeu_si256(out.add(2), _mm256_permute2x128_si256::<0x31>(i04, i15));
            _mm256_storeu_si256(out.add(3), _mm256_permute2x128_si256::<0x31>(i26, i37));
        }
        rows.wanted.count_ones() as usize
    }
    #[inline(always)]
    fn prefetch<T>(value: &T) {
        let start: *const i8 = core::ptr::from_ref(value).cast();
        for line in 0..size_of::<T>().div_ceil(64) {
            // SAFETY: a prefetch reads nothing that the program sees, and the address is inside the value.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(64 * line)) };
        }
    }
    #[inline(always)]
    fn combine(columns: &[[f32; 4]; 3], x: f32, y: f32, z: f32) -> [f32; 4] {
        let mut out = [0.0; 4];
        // SAFETY: four floats are readable in each column and writable in `out`; no alignment is needed; AVX as above.
        unsafe {
            let column = |k: usize| _mm_loadu_ps(columns[k].as_ptr());
            let xy = _mm_add_ps(_mm_mul_ps(column(0), _mm_set1_ps(x)), _mm_mul_ps(column(1), _mm_set1_ps(y)));
            _mm_storeu_ps(out.as_mut_ptr(), _mm_add_ps(xy, _mm_mul_ps(column(2), _mm_set1_ps(z))));
        }
        out
    }
}

/// Four doubles in one register. Values exist only where those of [`Avx`] do.
#[derive(Clone, Copy)]
pub(super) struct AvxDoubles<R>(pub(super) __m256d, PhantomData<R>);

impl<R> AvxDoubles<R> {
    #[inline(always)]
    pub(super) const fn wrap(register: __m256d) -> Self {
        Self(register, PhantomData)
    }
}

register!([<R: Registers>] AvxDoubles<R>, f64:
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_set1_pd _mm256_max_pd _mm256_min_pd _mm256_xor_pd _mm256_and_pd,
    |x| _mm256_andnot_pd(_mm256_set1_pd(-0.0), x),
    |left, right, yes, no| _mm256_blendv_pd(no, yes, _mm256_cmp_pd::<_CMP_GT_OQ>(left, right)));
register!([<R: Registers>] AvxDoubles<R>: Div div _mm256_div_pd);

impl<R: Registers> Doubles for AvxDoubles<R> {
    type Two = R::Eight;

    #[inline(always)]
    fn load(values: &Quad) -> Self {
        // SAFETY: four doubles are readable, aligned to 32 bytes by the type; AVX as above.
        Self::wrap(unsafe { _mm256_load_pd(values.0.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> Quad {
        let mut out = Quad([0.0; 4]);
        // SAFETY: four doubles are writable, aligned to 32 bytes by the type; AVX as above.
        unsafe { _mm256_store_pd(out.0.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor has AVX (see the type).
        Self::wrap(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn narrow(self) -> [f32; 4] {
        let mut out = [0.0; 4];
        // SAFETY: four floats are writable; no alignment is needed; AVX as above.
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), _mm256_cvtpd_ps(self.0)) };
        out
    }
    #[inline(always)]
    fn min_element(self) -> f64 {
        // SAFETY: the processor has AVX (see the type).
        unsafe {
            let half = _mm_min_pd(_mm256_castpd256_pd128(self.0), _mm256_extractf128_pd::<1>(self.0));
            _mm_cvtsd_f64(_mm_min_sd(half, _mm_unpackhi_pd(half, half)))
        }
    }
    #[inline(always)]
    fn max_element(self) -> f64 {
        // SAFETY: the processor has AVX (see the type).
        unsafe {
            let half = _mm_max_pd(_mm256_castpd256_pd128(self.0), _mm256_extractf128_pd::<1>(self.0));
            _mm_cvtsd_f64(_mm_max_sd(half, _mm_unpackhi_pd(half, half)))
        }
    }
    #[inline(always)]
    fn transposed([a, b, c]: [Self; 3]) -> [Self; 3] {
        // SAFETY: the processor has AVX (see the type).
        unsafe {
            let zero = _mm256_setzero_pd();
            // First and third rows of a, b and of c, 0; then second and fourth.
            let (even_ab, even_c) = (_mm256_unpacklo_pd(a.0, b.0), _mm256_unpacklo_pd(c.0, zero));
            let (odd_ab, odd_c) = (_mm256_unpackhi_pd(a.0, b.0), _mm256_unpackhi_pd(c.0, zero));
            [
                Self::wrap(_mm256_permute2f128_pd::<0x20>(even_ab, even_c)),
                Self::wrap(_mm256_permute2f128_pd::<0x20>(odd_ab, odd_c)),
                Self::wrap(_mm256_permute2f128_pd::<0x31>(even_ab, even_c)),
            ]
        }
    }
}
