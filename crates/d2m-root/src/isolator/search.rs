//! The isolator: pieces from the left, bisect, contract, measure.
use super::{IsolatorOptions, Measurement, Piece, PieceTest, Verdict};

/// How a contact is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Evidence {
    /// A true contact inside the bracket is proven.
    Crossing,
    /// At the end of the bracket the distance is proven to be within the tolerance.
    WithinTolerance,
    /// The bracket is as narrow as the numbers allow and could not be excluded; the distance bound says how close
    /// the features are at its middle.
    Unresolved,
}

/// Answer of [`isolate`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum FirstRoot {
    /// No contact in the window.
    Clear,
    /// No contact before `bracket.lo`; contact, as the evidence says, at some time of the bracket.
    Found {
        /// Where.
        bracket: Piece,
        /// How it is known.
        evidence: Evidence,
        /// Proven upper bound of the distance at some time of the bracket (0 for a crossing).
        distance: f64,
    },
    /// The limit of evaluations was reached, or not even a distance could be bounded; no contact before `clear_until`.
    Undecided {
        /// All before this time is clear.
        clear_until: f64,
    },
}

/// An answer and what it cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isolation {
    /// The answer.
    pub root: FirstRoot,
    /// Evaluations and measurements.
    pub evaluations: u32,
}

/// Below this part of its old width a contracted piece is kept as it is.
const GOOD: f64 = 0.6;
/// Above this part of its old width a piece is measured before it is bisected.
const POOR: f64 = 0.95;
/// Pieces that wait without memory of their own.
const FEW: usize = 6;
/// No piece is divided below four last places of the times it is made of.
const RESOLVABLE: f64 = 4.0 * f64::EPSILON;
/// Below this part of the resolution, a piece that nothing can be said about is not halved again.
const GIVE_UP: f64 = 0.25;

/// Pieces to the right of the current one, the leftmost on top: the first ones in place, as most searches need no more.
struct Rest {
    few: [Piece; FEW],
    len: usize,
    more: Vec<Piece>,
}

impl Rest {
    const fn new(window: Piece) -> Self {
        Self { few: [window; FEW], len: 0, more: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, piece: Piece) {
        match self.few.get_mut(self.len) {
            Some(place) => *place = piece,
            None => self.more.push(piece),
        }
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Piece> {
        self.len = self.len.checked_sub(1)?;
        match self.few.get(self.len) {
            Some(piece) => Some(*piece),
            None => self.more.pop(),
        }
    }

    fn clear(&mut self) {
        self.len = 0;
        self.more.clear();
    }
}

/// First contact in a window of time, from the left.
///
/// Promise: if the test's promises hold, there is no contact in `[window.lo, bracket.lo)`, and none at all when the
/// answer is [`FirstRoot::Clear`]. It ends after at most `max_evaluations` evaluations and measurements.
pub fn isolate<T: PieceTest>(test: &mut T, window: Piece, options: &IsolatorOptions) -> Isolation {
    let mut rest = Rest::new(window);
    let mut piece = window;
    let mut evaluations = 0;
    // A time at which the distance was seen within the tolerance; nothing to its right matters.
    let mut seen: Option<(f64, f64)> = None;
    let mut start_measured = options.start_apart;
    let tolerance = test.tolerance();
    let resolution = test.resolution().max(RESOLVABLE * window.reach());
    let found = |bracket, evidence, distance| FirstRoot::Found { bracket, evidence, distance };
    let root = 'search: loop {
        let next = 'piece: {
            let mid = piece.mid();
            if test.too_wide(0.5 * piece.width()) && piece.lo < mid && mid < piece.hi {
                rest.push(Piece { lo: mid, ..piece });
                piece.hi = mid;
                continue 'search;
            }
            if evaluations >= options.max_evaluations {
                break 'search FirstRoot::Undecided { clear_until: piece.lo };
            }
            evaluations += 1;
            let old_width = piece.width();
            match test.evaluate(piece) {
                Verdict::Clear => break 'piece rest.pop(),
                Verdict::Within { part, certain } => {
                    piece = part;
                    if certain && piece.width() <= resolution {
                        break 'search found(piece, Evidence::Crossing, 0.0);
                    }
                }
            }
            if piece.lo <= window.lo && evaluations > 1 && !start_measured {
                start_measured = true;
                evaluations += 1;
                let at_start = test.measure(piece, piece.lo);
                if at_start.distance <= tolerance {
                    let bracket = Piece { lo: piece.lo, hi: piece.lo };
                    break 'search found(bracket, Evidence::WithinTolerance, at_start.distance);
                }
                if at_start.clear_hi > piece.lo {
                    if at_start.clear_hi >= piece.hi {
                        break 'piece rest.pop();
                    }
                    piece.lo = at_start.clear_hi;
                }
            }
            let (width, mid) = (piece.width(), piece.mid());
            let narrow = width <= resolution || mid <= piece.lo || mid >= piece.hi;
            if !narrow && width < GOOD * old_width {
                continue 'search;
            }
            let mut cut = Measurement { distance: f64::INFINITY, clear_lo: mid, clear_hi: mid };
            if narrow || width > POOR * old_width {
                evaluations += 1;
                cut = test.measure(piece, mid);
                if cut.distance <= tolerance {
                    if narrow {
                        let bracket = Piece { lo: piece.lo, hi: mid };
                        break 'search found(bracket, Evidence::WithinTolerance, cut.distance);
                    }
                    seen = Some((mid, cut.distance));
                    rest.clear();
                    piece.hi = mid;
                    continue 'search;
                }
                let (clear_lo, clear_hi) = (cut.clear_lo.max(piece.lo), cut.clear_hi.min(piece.hi));
                if clear_lo < clear_hi {
                    match (piece.lo < clear_lo, clear_hi < piece.hi) {
                        (false, false) => break 'piece rest.pop(),
                        (true, false) => piece.hi = clear_lo,
                        (false, true) => piece.lo = clear_hi,
                        (true, true) => {
                            rest.push(Piece { lo: clear_hi, ..piece });
                            piece.hi = clear_lo;
                        }
                    }
                    continue 'search;
                }
            }
            // Nothing could be said: halve, down to the last representable width.
            if mid <= piece.lo || mid >= piece.hi || (narrow && width <= GIVE_UP * resolution) {
                if cut.distance.is_finite() {
                    break 'search found(piece, Evidence::Unresolved, cut.distance);
                }
                // Not even how far apart they are.
                break 'search FirstRoot::Undecided { clear_until: piece.lo };
            }
            rest.push(Piece { lo: mid, ..piece });
            piece.hi = mid;
            continue 'search;
        };
        match (next, seen) {
            (Some(piece_to_the_right), _) => piece = piece_to_the_right,
            // All before the time seen is clear: the contact is there, within the tolerance.
            (None, Some((time, distance))) => {
                break found(Piece { lo: time, hi: time }, Evidence::WithinTolerance, distance);
            }
            (None, None) => break FirstRoot::Clear,
        }
    };
    Isolation { root, evaluations }
}
