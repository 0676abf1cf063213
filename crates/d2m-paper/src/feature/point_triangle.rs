//! First contact of a moving point and a moving triangle or convex polygon (section IV-B of the paper).

use super::closest::estimate_on_polygon;
use super::direction::{Direction, unit};
use super::gamma::gamma_point_face;
use super::{Face, PaperOptions, PointJet, RelativeMotion, TriangleFace};
use d2m_interval::{Interval, IntervalVec3};
use d2m_root::{
    Gamma, InclusionFunction, IntervalFunction, RootSearch, SecondOrder, Settled, hrfoi,
    intersect_root_domain,
};
use glam::DVec3;

/// First contact of `point` (frame of the mover) with the closed triangle (frame of the observer) in `window`.
///
/// Promise: no contact in the window before the lower end of the bracket (or `clear_until`, or anywhere for
/// [`RootSearch::None`]). A bracket without a contact is possible only where the features come within about
/// `options.tolerance`, or rounding of the poses hides more than that.
///
/// f(t) = n·(q(t) − b), the signed distance to the plane, with f′ and f″ of Appendix D; Γ of Algorithm 4; the search
/// is [`hrfoi`]. Works for any [`RigidMotion`](d2m_motion::RigidMotion) through its enclosures; over a span with a joint inside, those of the
/// places alone, so windows without joints are faster.
///
/// ```
/// use d2m_paper::{PaperOptions, RelativeMotion, point_triangle};
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let triangle = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(2.0, -1.0, 0.0), DVec3::new(-1.0, 2.0, 0.0)];
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let found = point_triangle(&motion, DVec3::ZERO, &triangle, Interval::UNIT, &PaperOptions::DEFAULT);
/// let RootSearch::Bracket(b) = found else { panic!() };
/// assert!(b.lo() <= 0.5 && b.lo() > 0.5 - 1e-10);
/// ```
pub fn point_triangle(
    motion: &RelativeMotion<'_>,
    point: DVec3,
    triangle: &[DVec3; 3],
    window: Interval,
    options: &PaperOptions,
) -> RootSearch {
    point_face(motion, point, TriangleFace::new(*triangle).face(), window, options)
}

/// First contact of `point` (frame of the mover) with a convex polygon (frame of the observer): as [`point_triangle`].
///
/// ```
/// use d2m_paper::{PaperOptions, PolygonFace, RelativeMotion, point_polygon};
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let square = [DVec3::new(-1., -1., 0.), DVec3::new(1., -1., 0.), DVec3::new(1., 1., 0.), DVec3::new(-1., 1., 0.)];
/// let square = PolygonFace::try_new(&square).unwrap();
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let hit = point_polygon(&motion, DVec3::new(0.9, 0.9, 0.0), &square, Interval::UNIT, &PaperOptions::DEFAULT);
/// assert!(matches!(hit, RootSearch::Bracket(b) if b.lo() <= 0.5 && b.lo() > 0.5 - 1e-10));
/// ```
pub fn point_polygon(
    motion: &RelativeMotion<'_>,
    point: DVec3,
    polygon: &super::PolygonFace,
    window: Interval,
    options: &PaperOptions,
) -> RootSearch {
    point_face(motion, point, polygon.face(), window, options)
}

fn point_face(
    motion: &RelativeMotion<'_>,
    point: DVec3,
    face: Face<'_>,
    window: Interval,
    options: &PaperOptions,
) -> RootSearch {
    let jet = motion.frame(window).jet(point);
    PointFace::new(motion, point, face, jet, options).first_contact(window)
}

/// f and Γ of one point/face pair, as functions of time.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::{PaperOptions, PointFace, RelativeMotion, TriangleFace};
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let floor = TriangleFace::new([-DVec3::X - DVec3::Y, DVec3::X - DVec3::Y, DVec3::Y]);
/// let jet = motion.frame(Interval::UNIT).jet(DVec3::ZERO);
/// let mut pair = PointFace::new(&motion, DVec3::ZERO, floor.face(), jet, &PaperOptions::DEFAULT);
/// assert!(matches!(pair.first_contact(Interval::UNIT), RootSearch::Bracket(b) if b.contains(0.5)));
/// assert!(pair.evaluated() > 0);
/// ```
#[derive(Debug)]
pub struct PointFace<'a> {
    motion: &'a RelativeMotion<'a>,
    point: DVec3,
    face: Face<'a>,
    jet: PointJet,
    options: PaperOptions,
    evaluated: u32,
}

impl<'a> PointFace<'a> {
    /// `jet` is the path of `point` over the first span that will be queried; it may be shared with other features.
    pub const fn new(
        motion: &'a RelativeMotion<'a>,
        point: DVec3,
        face: Face<'a>,
        jet: PointJet,
        options: &PaperOptions,
    ) -> Self {
        Self { motion, point, face, jet, options: *options, evaluated: 0 }
    }

