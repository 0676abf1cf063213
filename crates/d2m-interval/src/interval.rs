use crate::IntervalError;
use d2m_lanes::F64x2;

/// A closed, connected set of real numbers `[lo, hi]`; possibly unbounded, possibly empty.
///
/// Promise of every function in this crate: the result holds the exact mathematical value for every choice of
/// elements in the arguments (those inside the function's domain). End points are rounded outwards.
///
/// Kept as the pair (−lo, hi) in one 128-bit vector, so that both ends are rounded upwards by the same
/// instructions. `[−∞, x]`, `[x, +∞]`, [`Self::ENTIRE`] and [`Self::EMPTY`] are intervals; NaN is never an end
/// point.
///
/// ```
/// use d2m_interval::Interval;
/// let x = Interval::new(1.0, 2.0);
/// let y = x * x - x / 3.0;
/// assert!(y.lo() <= 1.0 - 2.0 / 3.0 && 4.0 - 1.0 / 3.0 <= y.hi());
/// ```
#[derive(Clone, Copy)]
#[repr(transparent)]
#[must_use]
pub struct Interval(pub(crate) F64x2);

impl Interval {
    /// The empty set.
    pub const EMPTY: Self = Self(F64x2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
    /// All real numbers.
    pub const ENTIRE: Self = Self(F64x2::new(f64::INFINITY, f64::INFINITY));
    /// `[0, 0]`.
    pub const ZERO: Self = Self(F64x2::new(0.0, 0.0));
    /// `[1, 1]`.
    pub const ONE: Self = Self(F64x2::new(-1.0, 1.0));
    /// `[0, 1]`.
    pub const UNIT: Self = Self(F64x2::new(0.0, 1.0));
    /// `[−1, 1]`.
    pub const SIGNED_UNIT: Self = Self(F64x2::new(1.0, 1.0));
    /// The two doubles around π.
    pub const PI: Self = Self::raw(core::f64::consts::PI, f64::from_bits(0x4009_21FB_5444_2D19));
    /// The two doubles around 2π.
    pub const TAU: Self = Self::raw(core::f64::consts::TAU, f64::from_bits(0x4019_21FB_5444_2D19));
    /// The two doubles around π/2.
    pub const FRAC_PI_2: Self =
        Self::raw(core::f64::consts::FRAC_PI_2, f64::from_bits(0x3FF9_21FB_5444_2D19));
    /// The two doubles around e.
    pub const E: Self = Self::raw(core::f64::consts::E, f64::from_bits(0x4005_BF0A_8B14_576A));

    /// `lo <= hi`, no NaN; not checked.
    #[inline(always)]
    pub(crate) const fn raw(lo: f64, hi: f64) -> Self {
        Self(F64x2::new(-lo, hi))
    }

    /// From computed end points: NaN means unbounded on that side.
    #[inline]
    pub(crate) fn from_ends(lo: f64, hi: f64) -> Self {
        Self::raw(
            if lo.is_nan() { f64::NEG_INFINITY } else { lo },
            if hi.is_nan() { f64::INFINITY } else { hi },
        )
    }

    /// `[lo, hi]`.
    ///
    /// # Panics
    /// When [`Self::try_new`] returns an error.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let x = Interval::new(-1.0, f64::INFINITY);
    /// assert!(x.contains(1e300) && !x.contains(-1.5));
    /// ```
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
    ///
    /// ```
    /// # use d2m_interval::{Interval, IntervalError};
    /// assert!(matches!(Interval::try_new(2.0, 1.0), Err(IntervalError::Order { .. })));
    /// assert!(matches!(Interval::try_new(f64::NAN, 1.0), Err(IntervalError::Nan { .. })));
    /// ```
    #[inline]
    pub fn try_new(lo: f64, hi: f64) -> Result<Self, IntervalError> {
        if lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY {
            Ok(Self(F64x2::pack(-lo, hi)))
        } else if lo.is_nan() || hi.is_nan() {
            Err(IntervalError::Nan { lo, hi })
        } else {
            Err(IntervalError::Order { lo, hi })
        }
    }

    /// `[x, x]`; [`Self::ENTIRE`] when `x` is not a finite number ("cannot exclude").
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::point(f64::NAN).is_entire());
    /// ```
    #[inline(always)]
    pub fn point(x: f64) -> Self {
        let point = Self::point_unchecked(x);
        if x.abs() < f64::INFINITY { point } else { Self::ENTIRE }
    }

    /// The pair (−x, x) even when that is no interval: for fast paths that check their result.
    #[inline(always)]
    pub(crate) fn point_unchecked(x: f64) -> Self {
        Self(F64x2::splat(x).neg_first())
    }

    /// `[center − radius, center + radius]`, rounded outwards; a negative radius counts as its absolute value.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::around(1.0, 0.1).contains(1.1));
    /// ```
    #[inline]
    pub fn around(center: f64, radius: f64) -> Self {
        Self::point(center) + Self::raw(-1.0, 1.0) * radius
    }

    /// Lower end point (`+∞` when empty).
    #[inline(always)]
    pub const fn lo(self) -> f64 {
        -self.0.to_array()[0]
    }

    /// Upper end point (`−∞` when empty).
    #[inline(always)]
    pub const fn hi(self) -> f64 {
        self.0.to_array()[1]
    }

    /// [`Self::lo`] by the name that interval arithmetic gives it (IEEE 1788).
    #[inline(always)]
    pub const fn inf(self) -> f64 {
        self.lo()
    }

    /// [`Self::hi`] by the name that interval arithmetic gives it (IEEE 1788).
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let third = Interval::ONE / Interval::point(3.0);
    /// assert!(third.inf() < third.sup());
    /// ```
    #[inline(always)]
    pub const fn sup(self) -> f64 {
        self.hi()
    }
}

impl PartialEq for Interval {
    /// Equal sets.
    fn eq(&self, o: &Self) -> bool {
        self.lo() == o.lo() && self.hi() == o.hi()
    }
}

impl Default for Interval {
    fn default() -> Self {
        Self::ZERO
    }
}

impl From<f64> for Interval {
    /// As [`Interval::point`].
    fn from(x: f64) -> Self {
        Self::point(x)
    }
}

impl From<i32> for Interval {
    fn from(x: i32) -> Self {
        Self::point(f64::from(x))
    }
}

impl TryFrom<(f64, f64)> for Interval {
    type Error = IntervalError;
    /// As [`Interval::try_new`].
    fn try_from((lo, hi): (f64, f64)) -> Result<Self, IntervalError> {
        Self::try_new(lo, hi)
    }
}

impl From<Interval> for (f64, f64) {
    /// `(lo, hi)`.
    fn from(x: Interval) -> Self {
        (x.lo(), x.hi())
    }
}
