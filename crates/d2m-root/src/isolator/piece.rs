//! Pieces of time, and the rounding of their ends.

/// A piece of time `[lo, hi]`, lo ≤ hi.
///
/// ```
/// use d2m_root::Piece;
/// let window = Piece { lo: 0.0, hi: 1.0 };
/// assert!(window.holds(Piece { lo: 0.25, hi: 0.5 }));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Start.
    pub lo: f64,
    /// End.
    pub hi: f64,
}

impl Piece {
    /// Holds no piece.
    pub const NONE: Self = Self { lo: f64::INFINITY, hi: f64::NEG_INFINITY };

    /// True if `part` lies in this piece.
    ///
    /// ```
    /// use d2m_root::Piece;
    /// let piece = Piece { lo: 0.0, hi: 1.0 };
    /// assert!(piece.holds(piece) && !piece.holds(Piece { lo: 0.5, hi: 1.5 }) && !Piece::NONE.holds(piece));
    /// ```
    #[inline(always)]
    pub fn holds(&self, part: Self) -> bool {
        self.lo <= part.lo && part.hi <= self.hi
    }

    /// A time inside, the middle up to rounding.
    ///
    /// ```
    /// use d2m_root::Piece;
    /// assert_eq!(Piece { lo: 1.0, hi: 2.0 }.mid(), 1.5);
    /// assert_eq!(Piece { lo: -f64::MAX, hi: f64::MAX }.mid(), 0.0);
    /// ```
    #[inline(always)]
    pub fn mid(&self) -> f64 {
        // The halves first: a difference of times may overflow.
        self.lo + (0.5 * self.hi - 0.5 * self.lo)
    }

    /// `hi − lo` in plain floating point.
    #[inline(always)]
    pub fn width(&self) -> f64 {
        self.hi - self.lo
    }

    /// Without what is cut off either end; `None` if nothing is left. An end from which nothing is cut stays as it is.
    #[inline(always)]
    pub(super) fn shortened(self, advance: f64, retreat: f64) -> Option<Self> {
        let (lo, hi) = (self.lo + advance, self.hi - retreat);
        // Both ends may have been cut past each other.
        if lo > hi { None } else { Some(Self { lo, hi }) }
    }

    /// The largest |s| of its times s, if neither end is NaN.
    ///
    /// ```
    /// assert_eq!(d2m_root::Piece { lo: -3.0, hi: 1.0 }.reach(), 3.0);
    /// ```
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        let (left, right) = (self.lo.abs(), self.hi.abs());
        if left > right { left } else { right }
    }

    /// Whether its ends are in order and up to `reach` from zero; false if one is NaN.
    #[inline(always)]
    pub(super) fn is_within(&self, reach: f64) -> bool {
        self.reach() <= reach && self.lo <= self.hi
    }
}
