//! First zero of a user's own function, with a proof that it exists.

use crate::gamma::{excludes_zero, known, split_time};
use crate::{IntervalFunction, SearchLimits};
use d2m_interval::Interval;

/// A function known through enclosures of itself and of its derivative: continuously differentiable over every interval
/// for which the enclosure of its value or that of its derivative is bounded.
///
/// Over any other interval it may have poles (`tan t`, `1/t`); there no slope is used. A jump that no enclosure shows, as of
/// `atan(1/t)` at 0, breaks this contract.
///
/// An empty enclosure (`√t` for t < 0) says that the function is not defined there. It proves nothing: [`first_zero`]
/// takes it for "unknown".
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Differentiable, FirstZero, IntervalFunction, SearchLimits, first_zero};
/// /// t² − 2.
/// struct Square;
/// impl IntervalFunction for Square {
///     fn enclose(&mut self, t: Interval) -> Interval { t.sqr() - 2.0 }
/// }
/// impl Differentiable for Square {
///     fn enclose_derivative(&mut self, t: Interval) -> Interval { t * 2.0 }
/// }
/// let found = first_zero(&mut Square, Interval::new(0.0, 9.0), SearchLimits::new(1e-12));
/// assert!(matches!(found, FirstZero::Found { bracket, .. } if bracket.contains(2f64.sqrt())));
/// ```
pub trait Differentiable: IntervalFunction {
    /// Encloses f′ over all times of `t`.
    fn enclose_derivative(&mut self, t: Interval) -> Interval;
}

/// Two closures as one function: f, and its derivative.
struct Pair<F, D> {
    f: F,
    derivative: D,
}

impl<F: FnMut(Interval) -> Interval, D> IntervalFunction for Pair<F, D> {
    fn enclose(&mut self, t: Interval) -> Interval {
        (self.f)(t)
    }
}

impl<F, D> Differentiable for Pair<F, D>
where
    F: FnMut(Interval) -> Interval,
    D: FnMut(Interval) -> Interval,
{
    fn enclose_derivative(&mut self, t: Interval) -> Interval {
        (self.derivative)(t)
    }
}

/// [`first_zero`] of a closure and of its derivative.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{FirstZero, SearchLimits, first_zero_of};
/// let range = Interval::new(0.0, 10.0);
/// let found = first_zero_of(|t| t.cos() - t * 0.25, |t| -t.sin() - 0.25, range, SearchLimits::new(1e-12));
/// let FirstZero::Found { bracket, .. } = found else { panic!("{found:?}") };
/// assert!(bracket.contains(1.252_353_234_002_588_8));
/// ```
pub fn first_zero_of(
    f: impl FnMut(Interval) -> Interval,
    derivative: impl FnMut(Interval) -> Interval,
    domain: Interval,
    limits: SearchLimits,
) -> FirstZero {
    first_zero(&mut Pair { f, derivative }, domain, limits)
}

/// What is known of the zero in a bracket.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{FirstZero, SearchLimits, ZeroEvidence, first_zero_of};
/// let evidence = |shift: f64| {
///     let f = move |t: Interval| (t - 1.0).sqr() - shift;
///     match first_zero_of(f, |t| (t - 1.0) * 2.0, Interval::new(0.0, 2.0), SearchLimits::new(1e-9)) {
///         FirstZero::Found { evidence, .. } => evidence,
///         other => panic!("{other:?}"),
///     }
/// };
/// assert_eq!(evidence(0.25), ZeroEvidence::Unique); // crosses zero at 0.5
/// assert_eq!(evidence(0.0), ZeroEvidence::Undecided); // touches it at 1: signs do not distinguish a double root from a near miss
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ZeroEvidence {
    /// Exactly one: on a bounded piece around the bracket f′ has no zero, and f changes sign or interval Newton maps the
    /// piece into itself.
    Unique,
    /// At least one: f is bounded over the bracket and has certainly opposite signs at its ends, or vanishes at one.
    SignChange,
    /// Perhaps none: the bracket is as narrow as requested, and f is too small there to be distinguished from zero (a double
    /// root, a near miss, enclosures that do not shrink), or it is not defined there.
    Undecided,
}

