//! Four intervals at once.
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::{
    Interval,
    round::{HALF_ULP, TINY},
};
use d2m_lanes::F64x4;

/// Four independent intervals, in two 256-bit vectors (with AVX; pairs of 128-bit vectors elsewhere).
///
/// Each lane has the bits that [`Interval`] would give, in every operation.
///
/// ```
/// use d2m_interval::{Interval, IntervalX4};
/// let x = IntervalX4::new([1.0, 2.0, 3.0, 4.0].map(Interval::point));
/// let y = x * x + IntervalX4::splat(Interval::ONE);
/// assert!(y.lane(3).contains(17.0));
/// ```
#[derive(Clone, Copy)]
pub struct IntervalX4 {
    pub(crate) neg_lo: F64x4,
    pub(crate) hi: F64x4,
}

/// Increment for one rounding, or for the stated share of the sizes.
#[inline(always)]
pub(crate) fn pad(size: F64x4, share: f64) -> F64x4 {
    size * F64x4::splat(share) + F64x4::splat(TINY)
}

#[inline(always)]
pub(crate) fn finite(e: F64x4, f: F64x4) -> bool {
    let infinity = F64x4::splat(f64::INFINITY);
    e.lt_bits(infinity) & f.lt_bits(infinity) == 15
}

impl IntervalX4 {
    /// From four intervals.
    #[inline]
    pub fn new(lanes: [Interval; 4]) -> Self {
        Self { neg_lo: F64x4::new(lanes.map(|x| -x.lo())), hi: F64x4::new(lanes.map(Interval::hi)) }
    }

    /// The same interval four times.
    #[inline(always)]
    pub fn splat(x: Interval) -> Self {
        Self { neg_lo: F64x4::splat(-x.lo()), hi: F64x4::splat(x.hi()) }
    }

    /// The four numbers as intervals; entire where a number is not finite.
    #[inline]
    pub fn points(x: [f64; 4]) -> Self {
        Self::new(x.map(Interval::point))
    }

    /// The four intervals.
    #[inline]
    pub fn lanes(self) -> [Interval; 4] {
        let (a, b) = (self.neg_lo.to_array(), self.hi.to_array());
        core::array::from_fn(|i| Interval::raw(-a[i], b[i]))
    }

    /// One of the four.
    ///
    /// # Panics
    /// When `i > 3`.
    #[inline]
    pub fn lane(self, i: usize) -> Interval {
        Interval::raw(-self.neg_lo.to_array()[i], self.hi.to_array()[i])
    }

    /// Bit i is set when lane i holds zero ("cannot exclude").
    #[inline(always)]
    pub fn contains_zero(self) -> u32 {
        let zero = F64x4::splat(0.0);
        zero.le_bits(self.neg_lo) & zero.le_bits(self.hi)
    }

    /// Bit i is set when every element of lane i is known to be positive.
    #[inline(always)]
    pub fn certainly_positive(self) -> u32 {
        self.neg_lo.lt_bits(F64x4::splat(0.0))
    }

    /// The smallest intervals that hold both.
    #[inline(always)]
    pub fn hull(self, o: Self) -> Self {
        Self { neg_lo: self.neg_lo.max(o.neg_lo), hi: self.hi.max(o.hi) }
    }

    /// `largest` is the maximum of the operands of products.
    #[inline(always)]
    pub(crate) fn rounded(
        self,
        sizes: Self,
        share: f64,
        largest: F64x4,
        slow: impl FnOnce() -> Self,
    ) -> Self {
        let (e, f) = (pad(sizes.neg_lo, share), pad(sizes.hi, share));
        if finite(largest.max(e), f) { Self { neg_lo: self.neg_lo + e, hi: self.hi + f } } else { slow() }
    }

    #[inline(always)]
    pub(crate) fn largest(self) -> F64x4 {
        self.neg_lo.max(self.hi)
    }

    #[inline(always)]
    pub(crate) fn size(self) -> Self {
        Self { neg_lo: self.neg_lo.abs(), hi: self.hi.abs() }
    }

    #[inline(always)]
    pub(crate) fn sum(self, o: Self) -> Self {
        Self { neg_lo: self.neg_lo + o.neg_lo, hi: self.hi + o.hi }
    }

    /// Products of the ends, not yet rounded up.
    #[inline(always)]
    pub(crate) fn products(self, o: Self) -> Self {
        let (a, b, c, d) = (self.neg_lo, self.hi, o.neg_lo, o.hi);
        let (minus_c, minus_d) = (-c, -d);
        Self {
            neg_lo: (a * d).max(a * minus_c).max((b * minus_d).max(b * c)),
            hi: (a * c).max(a * minus_d).max((b * minus_c).max(b * d)),
        }
    }

    fn each(self, o: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        let (x, y) = (self.lanes(), o.lanes());
        Self::new(core::array::from_fn(|i| f(x[i], y[i])))
    }

    #[cold]
    #[inline(never)]
    fn add_slow(self, o: Self) -> Self {
        self.each(o, |x, y| x + y)
    }

    #[cold]
    #[inline(never)]
    fn mul_slow(self, o: Self) -> Self {
        self.each(o, |x, y| x * y)
    }

    /// `x²`; never below zero.
    #[inline(always)]
    pub fn sqr(self) -> Self {
        let zero = F64x4::splat(0.0);
        let least = (-self.neg_lo).max(-self.hi).max(zero);
        let greatest = self.neg_lo.max(self.hi);
        let (l, g) = (least * least, greatest * greatest);
        let (e, f) = (pad(l, HALF_ULP), pad(g, HALF_ULP));
        if finite(e, f) {
            Self { neg_lo: (-l + e).min(zero), hi: g + f }
        } else {
            Self::new(self.lanes().map(Interval::sqr))
        }
    }

    /// `√x` over the parts that are not negative.
    #[inline]
    pub fn sqrt(self) -> Self {
        let zero = F64x4::splat(0.0);
        if zero.le_bits(self.hi) != 15 || self.hi.lt_bits(F64x4::splat(f64::INFINITY)) != 15 {
            return Self::new(self.lanes().map(Interval::sqrt));
        }
        let (l, g) = (zero.max(-self.neg_lo).sqrt(), zero.max(self.hi).sqrt());
        Self { neg_lo: (-l + pad(l, HALF_ULP)).min(zero), hi: g + pad(g, HALF_ULP) }
    }
}

impl core::fmt::Debug for IntervalX4 {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.lanes().fmt(f)
    }
}

impl Neg for IntervalX4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { neg_lo: self.hi, hi: self.neg_lo }
    }
}

impl Add for IntervalX4 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let x = self.sum(o);
        x.rounded(x.size(), HALF_ULP, F64x4::splat(0.0), || self.add_slow(o))
    }
}

impl Sub for IntervalX4 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for IntervalX4 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let x = self.products(o);
        x.rounded(x.size(), HALF_ULP, self.largest().max(o.largest()), || self.mul_slow(o))
    }
}

impl Div for IntervalX4 {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        self.each(o, |x, y| x / y)
    }
}
