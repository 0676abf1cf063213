use crate::{Interval, round::up};

impl Interval {
    /// Whether this is the empty set.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.lo() > self.hi()
    }

    /// Whether this holds all real numbers.
    #[inline]
    pub fn is_entire(self) -> bool {
        self.lo() == f64::NEG_INFINITY && self.hi() == f64::INFINITY
    }

    /// Whether the real number `x` lies inside; false for NaN and infinities.
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lo() <= x && x <= self.hi() && x.is_finite()
    }

    /// Whether zero lies inside.
    #[inline(always)]
    pub fn contains_zero(self) -> bool {
        self.lo() <= 0.0 && 0.0 <= self.hi()
    }

    /// Whether every element of `self` is in `other`.
    #[inline]
    pub fn is_subset(self, other: Self) -> bool {
        self.is_empty() || (other.lo() <= self.lo() && self.hi() <= other.hi())
    }

    /// Whether every element is known to be `> 0` (true for the empty set).
    #[inline(always)]
    pub fn certainly_positive(self) -> bool {
        self.lo() > 0.0
    }

    /// Whether every element is known to be `< 0` (true for the empty set).
    #[inline(always)]
    pub fn certainly_negative(self) -> bool {
        self.hi() < 0.0
    }

    /// The common elements.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        let lo = if self.lo() > other.lo() { self.lo() } else { other.lo() };
        let hi = if self.hi() < other.hi() { self.hi() } else { other.hi() };
        if lo <= hi { Self::raw(lo, hi) } else { Self::EMPTY }
    }

    /// The smallest interval that holds both.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        let lo = if self.lo() < other.lo() { self.lo() } else { other.lo() };
        let hi = if self.hi() > other.hi() { self.hi() } else { other.hi() };
        Self::raw(lo, hi)
    }

    /// A finite element near the middle; NaN when empty.
    #[inline]
    pub fn mid(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        if self.is_entire() {
            return 0.0;
        }
        let lo = if self.lo() < -f64::MAX { -f64::MAX } else { self.lo() };
        let hi = if self.hi() > f64::MAX { f64::MAX } else { self.hi() };
        let mid = lo * 0.5 + hi * 0.5;
        mid.clamp(lo, hi)
    }

    /// `hi − lo`, rounded up; NaN when empty.
    #[inline]
    pub fn width(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        if self.lo() == self.hi() { 0.0 } else { up(self.hi() - self.lo()) }
    }

    /// A number `r` with `self ⊆ [mid − r, mid + r]`; NaN when empty.
    #[inline]
    pub fn rad(self) -> f64 {
        let mid = self.mid();
        let below = if mid == self.lo() { 0.0 } else { up(mid - self.lo()) };
        let above = if mid == self.hi() { 0.0 } else { up(self.hi() - mid) };
        if mid.is_nan() || below > above { below } else { above }
    }

    /// The largest absolute value; NaN when empty.
    #[inline]
    pub fn mag(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        let (a, b) = (self.lo().abs(), self.hi().abs());
        if a > b { a } else { b }
    }

    /// The smallest absolute value; NaN when empty.
    #[inline]
    pub fn mig(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        if self.contains_zero() {
            return 0.0;
        }
        let (a, b) = (self.lo().abs(), self.hi().abs());
        if a < b { a } else { b }
    }

    /// `([lo, at], [at, hi])`, with `at` moved into the interval when it lies outside (or is NaN).
    #[inline]
    pub fn split(self, at: f64) -> (Self, Self) {
        if self.is_empty() {
            return (self, self);
        }
        let at = if at.is_nan() { self.mid() } else { at };
        let at = at.clamp(self.lo(), self.hi()).clamp(-f64::MAX, f64::MAX);
        (Self::raw(self.lo(), at), Self::raw(at, self.hi()))
    }
}
