//! Two constant twists that stay near two motions for a while, and how near that is proven to be.
//!
//! docs/theory/motions.md, section 3, derives the bound.

use crate::{Ball, CertifiedState, ConstantTwist, Kinematics, RigidMotion, StateTwist, length};
use d2m_interval::Interval;
use d2m_lanes::UP;
use glam::DVec3;

/// A body that moves, as far as fits need it.
///
/// ```
/// use d2m_motion::{ConstantTwist, FittedTwists, MovingBall};
/// use glam::DVec3;
/// let ball = MovingBall { motion: &ConstantTwist::REST, center: DVec3::X, radius: 0.5 };
/// let fitted = FittedTwists::new(&[ball; 2], d2m_interval::Interval::new(0.0, 1.0), DVec3::ZERO).unwrap();
/// assert!(fitted.deviation < 1e-12 && (fitted.size - 2.0 * 1.5).abs() < 1e-9);
/// ```
#[derive(Clone, Copy)]
pub struct MovingBall<'m> {
    /// How it moves.
    pub motion: &'m dyn RigidMotion,
    /// All of its points are within the radius of this one, in its frame.
    pub center: DVec3,
    /// How far they are at most.
    pub radius: f64,
}

impl core::fmt::Debug for MovingBall<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { center, radius, .. } = self;
        f.debug_struct("MovingBall").field("center", center).field("radius", radius).finish_non_exhaustive()
    }
}

/// The constant twists that have the states of two motions at one time of a span.
///
/// ```
/// use d2m_motion::{FittedTwists, MovingBall, Pose, RigidMotion, Spline, SplineDegree};
/// use glam::{DQuat, DVec3};
/// let frames = [0.0, 1.0, 2.0, 3.0].map(|t: f64| {
///     (t, Pose { translation: DVec3::X * t * t, rotation: DQuat::IDENTITY, at: DVec3::ZERO })
/// });
/// let spline = Spline::try_through(&frames, SplineDegree::Cubic)?;
/// let ball = |motion| MovingBall { motion, center: DVec3::ZERO, radius: 0.1 };
/// let bodies = [ball(&spline as &dyn RigidMotion), ball(&d2m_motion::ConstantTwist::REST)];
/// let fitted = FittedTwists::new(&bodies, d2m_interval::Interval::new(1.0, 1.1), DVec3::ZERO).unwrap();
/// let [lo, _] = fitted.clock.span(1.0, 1.1);
/// let [at, near] = [spline.pose_and_twist(1.0), fitted.twists[0].pose_and_twist(lo)].map(|(pose, _)| pose.translation);
/// assert!((at - near).length() <= fitted.deviation && fitted.deviation < 5e-3);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct FittedTwists {
    /// The two motions over the fitted clock, their positions relative to the origin that was given.
    pub twists: [ConstantTwist; 2],
    /// The time by which they go.
    pub clock: FittedClock,
    /// At every time of the span the distance of any point of the one body from any of the other differs by at most this.
    pub deviation: f64,
    /// The part of it that no shorter span takes away.
    pub floor: f64,
    /// How much of it goes like the span, not like its square: what the enclosures of velocities at a single time leave open.
    pub drift: f64,
    /// The lengths that its rounding is about: how far the bodies' points are from the world's origin at most, together.
    pub size: f64,
}

/// One motion, expressed by one body point.
struct Fit {
    twist: ConstantTwist,
    state: CertifiedState,
    rotation_radius: f64,
    acceleration: Ball,
    angular_rate: Ball,
    reach: f64,
}

/// The pole of acceleration is sought within so many radii of the body.
const POLE_WITHIN: f64 = 16.0;

