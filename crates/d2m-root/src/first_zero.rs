//! First zero of a user's own function, with a proof that it exists.

use crate::gamma::split_time;
use crate::{IntervalFunction, SearchLimits};
use d2m_interval::Interval;

/// A continuously differentiable function known through enclosures of itself and of its derivative.
pub trait Differentiable: IntervalFunction {
    /// Encloses f′ over all times of `t`.
    fn enclose_derivative(&mut self, t: Interval) -> Interval;
}

/// What is known of the zero in a bracket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ZeroEvidence {
    /// Exactly one: f′ has no zero where it was looked for, and f changes sign or interval Newton maps the piece into
    /// itself.
    Unique,
    /// At least one: f has certainly opposite signs at the ends of the bracket, or vanishes at one.
    SignChange,
    /// Perhaps none: the bracket is as narrow as asked, and f is too small there to be told from zero (a double root,
    /// a near miss, enclosures that do not shrink).
    Undecided,
}

/// Answer of [`first_zero`].
#[derive(Clone, Copy, Debug, PartialEq)]
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
/// slope where it is not.
///
/// Promise, if the enclosures keep theirs: f ≠ 0 in the domain left of the bracket, or of `clear_until`, or everywhere
/// for [`FirstZero::None`]; and what the evidence says. A simple zero that the enclosures can tell from its neighbours is
/// [`ZeroEvidence::Unique`], in a bracket as narrow as the rounding of f allows (which may be below or above
/// `limits.time_tolerance`).
///
/// ```text
/// f′ ≠ 0 on the piece [a, b]:  N = m − f(m)/f′([a, b])        every zero of the piece is in N
///                              N ∩ [a, b] = ∅                 there is none
///                              N ⊆ [a, b], or f(a)·f(b) < 0   there is exactly one
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
    let mut stack = vec![domain];
    let mut evaluations = 0;
    while let Some(piece) = stack.pop() {
        if evaluations >= limits.evaluations {
            return FirstZero::Undecided { clear_until: piece.lo() };
        }
        evaluations += 1;
        let part = match look_at(f, piece) {
            Look::Free => continue,
            Look::Unique(part) => {
                let bracket = narrowed(f, part);
                return FirstZero::Found { bracket, evidence: ZeroEvidence::Unique };
            }
            Look::Perhaps(part) => part,
        };
        let split = split_time(part).filter(|_| part.hi() - part.lo() > limits.time_tolerance);
        let Some(middle) = split else {
            let (first, last) = (f.enclose(part.lo().into()), f.enclose(part.hi().into()));
            let zero = |value: Interval| value.lo() == 0.0 && value.hi() == 0.0;
            let proven = opposite(first, last) || zero(first) || zero(last);
            let evidence = if proven { ZeroEvidence::SignChange } else { ZeroEvidence::Undecided };
            return FirstZero::Found { bracket: part, evidence };
        };
        if part.hi() - part.lo() <= 0.5 * (piece.hi() - piece.lo()) {
            stack.push(part);
        } else {
            stack.push(Interval::new(middle, part.hi()));
            stack.push(Interval::new(part.lo(), middle));
        }
    }
    FirstZero::None
}

/// What one look tells of a piece.
enum Look {
    /// No zero.
    Free,
    /// Exactly one zero in the piece, and it lies in the part.
    Unique(Interval),
    /// Every zero of the piece lies in the part.
    Perhaps(Interval),
}

fn opposite(a: Interval, b: Interval) -> bool {
    (a.certainly_positive() && b.certainly_negative()) || (a.certainly_negative() && b.certainly_positive())
}

fn look_at<F: Differentiable + ?Sized>(f: &mut F, piece: Interval) -> Look {
    let value = f.enclose(piece);
    if value.certainly_positive() || value.certainly_negative() {
        return Look::Free;
    }
    let slope = f.enclose_derivative(piece);
    let (first, last) = (f.enclose(piece.lo().into()), f.enclose(piece.hi().into()));
    if !(slope.certainly_positive() || slope.certainly_negative()) {
        return trimmed(piece, slope, first, last);
    }
    let same = |a: Interval, b: Interval| {
        (a.certainly_positive() && b.certainly_positive())
            || (a.certainly_negative() && b.certainly_negative())
    };
    if same(first, last) {
        return Look::Free;
    }
    let step = newton(f, piece, slope);
    let part = step.intersection(piece);
    if part.is_empty() {
        return Look::Free;
    }
    if opposite(first, last) || (piece.lo() <= step.lo() && step.hi() <= piece.hi()) {
        return Look::Unique(part);
    }
    Look::Perhaps(part)
}

/// m − f(m)/f′.
fn newton<F: Differentiable + ?Sized>(f: &mut F, piece: Interval, slope: Interval) -> Interval {
    let middle = Interval::point(split_time(piece).unwrap_or(piece.lo()));
    middle - f.enclose(middle) / slope
}

/// Cuts off both ends of a piece as far as the slope cannot bring f to zero.
fn trimmed(piece: Interval, slope: Interval, first: Interval, last: Interval) -> Look {
    // How long a value at one end stays away from 0: |value| over the fastest approach, rounded down; `None`: for good.
    let lasts = |value: Interval, steepest_fall: f64, steepest_rise: f64| {
        let (size, approach) = if value.certainly_positive() {
            (value.lo(), steepest_fall)
        } else if value.certainly_negative() {
            (-value.hi(), steepest_rise)
        } else {
            return Some(0.0);
        };
        let time = (Interval::point(size) / Interval::point(approach)).lo();
        if approach <= 0.0 { None } else { Some(if time > 0.0 { time } else { 0.0 }) }
    };
    let (fall, rise) = (-slope.lo(), slope.hi());
    let (Some(from), Some(to)) = (lasts(first, fall, rise), lasts(last, rise, fall)) else {
        return Look::Free;
    };
    let lo = (Interval::point(piece.lo()) + from).lo();
    let hi = (Interval::point(piece.hi()) - to).hi();
    if lo > piece.hi() || hi < piece.lo() || lo > hi {
        return Look::Free;
    }
    // What is not a number cuts nothing.
    let lo = if lo > piece.lo() { lo } else { piece.lo() };
    let hi = if hi < piece.hi() { hi } else { piece.hi() };
    Look::Perhaps(Interval::new(lo, hi))
}

/// Newton steps on a piece with exactly one zero, until it shrinks no more.
fn narrowed<F: Differentiable + ?Sized>(f: &mut F, mut part: Interval) -> Interval {
    for _ in 0..64 {
        let width = part.hi() - part.lo();
        let slope = f.enclose_derivative(part);
        if !(slope.certainly_positive() || slope.certainly_negative()) {
            break;
        }
        let next = newton(f, part, slope).intersection(part);
        if next.is_empty() {
            break;
        }
        part = next;
        let shrunk = part.hi() - part.lo();
        if shrunk <= 0.0 || shrunk > 0.75 * width {
            break;
        }
    }
    part
}
