//! Sine, cosine, tangent.
//!
//! Both ends of an interval travel through one vector: reduction by n·π/2 (three-part Cody–Waite), two Taylor
//! polynomials, quadrant by bit masks. Extrema inside come from the quadrant numbers of the two ends.
use super::{enclose, reduce::Reduced};
use crate::Interval;
use d2m_lanes::{F64x2, Vector, power_of_two};

// π/2 in three parts: 33 bits, 33 bits, the rest. n·P1 and n·P2 are exact for |n| < 2²⁰.
const P1: f64 = f64::from_bits(0x3FF9_21FB_5440_0000);
const P2: f64 = f64::from_bits(0x3DD0_B461_1A60_0000);
const P3: f64 = f64::from_bits(0x3BA3_198A_2E03_7073);
/// 1.5·2⁵²: adding it rounds to the nearest integer, whose low bits are then the low bits of the double.
pub(super) const MAGIC: f64 = 6_755_399_441_055_744.0;
/// Beyond, the slow path reduces with as many digits of π as it takes.
pub(super) const FAST_LIMIT: f64 = 524_288.0;
/// 2⁻⁴⁵: a reduced argument below this share of the argument has lost too many digits.
pub(super) const CANCELLED: f64 = power_of_two(-45);
/// (15/8)·2⁻⁵³: kernel error (0.73 units of 2⁻⁵³), final rounding (1 unit), and a margin.
pub(super) const PAD: f64 = f64::from_bits(0x3CAE_0000_0000_0000);
/// 2⁻¹⁰⁰⁰, for underflow.
pub(super) const PAD_TINY: f64 = power_of_two(-1000);
/// 2⁻³⁰: an end this near to an extremum counts as having it inside (the value there is 1 − 2⁻⁶¹).
pub(super) const NEAR: f64 = power_of_two(-30);

const fn inverse_factorial(n: u64) -> f64 {
    let (mut product, mut i) = (1u64, 2);
    while i <= n {
        product *= i;
        i += 1;
    }
    1.0 / product as f64
}

#[inline(always)]
fn constant<V: Vector>(n: u64) -> V {
    V::splat(inverse_factorial(n))
}

/// A number without its multiples of π/2.
#[derive(Clone, Copy)]
pub(super) struct Turned<V> {
    /// x·2/π + 1.5·2⁵²: the nearest multiple of π/2 in the low bits.
    pub(super) turns: V,
    /// The rest is the sum of this and `r_low`.
    pub(super) r: V,
    pub(super) r_low: V,
}

/// Sine and cosine, each as an unevaluated sum of a high and a low part.
pub(super) struct SineCosine<V> {
    pub(super) sin: [V; 2],
    pub(super) cos: [V; 2],
}

/// Takes the nearest multiple of π/2 off.
#[inline(always)]
pub(super) fn reduce<V: Vector>(x: V) -> Turned<V> {
    let turns = x * V::splat(core::f64::consts::FRAC_2_PI) + V::splat(MAGIC);
    let n = turns - V::splat(MAGIC);
    let w = x - n * V::splat(P1);
    let t = n * V::splat(P2);
    let r1 = w - t;
    let b = r1 - w;
    let e = w - (r1 - b) - (t + b);
    let low = e - n * V::splat(P3);
    let r = r1 + low;
    Turned { turns, r, r_low: low - (r - r1) }
}

/// Sine and cosine of `r + r_low` for |r| ≤ π/4 + 2⁻³⁰.
#[inline(always)]
pub(super) fn kernel<V: Vector>(r: V, r_low: V) -> SineCosine<V> {
    let z = r * r;
    let z2 = z * z;
    let z4 = z2 * z2;
    // sin r = r − r z (1/3! − z (1/5! − z/7! + z² (…)))
    let a = constant::<V>(5) - z * constant::<V>(7);
    let b = constant::<V>(9) - z * constant::<V>(11);
    let c = constant::<V>(13) - z * constant::<V>(15) + z2 * constant::<V>(17);
    let p = constant::<V>(3) - z * (a + z2 * b + z4 * c);
    let half_z = z * V::splat(0.5);
    let one = V::splat(1.0);
    let c0 = one - half_z;
    let sin_tail = r_low * c0 - r * (z * p);
    let sin = r + sin_tail;
    let sin_low = sin_tail - (sin - r);
    // cos r = 1 − z/2 + z² (1/4! − z (1/6! − z/8! + z² (…)))
    let a = constant::<V>(6) - z * constant::<V>(8);
    let b = constant::<V>(10) - z * constant::<V>(12);
    let c = constant::<V>(14) - z * constant::<V>(16);
    let q = constant::<V>(4) - z * (a + z2 * b + z4 * c);
    let cos_tail = one - c0 - half_z + (z2 * q - r * r_low);
    let cos = c0 + cos_tail;
    let cos_low = cos_tail - (cos - c0);
    SineCosine { sin: [sin, sin_low], cos: [cos, cos_low] }
}

/// (−min, max) over two numbers, each known as high + low within the kernel's error.
#[inline(always)]
fn outer(high: F64x2, low: F64x2) -> F64x2 {
    let size = high.abs();
    let pad = size * F64x2::splat(PAD);
    let pad = pad + F64x2::splat(0.0).lt(size).and(F64x2::splat(PAD_TINY));
    // Upper bounds of (−first, second) and (−second, first).
    let (h, l) = (high.neg_first(), low.neg_first());
    let straight = h + (l + pad);
    let (h, l) = (high.swap().neg_first(), low.swap().neg_first());
    let crossed = h + (l + pad.swap());
    straight.max(crossed).min(F64x2::splat(1.0))
}

