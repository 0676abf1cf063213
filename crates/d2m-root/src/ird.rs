//! Intersect-Root-Domain, Algorithm 3 of the paper.

use crate::{InclusionFunction, Parabola};
use d2m_interval::Interval;

/// A piece that may begin at a zero is cut at this many times the time at which f has certainly left it, and this part of
/// the piece later: far enough behind for the sign to be certain there. Any cut is sound.
const BEHIND_LEAVING: f64 = 4.0;
const PART_OF_PIECE: f64 = 1.0 / 1024.0;

/// Shortens the domain of `function` to the part in which its first root can lie; `None` promises f ≠ 0 throughout.
///
/// The result \[l, u\] promises f ≠ 0 on \[t0, l). It promises *nothing* about (u, t1\]: where u < t1, a root in
/// \[l, u\] is very likely, but it may be one that Γ refuses, and a later root may be the contact. A search therefore
/// goes on behind u (see [`hrfoi`](crate::hrfoi)).
///
/// Two repairs of the paper's text. The sign of f at t0 is read from an interval: where that holds 0 the flip of
/// line 1 is undefined, and the bracket starts at t0. And a horizontal piece (f ≡ 0) is kept, not discarded.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::{InclusionFunction, intersect_root_domain};
/// // 1 − t² known with f″ ∈ [−3, −1] on [0, 4]
/// let f = InclusionFunction::new(
///     Interval::point(1.0), Interval::point(0.0), Interval::new(-3.0, -1.0), Interval::new(0.0, 4.0));
/// let part = intersect_root_domain(&f).unwrap();
/// assert!(part.lo() <= (2.0f64 / 3.0).sqrt() && part.hi() >= 2.0f64.sqrt());
/// assert!(part.width() < 0.6);
/// ```
#[doc(alias = "IRD")]
pub fn intersect_root_domain(function: &InclusionFunction) -> Option<Interval> {
    let domain = function.domain();
    if domain.is_empty() {
        return None;
    }
    let value = function.value();
    if value.certainly_negative() {
        return intersect_root_domain(&function.negated());
    }
    let width = function.offsets().hi();
    if value.certainly_positive() {
        let lower = function.lower().first_nonpositive()?;
        if lower.lo() > width {
            return None;
        }
        let lo = time(domain, lower.lo()).lo().clamp(domain.lo(), domain.hi());
        return Some(Interval::new(lo, end_of_crossing(domain, function.upper()).max(lo)));
    }
    // The value holds 0 (or is undefined): a root may be at t0. Where the slope has a certain sign, f leaves zero soon;
    // cut well behind that time, so that the rest starts with a certain sign. Any cut is sound.
    let leaving = if function.slope().certainly_negative() {
        function.upper()
    } else if function.slope().certainly_positive() {
        function.lower().negated()
    } else {
        return Some(domain);
    };
    let cut = match leaving.first_nonpositive() {
        Some(x) => time(domain, BEHIND_LEAVING * x.hi() + PART_OF_PIECE * width).hi().min(domain.hi()),
        None => domain.hi(),
    };
    Some(Interval::new(domain.lo(), if cut > domain.lo() { cut } else { domain.hi() }))
}

/// The time at which `upper`, a bound of f from above, has come down to zero; the end of the domain if it does not,
/// or if that is no progress from t0.
fn end_of_crossing(domain: Interval, upper: Parabola) -> f64 {
    let end = match upper.first_nonpositive() {
        Some(x) if x.hi() < f64::INFINITY => time(domain, x.hi()).hi().min(domain.hi()),
        _ => domain.hi(),
    };
    if end > domain.lo() { end } else { domain.hi() }
}

fn time(domain: Interval, x: f64) -> Interval {
    Interval::point(domain.lo()) + x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn theta(value: (f64, f64), slope: f64, second: (f64, f64), domain: (f64, f64)) -> InclusionFunction {
        InclusionFunction::new(
            Interval::new(value.0, value.1),
            Interval::point(slope),
            Interval::new(second.0, second.1),
            Interval::new(domain.0, domain.1),
        )
    }

    /// Erratum 3. f(t) = (t − t0)·1 with f(t0) known as [−1e-16, 1e-16]. The literal test "I(t0) < 0" reads one of
    /// the ends; with the upper end it finds the piece positive and rising and reports "no root".
    #[test]
    fn a_value_that_holds_zero_starts_the_bracket_at_t0() {
        let f = theta((-1e-16, 1e-16), 1.0, (0.0, 0.0), (0.0, 1.0));
        let part = intersect_root_domain(&f).expect("the root at t0");
        assert_eq!(part.lo(), 0.0);
        assert!(part.hi() < 1e-2, "and it is left as soon as the sign is certain: {part:?}");
        // The literal algorithm, sign taken from the upper end: rising from a positive value, no root.
        assert!(Parabola::new(1e-16, 1.0, 0.0).first_nonpositive().is_none());
    }

    /// Empty enclosures: nothing is known. (Each of them has both signs, and the sign was flipped without end.)
    #[test]
    fn empty_enclosures_prove_nothing() {
        let (domain, point) = (Interval::new(0.0, 1.0), Interval::point);
        for (value, slope, second) in [
            (Interval::EMPTY, point(1.0), point(0.0)),
            (point(1.0), Interval::EMPTY, point(0.0)),
            (point(1.0), point(1.0), Interval::EMPTY),
        ] {
            let part = intersect_root_domain(&InclusionFunction::new(value, slope, second, domain));
            assert_eq!(part.map(d2m_interval::Interval::hi), Some(1.0), "{value:?} {slope:?} {second:?}");
        }
        let f = InclusionFunction::new(point(1.0), point(-1.0), point(0.0), Interval::EMPTY);
        assert_eq!(intersect_root_domain(&f), None);
        assert_eq!(f.nonpositive_hull(Interval::EMPTY), None);
    }

    /// Erratum 4, first half: f ≡ 0 keeps its domain instead of being discarded.
    #[test]
    fn a_horizontal_piece_is_kept() {
        let f = theta((0.0, 0.0), 0.0, (0.0, 0.0), (2.0, 3.0));
        assert_eq!(intersect_root_domain(&f).map(|p| (p.lo(), p.hi())), Some((2.0, 3.0)));
    }

    #[test]
    fn sign_is_irrelevant() {
        let f = theta((1.0, 1.0), -2.0, (-0.5, 0.5), (0.0, 3.0));
        let p = intersect_root_domain(&f).unwrap();
        let q = intersect_root_domain(&f.negated()).unwrap();
        assert_eq!((p.lo(), p.hi()), (q.lo(), q.hi()));
        assert!(p.lo() > 0.4 && p.hi() < 0.6);
    }

    #[test]
    fn no_root_within_the_domain() {
        assert!(intersect_root_domain(&theta((1.0, 1.0), -0.25, (0.0, 0.0), (0.0, 3.0))).is_none());
        assert!(intersect_root_domain(&theta((-1.0, -1.0), 0.25, (0.0, 0.0), (0.0, 3.0))).is_none());
        let at_the_end = intersect_root_domain(&theta((1.0, 1.0), -0.25, (0.0, 0.0), (0.0, 4.0)));
        assert!(at_the_end.is_some_and(|p| p.contains(4.0)), "a root at the very end counts");
    }
}
