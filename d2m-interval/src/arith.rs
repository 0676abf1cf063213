use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::{
    Interval,
    round::{down, up},
};

/// Product of end points: 0·∞ is 0.
#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

#[inline(always)]
fn max4(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let m = if a > b { a } else { b };
    let n = if c > d { c } else { d };
    if m > n { m } else { n }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::raw(-self.hi(), -self.lo())
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(down(self.lo() + o.lo()), up(self.hi() + o.hi()))
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Self::EMPTY;
        }
        let (a, b, c, d) = (
            times(self.lo(), o.lo()),
            times(self.lo(), o.hi()),
            times(self.hi(), o.lo()),
            times(self.hi(), o.hi()),
        );
        Self::raw(down(-max4(-a, -b, -c, -d)), up(max4(a, b, c, d)))
    }
}

impl Div for Interval {
    type Output = Self;
    /// Hull of the quotients with non-zero divisors; empty when the divisor is `[0, 0]`.
    #[inline]
    fn div(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() || (o.lo() == 0.0 && o.hi() == 0.0) {
            return Self::EMPTY;
        }
        if self.lo() == 0.0 && self.hi() == 0.0 {
            return Self::ZERO;
        }
        if o.lo() < 0.0 && o.hi() > 0.0 {
            return Self::ENTIRE;
        }
        // The divisor keeps one sign; make it positive.
        let (n, d) = if o.hi() <= 0.0 { (-self, -o) } else { (self, o) };
        let lo = if n.lo() >= 0.0 {
            if d.hi() == f64::INFINITY { 0.0 } else { down(n.lo() / d.hi()) }
        } else if d.lo() == 0.0 || n.lo() == f64::NEG_INFINITY {
            f64::NEG_INFINITY
        } else {
            down(n.lo() / d.lo())
        };
        let hi = if n.hi() <= 0.0 {
            if d.hi() == f64::INFINITY { 0.0 } else { up(n.hi() / d.hi()) }
        } else if d.lo() == 0.0 || n.hi() == f64::INFINITY {
            f64::INFINITY
        } else {
            up(n.hi() / d.lo())
        };
        Self::from_ends(lo, hi)
    }
}

macro_rules! mixed {
    ($($op:ident $f:ident $opa:ident $fa:ident),*) => {$(
        impl $op<f64> for Interval {
            type Output = Self;
            #[inline]
            fn $f(self, o: f64) -> Self { $op::$f(self, Self::point(o)) }
        }
        impl $op<Interval> for f64 {
            type Output = Interval;
            #[inline]
            fn $f(self, o: Interval) -> Interval { $op::$f(Interval::point(self), o) }
        }
        impl $opa for Interval {
            #[inline]
            fn $fa(&mut self, o: Self) { *self = $op::$f(*self, o); }
        }
        impl $opa<f64> for Interval {
            #[inline]
            fn $fa(&mut self, o: f64) { *self = $op::$f(*self, Self::point(o)); }
        }
    )*};
}
mixed!(Add add AddAssign add_assign, Sub sub SubAssign sub_assign, Mul mul MulAssign mul_assign, Div div DivAssign div_assign);

impl core::iter::Sum for Interval {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, |a, b| a + b)
    }
}

impl Interval {
    /// `1/x`.
    #[inline]
    pub fn recip(self) -> Self {
        Self::ONE / self
    }

    /// `x²`; never below zero.
    #[inline]
    pub fn sqr(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let (mig, mag) = (self.mig(), self.mag());
        let lo = down(mig * mig);
        Self::raw(if lo > 0.0 { lo } else { 0.0 }, up(mag * mag))
    }

    /// `√x` over the part of the interval that is not negative; empty when there is none.
    #[inline]
    pub fn sqrt(self) -> Self {
        if self.is_empty() || self.hi() < 0.0 {
            return Self::EMPTY;
        }
        let lo = if self.lo() > 0.0 { down(self.lo().sqrt()) } else { 0.0 };
        let hi = if self.hi() == 0.0 { 0.0 } else { up(self.hi().sqrt()) };
        Self::raw(if lo > 0.0 { lo } else { 0.0 }, hi)
    }

    /// `|x|`.
    #[inline]
    pub fn abs(self) -> Self {
        if self.is_empty() { self } else { Self::raw(self.mig(), self.mag()) }
    }

    /// `min(x, y)`, element by element.
    #[inline]
    pub fn min(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(
            if self.lo() < o.lo() { self.lo() } else { o.lo() },
            if self.hi() < o.hi() { self.hi() } else { o.hi() },
        )
    }

    /// `max(x, y)`, element by element.
    #[inline]
    pub fn max(self, o: Self) -> Self {
        -((-self).min(-o))
    }

    /// `xⁿ`.
    pub fn powi(self, n: i32) -> Self {
        if self.is_empty() {
            return self;
        }
        if n < 0 {
            return self.powi_unsigned(n.unsigned_abs()).recip();
        }
        self.powi_unsigned(n.unsigned_abs())
    }

    fn powi_unsigned(self, n: u32) -> Self {
        match n {
            0 => Self::ONE,
            1 => self,
            _ if n.is_multiple_of(2) => self.powi_unsigned(n / 2).sqr(),
            _ => {
                let point = |x: f64| Self::raw(x, x) * Self::raw(x, x).powi_unsigned(n - 1);
                if self.lo() == f64::NEG_INFINITY || self.hi() == f64::INFINITY {
                    return self * self.powi_unsigned(n - 1);
                }
                point(self.lo()).hull(point(self.hi()))
            }
        }
    }
}
