//! The second-order inclusion function θ of the paper (section IV-A).

use crate::Parabola;
use d2m_interval::Interval;

/// θ(f, f′, f″, \[t0, t1\]): all that is known of a twice differentiable f over one piece of time.
///
/// For t in \[t0, t1\] and x = t − t0, if f is twice differentiable on all of \[t0, t1\] (no pole in it),
/// f(t) ∈ f(t0) + f′(t0)·x + ½·f″(\[t0, t1\])·x².
///
/// `value` and `slope` are intervals here (the paper has reals): they enclose what rounding leaves of f(t0) and
/// f′(t0). The factor ½ belongs to this formula; callers pass f″ itself. (Algorithm 2 line 5 and Algorithm 5 line 10
/// of the paper pass f″/2 into a θ that halves again, and the parabolas then no longer bound f.)
///
/// Source: section IV-A and Figure 2 of the paper; the same form is the second-order Taylor form of Neumaier,
/// *Taylor forms – use and limits*, Reliable Computing 9 (2003), <https://doi.org/10.1023/A:1023061927787>.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::InclusionFunction;
/// // f(t) = 1 − t² on [0, 2]: f(0) = 1, f′(0) = 0, f″ = −2
/// let f = InclusionFunction::new(
///     Interval::point(1.0), Interval::point(0.0), Interval::point(-2.0), Interval::new(0.0, 2.0));
/// assert!(f.range().contains(-3.0) && f.range().contains(1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct InclusionFunction {
    value: Interval,
    slope: Interval,
    second_derivative: Interval,
    domain: Interval,
}

impl InclusionFunction {
    /// θ with f(t0) ∈ `value`, f′(t0) ∈ `slope`, f″(t) ∈ `second_derivative` for all t in `domain` = \[t0, t1\].
    ///
    /// An empty enclosure says that f is not defined, which proves nothing: it counts as entire.
    pub const fn new(
        value: Interval,
        slope: Interval,
        second_derivative: Interval,
        domain: Interval,
    ) -> Self {
        const fn known(x: Interval) -> Interval {
            if x.lo() > x.hi() { Interval::ENTIRE } else { x }
        }
        Self { value: known(value), slope: known(slope), second_derivative: known(second_derivative), domain }
    }

    /// f(t0).
    pub const fn value(&self) -> Interval {
        self.value
    }

    /// f′(t0).
    pub const fn slope(&self) -> Interval {
        self.slope
    }

    /// \[t0, t1\].
    pub const fn domain(&self) -> Interval {
        self.domain
    }

