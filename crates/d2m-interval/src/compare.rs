//! Comparisons of IEEE 1788, and certain/possible order.
use crate::Interval;

/// `a < b`, or both are the same infinity.
#[inline]
fn below(a: f64, b: f64) -> bool {
    a < b || (a == b && a.is_infinite())
}

/// How two intervals lie on the line: exactly one state holds (IEEE 1788-2015, table 10.7).
///
/// ```text
/// first   |----|                      Before
///              |----|                 Meets … MetBy mirror images
///           |----|                    Overlaps
/// second         |--------|
///                |--|                 Starts
///                  |---|              ContainedBy
///                     |---|           Finishes
/// ```
///
/// ```
/// use d2m_interval::{Interval, Overlap};
/// let inner = Interval::new(1.0, 2.0);
/// assert_eq!(inner.overlap(Interval::new(0.0, 3.0)), Overlap::ContainedBy);
/// assert_eq!(inner.overlap(Interval::new(2.0, 3.0)), Overlap::Meets);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Overlap {
    /// Both are empty.
    BothEmpty,
    /// Only the first is empty.
    FirstEmpty,
    /// Only the second is empty.
    SecondEmpty,
    /// The first ends before the second starts.
    Before,
    /// The first ends where the second starts; neither is a point.
    Meets,
    /// The first starts first, and ends inside the second.
    Overlaps,
    /// Same start, the first ends first.
    Starts,
    /// The first lies strictly inside the second.
    ContainedBy,
    /// Same end, the first starts later.
    Finishes,
    /// The same set.
    Equals,
    /// Same end, the second starts later.
    FinishedBy,
    /// The second lies strictly inside the first.
    Contains,
    /// Same start, the second ends first.
    StartedBy,
    /// The second starts first, and ends inside the first.
    OverlappedBy,
    /// The second ends where the first starts; neither is a point.
    MetBy,
    /// The second ends before the first starts.
    After,
}

impl Interval {
    /// Whether every element of `self` is in `o`.
    #[inline]
    pub fn is_subset(self, o: Self) -> bool {
        self.is_empty() || (o.lo() <= self.lo() && self.hi() <= o.hi())
    }

    /// Whether `self` lies in the interior of `o` (the whole line is open).
    #[inline]
    pub fn is_interior(self, o: Self) -> bool {
        self.is_empty() || (below(o.lo(), self.lo()) && below(self.hi(), o.hi()))
    }

    /// Whether there is no common element.
    #[inline]
    pub fn is_disjoint(self, o: Self) -> bool {
        self.is_empty() || o.is_empty() || self.hi() < o.lo() || o.hi() < self.lo()
    }

    /// Whether both ends of `self` are at most those of `o` ("weakly less").
    #[inline]
    pub fn less(self, o: Self) -> bool {
        if self.is_empty() || o.is_empty() {
            return self.is_empty() && o.is_empty();
        }
        self.lo() <= o.lo() && self.hi() <= o.hi()
    }

    /// Whether both ends of `self` are below those of `o`, or the same infinities.
    #[inline]
    pub fn strictly_less(self, o: Self) -> bool {
        if self.is_empty() || o.is_empty() {
            return self.is_empty() && o.is_empty();
        }
        below(self.lo(), o.lo()) && below(self.hi(), o.hi())
    }

    /// Whether no element of `self` is greater than an element of `o`.
    #[inline]
    pub fn precedes(self, o: Self) -> bool {
        self.is_empty() || o.is_empty() || self.hi() <= o.lo()
    }

    /// Whether every element of `self` is less than every element of `o`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::new(0.0, 1.0).strictly_precedes(Interval::new(1.5, 2.0)));
    /// assert!(!Interval::new(0.0, 1.0).strictly_precedes(Interval::new(1.0, 2.0)));
    /// ```
    #[inline]
    pub fn strictly_precedes(self, o: Self) -> bool {
        self.is_empty() || o.is_empty() || self.hi() < o.lo()
    }

    /// The one state of [`Overlap`] that holds.
    ///
    /// ```
    /// # use d2m_interval::{Interval, Overlap};
    /// assert_eq!(Interval::new(0.0, 2.0).overlap(Interval::new(1.0, 3.0)), Overlap::Overlaps);
    /// ```
    pub fn overlap(self, o: Self) -> Overlap {
        let (a, b, c, d) = (self.lo(), self.hi(), o.lo(), o.hi());
        match (self.is_empty(), o.is_empty()) {
            (true, true) => return Overlap::BothEmpty,
            (true, false) => return Overlap::FirstEmpty,
            (false, true) => return Overlap::SecondEmpty,
            (false, false) => {}
        }
        if b < c {
            Overlap::Before
        } else if d < a {
            Overlap::After
        } else if a == c {
            if b == d {
                Overlap::Equals
            } else if b < d {
                Overlap::Starts
            } else {
                Overlap::StartedBy
            }
        } else if b == d {
            if a < c { Overlap::FinishedBy } else { Overlap::Finishes }
        } else if a < c {
            if d < b {
                Overlap::Contains
            } else if b == c {
                Overlap::Meets
            } else {
                Overlap::Overlaps
            }
        } else if b < d {
            Overlap::ContainedBy
        } else if d == a {
            Overlap::MetBy
        } else {
            Overlap::OverlappedBy
        }
    }

    /// Whether the least element is known to be `>= 0`; true for the empty set.
    #[inline]
    pub fn certainly_non_negative(self) -> bool {
        self.lo() >= 0.0
    }

    /// Whether `x < y` may hold for some elements: what cannot be excluded.
    #[inline]
    pub fn possibly_less(self, o: Self) -> bool {
        !self.is_empty() && !o.is_empty() && self.lo() < o.hi()
    }
}