impl FittedTwists {
    /// Fits in the middle of the span, or at its start where no number lies between the ends: at the end the next piece of a
    /// motion may have begun. `None` where the motions' enclosures know too little, whatever the span.
    ///
    /// Each motion is expressed by its reference point and by the one that accelerates least; what gives the smaller
    /// deviation is taken.
    pub fn new(bodies: &[MovingBall<'_>; 2], span: Interval, origin: DVec3) -> Option<Self> {
        let (from, to) = (span.lo(), span.hi());
        let middle = (from + 0.5 * (to - from)).clamp(from, to);
        let middle = if middle < to { middle } else { from };
        let fits = bodies.map(|body| candidates(&body, span, middle, origin));
        // Either difference is rounded once.
        let half = (to - middle).max(middle - from) * UP;
        let mut best = None;
        let mut least = f64::INFINITY;
        let mut turned = [0, 1].map(|k| fits[k].each_ref().map(|fit| Turned::new(fit.as_ref(), half)));
        let [of_a, of_b] = &mut turned;
        for a in of_a.iter_mut().flatten() {
            for b in of_b.iter_mut().flatten() {
                for (which, bend) in bends(a.fit, b.fit).into_iter().enumerate() {
                    if bend.abs() * half > MOST_BEND {
                        continue;
                    }
                    let turns = [a.at(which, bend), b.at(which, bend)];
                    let deviation = deviation([a.fit, b.fit], half, bend, turns);
                    // What is not a number is never better.
                    if deviation < least {
                        (best, least) = (Some(([a.fit, b.fit], FittedClock { middle, bend })), deviation);
                    }
                }
            }
        }
        let size = |fit: &Fit| (fit.state.position + origin).length() + fit.reach;
        let size = fits.iter().filter_map(|[given, _]| given.as_ref()).map(size).sum();
        best.map(|(fits, clock)| Self::of(fits, half, clock, least, size))
    }

    fn of([a, b]: [&Fit; 2], half: f64, clock: FittedClock, deviation: f64, size: f64) -> Self {
        let drifts = |fit: &Fit| half * (fit.state.linear_radius + fit.reach * fit.state.angular_radius);
        let still = |fit: &Fit| fit.state.position_radius + fit.reach * fit.rotation_radius;
        // By its own clock a motion has its reference time at zero.
        let timed =
            |twist: ConstantTwist| if clock.bend == 0.0 { twist } else { twist.with_reference_time(0.0) };
        Self {
            twists: [timed(a.twist), timed(b.twist)],
            clock,
            deviation,
            floor: still(a) + still(b),
            drift: drifts(a) + drifts(b),
            size,
        }
    }
}

fn candidates(body: &MovingBall<'_>, span: Interval, middle: f64, origin: DVec3) -> [Option<Fit>; 2] {
    let kinematics = body.motion.enclose_kinematics(span);
    let state = body.motion.enclose_state_about(middle, origin);
    let one = |state: CertifiedState, kinematics: &Kinematics| {
        let StateTwist { motion, rotation_radius, .. } = state.to_constant_twist(middle)?;
        Some(Fit {
            twist: motion,
            rotation_radius,
            acceleration: kinematics.linear_rate,
            angular_rate: kinematics.angular_rate,
            reach: (body.radius + length(body.center - state.at)) * UP,
            state,
        })
    };
    let (w, a) = (state.angular, kinematics.linear_rate.center);
    let across = (a - w * (w.dot(a) / w.length_squared())) / w.length_squared();
    let near = across.length() <= POLE_WITHIN * body.radius && across != DVec3::ZERO;
    let pole = near.then(|| {
        // ω × (ω × e) = −a across ω.
        let at = state.at + state.rotation.transpose() * across;
        one(state.following(at), &kinematics.following(at))
    });
    [one(state, &kinematics), pole.flatten()]
}

/// Relative changes of speed that one of the motions, or the one against the other, keeps to: none, and the parts of the
/// accelerations along the twists.
fn bends(a: &Fit, b: &Fit) -> [f64; 4] {
    let along = |rate: DVec3, speed: DVec3| {
        let bend = rate.dot(speed) / speed.length_squared();
        if bend.is_finite() { bend } else { 0.0 }
    };
    [
        0.0,
        along(a.angular_rate.center, a.state.angular),
        along(b.angular_rate.center, b.state.angular),
        along(a.acceleration.center - b.acceleration.center, a.state.linear - b.state.linear),
    ]
}

/// By how much a body may be turned away from its fit, for bends that were asked for.
struct Turned<'f> {
    fit: &'f Fit,
    half: f64,
    /// The last bend of each kind, and the answer: mostly the same with each fit of the other body.
    known: [Option<(f64, f64)>; 4],
}

