//! The field operations, square, square root, and what is exact: negation, absolute value, minimum, maximum.
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::{
    Interval,
    round::{HALF_ULP, TINY, down, finite, finite_with, increment, up},
};
use d2m_lanes::{Binary, F64x2, power_of_two, scaled, two_product, two_sum};

/// All products of an element of `a` and one of `b`, each end correctly rounded, for finite ends (callers check
/// by [`finite_with`]).
#[inline(always)]
pub(crate) fn products(a: F64x2, b: F64x2) -> F64x2 {
    let (low, high) = (a.both_first(), a.both_second());
    let crossed = b.swap();
    let p = low * crossed;
    let q = low * -b;
    let r = high * b;
    let s = high * -crossed;
    p.max(q).max(s.max(r))
}

/// The same for one number on the right.
#[inline(always)]
pub(crate) fn products_with(a: F64x2, b: f64) -> F64x2 {
    (a * F64x2::splat(b)).max(a.swap() * F64x2::splat(-b))
}

#[inline(always)]
fn rounded(x: F64x2, slow: impl FnOnce() -> Interval) -> Interval {
    let e = increment(x);
    if finite(e) { Interval(x + e) } else { slow() }
}

/// Product of end points: 0·∞ is 0.
fn end_product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

#[cold]
#[inline(never)]
pub(crate) fn add_slow(a: Interval, b: Interval) -> Interval {
    if a.is_empty() || b.is_empty() {
        return Interval::EMPTY;
    }
    Interval::raw(down(a.lo() + b.lo()), up(a.hi() + b.hi()))
}

#[cold]
#[inline(never)]
pub(crate) fn mul_slow(a: Interval, b: Interval) -> Interval {
    if a.is_empty() || b.is_empty() {
        return Interval::EMPTY;
    }
    if a == Interval::ZERO || b == Interval::ZERO {
        return Interval::ZERO;
    }
    let products = [(a.lo(), b.lo()), (a.lo(), b.hi()), (a.hi(), b.lo()), (a.hi(), b.hi())];
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for (x, y) in products {
        let p = end_product(x, y);
        lo = if p < lo { p } else { lo };
        hi = if p > hi { p } else { hi };
    }
    Interval::raw(down(lo), up(hi))
}

#[cold]
#[inline(never)]
fn div_slow(a: Interval, b: Interval) -> Interval {
    if a.is_empty() || b.is_empty() || b == Interval::ZERO {
        return Interval::EMPTY;
    }
    if a == Interval::ZERO {
        return Interval::ZERO;
    }
    if b.lo() < 0.0 && b.hi() > 0.0 {
        return Interval::ENTIRE;
    }
    // The divisor keeps one sign; make it positive.
    let (n, d) = if b.hi() <= 0.0 { (-a, -b) } else { (a, b) };
    let upper = |n: f64| {
        if n <= 0.0 {
            if n == 0.0 || d.hi() == f64::INFINITY { 0.0 } else { up(n / d.hi()) }
        } else if d.lo() == 0.0 || n == f64::INFINITY {
            f64::INFINITY
        } else {
            up(n / d.lo())
        }
    };
    Interval::raw(-upper(-n.lo()), upper(n.hi()))
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.swap())
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        rounded(self.0 + o.0, || add_slow(self, o))
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let x = products(self.0, o.0);
        let e = increment(x);
        if finite_with(self.0.max(o.0), e) { Self(x + e) } else { mul_slow(self, o) }
    }
}

impl Div for Interval {
    type Output = Self;
    /// Hull of the quotients with non-zero divisors: [`Interval::EMPTY`] when the divisor is `[0, 0]`,
    /// unbounded when it holds zero. See [`Interval::div_pair`] for both pieces.
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let zero = F64x2::splat(0.0);
        let flip = o.0.second() < 0.0;
        let (n, d) = if flip { (self.0.swap(), o.0.swap()) } else { (self.0, o.0) };
        let (smallest, largest) = (-d.both_first(), d.both_second());
        let x = n / n.lt(zero).select(largest, smallest);
        let e = increment(x);
        if finite(e) && d.first() < 0.0 && d.second() > 0.0 { Self(x + e) } else { div_slow(self, o) }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        let x = products_with(self.0, o);
        let e = increment(x);
        if finite_with(self.0, e) { Self(x + e) } else { mul_slow(self, Self::point(o)) }
    }
}

