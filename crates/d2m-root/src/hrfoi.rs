//! Hybrid-Root-Finder-On-Intervals, Algorithm 2 of the paper.

use crate::gamma::{excludes_zero, report, split_time};
use crate::{Gamma, RootSearch, SearchLimits, SecondOrder, Settled, intersect_root_domain};
use d2m_interval::Interval;

/// Finds the first bracket of width `limits.time_tolerance` in which f may be 0 and Γ may hold, shortening each piece
/// by its second-order inclusion function first.
///
/// Promise: no contact left of the bracket, or of `clear_until`, or anywhere in `domain` for [`RootSearch::None`].
///
/// ```text
/// [t0 ─────────────────────────────── t1]   a piece
///        l ──── u                           IRD: f ≠ 0 on [t0, l)
///        l ─ m ─ u   then   u ────── t1     both halves first, and then what lies behind u
/// ```
///
/// Deviations from the text, each because the text loses contacts or does not end:
/// - What lies behind u is searched if the root in \[l, u\] fails Γ (the paper returns ∅ there).
/// - ½ enters θ once.
/// - A value at t0 that holds 0, and f ≡ 0, keep the piece (see [`intersect_root_domain`]).
/// - A piece in which no double lies is reported as it is.
/// - A piece that shrank below half is not bisected as well: shortening converges cubically, bisection linearly.
/// - Where the range of θ is not bounded f may have a pole: such a piece is halved, whatever its parabolas say.
/// - [`Gamma::settle`] may decide a piece that would not shrink (grazing, coplanar and parallel features). A time that
///   is certainly within the tolerance ends the search to its right; if all before it is then excluded, it is itself
///   the bracket.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{Gamma, InclusionFunction, IntervalFunction, RootSearch, SearchLimits, SecondOrder, hrfoi};
/// struct Cosine;
/// impl IntervalFunction for Cosine {
///     fn enclose(&mut self, t: Interval) -> Interval { t.cos() }
/// }
/// impl SecondOrder for Cosine {
///     fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
///         let start = Interval::point(t.lo());
///         InclusionFunction::new(start.cos(), -start.sin(), -t.cos(), t)
///     }
/// }
/// impl Gamma for Cosine {
///     fn may_touch(&mut self, t: Interval) -> bool { t.hi() >= 2.0 } // the root π/2 is not a contact
/// }
/// let found = hrfoi(&mut Cosine, Interval::new(0.0, 8.0), SearchLimits::new(1e-12));
/// let RootSearch::Bracket(b) = found else { panic!("the second root was lost") };
/// assert!((b.mid() - 1.5 * std::f64::consts::PI).abs() < 1e-12);
/// ```
#[doc(alias = "HRFOI")]
pub fn hrfoi<F>(f: &mut F, domain: Interval, limits: SearchLimits) -> RootSearch
where
    F: SecondOrder + Gamma + ?Sized,
{
    if domain.is_empty() {
        return RootSearch::None;
    }
    let mut stack = vec![domain];
    let mut evaluations = 0;
    let mut near = None;
    while let Some(piece) = stack.pop() {
        if evaluations >= limits.evaluations {
            return RootSearch::Undecided { clear_until: piece.lo() };
        }
        evaluations += 1;
        if !f.may_touch(piece) {
            continue;
        }
        let theta = f.inclusion_function(piece);
        let part = if theta.range().is_bounded() {
            let Some(part) = intersect_root_domain(&theta) else { continue };
            part
        } else {
            // Where θ overflows, the piece has no start, or f may have a pole, of which parabolas know nothing, f itself may
            // be certainly not zero.
            if excludes_zero(f.enclose(piece)) {
                continue;
            }
            piece
        };
        if part.hi() < piece.hi() {
            stack.push(Interval::new(part.hi(), piece.hi()));
        }
        let width = part.width();
        let Some(middle) = split_time(part).filter(|_| width > limits.time_tolerance) else {
            if let Some(found) = report(f, part) {
                return found;
            }
            continue;
        };
        // (An unbounded piece that stays unbounded has not shrunk.)
        if width <= 0.5 * piece.width() && width < f64::INFINITY {
            stack.push(part);
            continue;
        }
        match f.settle(part) {
            Settled::Excluded => {}
            Settled::Near(at) if part.lo() <= at && at < part.hi() => {
                // Later times no longer matter; what lies before `at` may still hold the first contact.
                near = Some(at);
                stack.clear();
                stack.push(Interval::new(part.lo(), at));
                split_top(&mut stack);
            }
            Settled::Near(_) | Settled::Open => {
                stack.push(Interval::new(middle, part.hi()));
                stack.push(Interval::new(part.lo(), middle));
            }
        }
    }
    near.map_or(RootSearch::None, |at| RootSearch::Bracket(Interval::point(at)))
}

/// Halves the top of the stack, so that the next round makes progress whatever the function says.
fn split_top(stack: &mut Vec<Interval>) {
    if let Some(top) = stack.pop() {
        if let Some(middle) = split_time(top) {
            stack.push(Interval::new(middle, top.hi()));
            stack.push(Interval::new(top.lo(), middle));
        } else {
            stack.push(top);
        }
    }
}
