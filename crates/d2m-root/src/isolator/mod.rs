//! First contact of something that can be excluded, contracted and measured on pieces of time: from the left.
//!
//! **Invariant:** nothing here knows what is moving. A [`PieceTest`] answers for pieces of time; [`isolate`] decides
//! which pieces to evaluate, and keeps the promise "nothing before `lo`" from the promises of the test.
mod cubic;
mod first_zero_bound;
mod options;
mod piece;
mod quadratic;
mod search;
mod time_unit;

#[cfg(test)]
mod tests;

pub use cubic::{Cubic, NearbyQuadratic};
pub use options::IsolatorOptions;
pub use piece::Piece;
pub use quadratic::{Band, Quadratic};
pub use search::{Evidence, FirstRoot, Isolation, isolate};

/// What a test found out about a piece.
///
/// ```
/// use d2m_root::{Piece, Verdict};
/// /// Of a function that is at least 1 − t.
/// fn judge(piece: Piece) -> Verdict {
///     if piece.hi < 1.0 {
///         Verdict::Clear
///     } else {
///         Verdict::Within { part: Piece { lo: piece.lo.max(1.0), ..piece }, certain: false }
///     }
/// }
/// assert_eq!(judge(Piece { lo: 0.0, hi: 0.5 }), Verdict::Clear);
/// assert!(matches!(judge(Piece { lo: 0.0, hi: 2.0 }), Verdict::Within { part, .. } if part.lo == 1.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
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
///
/// ```
/// use d2m_root::Measurement;
/// // A body at distance 0.3 that comes nearer by at most 2 a unit of time, measured at 0.5: nothing meets for 0.15 around it.
/// let measured = Measurement { distance: 0.3, clear_lo: 0.5 - 0.15, clear_hi: 0.5 + 0.15 };
/// assert!(measured.clear_lo < measured.clear_hi, "a part is proven clear");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Upper bound of the distance at that time, minus the separation that counts as contact.
    pub distance: f64,
    /// No contact at any time of the piece from `clear_lo` to `clear_hi`, both included; nothing is said if
    /// `clear_lo >= clear_hi`.
    pub clear_lo: f64,
    /// End of the clear part.
    pub clear_hi: f64,
}

/// A test for contact that can be evaluated piece by piece.
///
/// ```
/// use d2m_root::{FirstRoot, IsolatorOptions, Measurement, Piece, PieceTest, Verdict, isolate};
/// /// 2 − 3t, which enters the band of numbers up to 0.5 at t = 0.5.
/// struct Line;
///
/// impl PieceTest for Line {
///     fn too_wide(&self, _half_width: f64) -> bool {
///         false
///     }
///     fn evaluate(&mut self, piece: Piece) -> Verdict {
///         if 2.0 - 3.0 * piece.hi > 0.5 { Verdict::Clear } else { Verdict::Within { part: piece, certain: false } }
///     }
///     fn measure(&mut self, _piece: Piece, at: f64) -> Measurement {
///         Measurement { distance: 2.0 - 3.0 * at - 0.5, clear_lo: at, clear_hi: at }
///     }
///     fn tolerance(&self) -> f64 {
///         1e-6
///     }
///     fn resolution(&self) -> f64 {
///         1e-9
///     }
/// }
///
/// let found = isolate(&mut Line, Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
/// let FirstRoot::Found { bracket, .. } = found.root else { panic!("{found:?}") };
/// assert!(bracket.lo <= 0.5 && bracket.lo > 0.5 - 1e-3);
/// ```
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
