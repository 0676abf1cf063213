//! What the paper's root searches need of a function: values, derivatives and Γ.

use crate::InclusionFunction;
use d2m_interval::Interval;

/// A real function of time known through enclosures.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::IntervalFunction;
/// let mut parabola = |t: Interval| t.sqr() - 2.0; // a closure is a function
/// assert!(parabola.enclose(Interval::new(0.0, 1.0)).contains(-1.5));
/// ```
pub trait IntervalFunction {
    /// Encloses f over all times of `t`. An empty result ("not defined") proves nothing: searches take it for unknown.
    fn enclose(&mut self, t: Interval) -> Interval;
}

/// A closure is a function: `|t| t.cos() - t * 0.25`.
impl<F: FnMut(Interval) -> Interval> IntervalFunction for F {
    fn enclose(&mut self, t: Interval) -> Interval {
        self(t)
    }
}

/// A function whose value, slope and second derivative can be enclosed: of class C² over every interval for which the
/// [range](InclusionFunction::range) of its inclusion function is bounded; over others it may have poles.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{InclusionFunction, IntervalFunction, SecondOrder};
/// /// t² − 1.
/// struct Square;
/// impl IntervalFunction for Square {
///     fn enclose(&mut self, t: Interval) -> Interval { t * t - 1.0 }
/// }
/// impl SecondOrder for Square {
///     fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
///         let start = Interval::point(t.lo());
///         InclusionFunction::new(start * start - 1.0, start * 2.0, Interval::point(2.0), t)
///     }
/// }
/// let piece = Interval::new(0.0, 2.0);
/// assert!(Square.inclusion_function(piece).enclose_at_offset(Interval::point(1.0)).contains(0.0));
/// ```
pub trait SecondOrder: IntervalFunction {
    /// θ of f over the piece `t`: see [`InclusionFunction`].
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction;
}

/// Γ, the validation of roots: not every root of f is a contact.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Gamma, IntervalFunction, RootSearch, SearchLimits, bboi};
/// /// 1 − t², which counts after t = 2 only.
/// struct Late;
/// impl IntervalFunction for Late {
///     fn enclose(&mut self, t: Interval) -> Interval { 1.0 - t * t }
/// }
/// impl Gamma for Late {
///     fn may_touch(&mut self, t: Interval) -> bool { t.hi() >= 2.0 }
/// }
/// // The root at 1 is no contact.
/// assert_eq!(bboi(&mut Late, Interval::new(0.0, 3.0), SearchLimits::new(1e-6)), RootSearch::None);
/// ```
pub trait Gamma {
    /// `false` promises that no time in `t` is a contact; `true` promises nothing.
    fn may_touch(&mut self, t: Interval) -> bool;

    /// A more expensive test of a piece that would not shrink. The default decides nothing.
    fn settle(&mut self, t: Interval) -> Settled {
        let _ = t;
        Settled::Open
    }
}

/// Answer of [`Gamma::settle`].
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Gamma, IntervalFunction, Settled};
/// /// t, which is within a thousandth of a contact where it is below that.
/// struct Approach;
/// impl IntervalFunction for Approach {
///     fn enclose(&mut self, t: Interval) -> Interval { t }
/// }
/// impl Gamma for Approach {
///     fn may_touch(&mut self, _t: Interval) -> bool { true }
///     fn settle(&mut self, t: Interval) -> Settled {
///         if t.lo() <= 1e-3 { Settled::Near(t.lo()) } else { Settled::Open }
///     }
/// }
/// assert_eq!(Approach.settle(Interval::new(0.0, 1.0)), Settled::Near(0.0));
/// assert_eq!(Approach.settle(Interval::new(0.5, 1.0)), Settled::Open);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Settled {
    /// No time of the piece is a contact.
    Excluded,
    /// At this time of the piece the features are certainly within the tolerance of a contact. Later times no longer
    /// matter.
    Near(f64),
    /// Not decided.
    Open,
}