impl<'f> Turned<'f> {
    fn new(fit: Option<&'f Fit>, half: f64) -> Option<Self> {
        fit.map(|fit| Self { fit, half, known: [None; 4] })
    }

    fn at(&mut self, which: usize, bend: f64) -> f64 {
        let Self { fit, half, .. } = *self;
        match self.known[which] {
            Some((known, turned)) if known == bend => turned,
            _ => {
                let rate = (fit.angular_rate - kept(fit.state.angular, bend)).bound_length();
                let turned = fit.reach
                    * (fit.rotation_radius + half * fit.state.angular_radius + 0.5 * half * (half * rate));
                self.known[which] = Some((bend, turned));
                turned
            }
        }
    }
}

/// What a clock with this bend changes of a speed.
fn kept(speed: DVec3, bend: f64) -> Ball {
    Ball::point(speed).times(bend, 0.0)
}

/// How far apart distances of these fits and of the motions are, by a clock with this bend, where the bodies are turned away by so much.
fn deviation([a, b]: [&Fit; 2], half: f64, bend: f64, [turned_a, turned_b]: [f64; 2]) -> f64 {
    let relative = (Ball::point(a.state.linear) - Ball::point(b.state.linear)).times(bend, 0.0);
    let along = (a.acceleration - b.acceleration - relative).bound_length();
    // The square of a short time alone may be lost to underflow.
    let moved = half * (a.state.linear_radius + b.state.linear_radius) + 0.5 * half * (half * along);
    let deviation = a.state.position_radius + b.state.position_radius + moved + turned_a + turned_b;
    // What underflow may take is less than the smallest normal number.
    deviation * UP + f64::MIN_POSITIVE
}

/// The time s(t) = x + ½κx², x = t − m, by which fitted motions go that become faster or slower together; the time itself where κ
/// is zero.
///
/// ```
/// use d2m_motion::{ConstantTwist, FittedTwists, MovingBall};
/// use glam::DVec3;
/// let ball = MovingBall { motion: &ConstantTwist::REST, center: DVec3::ZERO, radius: 1.0 };
/// let span = d2m_interval::Interval::new(2.0, 3.0);
/// let clock = FittedTwists::new(&[ball; 2], span, DVec3::ZERO).unwrap().clock;
/// assert_eq!(clock.span(2.0, 3.0), [2.0, 3.0]); // nothing gains speed
/// assert_eq!((clock.time_down(2.5, 2.0), clock.time_up(2.5, 3.0)), (2.5, 2.5));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FittedClock {
    middle: f64,
    bend: f64,
}

/// Largest |κx|: the clock then goes at half the speed at least.
const MOST_BEND: f64 = 0.5;
/// Steps of a unit in the last place until the time of a clock is on the right side; its root and square are off by a few.
const STEPS: u32 = 16;

impl FittedClock {
    fn at(&self, time: f64) -> Interval {
        let x = Interval::point(time) - Interval::point(self.middle);
        if self.bend == 0.0 { Interval::point(time) } else { x + x.sqr() * (0.5 * self.bend) }
    }

    /// The span by this clock, and what rounding adds to it; its ends may be infinite.
    pub fn span(&self, from: f64, to: f64) -> [f64; 2] {
        [self.at(from).lo(), self.at(to).hi()]
    }

    fn estimate(&self, clock: f64) -> f64 {
        if self.bend == 0.0 {
            return clock;
        }
        self.middle + 2.0 * clock / (1.0 + (1.0 + 2.0 * self.bend * clock).sqrt())
    }

    /// A time not after the clock says this, and not before `least`, up to which nothing is claimed then.
    pub fn time_down(&self, clock: f64, least: f64) -> f64 {
        self.safe_time(clock, -1.0, |s| s.hi() <= clock).map_or(least, |time| time.max(least))
    }

    /// A time not before the clock says this; `most` where rounding leaves that open.
    pub fn time_up(&self, clock: f64, most: f64) -> f64 {
        self.safe_time(clock, 1.0, |s| s.lo() >= clock).map_or(most, |time| time.min(most))
    }

