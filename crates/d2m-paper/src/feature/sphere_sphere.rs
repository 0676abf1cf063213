//! First contact of two moving solid spheres (section IV-D and Appendix B of the paper).

use super::point_triangle::fits;
use super::{PaperOptions, PointJet, RelativeMotion};
use d2m_feature::Sphere;
use d2m_interval::{Interval, IntervalVec3};
use d2m_root::{Gamma, InclusionFunction, IntervalFunction, RootSearch, SecondOrder, Settled, hrfoi};
use glam::DVec3;

/// First contact of two solid spheres, each fixed in its body, in `window`. Spheres that overlap at the start are in
/// contact there.
///
/// f(t) = |γ|² − (r_A + r_B)², f′ = 2 γ·γ′, f″ = 2 (γ·γ″ + |γ′|²) (Appendix B; γ is taken in the observer's frame, in
/// which f is the same number). All of it in interval arithmetic: where γ·γ cancels far from the contact (speeds of
/// 1e9) the parabolas only get wide, and the next piece starts near the contact, where nothing cancels. The plain
/// b² − 4ac was late there.
///
/// ```
/// use d2m_paper::{PaperOptions, RelativeMotion, Sphere, sphere_sphere};
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_root::RootSearch;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(4.0 * DVec3::Z).with_linear_velocity(-4.0 * DVec3::Z);
/// let motion = RelativeMotion::new(&falling, &ConstantTwist::REST);
/// let sphere = Sphere { center: DVec3::ZERO, radius: 1.0 };
/// let found = sphere_sphere(&motion, &sphere, &sphere, Interval::UNIT, &PaperOptions::DEFAULT);
/// let RootSearch::Bracket(b) = found else { panic!() };
/// assert!(b.lo() <= 0.5 && b.lo() > 0.5 - 1e-10);
/// ```
pub fn sphere_sphere(
    motion: &RelativeMotion<'_>,
    mover: &Sphere,
    observer: &Sphere,
    window: Interval,
    options: &PaperOptions,
) -> RootSearch {
    let jet = motion.frame(window).jet(mover.center);
    let speed = jet.bound_speed();
    let mut pair = SpherePair {
        motion,
        mover: mover.center,
        observer: observer.center,
        radii: Interval::point(mover.radius) + observer.radius,
        jet,
        tolerance: options.tolerance,
    };
    let start = Interval::point(window.lo());
    // f has a sign inside as well: a start that is not certainly apart is a contact, not a function without a root.
    // The window's own enclosures may be wider there.
    let now = motion.frame(start).jet(mover.center);
    if !pair.gap_of(&now, Interval::ZERO).certainly_positive() {
        return RootSearch::Bracket(start);
    }
    hrfoi(&mut pair, window, options.limits(speed))
}

struct SpherePair<'a> {
    motion: &'a RelativeMotion<'a>,
    mover: DVec3,
    observer: DVec3,
    radii: Interval,
    jet: PointJet,
    tolerance: f64,
}

impl SpherePair<'_> {
    fn offsets_of(&mut self, t: Interval) -> Interval {
        if !fits(&self.jet, t) {
            self.jet = self.motion.frame(t).jet(self.mover);
        }
        self.jet.offsets(t)
    }

    /// Encloses the distance of the surfaces over the offsets `x`; negative inside.
    fn gap(&self, x: Interval) -> Interval {
        self.gap_of(&self.jet, x)
    }

    fn gap_of(&self, jet: &PointJet, x: Interval) -> Interval {
        (jet.enclose(x) - self.observer).norm() - self.radii
    }
}

impl IntervalFunction for SpherePair<'_> {
    fn enclose(&mut self, t: Interval) -> Interval {
        let x = self.offsets_of(t);
        (self.jet.enclose(x) - self.observer).norm_squared() - self.radii.sqr()
    }
}

impl SecondOrder for SpherePair<'_> {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        if self.jet.span() != t {
            self.jet = self.motion.frame(t).jet(self.mover);
        }
        let [q, v, a] = *self.jet.derivatives();
        let x = self.jet.offsets(t);
        let w: IntervalVec3 = q - self.observer;
        let (path, speed) = (self.jet.enclose(x) - self.observer, self.jet.enclose_velocity(x));
        InclusionFunction::new(
            (w.norm() - self.radii) * (w.norm() + self.radii),
            w.dot(v) * 2.0,
            (path.dot(a) + speed.norm_squared()) * 2.0,
            t,
        )
    }
}

impl Gamma for SpherePair<'_> {
    /// Every root of f is a contact; and a start inside is one as well.
    fn may_touch(&mut self, t: Interval) -> bool {
        let x = self.offsets_of(t);
        !self.gap(x).certainly_positive()
    }

    fn settle(&mut self, t: Interval) -> Settled {
        let x = self.offsets_of(t);
        let time = self.jet.span().lo() + x.mid();
        let middle = Interval::point(x.mid());
        if t.contains(time) && self.gap(middle).hi() <= self.tolerance {
            return Settled::Near(time);
        }
        let Some(n) = super::direction::unit((self.jet.enclose(middle) - self.observer).mid()) else {
            return Settled::Open;
        };
        let along = self.jet.range_along(n, x) - IntervalVec3::point(self.observer).dot_point(n);
        let length = IntervalVec3::point(n).norm();
        if (along - self.radii * length).certainly_positive() { Settled::Excluded } else { Settled::Open }
    }
}
