//! The isolator: pieces from the left, bisect, contract, measure.
use super::{IsolatorOptions, Measurement, Piece, PieceTest, Verdict};

/// How a contact is known.
///
/// ```
/// # use d2m_root::{IsolatorOptions, Measurement, Piece, PieceTest, Verdict, isolate};
/// # struct Line;
/// # impl PieceTest for Line {
/// #     fn too_wide(&self, _half_width: f64) -> bool { false }
/// #     fn evaluate(&mut self, piece: Piece) -> Verdict {
/// #         if 2.0 - 3.0 * piece.hi > 0.5 { Verdict::Clear } else { Verdict::Within { part: piece, certain: false } }
/// #     }
/// #     fn measure(&mut self, _piece: Piece, at: f64) -> Measurement {
/// #         Measurement { distance: 2.0 - 3.0 * at - 0.5, clear_lo: at, clear_hi: at }
/// #     }
/// #     fn tolerance(&self) -> f64 { 1e-6 }
/// #     fn resolution(&self) -> f64 { 1e-9 }
/// # }
/// use d2m_root::{Evidence, FirstRoot};
/// // A test (here of 2 − 3t against the band up to 0.5) that measures distances and proves no crossing.
/// let found = isolate(&mut Line, Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
/// assert!(matches!(found.root, FirstRoot::Found { evidence: Evidence::WithinTolerance, distance, .. } if distance <= 1e-6));
/// ```
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
///
/// ```
/// # use d2m_root::{IsolatorOptions, Measurement, Piece, PieceTest, Verdict, isolate};
/// # struct Line;
/// # impl PieceTest for Line {
/// #     fn too_wide(&self, _half_width: f64) -> bool { false }
/// #     fn evaluate(&mut self, piece: Piece) -> Verdict {
/// #         if 2.0 - 3.0 * piece.hi > 0.5 { Verdict::Clear } else { Verdict::Within { part: piece, certain: false } }
/// #     }
/// #     fn measure(&mut self, _piece: Piece, at: f64) -> Measurement {
/// #         Measurement { distance: 2.0 - 3.0 * at - 0.5, clear_lo: at, clear_hi: at }
/// #     }
/// #     fn tolerance(&self) -> f64 { 1e-6 }
/// #     fn resolution(&self) -> f64 { 1e-9 }
/// # }
/// use d2m_root::FirstRoot;
/// // 2 − 3t enters the band up to 0.5 at t = 0.5.
/// let ask = |hi: f64| isolate(&mut Line, Piece { lo: 0.0, hi }, &IsolatorOptions::new()).root;
/// assert_eq!(ask(0.4), FirstRoot::Clear);
/// assert!(matches!(ask(1.0), FirstRoot::Found { bracket, .. } if bracket.lo <= 0.5 && bracket.hi >= 0.5 - 1e-6));
/// ```
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
///
/// ```
/// # use d2m_root::{IsolatorOptions, Measurement, Piece, PieceTest, Verdict, isolate};
/// # struct Line;
/// # impl PieceTest for Line {
/// #     fn too_wide(&self, _half_width: f64) -> bool { false }
/// #     fn evaluate(&mut self, piece: Piece) -> Verdict {
/// #         if 2.0 - 3.0 * piece.hi > 0.5 { Verdict::Clear } else { Verdict::Within { part: piece, certain: false } }
/// #     }
/// #     fn measure(&mut self, _piece: Piece, at: f64) -> Measurement {
/// #         Measurement { distance: 2.0 - 3.0 * at - 0.5, clear_lo: at, clear_hi: at }
/// #     }
/// #     fn tolerance(&self) -> f64 { 1e-6 }
/// #     fn resolution(&self) -> f64 { 1e-9 }
/// # }
/// use d2m_root::{FirstRoot, Isolation};
/// // 2 − 3t stays above the band up to 0.5 until 0.5: one evaluation says so of the whole window.
/// let Isolation { root, evaluations } = isolate(&mut Line, Piece { lo: 0.0, hi: 0.4 }, &IsolatorOptions::new());
/// assert_eq!((root, evaluations), (FirstRoot::Clear, 1));
/// ```
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
const FEW: usize = 3;
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
///
/// ```
/// use d2m_root::{FirstRoot, IsolatorOptions, Measurement, Piece, PieceTest, Verdict, isolate};
/// /// 2 − 3t, which enters the band of numbers up to 0.5 at t = 0.5.
/// struct Line;
/// impl PieceTest for Line {
///     fn too_wide(&self, _half_width: f64) -> bool { false }
///     fn evaluate(&mut self, piece: Piece) -> Verdict {
///         if 2.0 - 3.0 * piece.hi > 0.5 { Verdict::Clear } else { Verdict::Within { part: piece, certain: false } }
///     }
///     fn measure(&mut self, _piece: Piece, at: f64) -> Measurement {
///         Measurement { distance: 2.0 - 3.0 * at - 0.5, clear_lo: at, clear_hi: at }
///     }
///     fn tolerance(&self) -> f64 { 1e-6 }
///     fn resolution(&self) -> f64 { 1e-9 }
/// }
/// let found = isolate(&mut Line, Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
/// assert!(matches!(found.root, FirstRoot::Found { bracket, .. } if bracket.lo <= 0.5 && bracket.lo > 0.5 - 1e-3));
/// ```
pub fn isolate<T: PieceTest>(test: &mut T, window: Piece, options: &IsolatorOptions) -> Isolation {
    let tolerance = test.tolerance();
    let resolution = test.resolution().max(RESOLVABLE * window.reach());
    let mut search = Search {
        test,
        window,
        tolerance,
        resolution,
        max_evaluations: options.max_evaluations,
        evaluations: 0,
        start_is_known: options.start_apart,
        rest: Rest::new(window),
        seen: None,
    };
    let mut next = Some(window);
    let root = loop {
        let Some(piece) = next else { break search.nothing_left() };
        next = match search.examine(piece) {
            Step::Go(piece) => Some(piece),
            Step::Clear => search.rest.pop(),
            Step::Answer(root) => break root,
        };
    };
    Isolation { root, evaluations: search.evaluations }
}