/// Where a search stops.
///
/// ```
/// let limits = d2m_root::SearchLimits::new(1e-9).with_evaluations(1000);
/// assert_eq!((limits.time_tolerance, limits.evaluations), (1e-9, 1000)); // a time; pieces that may be evaluated
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct SearchLimits {
    /// ε_t: a bracket at most this wide is reported as it is (one that reaches to infinity never is).
    pub time_tolerance: f64,
    /// The most pieces that may be evaluated; then the answer is [`RootSearch::Undecided`].
    pub evaluations: u32,
}

impl SearchLimits {
    /// The default number of pieces. Hard families (fast rotation, 300 rad) need a few hundred to a few thousand.
    pub const DEFAULT_EVALUATIONS: u32 = 1 << 18;

    /// Stops at brackets of width `time_tolerance` (negative or NaN counts as 0), or after
    /// [`Self::DEFAULT_EVALUATIONS`] pieces.
    pub const fn new(time_tolerance: f64) -> Self {
        let time_tolerance = if time_tolerance > 0.0 { time_tolerance } else { 0.0 };
        Self { time_tolerance, evaluations: Self::DEFAULT_EVALUATIONS }
    }

    /// Replaces the number of pieces.
    pub const fn with_evaluations(mut self, evaluations: u32) -> Self {
        self.evaluations = evaluations;
        self
    }
}

/// Answer of [`bboi`](crate::bboi) and [`hrfoi`](crate::hrfoi).
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Gamma, IntervalFunction, RootSearch, SearchLimits, bboi};
/// struct Falling;
/// impl IntervalFunction for Falling {
///     fn enclose(&mut self, t: Interval) -> Interval { 1.0 - t * t }
/// }
/// impl Gamma for Falling {
///     fn may_touch(&mut self, _: Interval) -> bool { true }
/// }
/// let search = |end: f64| bboi(&mut Falling, Interval::new(0.0, end), SearchLimits::new(1e-9));
/// assert_eq!(search(0.5), RootSearch::None);
/// assert!(matches!(search(3.0), RootSearch::Bracket(bracket) if bracket.contains(1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RootSearch {
    /// No contact in the domain.
    None,
    /// No contact before the lower end; the first contact is believed to lie in the bracket.
    Bracket(Interval),
    /// The budget ran out. No contact before this time.
    Undecided {
        /// The end of what was searched.
        clear_until: f64,
    },
}

/// An empty enclosure says that a function is not defined, which proves nothing: entire instead.
pub(crate) fn known(enclosure: Interval) -> Interval {
    if enclosure.is_empty() { Interval::ENTIRE } else { enclosure }
}

/// True if the enclosure proves that its function does not vanish; an empty one proves nothing.
pub(crate) fn excludes_zero(enclosure: Interval) -> bool {
    let enclosure = known(enclosure);
    enclosure.certainly_positive() || enclosure.certainly_negative()
}

/// The middle of a piece, or `None` where no double lies strictly inside it. Of an unbounded piece, the double that
/// has half of the piece's doubles on either side.
///
/// The paper's (t0 + t1)/2 "could evaluate to t0", as it says itself; then its recursion never ends.
pub(crate) fn split_time(t: Interval) -> Option<f64> {
    let (a, b) = (t.lo(), t.hi());
    let middle = if t.is_bounded() { 0.5 * a + 0.5 * b } else { at_rank(i64::midpoint(rank(a), rank(b))) };
    (a < middle && middle < b).then_some(middle)
}

/// Doubles in order: 0 for 0, one more for each neighbour above.
fn rank(x: f64) -> i64 {
    let size = x.abs().to_bits().cast_signed();
    if x < 0.0 { -size } else { size }
}

fn at_rank(rank: i64) -> f64 {
    let size = f64::from_bits(rank.unsigned_abs());
    if rank < 0 { -size } else { size }
}

/// Handles a piece that is too narrow to split: the report, or `None` where the piece holds no contact.
pub(crate) fn report<F: Gamma + ?Sized>(f: &mut F, piece: Interval) -> Option<RootSearch> {
    if !f.may_touch(piece) {
        return None;
    }
    match f.settle(piece) {
        Settled::Excluded => None,
        Settled::Near(at) if at >= piece.lo() && at < piece.hi() => {
            Some(RootSearch::Bracket(Interval::new(piece.lo(), at)))
        }
        _ => Some(RootSearch::Bracket(piece)),
    }
}