    /// How many pieces of time have been evaluated so far: what a budget is charged with.
    pub const fn evaluated(&self) -> u32 {
        self.evaluated
    }

    /// The first contact in `window`.
    pub fn first_contact(&mut self, window: Interval) -> RootSearch {
        let limits = self.options.limits(self.jet.bound_speed());
        hrfoi(self, window, limits)
    }

    /// From the enclosure at hand, without a new one of the motion: the part of the jet's span in which a contact may begin.
    /// `None` promises that there is none in the span.
    pub fn try_first_part(face: &Face<'_>, jet: &PointJet) -> Option<Interval> {
        let theta = plane_function(face, jet);
        let part = intersect_root_domain(&theta)?;
        gamma_point_face(face, jet, jet.offsets(jet.span())).then_some(part)
    }

    /// Makes the jet fit the piece `t` and returns the offsets of `t` in it.
    fn offsets_of(&mut self, t: Interval) -> Interval {
        if !fits(&self.jet, t) {
            self.jet = self.motion.frame(t).jet(self.point);
        }
        self.jet.offsets(t)
    }
}

/// May the jet serve for `t`? It must cover it and be not much longer, or its acceleration is too wide.
pub(super) fn fits(jet: &PointJet, t: Interval) -> bool {
    let span = jet.span();
    span.lo() <= t.lo() && t.hi() <= span.hi() && t.hi() - t.lo() >= 0.3 * (span.hi() - span.lo())
}

fn plane_function(face: &Face<'_>, jet: &PointJet) -> InclusionFunction {
    let [q, v, a] = jet.derivatives();
    let n = face.normal.vector;
    InclusionFunction::new(q.dot_point(n) - face.normal.extent, v.dot_point(n), a.dot_point(n), jet.span())
}

impl IntervalFunction for PointFace<'_> {
    fn enclose(&mut self, t: Interval) -> Interval {
        let x = self.offsets_of(t);
        self.jet.range_along(self.face.normal.vector, x) - self.face.normal.extent
    }
}

impl SecondOrder for PointFace<'_> {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        if self.jet.span() != t {
            self.jet = self.motion.frame(t).jet(self.point);
        }
        plane_function(&self.face, &self.jet)
    }
}

impl Gamma for PointFace<'_> {
    fn may_touch(&mut self, t: Interval) -> bool {
        self.evaluated = self.evaluated.saturating_add(1);
        let x = self.offsets_of(t);
        let normal = &self.face.normal;
        !normal.certainly_apart(self.jet.range_along(normal.vector, x))
            && gamma_point_face(&self.face, &self.jet, x)
    }

    fn settle(&mut self, t: Interval) -> Settled {
        let x = self.offsets_of(t);
        let offset = x.mid();
        let time = self.jet.span().lo() + offset;
        let q = self.jet.enclose(Interval::point(offset));
        let p = q.mid();
        let c = estimate_on_polygon(p, self.face.vertices, self.face.normal.vector);
        // `c` is on the polygon up to rounding of its own computation.
        let size = self.face.vertices.iter().fold(0.0f64, |m, k| m.max(k.abs().max_element()));
        let off = Interval::point(size.max(c.abs().max_element())) * ON_FACE;
        let inside = estimate_is_on(&self.face, c);
        if inside
            && t.contains(time)
            && ((q - IntervalVec3::point(c)).norm() + off).hi() <= self.options.tolerance
        {
            return Settled::Near(time);
        }
        let apart = |v: DVec3| {
            unit(v).is_some_and(|v| {
                Direction::new(v, self.face.vertices).certainly_apart(self.jet.range_along(v, x))
            })
        };
        let gap = p - c;
        if apart(gap) || apart(self.face.normal.vector) {
            return Settled::Excluded;
        }
        let n = self.face.vertices.len();
        for i in 0..n {
            let Some(e) = unit(self.face.vertices[(i + 1) % n] - self.face.vertices[i]) else { continue };
            if apart(gap - e * gap.dot(e)) {
                return Settled::Excluded;
            }
        }
        Settled::Open
    }
}

/// What a point that is computed to lie on a face is taken to be off it, as a part of the largest coordinate: the foot is a
/// sum of three products of weights and vertices, some 8·2⁻⁵³.
const ON_FACE: f64 = 1e-15;

/// Is `c` on the face within [`ON_FACE`] of its size for each vertex? Judged along all its directions.
fn estimate_is_on(face: &Face<'_>, c: DVec3) -> bool {
    face.sides.iter().chain([&face.normal]).all(|d| {
        let v = d.vector.dot(c);
        let slack = ON_FACE * (1.0 + face.vertices.len() as f64) * c.abs().max_element().max(d.extent.mag());
        v >= d.extent.lo() - slack && v <= d.extent.hi() + slack
    })
}