/// Answer of [`first_zero`].
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{FirstZero, SearchLimits, first_zero_of};
/// let domain = Interval::new(0.0, 1.0);
/// // cos t has no zero in [0, 1]: proven.
/// assert_eq!(first_zero_of(|t| t.cos(), |t| -t.sin(), domain, SearchLimits::new(1e-9)), FirstZero::None);
/// // With one evaluation little is proven, and that is said.
/// let few = SearchLimits::new(1e-9).with_evaluations(1);
/// let FirstZero::Undecided { clear_until } = first_zero_of(|t| t.sqr() - 0.25, |t| t * 2.0, domain, few)
///     else { panic!("one evaluation is too few") };
/// assert!(clear_until <= 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum FirstZero {
    /// f ≠ 0 in all of the domain.
    None,
    /// f ≠ 0 in the domain before the bracket.
    Found {
        /// Where.
        bracket: Interval,
        /// What is known of it.
        evidence: ZeroEvidence,
    },
    /// The budget ran out; f ≠ 0 before this time.
    Undecided {
        /// The end of what was searched.
        clear_until: f64,
    },
}

/// Finds the first zero of f in a domain: from the left, by interval Newton where f is monotone, by the bound of its
/// slope where it is not, and by its values alone where it may have a pole.
///
/// Promise, if the enclosures keep theirs: f ≠ 0 in the domain left of the bracket, or of `clear_until`, or everywhere
/// for [`FirstZero::None`]; and what the evidence says. A simple zero that the enclosures can distinguish from its neighbors is
/// [`ZeroEvidence::Unique`], in a bracket as narrow as the rounding of f allows (which may be below
/// `limits.time_tolerance`, and is above it only where f cannot be distinguished from zero at any time that would cut it).
///
/// The domain may be unbounded: pieces that reach to infinity are cut where half of the doubles lie on either side. Where
/// f cannot be distinguished from zero beyond the largest double, the bracket is `[MAX, ∞]` (or `[−∞, −MAX]`) with
/// [`ZeroEvidence::Undecided`]. An empty domain has no zeros.
///
/// ```text
/// f′ ≠ 0 on the piece [a, b]:  N = m − f(m)/f′([a, b])        every zero of the piece is in N
///                              N ∩ [a, b] = ∅                 there is none
///                              N ⊆ [a, b], or f(a)·f(b) < 0   there is exactly one (a, b finite, f defined at both)
/// f′ may vanish:               f(a) > 0  ⇒  none before a + f(a)/max(−f′); the same from b
/// ```
///
/// It is the loop of [`bboi`](crate::bboi) with these steps before a piece is halved. Differences to its relatives in
/// this crate: [`hrfoi`](crate::hrfoi) needs f″ and a validation Γ and proves no existence; [`isolate`](crate::isolate) is
/// for contacts with a distance.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Differentiable, FirstZero, IntervalFunction, SearchLimits, ZeroEvidence, first_zero};
/// /// cos t − t/4: zeros at 1.252…, and two more to the left of 0.
/// struct Wave;
/// impl IntervalFunction for Wave {
///     fn enclose(&mut self, t: Interval) -> Interval { t.cos() - t * 0.25 }
/// }
/// impl Differentiable for Wave {
///     fn enclose_derivative(&mut self, t: Interval) -> Interval { -t.sin() - 0.25 }
/// }
/// let found = first_zero(&mut Wave, Interval::new(0.0, 10.0), SearchLimits::new(1e-12));
/// let FirstZero::Found { bracket, evidence } = found else { panic!("{found:?}") };
/// assert_eq!(evidence, ZeroEvidence::Unique);
/// assert!((bracket.mid() - 1.252_353_234_002_589).abs() < 1e-14 && bracket.width() < 1e-14);
/// // To the right of it there is none, and that is proven.
/// let rest = first_zero(&mut Wave, Interval::new(1.3, 10.0), SearchLimits::new(1e-12));
/// assert_eq!(rest, FirstZero::None);
/// ```
///
/// Source: interval Newton with existence by R. E. Moore, *Interval Analysis* (1966), and K. Nickel, "On the Newton
/// method in interval analysis" (1971).
#[doc(alias = "interval Newton")]
pub fn first_zero<F>(f: &mut F, domain: Interval, limits: SearchLimits) -> FirstZero
where
    F: Differentiable + ?Sized,
{
    if domain.is_empty() {
        return FirstZero::None;
    }
    let mut stack = vec![domain];
    let mut evaluations = 0;
    while let Some(piece) = stack.pop() {
        if evaluations >= limits.evaluations {
            return FirstZero::Undecided { clear_until: piece.lo() };
        }
        evaluations += 1;
        let part = match examine(f, piece) {
            Examined::Free => continue,
            Examined::Unique { part, trend } => {
                let bracket = narrowed(f, part, trend, limits.time_tolerance);
                return FirstZero::Found { bracket, evidence: ZeroEvidence::Unique };
            }
            Examined::Perhaps(part) => part,
        };
        if part.width() < SHRUNK * piece.width() {
            stack.push(part);
            continue;
        }
        let split = split_time(part).filter(|_| part.width() > limits.time_tolerance);
        let Some(middle) = split else {
            let (first, last) = (value_at(f, part.lo()), value_at(f, part.hi()));
            let zero = |value: Interval| value.lo() == 0.0 && value.hi() == 0.0;
            // Signs change at poles too.
            let crosses = opposite(first, last) && known(f.enclose(part)).is_bounded();
            let proven = crosses || zero(first) || zero(last);
            let evidence = if proven { ZeroEvidence::SignChange } else { ZeroEvidence::Undecided };
            return FirstZero::Found { bracket: part, evidence };
        };
        stack.push(Interval::new(middle, part.hi()));
        stack.push(Interval::new(part.lo(), middle));
    }
    FirstZero::None
}

