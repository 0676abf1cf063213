//! First contact of something that can be excluded, contracted and measured on pieces of time: from the left.
//!
//! **Invariant:** nothing here knows what is moving. A [`PieceTest`] answers for pieces of time; [`isolate`] decides
//! which pieces to ask about, and keeps the promise "nothing before `lo`" from the promises of the test.
mod cubic;
mod options;
mod quadratic;
mod search;

#[cfg(test)]
mod tests;

pub use cubic::Cubic;
pub use options::IsolatorOptions;
pub use quadratic::{Band, Quadratic};
pub use search::{Evidence, FirstRoot, Isolation, isolate};

/// A piece of time `[lo, hi]`, lo ≤ hi.
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
    #[inline(always)]
    pub fn mid(&self) -> f64 {
        self.lo + 0.5 * (self.hi - self.lo)
    }

    /// `hi − lo` in plain floating point.
    #[inline(always)]
    pub fn width(&self) -> f64 {
        self.hi - self.lo
    }
}

/// What a test found out about a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// No contact at any time of the piece.
    Clear,
    /// Every contact of the piece lies in this part of it.
    Within {
        /// The part.
        part: Piece,
        /// A contact in the part is proven.
        certain: bool,
    },
}

/// What a test measured at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Upper bound of the distance at that time, minus the separation that counts as contact.
    pub distance: f64,
    /// No contact at any time of the piece that lies strictly between `clear_lo` and `clear_hi`, nor at them if they
    /// lie inside the piece's interior; empty if `clear_lo >= clear_hi`.
    pub clear_lo: f64,
    /// End of the clear part.
    pub clear_hi: f64,
}

/// A question about contact that can be asked piece by piece.
pub trait PieceTest {
    /// True if an evaluation of a piece of this half-width would not pay: it is then bisected unevaluated.
    fn too_wide(&self, half_width: f64) -> bool;

    /// Excludes or contracts a piece.
    fn evaluate(&mut self, piece: Piece) -> Verdict;

    /// Measures the distance at a time of the piece, and how far around it the piece is clear.
    fn measure(&mut self, piece: Piece, at: f64) -> Measurement;

    /// A distance up to this counts as contact.
    fn tolerance(&self) -> f64;

    /// Pieces up to this width are decided by a measurement.
    fn resolution(&self) -> f64;
}
