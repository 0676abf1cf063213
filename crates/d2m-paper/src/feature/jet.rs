//! The path of a point over a span: position and velocity at the start, acceleration throughout.

use d2m_interval::{Interval, IntervalVec3};
use d2m_root::InclusionFunction;
use glam::DVec3;

/// q(t) for t in a span: q(t0) and q′(t0) enclosed at its start t0, q″ over all of it.
///
/// Every linear function d·q of it is an [`InclusionFunction`]: this is how Γ, the plane function and every separating
/// axis are evaluated without wrapping boxes around the path first.
///
/// ```
/// use d2m_interval::{Interval, IntervalVec3};
/// use d2m_paper::PointJet;
/// use glam::DVec3;
/// // Thrown upwards at 5 under a gravity of 10: it is back at the time 1.
/// let jet = PointJet::new(Interval::UNIT, [DVec3::ZERO, DVec3::Z * 5.0, DVec3::Z * -10.0].map(IntervalVec3::point));
/// assert!(jet.enclose(Interval::point(1.0)).z.contains(0.0));
/// assert!(jet.range_along(DVec3::Z, Interval::point(0.5)).contains(1.25));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PointJet {
    span: Interval,
    q: [IntervalVec3; 3],
}

impl PointJet {
    /// From position and velocity at the start of `span` and the acceleration over all of it.
    pub const fn new(span: Interval, q: [IntervalVec3; 3]) -> Self {
        Self { span, q }
    }

    /// The span for which it holds.
    pub const fn span(&self) -> Interval {
        self.span
    }

    /// q(t0), q′(t0), q″(span).
    pub const fn derivatives(&self) -> &[IntervalVec3; 3] {
        &self.q
    }

    /// The function d·q over the span.
    pub fn along(&self, d: DVec3) -> InclusionFunction {
        InclusionFunction::new(
            self.q[0].dot_point(d),
            self.q[1].dot_point(d),
            self.q[2].dot_point(d),
            self.span,
        )
    }

    /// The offsets x = t − t0 of a part of the span.
    pub fn offsets(&self, part: Interval) -> Interval {
        let x = part - self.span.lo();
        Interval::new(x.lo().max(0.0), x.hi().max(0.0))
    }

    /// Encloses d·q over the offsets `x`.
    pub fn range_along(&self, d: DVec3, x: Interval) -> Interval {
        self.along(d).enclose_at_offset(x)
    }

    /// Encloses q over the offsets `x`.
    pub fn enclose(&self, x: Interval) -> IntervalVec3 {
        self.q[0] + (self.q[1] + self.q[2] * (x * 0.5)) * x
    }

    /// Encloses q′ over the offsets `x`.
    pub(crate) fn enclose_velocity(&self, x: Interval) -> IntervalVec3 {
        self.q[1] + self.q[2] * x
    }

    /// An upper bound of |q′| over the whole span.
    pub fn bound_speed(&self) -> f64 {
        let width = (Interval::point(self.span.hi()) - self.span.lo()).hi().max(0.0);
        self.enclose_velocity(Interval::new(0.0, width)).norm().hi()
    }

    /// The jet of the difference q − o.
    pub fn minus(&self, o: &Self) -> [IntervalVec3; 3] {
        [self.q[0] - o.q[0], self.q[1] - o.q[1], self.q[2] - o.q[2]]
    }
}