impl Mul<Interval> for f64 {
    type Output = Interval;
    #[inline(always)]
    fn mul(self, o: Interval) -> Interval {
        o * self
    }
}

impl Add<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        rounded(self.0 + Self::point_unchecked(o).0, || add_slow(self, Self::point(o)))
    }
}

impl Add<Interval> for f64 {
    type Output = Interval;
    #[inline(always)]
    fn add(self, o: Interval) -> Interval {
        o + self
    }
}

impl Sub<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: f64) -> Self {
        self + -o
    }
}

impl Sub<Interval> for f64 {
    type Output = Interval;
    #[inline(always)]
    fn sub(self, o: Interval) -> Interval {
        -o + self
    }
}

impl Div<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        self / Self::point(o)
    }
}

impl Div<Interval> for f64 {
    type Output = Interval;
    #[inline(always)]
    fn div(self, o: Interval) -> Interval {
        Interval::point(self) / o
    }
}

macro_rules! assign {
    ($($op:ident $f:ident $by:ident),*) => {$(
        impl $op for Interval {
            #[inline(always)]
            fn $f(&mut self, o: Self) { *self = self.$by(o); }
        }
        impl $op<f64> for Interval {
            #[inline(always)]
            fn $f(&mut self, o: f64) { *self = self.$by(o); }
        }
    )*};
}
assign!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul, DivAssign div_assign div);

impl core::iter::Sum for Interval {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, |a, b| a + b)
    }
}

impl core::iter::Product for Interval {
    fn product<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ONE, |a, b| a * b)
    }
}

/// (mig, mag): the least and the greatest absolute value.
#[inline(always)]
pub(crate) fn magnitudes(a: F64x2) -> F64x2 {
    let minus = -a;
    let least = minus.max(minus.swap()).max(F64x2::splat(0.0));
    least.first_and_second(a.max(a.swap()))
}

impl Interval {
    /// `1/x`, with the conventions of division.
    #[inline]
    pub fn recip(self) -> Self {
        Self::ONE / self
    }

    /// `x²`; never below zero.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let s = Interval::new(-1.0, 3.0).sqr();
    /// assert!(s.lo() == 0.0 && s.contains(9.0) && s.hi() < 9.000_000_1);
    /// ```
    #[inline(always)]
    pub fn sqr(self) -> Self {
        let m = magnitudes(self.0);
        let x = m * m;
        let e = increment(x);
        if finite(e) {
            Self((x.neg_first() + e).min(F64x2::new(0.0, f64::INFINITY)))
        } else {
            self.sqr_slow()
        }
    }

    #[cold]
    #[inline(never)]
    fn sqr_slow(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let (mig, mag) = (self.mig(), self.mag());
        let lo = down(mig * mig);
        Self::raw(if lo > 0.0 { lo } else { 0.0 }, up(mag * mag))
    }