    /// The estimate, moved by more and more units in the last place until the clock is certainly on the right side.
    fn safe_time(&self, clock: f64, direction: f64, is_safe: impl Fn(Interval) -> bool) -> Option<f64> {
        let estimate = self.estimate(clock);
        let unit = f64::EPSILON * (estimate.abs() + self.middle.abs());
        (0..STEPS)
            .map(|step| estimate + direction * unit * f64::from(step))
            .find(|&time| is_safe(self.at(time)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chain, Joint, JointKind, JointValue};
    use glam::DQuat;

    fn value(coefficients: &[f64]) -> JointValue {
        JointValue::try_polynomial(coefficients.to_vec()).unwrap()
    }

    fn turning(x: DVec3, axis: DVec3, coefficients: &[f64]) -> Joint {
        let kind = JointKind::Revolute { axis, value: value(coefficients) };
        Joint::try_new(x, DQuat::IDENTITY, kind).unwrap()
    }

    fn sliding(x: DVec3, axis: DVec3, coefficients: &[f64]) -> Joint {
        let kind = JointKind::Prismatic { axis, value: value(coefficients) };
        Joint::try_new(x, DQuat::IDENTITY, kind).unwrap()
    }

    #[test]
    fn clocks_are_rounded_to_the_safe_side() {
        for (middle, bend) in [(0.5, 0.3), (0.5, -0.9), (1e5 + 0.5, 0.7), (-3.0, 1e-9), (2.0, 0.0)] {
            let clock = FittedClock { middle, bend };
            let [start, end] = clock.span(middle - 0.5, middle + 0.5);
            for i in 0..=200 {
                let s = start + (end - start) * f64::from(i) / 200.0;
                let (down, up) = (clock.time_down(s, middle - 1.0), clock.time_up(s, middle + 1.0));
                assert!(clock.at(down).hi() <= s && s <= clock.at(up).lo(), "{middle} {bend} {s}");
                assert!(up - down <= 32.0 * f64::EPSILON * (1.0 + middle.abs()), "{middle} {bend} {s}");
            }
        }
    }

    /// Where no number lies within the span and the next piece of the motion begins at its end, in which it rests.
    #[test]
    fn spans_without_a_number_inside_are_fitted_in_their_own_piece() {
        fn ball(motion: &dyn RigidMotion) -> MovingBall<'_> {
            MovingBall { motion, center: DVec3::new(0.5, 0.5, 0.0), radius: 0.8 }
        }
        for begin in [1.0, 1.0f64.next_up(), 3.0] {
            let times = vec![begin, begin.next_up(), begin.next_up().next_up()];
            let u = times[1] - times[0];
            let value = JointValue::try_pieces(times.clone(), vec![vec![0.0, 10.0 / u], vec![10.0]]).unwrap();
            let kind = JointKind::Prismatic { axis: DVec3::X, value };
            let joint = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap();
            let (motion, still) = (Chain::try_new(vec![joint]).unwrap(), ConstantTwist::REST);
            let bodies = [ball(&motion), ball(&still)];
            let fitted = FittedTwists::new(&bodies, Interval::new(times[0], times[1]), DVec3::ZERO).unwrap();
            assert_eq!(fitted.clock.middle, times[0]);
            assert!(fitted.twists[0].linear_velocity().x > 9.0 / u, "{:?}", fitted.twists[0]);
        }
    }

    /// In units of time whose square is no number a deviation is the same part of the unit of length.
    #[test]
    fn deviations_are_the_same_in_any_unit_of_time() {
        let deviation = |meter: i32, second: i32| {
            let (meter, second) = (2f64.powi(meter), 2f64.powi(second));
            let gained = meter / second / second;
            let motion = Chain::try_new(vec![
                sliding(DVec3::ZERO, DVec3::Z, &[0.0, meter / second]),
                sliding(DVec3::ZERO, DVec3::X, &[0.0, 0.0, gained]),
            ])
            .unwrap();
            let still = ConstantTwist::REST;
            let ball = |motion| MovingBall { motion, center: DVec3::ZERO, radius: meter };
            let bodies: [MovingBall<'_>; 2] = [ball(&motion), ball(&still)];
            let fitted = FittedTwists::new(&bodies, Interval::new(0.0, second), DVec3::ZERO).unwrap();
            fitted.deviation / meter
        };
        let usual = deviation(0, 0);
        assert!(usual > 0.25);
        for (meter, second) in [(-90, -540), (-150, -570), (0, 450), (40, -470)] {
            let found = deviation(meter, second);
            // Lengths of very large and very small vectors are known to √3.
            assert!((1.0 - 1e-12..1.74).contains(&(found / usual)), "{meter} {second}: {found:e} {usual:e}");
        }
    }

    /// Differences of positions, of the corners of a body that is a thin rod from its origin and of a point at rest: within
    /// the bound at all times of the span, and nearly reached by some.
    #[test]
    fn fitted_twists_stay_within_the_deviation() {
        let corners = [-DVec3::X, DVec3::X, DVec3::Y * 1e-3];
        fn ball(motion: &dyn RigidMotion, radius: f64) -> MovingBall<'_> {
            MovingBall { motion, center: DVec3::ZERO, radius }
        }
        let still = ConstantTwist::REST;
        let mut sharpest = [0.0_f64; 6];
        for (kind, joints) in [
            vec![sliding(DVec3::ZERO, DVec3::Z, &[0.0, 1.0, 1.0])],
            vec![turning(DVec3::ZERO, DVec3::Z, &[0.0, 0.0, 1.0])],
            vec![
                turning(DVec3::ZERO, DVec3::Z, &[0.3, -2.0]),
                turning(DVec3::X, DVec3::Y, &[0.0, 1.0, -3.0]),
            ],
            // A turn at a constant rate about a point that the body does not follow: the pole does not accelerate.
            vec![turning(DVec3::ZERO, DVec3::Z, &[0.0, 2.0]), turning(DVec3::X, DVec3::Y, &[0.0])],
            // Across the velocity, and from rest.
            vec![
                sliding(DVec3::ZERO, DVec3::Z, &[0.0, 1.0]),
                sliding(DVec3::ZERO, DVec3::X, &[0.0, 0.0, 1.0]),
            ],
            vec![turning(DVec3::ZERO, DVec3::Z, &[0.0, 0.0, 1.0])],
        ]
        .into_iter()
        .enumerate()
        {
            let motion = Chain::try_new(joints).unwrap();
            for (from, to) in [(0.0, 0.1), (0.4, 0.5), (-0.3, 0.3), (-0.05, 0.05), (1.0, 1.000_01)] {
                let bodies = [ball(&motion, 1.0), ball(&still, 1e-6)];
                let fitted = FittedTwists::new(&bodies, Interval::new(from, to), DVec3::ZERO).unwrap();
                assert!(fitted.floor <= fitted.deviation && fitted.floor < 1e-13);
                let mut most = 0.0_f64;
                for i in 0..=20 {
                    let t = from + (to - from) * f64::from(i) / 20.0;
                    let (true_pose, _) = motion.pose_and_twist(t);
                    let (near, _) = fitted.twists[0].pose_and_twist(fitted.clock.at(t).mid());
                    for corner in &corners {
                        let off = true_pose.transform_point(*corner) - near.transform_point(*corner);
                        assert!(off.length() <= fitted.deviation + 1e-14, "{kind}, {t}");
                        most = most.max(off.length());
                    }
                }
                if to - from > 0.05 {
                    sharpest[kind] = sharpest[kind].max(most / fitted.deviation);
                }
            }
            if kind == 3 {
                let bodies = [ball(&motion, 1.0), ball(&still, 1e-6)];
                let fitted = FittedTwists::new(&bodies, Interval::new(0.0, 1e-4), DVec3::ZERO).unwrap();
                assert!(fitted.deviation < 1e-2 * 0.5 * 0.5e-4 * 0.5e-4 * 4.0, "{fitted:?}");
            }
        }
        // The first two become faster as their clock does: what is left are radii.
        assert!(sharpest[4] > 0.99 && sharpest[5] > 0.9, "{sharpest:?}");
    }
}