/// Which extrema to add, as (−min, max): 1 where the extremum is inside.
#[inline(always)]
fn extrema(min_inside: u32, max_inside: u32) -> F64x2 {
    const TABLE: [F64x2; 4] =
        [F64x2::new(-2.0, -2.0), F64x2::new(1.0, -2.0), F64x2::new(-2.0, 1.0), F64x2::new(1.0, 1.0)];
    TABLE[((min_inside & 1) | (max_inside & 1) << 1) as usize]
}

/// Bit j is set when a multiple `m π/2` with `m ≡ j (mod 4)` has first ≤ m ≤ last.
#[inline(always)]
pub(super) fn residues(first: i32, last: i32) -> u32 {
    let count = (last - first + 1).clamp(0, 4);
    let run = ((1u32 << count) - 1) << (first & 3);
    run | run >> 4
}

impl Interval {
    /// `(sin x, cos x)`: about the cost of one of them.
    ///
    /// Within 4 units in the last place of the tightest enclosure, for arguments of any size.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let (sin, cos) = Interval::new(1.0, 2.0).sin_cos();
    /// assert_eq!(sin.hi(), 1.0); // π/2 is inside
    /// assert!(sin.contains(1.5_f64.sin()) && cos.contains(1.5_f64.cos()));
    /// ```
    #[inline]
    pub fn sin_cos(self) -> (Self, Self) {
        let x = self.0.neg_first();
        let Turned { turns, r, r_low } = reduce(x);
        let size = x.abs();
        let in_range = size.lt(F64x2::splat(FAST_LIMIT));
        let kept = (size * F64x2::splat(CANCELLED)).le(r.abs());
        // The empty set is (+∞, −∞) here, and not in range.
        if in_range.and(kept).sign_bits() != 3 {
            return self.sin_cos_slow();
        }
        let SineCosine { sin: [s, s_low], cos: [c, c_low] } = kernel(r, r_low);
        let odd = turns.lowest_bit();
        let sign = turns.second_bit_as_sign();
        let sin = odd.select(c, s).xor(sign);
        let sin_low = odd.select(c_low, s_low).xor(sign);
        let sign = sign.xor(odd.and(F64x2::splat(-0.0)));
        let cos = odd.select(s, c).xor(sign);
        let cos_low = odd.select(s_low, c_low).xor(sign);
        let quadrant = |turns: f64| turns.to_bits() as i32;
        let first = quadrant(turns.first()) + i32::from(r.first() > NEAR);
        let last = quadrant(turns.second()) - i32::from(r.second() < -NEAR);
        let inside = residues(first, last);
        (
            Self(outer(sin, sin_low).max(extrema(inside >> 3, inside >> 1))),
            Self(outer(cos, cos_low).max(extrema(inside >> 2, inside))),
        )
    }

    #[cold]
    #[inline(never)]
    fn sin_cos_slow(self) -> (Self, Self) {
        if self.is_empty() {
            return (self, self);
        }
        let all = Self::SIGNED_UNIT;
        if !self.is_bounded() || self.hi() - self.lo() >= 6.25 {
            return (all, all);
        }
        let (a, b) = (Reduced::new(self.lo()), Reduced::new(self.hi()));
        let inside = a.multiples_to(&b, self);
        let hull = |(u, v): (f64, f64), (s, t): (f64, f64)| {
            Self::raw(if u < s { u } else { s }, if v > t { v } else { t }).intersection(all)
        };
        let (sin, cos) = (hull(a.sin(), b.sin()), hull(a.cos(), b.cos()));
        let with = |x: Self, min: u32, max: u32| {
            Self::raw(if min & 1 == 1 { -1.0 } else { x.lo() }, if max & 1 == 1 { 1.0 } else { x.hi() })
        };
        (with(sin, inside >> 3, inside >> 1), with(cos, inside >> 2, inside))
    }

    /// `sin x`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let s = Interval::point(1e22).sin();
    /// assert!(s.contains(-0.852_200_849_767_188_8) && s.width() < 1e-15);
    /// ```
    #[inline]
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// `cos x`.
    #[inline]
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// `tan x`; entire when an odd multiple of π/2 is inside.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::new(-1.0, 1.0).tan().contains(1.0_f64.tan()));
    /// assert!(Interval::new(1.0, 2.0).tan().is_entire());
    /// ```
    pub fn tan(self) -> Self {
        if self.is_empty() {
            return self;
        }
        if !self.is_bounded() || self.hi() - self.lo() >= 3.15 {
            return Self::ENTIRE;
        }
        let (a, b) = (Reduced::new(self.lo()), Reduced::new(self.hi()));
        if a.multiples_to(&b, self) & 0b1010 != 0 {
            return Self::ENTIRE;
        }
        let lo = if self.lo() == 0.0 { 0.0 } else { enclose(a.tan()).0 };
        let hi = if self.hi() == 0.0 { 0.0 } else { enclose(b.tan()).1 };
        Self::from_ends(lo, hi)
    }
}