/// A piece that shrank below this part of its width is examined again before it is halved.
const SHRUNK: f64 = 0.5;

/// Which way a strictly monotone function goes.
#[derive(Clone, Copy, PartialEq)]
enum Trend {
    Rising,
    Falling,
}

/// What is known of a piece after one examination.
enum Examined {
    /// No zero.
    Free,
    /// Exactly one zero in the piece, and it lies in the part, where f is strictly monotone.
    Unique { part: Interval, trend: Trend },
    /// Every zero of the piece lies in the part.
    Perhaps(Interval),
}

/// f at one time; entire where there is none, or f is not defined.
fn value_at<F: Differentiable + ?Sized>(f: &mut F, t: f64) -> Interval {
    if t.is_finite() { known(f.enclose(Interval::point(t))) } else { Interval::ENTIRE }
}

fn opposite(a: Interval, b: Interval) -> bool {
    (a.certainly_positive() && b.certainly_negative()) || (a.certainly_negative() && b.certainly_positive())
}

fn examine<F: Differentiable + ?Sized>(f: &mut F, piece: Interval) -> Examined {
    let value = known(f.enclose(piece));
    if excludes_zero(value) {
        return Examined::Free;
    }
    let slope = known(f.enclose_derivative(piece));
    // A slope says nothing across a pole.
    if !value.is_bounded() && !slope.is_bounded() {
        return Examined::Perhaps(piece);
    }
    let (first, last) = (value_at(f, piece.lo()), value_at(f, piece.hi()));
    if !excludes_zero(slope) {
        return trimmed(piece, slope, first, last);
    }
    let same = |a: Interval, b: Interval| {
        (a.certainly_positive() && b.certainly_positive())
            || (a.certainly_negative() && b.certainly_negative())
    };
    if same(first, last) {
        return Examined::Free;
    }
    let step = newton(f, piece, slope);
    let part = step.intersection(piece);
    if part.is_empty() {
        return Examined::Free;
    }
    // Existence needs f to be defined on the whole piece, of which its ends are witnesses, and a step that is bounded: a
    // value of which nothing is known "maps" the whole line into itself.
    let defined = piece.is_bounded() && step.is_bounded() && !first.is_entire() && !last.is_entire();
    if opposite(first, last) || (defined && step.is_subset(piece)) {
        return Examined::Unique {
            part,
            trend: if slope.certainly_positive() { Trend::Rising } else { Trend::Falling },
        };
    }
    Examined::Perhaps(part)
}