/// A search under way. All before the current piece is clear, and so is what lies between it and the pieces that wait.
struct Search<'t, T> {
    test: &'t mut T,
    window: Piece,
    tolerance: f64,
    /// Pieces are not divided below this width.
    resolution: f64,
    max_evaluations: u32,
    evaluations: u32,
    /// The start of the window was measured, or the caller knows that the features are apart there.
    start_is_known: bool,
    rest: Rest,
    /// Where the distance was within the tolerance; nothing to its right matters.
    seen: Option<Seen>,
}

/// A time at which the distance was measured to be within the tolerance.
#[derive(Clone, Copy)]
struct Seen {
    time: f64,
    distance: f64,
}

/// What to do next.
enum Step {
    /// Examine this piece.
    Go(Piece),
    /// The piece is clear: on to those that wait.
    Clear,
    Answer(FirstRoot),
}

/// Of a piece whose middle is measured.
#[derive(Clone, Copy)]
enum Width {
    /// What is near there is searched on from the left.
    Wide,
    /// As narrow as a bracket is to be.
    Narrow,
}

/// What the measurement of a piece's middle leads to.
enum Measured {
    Done(Step),
    /// Nothing is clear about it; the distance there is at most this.
    Within(f64),
}

impl<T: PieceTest> Search<'_, T> {
    /// Bisects, contracts by the test, or measures.
    #[inline(always)]
    fn examine(&mut self, piece: Piece) -> Step {
        let mid = piece.mid();
        if self.test.too_wide(0.5 * piece.width()) && piece.lo < mid && mid < piece.hi {
            return self.halve(piece);
        }
        if self.evaluations >= self.max_evaluations {
            return Step::Answer(FirstRoot::Undecided { clear_until: piece.lo });
        }
        self.evaluations += 1;
        let old_width = piece.width();
        let Verdict::Within { part: mut piece, certain } = self.test.evaluate(piece) else {
            return Step::Clear;
        };
        if certain && piece.width() <= self.resolution {
            return found(piece, Evidence::Crossing, 0.0);
        }
        if piece.lo <= self.window.lo && self.evaluations > 1 && !self.start_is_known {
            match self.measure_start(piece) {
                Step::Go(rest) => piece = rest,
                done => return done,
            }
        }
        let (width, mid) = (piece.width(), piece.mid());
        let is_last = mid <= piece.lo || mid >= piece.hi;
        let narrow = width <= self.resolution || is_last;
        if !narrow && width < GOOD * old_width {
            return Step::Go(piece);
        }
        let mut distance = None;
        if narrow || width > POOR * old_width {
            match self.measure_middle(piece, if narrow { Width::Narrow } else { Width::Wide }) {
                Measured::Done(step) => return step,
                Measured::Within(bound) => distance = Some(bound),
            }
        }
        // Nothing could be said: halve, down to the last representable width.
        let is_hopeless = is_last || narrow && width <= GIVE_UP * self.resolution;
        if !is_hopeless {
            return self.halve(piece);
        }
        match distance.filter(|bound| bound.is_finite()) {
            Some(bound) => found(piece, Evidence::Unresolved, bound),
            // Not even how far apart they are.
            None => Step::Answer(FirstRoot::Undecided { clear_until: piece.lo }),
        }
    }

    /// The left half next, the right one waits.
    #[inline(always)]
    fn halve(&mut self, piece: Piece) -> Step {
        let mid = piece.mid();
        self.rest.push(Piece { lo: mid, ..piece });
        Step::Go(Piece { hi: mid, ..piece })
    }

    /// At the start of the window: contact there, or what is left of the piece.
    #[inline(always)]
    fn measure_start(&mut self, piece: Piece) -> Step {
        self.start_is_known = true;
        self.evaluations += 1;
        let at_start = self.test.measure(piece, piece.lo);
        if at_start.distance <= self.tolerance {
            let bracket = Piece { lo: piece.lo, hi: piece.lo };
            found(bracket, Evidence::WithinTolerance, at_start.distance)
        } else if at_start.clear_hi >= piece.hi {
            Step::Clear
        } else if at_start.clear_hi > piece.lo {
            Step::Go(Piece { lo: at_start.clear_hi, ..piece })
        } else {
            // Also where it is no number.
            Step::Go(piece)
        }
    }

    /// In the middle of a piece: contact to its left or there, or a part around it that is clear.
    #[inline(always)]
    fn measure_middle(&mut self, piece: Piece, width: Width) -> Measured {
        let mid = piece.mid();
        self.evaluations += 1;
        let Measurement { distance, clear_lo, clear_hi } = self.test.measure(piece, mid);
        if distance <= self.tolerance {
            let bracket = Piece { hi: mid, ..piece };
            if let Width::Narrow = width {
                return Measured::Done(found(bracket, Evidence::WithinTolerance, distance));
            }
            self.seen = Some(Seen { time: mid, distance });
            self.rest.clear();
            return Measured::Done(Step::Go(bracket));
        }
        let (clear_lo, clear_hi) = (clear_lo.max(piece.lo), clear_hi.min(piece.hi));
        // What is no number is the end of the piece by now.
        if clear_lo >= clear_hi {
            return Measured::Within(distance);
        }
        let (left, right) = (Piece { hi: clear_lo, ..piece }, Piece { lo: clear_hi, ..piece });
        Measured::Done(match (piece.lo < clear_lo, clear_hi < piece.hi) {
            (false, false) => Step::Clear,
            (true, false) => Step::Go(left),
            (false, true) => Step::Go(right),
            (true, true) => {
                self.rest.push(right);
                Step::Go(left)
            }
        })
    }

    /// All pieces are clear.
    fn nothing_left(&self) -> FirstRoot {
        match self.seen {
            // All before the time seen is clear: the contact is there, within the tolerance.
            Some(Seen { time, distance }) => FirstRoot::Found {
                bracket: Piece { lo: time, hi: time },
                evidence: Evidence::WithinTolerance,
                distance,
            },
            None => FirstRoot::Clear,
        }
    }
}

const fn found(bracket: Piece, evidence: Evidence, distance: f64) -> Step {
    Step::Answer(FirstRoot::Found { bracket, evidence, distance })
}
