//! Binary-Bisection-On-Intervals, Algorithm 1 of the paper.

use crate::gamma::{excludes_zero, report, split_time};
use crate::{Gamma, IntervalFunction, RootSearch, SearchLimits};
use d2m_interval::Interval;

/// Finds the first bracket of width `limits.time_tolerance` in which f may be 0 and Γ may hold, by bisection alone.
///
/// Everything left of the bracket is certainly free of contact. The paper's recursion is a loop over a stack of
/// pieces here, leftmost first; a piece in which no double lies is reported as it is (the paper: "(t0+t1)/2 could
/// evaluate to t0"), and a budget ends what would take too long. An unbounded domain is split by the number of doubles on
/// either side; a bracket that reaches to infinity begins at the last double. An empty domain has no contact.
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
/// let RootSearch::Bracket(b) = bboi(&mut Falling, Interval::new(0.0, 3.0), SearchLimits::new(1e-9)) else { panic!() };
/// assert!(b.contains(1.0) && b.width() <= 1e-9);
/// ```
#[doc(alias = "BBOI")]
pub fn bboi<F>(f: &mut F, domain: Interval, limits: SearchLimits) -> RootSearch
where
    F: IntervalFunction + Gamma + ?Sized,
{
    if domain.is_empty() {
        return RootSearch::None;
    }
    let mut stack = vec![domain];
    let mut evaluations = 0;
    while let Some(piece) = stack.pop() {
        if evaluations >= limits.evaluations {
            return RootSearch::Undecided { clear_until: piece.lo() };
        }
        evaluations += 1;
        if excludes_zero(f.enclose(piece)) || !f.may_touch(piece) {
            continue;
        }
        match split_time(piece) {
            Some(middle) if piece.width() > limits.time_tolerance => {
                stack.push(Interval::new(middle, piece.hi()));
                stack.push(Interval::new(piece.lo(), middle));
            }
            _ => {
                if let Some(found) = report(f, piece) {
                    return found;
                }
            }
        }
    }
    RootSearch::None
}
