use crate::IntervalError;

/// A closed, connected set of real numbers `[lo, hi]`; possibly unbounded, possibly empty.
#[derive(Clone, Copy, PartialEq)]
pub struct Interval {
    neg_lo: f64,
    hi: f64,
}

impl Interval {
    /// The empty set.
    pub const EMPTY: Self = Self::raw(f64::INFINITY, f64::NEG_INFINITY);
    /// All real numbers.
    pub const ENTIRE: Self = Self::raw(f64::NEG_INFINITY, f64::INFINITY);
    /// `[0, 0]`.
    pub const ZERO: Self = Self::raw(0.0, 0.0);
    /// `[1, 1]`.
    pub const ONE: Self = Self::raw(1.0, 1.0);
    /// `[0, 1]`.
    pub const UNIT: Self = Self::raw(0.0, 1.0);

    #[inline(always)]
    pub(crate) const fn raw(lo: f64, hi: f64) -> Self {
        Self { neg_lo: -lo, hi }
    }

    /// From computed end points: NaN means entire.
    #[inline(always)]
    pub(crate) fn from_ends(lo: f64, hi: f64) -> Self {
        if lo <= hi { Self::raw(lo, hi) } else { Self::from_ends_slow(lo, hi) }
    }

    #[cold]
    fn from_ends_slow(lo: f64, hi: f64) -> Self {
        Self::raw(
            if lo.is_nan() { f64::NEG_INFINITY } else { lo },
            if hi.is_nan() { f64::INFINITY } else { hi },
        )
    }

    /// `[lo, hi]`.
    ///
    /// # Panics
    /// When [`Self::try_new`] would return an error.
    #[inline]
    #[track_caller]
    pub fn new(lo: f64, hi: f64) -> Self {
        match Self::try_new(lo, hi) {
            Ok(interval) => interval,
            Err(error) => panic!("{error}"),
        }
    }

    /// `[lo, hi]`.
    ///
    /// # Errors
    /// When an end point is NaN, `lo > hi`, `lo = +∞` or `hi = −∞`.
    #[inline]
    pub fn try_new(lo: f64, hi: f64) -> Result<Self, IntervalError> {
        if lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY {
            Ok(Self::raw(lo, hi))
        } else if lo.is_nan() || hi.is_nan() {
            Err(IntervalError::Nan { lo, hi })
        } else {
            Err(IntervalError::Order { lo, hi })
        }
    }

    /// `[x, x]`; entire when `x` is not finite.
    #[inline]
    pub fn point(x: f64) -> Self {
        if x.is_finite() { Self::raw(x, x) } else { Self::ENTIRE }
    }

    /// Lower end point (`+∞` when empty).
    #[inline(always)]
    pub const fn lo(self) -> f64 {
        -self.neg_lo
    }

    /// Upper end point (`−∞` when empty).
    #[inline(always)]
    pub const fn hi(self) -> f64 {
        self.hi
    }
}

impl core::fmt::Debug for Interval {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "[{:?}, {:?}]", self.lo(), self.hi())
    }
}

impl Default for Interval {
    fn default() -> Self {
        Self::ZERO
    }
}

impl From<f64> for Interval {
    fn from(x: f64) -> Self {
        Self::point(x)
    }
}
