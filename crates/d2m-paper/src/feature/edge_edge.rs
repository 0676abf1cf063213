//! First contact of two moving edges (section IV-C of the paper).

use super::closest::estimate_between_segments;
use super::direction::unit;
use super::gamma::{EdgeJet, gamma_edge_edge};
use super::point_triangle::fits;
use super::{PaperOptions, RelativeFrame, RelativeMotion};
use d2m_interval::{Interval, IntervalVec3};
use d2m_root::{
    Gamma, InclusionFunction, IntervalFunction, RootSearch, SecondOrder, Settled, hrfoi,
    intersect_root_domain,
};
use glam::DVec3;

/// First contact of the closed edge `mover` (frame of the mover) with the closed edge `observer` (frame of the
/// observer) in `window`.
///
/// Promise and hypotheses as for [`point_triangle`](super::point_triangle()).
/// f(t) = (e(t) × d)·(a(t) − c), with f′ and f″ of Appendix C (d stands still in the observer's frame, so its
/// derivatives vanish). Parallel edges make f ≡ 0: Γ and separating axes decide them.
///
/// ```
/// use d2m_paper::{PaperOptions, RelativeMotion, edge_edge};
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let (a, b) = ([-DVec3::X, DVec3::X], [-DVec3::Y, DVec3::Y]);
/// let found = edge_edge(&motion, &a, &b, Interval::UNIT, &PaperOptions::DEFAULT);
/// let RootSearch::Bracket(bracket) = found else { panic!() };
/// assert!(bracket.lo() <= 0.5 && bracket.lo() > 0.5 - 1e-10);
/// ```
pub fn edge_edge(
    motion: &RelativeMotion<'_>,
    mover: &[DVec3; 2],
    observer: &[DVec3; 2],
    window: Interval,
    options: &PaperOptions,
) -> RootSearch {
    let frame = motion.frame(window);
    EdgePair::new(motion, *mover, *observer, &frame, options).first_contact(window)
}

/// f and Γ of one pair of edges, as functions of time.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::{EdgePair, PaperOptions, RelativeMotion};
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let frame = motion.frame(Interval::UNIT); // one for all features of the two bodies
/// let (a, b) = ([-DVec3::X, DVec3::X], [-DVec3::Y, DVec3::Y]);
/// let mut pair = EdgePair::new(&motion, a, b, &frame, &PaperOptions::DEFAULT);
/// assert!(pair.try_first_part().is_some_and(|part| part.contains(0.5)));
/// assert!(matches!(pair.first_contact(Interval::UNIT), RootSearch::Bracket(b) if b.contains(0.5)));
/// ```
#[derive(Debug)]
pub struct EdgePair<'a> {
    motion: &'a RelativeMotion<'a>,
    mover: [DVec3; 2],
    observer: [DVec3; 2],
    jet: EdgeJet,
    options: PaperOptions,
    evaluated: u32,
}

impl<'a> EdgePair<'a> {
    /// `frame` must be the relative motion over the first span that will be queried; many features may share it.
    pub fn new(
        motion: &'a RelativeMotion<'a>,
        mover: [DVec3; 2],
        observer: [DVec3; 2],
        frame: &RelativeFrame,
        options: &PaperOptions,
    ) -> Self {
        Self { motion, mover, observer, jet: EdgeJet::new(frame, mover), options: *options, evaluated: 0 }
    }

    /// Replaces the most pieces of time that the search may evaluate.
    pub(crate) const fn set_max_evaluations(&mut self, evaluations: u32) {
        self.options.evaluations = evaluations;
    }

    /// How many pieces of time have been evaluated so far: what a budget is charged with.
    pub const fn evaluated(&self) -> u32 {
        self.evaluated
    }

    /// The first contact in `window`.
    pub fn first_contact(&mut self, window: Interval) -> RootSearch {
        let spin = self.jet.direction_jet().bound_speed();
        let speed = Interval::point(self.jet.start.bound_speed()) + spin;
        let limits = self.options.limits(speed.hi());
        hrfoi(self, window, limits)
    }