/// m − f(m)/f′, with every zero of the piece in it.
fn newton<F: Differentiable + ?Sized>(f: &mut F, piece: Interval, slope: Interval) -> Interval {
    let middle = split_time(piece).unwrap_or(if piece.lo().is_finite() { piece.lo() } else { piece.hi() });
    known(Interval::point(middle) - value_at(f, middle) / slope)
}

/// How long a value stays away from zero, bounded from below.
enum Lasts {
    /// At no time of the piece can it come to zero.
    ForGood,
    /// Not before this time has passed.
    For(f64),
}

/// |value| over the fastest approach.
fn lasts(value: Interval, steepest_fall: f64, steepest_rise: f64) -> Lasts {
    let (size, approach) = if value.certainly_positive() {
        (value.lo(), steepest_fall)
    } else if value.certainly_negative() {
        (-value.hi(), steepest_rise)
    } else {
        return Lasts::For(0.0);
    };
    if approach <= 0.0 {
        return Lasts::ForGood;
    }
    let time = (Interval::point(size) / Interval::point(approach)).lo();
    Lasts::For(if time > 0.0 { time } else { 0.0 })
}

/// Cuts off both ends of a piece as far as the slope cannot bring f to zero. No enclosure is empty.
fn trimmed(piece: Interval, slope: Interval, first: Interval, last: Interval) -> Examined {
    let (fall, rise) = (-slope.lo(), slope.hi());
    let (Lasts::For(from), Lasts::For(to)) = (lasts(first, fall, rise), lasts(last, rise, fall)) else {
        return Examined::Free;
    };
    let lo = (Interval::point(piece.lo()) + from).lo();
    let hi = (Interval::point(piece.hi()) - to).hi();
    if lo > piece.hi() || hi < piece.lo() || lo > hi {
        return Examined::Free;
    }
    Examined::Perhaps(Interval::new(lo.max(piece.lo()), hi.min(piece.hi())))
}

/// Steps of [`narrowed`] at most: more than the doubles between any two can be halved, and a few Newton steps for each.
const NARROWING_STEPS: u32 = 1024;
/// A Newton step that leaves more than this of the width is followed by a cut at a time where the sign is certain.
const PAYS: f64 = 0.75;

/// Shrinks a piece with exactly one zero, on which f is strictly monotone: by Newton steps as long as they pay, below the
/// tolerance too, and by the sign of f at times inside until the tolerance is reached or no sign is certain.
fn narrowed<F: Differentiable + ?Sized>(
    f: &mut F,
    mut part: Interval,
    trend: Trend,
    tolerance: f64,
) -> Interval {
    for _ in 0..NARROWING_STEPS {
        let width = part.width();
        let slope = known(f.enclose_derivative(part));
        if excludes_zero(slope) {
            let next = newton(f, part, slope).intersection(part);
            if !next.is_empty() {
                part = next;
            }
        }
        if part.width() <= PAYS * width && part.width() > 0.0 {
            continue;
        }
        if part.width() <= tolerance {
            break;
        }
        let Some(cut) = cut_by_sign(f, part, trend) else { break };
        part = cut;
    }
    part
}

/// The side of a time inside the part on which the zero lies, for the first such time at which f has a certain sign.
fn cut_by_sign<F: Differentiable + ?Sized>(f: &mut F, part: Interval, trend: Trend) -> Option<Interval> {
    let middle = split_time(part)?;
    let (left, right) = (Interval::new(part.lo(), middle), Interval::new(middle, part.hi()));
    for time in [Some(middle), split_time(left), split_time(right)].into_iter().flatten() {
        let value = value_at(f, time);
        if excludes_zero(value) {
            return Some(if value.certainly_negative() == (trend == Trend::Rising) {
                Interval::new(time, part.hi())
            } else {
                Interval::new(part.lo(), time)
            });
        }
    }
    None
}