    /// θ of −f.
    pub fn negated(&self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
            second_derivative: -self.second_derivative,
            domain: self.domain,
        }
    }

    /// The parabola below f for x = t − t0 in \[0, t1 − t0\].
    pub fn lower(&self) -> Parabola {
        Parabola::new(self.value.lo(), self.slope.lo(), self.second_derivative.lo())
    }

    /// The parabola above f for x = t − t0 in \[0, t1 − t0\].
    pub fn upper(&self) -> Parabola {
        Parabola::new(self.value.hi(), self.slope.hi(), self.second_derivative.hi())
    }

    /// All offsets x = t − t0 of the domain.
    pub fn offsets(&self) -> Interval {
        let hi = (Interval::point(self.domain.hi()) - self.domain.lo()).hi();
        Interval::new(0.0, hi.max(0.0))
    }

    /// Encloses f over the whole domain.
    pub fn range(&self) -> Interval {
        self.enclose_at_offset(self.offsets())
    }

    /// Encloses f at one offset x, or over a set of them.
    pub fn enclose_at_offset(&self, x: Interval) -> Interval {
        self.value + x * (self.slope + x * (self.second_derivative * 0.5))
    }

    /// The hull of the times in `searched` at which f may be ≤ 0; `None` promises f > 0 on all of `searched` (also when
    /// that is empty).
    ///
    /// `searched` must lie in the domain. The case distinction is made at the start of `searched`, the interval that
    /// is really searched, and not at t0 (Algorithm 5 of the paper judges at the epoch and then takes the exit for
    /// the entry). The hull may hold times at which f > 0 in between; times outside it are certain.
    ///
    /// ```
    /// use d2m_interval::Interval;
    /// use d2m_root::InclusionFunction;
    /// // (t − 1)(t − 2) on [0, 4], searched from 1.5 on: already below zero there, out at 2.
    /// let f = InclusionFunction::new(
    ///     Interval::point(2.0), Interval::point(-3.0), Interval::point(2.0), Interval::new(0.0, 4.0));
    /// let part = f.nonpositive_hull(Interval::new(1.5, 4.0)).unwrap();
    /// assert_eq!(part.lo(), 1.5);
    /// assert!((part.hi() - 2.0).abs() < 1e-12);
    /// ```
    pub fn nonpositive_hull(&self, searched: Interval) -> Option<Interval> {
        if searched.is_empty() {
            return None;
        }
        let (a, b) = (searched.lo(), searched.hi());
        let shift = Interval::point(a) - self.domain.lo();
        let lower = self.lower();
        let p = if shift.hi() <= 0.0 {
            lower
        } else {
            let shift = Interval::new(shift.lo().max(0.0), shift.hi());
            Parabola::new(lower.enclose(shift).lo(), lower.enclose_slope(shift).lo(), lower.curvature)
        };
        let width = (Interval::point(b) - a).hi().max(0.0);
        let time = |x: f64| Interval::point(a) + x;
        if p.value > 0.0 {
            let entry = p.first_nonpositive()?;
            if entry.lo() > width {
                return None;
            }
            let lo = time(entry.lo()).lo().clamp(a, b);
            let hi = time(p.bound_last_nonpositive()).hi().min(b);
            return Some(Interval::new(lo, hi.max(lo)));
        }
        let hi = if p.curvature > 0.0 {
            time(p.bound_last_nonpositive()).hi()
        } else if p.enclose(Interval::point(width)).certainly_positive() {
            time(p.bound_first_rise()).hi()
        } else {
            b
        };
        let hi = if hi.is_nan() { b } else { hi.clamp(a, b) };
        Some(Interval::new(a, hi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadratic(roots: (f64, f64), scale: f64, domain: (f64, f64)) -> InclusionFunction {
        // scale (t − r)(t − s) expanded at domain.0 = 0 with small integers and powers of two: exact
        let (r, s) = roots;
        InclusionFunction::new(
            Interval::point(scale * r * s),
            Interval::point(-scale * (r + s)),
            Interval::point(2.0 * scale),
            Interval::new(domain.0, domain.1),
        )
    }

    #[test]
    fn hull_covers_every_nonpositive_time_and_no_more_than_the_arcs() {
        for scale in [1.0, -1.0, 8.0] {
            for r in [0.5, 1.0, 2.0] {
                for s in [2.0, 2.5, 3.0] {
                    let f = quadratic((r, s), scale, (0.0, 4.0));
                    for i in 0..16 {
                        for j in i + 1..=16 {
                            let part = Interval::new(i as f64 / 4.0, j as f64 / 4.0);
                            let hull = f.nonpositive_hull(part);
                            let inside: Vec<f64> = (i * 16..=j * 16)
                                .map(|k| k as f64 / 64.0)
                                .filter(|t| scale * (t - r) * (t - s) <= 0.0)
                                .collect();
                            match hull {
                                None => assert!(inside.is_empty(), "{scale} {r} {s} {part:?}"),
                                Some(h) => {
                                    for &t in &inside {
                                        assert!(h.contains(t), "{scale} {r} {s} {part:?} {t}");
                                    }
                                    let width =
                                        inside.last().unwrap_or(&0.0) - inside.first().unwrap_or(&0.0);
                                    assert!(
                                        h.width() <= width + 1e-9 + 2.0 / 64.0,
                                        "{scale} {r} {s} {part:?} {h:?}"
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// Erratum 9. Judged at the epoch, the start of the domain, (t−1)(t−2) is positive, its first root in the part
    /// [1.5, 4] is the *exit* 2, and the literal algorithm answers [2, 4]: the overlap [1.5, 2] is lost.
    #[test]
    fn judged_at_the_start_of_what_is_searched() {
        let f = quadratic((1.0, 2.0), 1.0, (0.0, 4.0));
        let literal = {
            let roots: Vec<f64> = [1.0, 2.0].into_iter().filter(|t| *t >= 1.5).collect();
            Interval::new(roots[0], 4.0)
        };
        assert!(!literal.contains(1.75), "the literal text would have been right");
        assert!(f.nonpositive_hull(Interval::new(1.5, 4.0)).unwrap().contains(1.75));
    }
}