    /// From the enclosure at hand, without a new one of the motion: the part of the frame's span in which a contact may begin.
    /// `None` promises that there is none in the span.
    pub fn try_first_part(&self) -> Option<Interval> {
        let part = intersect_root_domain(&self.triple_product())?;
        gamma_edge_edge(&self.jet, &self.observer, self.jet.start.offsets(self.jet.start.span()))
            .then_some(part)
    }

    fn offsets_of(&mut self, t: Interval) -> Interval {
        if !fits(&self.jet.start, t) {
            self.jet = EdgeJet::new(&self.motion.frame(t), self.mover);
        }
        self.jet.start.offsets(t)
    }

    /// f over the span of the jet: e × d · w with w = a − c.
    fn triple_product(&self) -> InclusionFunction {
        let span = self.jet.start.span();
        let x = self.jet.start.offsets(span);
        let d = IntervalVec3::point(self.observer[1]) - self.observer[0];
        let [e0, e1, e2] = self.jet.direction;
        let [w0, w1, w2] = *self.jet.start.derivatives();
        let w0 = w0 - self.observer[0];
        let (n0, n1) = (e0.cross(d), e1.cross(d));
        let e_dot = e1 + e2 * x;
        let e = e0 + (e1 + e2 * (x * 0.5)) * x;
        let w_dot = w1 + w2 * x;
        let w = w0 + (w1 + w2 * (x * 0.5)) * x;
        let second = e2.cross(d).dot(w) + e_dot.cross(d).dot(w_dot) * 2.0 + e.cross(d).dot(w2);
        InclusionFunction::new(n0.dot(w0), n1.dot(w0) + n0.dot(w1), second, span)
    }
}

impl IntervalFunction for EdgePair<'_> {
    fn enclose(&mut self, t: Interval) -> Interval {
        let x = self.offsets_of(t);
        self.triple_product().enclose_at_offset(x)
    }
}

impl SecondOrder for EdgePair<'_> {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        if self.jet.start.span() != t {
            self.jet = EdgeJet::new(&self.motion.frame(t), self.mover);
        }
        self.triple_product()
    }
}

impl Gamma for EdgePair<'_> {
    fn may_touch(&mut self, t: Interval) -> bool {
        self.evaluated = self.evaluated.saturating_add(1);
        let x = self.offsets_of(t);
        gamma_edge_edge(&self.jet, &self.observer, x)
    }

    fn settle(&mut self, t: Interval) -> Settled {
        let x = self.offsets_of(t);
        let offset = x.mid();
        let time = self.jet.start.span().lo() + offset;
        let middle = Interval::point(offset);
        let (a, e) = (self.jet.start.enclose(middle), self.jet.direction_jet().enclose(middle));
        let (b, d) = (self.observer[0], self.observer[1] - self.observer[0]);
        let (am, em) = (a.mid(), e.mid());
        let (s, r) = estimate_between_segments(am, em, b, d);
        let along = IntervalVec3::point(self.observer[1]) - b;
        let gap = a + e * s - (along * r + b);
        if t.contains(time) && gap.norm().hi() <= self.options.tolerance {
            return Settled::Near(time);
        }
        let apart = |n: DVec3| unit(n).is_some_and(|n| self.jet.certainly_apart_along(n, &self.observer, x));
        let g = gap.mid();
        let (Some(eu), du) = (unit(em), unit(d)) else {
            return if apart(g) || unit(d).is_some_and(|d| apart(g - d * g.dot(d))) {
                Settled::Excluded
            } else {
                Settled::Open
            };
        };
        let du = du.unwrap_or(eu);
        if apart(g) || apart(eu.cross(du)) || apart(g - eu * g.dot(eu)) || apart(g - du * g.dot(du)) {
            return Settled::Excluded;
        }
        Settled::Open
    }
}