    /// `√x` over the part of the interval that is not negative; empty when there is none.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::new(2.0, 2.0).sqrt().contains(std::f64::consts::SQRT_2));
    /// assert_eq!(Interval::new(-2.0, 0.0).sqrt().lo(), 0.0);
    /// assert!(Interval::new(-2.0, -1.0).sqrt().is_empty());
    /// ```
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let zero = F64x2::splat(0.0);
        let x = self.0.neg_first();
        if x.second() < 0.0 {
            return Self::EMPTY;
        }
        let s = zero.max(x).sqrt();
        let e = s * F64x2::splat(HALF_ULP) + F64x2::splat(TINY);
        // The root of +∞ is +∞, and nothing is to be added.
        let grown = (s.neg_first() + e).min(F64x2::new(0.0, f64::INFINITY));
        if s.first() < f64::INFINITY { Self(grown) } else { Self::EMPTY }
    }

    /// `|x|`.
    #[inline]
    pub fn abs(self) -> Self {
        if self.is_empty() { self } else { Self(magnitudes(self.0).neg_first()) }
    }

    /// `min(x, y)`, element by element.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(Interval::new(0.0, 5.0).min(Interval::new(1.0, 2.0)), Interval::new(0.0, 2.0));
    /// ```
    #[inline]
    pub fn min(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Self::EMPTY;
        }
        Self(self.0.max(o.0).first_and_second(self.0.min(o.0)))
    }

    /// `max(x, y)`, element by element.
    #[inline]
    pub fn max(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Self::EMPTY;
        }
        Self(self.0.min(o.0).first_and_second(self.0.max(o.0)))
    }

    /// `x·y + z`; unlike `x * y + z`, narrow when product and summand nearly cancel.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let x = Interval::point(1.0 + f64::EPSILON);
    /// let y = x.mul_add(x, Interval::point(-1.0 - 2.0 * f64::EPSILON));
    /// assert!(y.contains(f64::EPSILON * f64::EPSILON) && y.lo() > 0.0); // the product's last bit
    /// ```
    pub fn mul_add(self, y: Self, z: Self) -> Self {
        if self.is_empty() || y.is_empty() || z.is_empty() {
            return Self::EMPTY;
        }
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        for (a, b) in [(self.lo(), y.lo()), (self.lo(), y.hi()), (self.hi(), y.lo()), (self.hi(), y.hi())] {
            let (low, high) = (-fused_up(-a, b, -z.lo()), fused_up(a, b, z.hi()));
            lo = if low < lo { low } else { lo };
            hi = if high > hi { high } else { hi };
        }
        Self::raw(lo, hi)
    }
}

/// 2⁹⁹⁰: below it, no step of [`two_product`] or of the sum overflows.
const LARGE: f64 = power_of_two(990);

/// An upper bound of `a·b + c`; for ends, so that 0·∞ is 0 and an infinite `c` stays.
fn fused_up(a: f64, b: f64, c: f64) -> f64 {
    let product = end_product(a, b);
    if c.is_infinite() {
        return c;
    }
    if !(a.abs() < LARGE && b.abs() < LARGE && product.abs() < LARGE && c.abs() < LARGE) {
        return if a.is_infinite() || b.is_infinite() {
            // ±∞, or c alone for 0·∞.
            up(product + c)
        } else {
            fused_up_large(a, b, c)
        };
    }
    let (p, q) = two_product(a, b);
    let (s, e) = two_sum(p, c);
    up(s + (e + q))
}

/// A term below 2⁻⁶⁰⁰ of another one is left out: the result is rounded up by half a last place at least.
const NEGLIGIBLE: i32 = -600;

/// [`fused_up`] for finite operands, with the larger one of product and summand scaled to about 1 by a power of two.
#[cold]
fn fused_up_large(a: f64, b: f64, c: f64) -> f64 {
    let [a, b, c] = [a, b, c].map(Binary::from_f64);
    let (p, q) = two_product(a.mantissa, b.mantissa);
    let of_product = a.exponent + b.exponent;
    let exponent = match (p == 0.0, c.is_zero()) {
        (true, _) => c.exponent,
        (_, true) => of_product,
        _ => of_product.max(c.exponent),
    };
    let scale = |of_term: i32| {
        let shift = of_term - exponent;
        if shift < NEGLIGIBLE { 0.0 } else { power_of_two(shift.min(0)) }
    };
    let (of_product, of_c) = (scale(of_product), scale(c.exponent));
    let (s, e) = two_sum(p * of_product, c.mantissa * of_c);
    let sum = s + (e + q * of_product);
    if sum == 0.0 {
        // Exactly: what cancels in the first sum leaves no error there.
        return up(0.0);
    }
    scaled_up(up(sum), exponent)
}

/// `x·2ⁿ` for |x| ≥ 2⁻⁶⁰⁰ and −300 ≤ n ≤ 2046, so that nothing underflows; ∞ above the doubles and −MAX below.
fn scaled_up(x: f64, n: i32) -> f64 {
    let scaled = scaled(x, n);
    if scaled < -f64::MAX { -f64::MAX } else { scaled }
}
