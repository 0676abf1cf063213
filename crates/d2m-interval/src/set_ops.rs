//! Sets and numbers of an interval: nothing here is rounded, except where stated.
use crate::{
    Interval,
    round::{difference_is_less, difference_up},
};
use d2m_lanes::F64x2;

impl Interval {
    /// Whether this is the empty set.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        -self.0.first() > self.0.second()
    }

    /// Whether this holds all real numbers.
    #[inline]
    pub fn is_entire(self) -> bool {
        self.lo() == f64::NEG_INFINITY && self.hi() == f64::INFINITY
    }

    /// Whether both end points are finite (also for the empty set).
    #[inline]
    pub fn is_bounded(self) -> bool {
        self.0.lt(F64x2::splat(f64::INFINITY)).sign_bits() == 3
    }

    /// Whether this is one number.
    #[inline]
    pub fn is_singleton(self) -> bool {
        self.lo() == self.hi()
    }

    /// Whether the real number `x` lies inside; false for NaN and infinities.
    #[inline(always)]
    pub fn contains(self, x: f64) -> bool {
        self.lo() <= x && x <= self.hi() && x.abs() < f64::INFINITY
    }

    /// Whether zero lies inside.
    #[inline(always)]
    pub fn contains_zero(self) -> bool {
        F64x2::splat(0.0).le(self.0).sign_bits() == 3
    }

    /// Whether every element is known to be `> 0` (true for the empty set).
    #[inline(always)]
    pub fn certainly_positive(self) -> bool {
        self.0.first() < 0.0
    }

    /// Whether every element is known to be `< 0` (true for the empty set).
    #[inline(always)]
    pub fn certainly_negative(self) -> bool {
        self.0.second() < 0.0
    }

    /// The sign of every element: 1 or −1 where it is certain (also of the empty set, by [`Self::certainly_positive`]), else 0.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let signs = [(1.0, 2.0), (-2.0, -1.0), (0.0, 1.0)].map(|(lo, hi)| Interval::new(lo, hi).certain_sign());
    /// assert_eq!(signs, [1, -1, 0]);
    /// ```
    #[inline]
    pub fn certain_sign(self) -> i32 {
        if self.certainly_positive() { 1 } else { -i32::from(self.certainly_negative()) }
    }

    /// The common elements.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let (x, y) = (Interval::new(0.0, 2.0), Interval::new(1.0, 3.0));
    /// assert_eq!(x.intersection(y), Interval::new(1.0, 2.0));
    /// assert!(x.intersection(Interval::new(5.0, 6.0)).is_empty());
    /// ```
    #[inline(always)]
    pub fn intersection(self, o: Self) -> Self {
        let common = Self(self.0.min(o.0));
        if common.is_empty() { Self::EMPTY } else { common }
    }

    /// The smallest interval that holds both.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(Interval::point(1.0).hull(Interval::point(3.0)), Interval::new(1.0, 3.0));
    /// assert_eq!(Interval::EMPTY.hull(Interval::ONE), Interval::ONE);
    /// ```
    #[inline(always)]
    pub fn hull(self, o: Self) -> Self {
        Self(self.0.max(o.0))
    }

    /// The double nearest to the middle: NaN when empty, 0 when entire, ±MAX when unbounded on one side.
    pub fn mid(self) -> f64 {
        let (lo, hi) = (self.lo(), self.hi());
        if lo > hi {
            return f64::NAN;
        }
        if lo == f64::NEG_INFINITY {
            return if hi == f64::INFINITY { 0.0 } else { -f64::MAX };
        }
        if hi == f64::INFINITY {
            return f64::MAX;
        }
        let sum = lo + hi;
        if sum.abs() < f64::INFINITY { 0.5 * sum } else { 0.5 * lo + 0.5 * hi }
    }

    /// `hi − lo`, rounded up; NaN when empty, +∞ when unbounded.
    #[inline]
    pub fn width(self) -> f64 {
        if self.is_empty() { f64::NAN } else { difference_up(self.hi(), self.lo()) }
    }

    /// The least double `r` with `self ⊆ [mid − r, mid + r]`; NaN when empty, +∞ when unbounded.
    pub fn rad(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        let mid = self.mid();
        let (below, above) = (difference_up(mid, self.lo()), difference_up(self.hi(), mid));
        if below > above { below } else { above }
    }

    /// The greatest absolute value; NaN when empty.
    #[inline]
    pub fn mag(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        let (a, b) = (self.0.first(), self.0.second());
        (if a > b { a } else { b }).abs()
    }

    /// The least absolute value; NaN when empty.
    #[inline]
    pub fn mig(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        let (a, b) = (-self.0.first(), -self.0.second());
        let least = if a > b { a } else { b };
        if least > 0.0 { least } else { 0.0 }
    }

    /// `([lo, at], [at, hi])`, with `at` moved into the interval when it lies outside (or is NaN).
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let (a, b) = Interval::new(0.0, 4.0).split(1.0);
    /// assert_eq!((a.hi(), b), (1.0, Interval::new(1.0, 4.0)));
    /// ```
    #[inline]
    pub fn split(self, at: f64) -> (Self, Self) {
        if self.is_empty() {
            return (self, self);
        }
        let at = if at.is_nan() { self.mid() } else { at };
        let at = at.clamp(self.lo(), self.hi()).clamp(-f64::MAX, f64::MAX);
        (Self::raw(self.lo(), at), Self::raw(at, self.hi()))
    }

    /// Both halves, split at [`Self::mid`].
    #[inline]
    pub fn bisect(self) -> (Self, Self) {
        self.split(self.mid())
    }

    /// The quotients `{n/d : n ∈ self, d ∈ divisor, d ≠ 0}` as two pieces, the lower one first; a piece that is
    /// not there is empty. For Newton steps with a derivative that holds zero.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let (left, right) = Interval::ONE.div_pair(Interval::new(-1.0, 2.0));
    /// assert!(left.contains(-1.0) && !left.contains(-0.9) && right.contains(0.5) && !right.contains(0.4));
    /// ```
    pub fn div_pair(self, divisor: Self) -> (Self, Self) {
        let splits = divisor.lo() < 0.0 && divisor.hi() > 0.0;
        if self.is_empty() || !splits || self.contains_zero() {
            return (self / divisor, Self::EMPTY);
        }
        let below = self / Self::raw(divisor.lo(), 0.0);
        let above = self / Self::raw(0.0, divisor.hi());
        if self.certainly_positive() { (below, above) } else { (above, below) }
    }

    /// The set `{x : x·d = n for some d ∈ self, n ∈ numerator}` as two pieces (the "reverse multiplication" of
    /// IEEE 1788): as [`Self::div_pair`], but everything when zero is in both.
    pub fn mul_rev_pair(self, numerator: Self) -> (Self, Self) {
        if self.is_empty() || numerator.is_empty() {
            return (Self::EMPTY, Self::EMPTY);
        }
        if self.contains_zero() && numerator.contains_zero() {
            return (Self::ENTIRE, Self::EMPTY);
        }
        numerator.div_pair(self)
    }

    /// The narrowest `z` with `o + z ⊇ self`, when this is at least as wide as `o` (compared exactly); else entire.
    /// Recovers a summand: `(x + y).cancel_minus(y)` encloses `x`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(Interval::new(1.0, 5.0).cancel_minus(Interval::new(0.0, 2.0)), Interval::new(1.0, 3.0));
    /// assert!(Interval::point(1.0).cancel_minus(Interval::new(0.0, 5e-324)).is_entire());
    /// ```
    pub fn cancel_minus(self, o: Self) -> Self {
        if self.is_empty() && o.is_bounded() {
            return Self::EMPTY;
        }
        if self.is_empty() || o.is_empty() || !self.is_bounded() || !o.is_bounded() {
            return Self::ENTIRE;
        }
        if difference_is_less(self.hi(), self.lo(), o.hi(), o.lo()) {
            return Self::ENTIRE;
        }
        let (lo, hi) = (self.lo(), self.hi());
        Self::raw(-difference_up(o.lo(), lo), difference_up(hi, o.hi()))
    }

    /// `cancel_minus` with the sign of `o` changed.
    pub fn cancel_plus(self, o: Self) -> Self {
        self.cancel_minus(-o)
    }
}
