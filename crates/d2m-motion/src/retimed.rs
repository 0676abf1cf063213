//! A motion at another pace.
use crate::ball::{Ball, length_up, up};
use crate::error::fault;
use crate::rounding::UNIT;
use crate::{CertifiedState, IntervalPose, IntervalTwist, Kinematics, MotionError, Pose, RigidMotion, Twist};
use d2m_interval::Interval;
use d2m_lanes::{two_product, two_sum};
use glam::{DMat3, DVec3};

/// A smooth motion at another pace: at time t where the given one is at `rate·t + offset`.
///
/// A negative rate runs it backwards. Motions with joints are refused: their joints would fall between two doubles (retime
/// [`Keyframes`](crate::Keyframes) and the values of a [`Chain`](crate::Chain) instead).
///
/// ```
/// use d2m_motion::{ConstantTwist, Retimed, RigidMotion};
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_linear_velocity(-DVec3::Z);
/// let rising = Retimed::try_reversed(falling, 0.0, 2.0)?;
/// let (pose, twist) = rising.pose_and_twist(0.5);
/// assert_eq!((pose.translation, twist.linear), (DVec3::Z * -1.5, DVec3::Z));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retimed<M> {
    motion: M,
    rate: f64,
    offset: f64,
    /// What `offset` leaves of a sum.
    offset_low: f64,
}

/// The time of the given motion at one time: `center`, which is in its domain, plus `rest`, within `error`.
#[derive(Clone, Copy)]
struct InnerTime {
    center: f64,
    rest: f64,
    error: f64,
}

/// Products from here on lose nothing in twice the digits.
const LEAST_PRODUCT: f64 = f64::from_bits((1023 - 960) << 52);
/// Numbers for time that are tried for the end of the domain.
const STEPS: u32 = 4;

impl<M: RigidMotion> Retimed<M> {
    /// At time t where `motion` is at `rate·t + offset`.
    ///
    /// # Errors
    /// A rate that is zero or not finite, an offset that is not finite, a motion with joints.
    pub fn try_new(motion: M, rate: f64, offset: f64) -> Result<Self, MotionError> {
        if !(rate.is_finite() && rate != 0.0) {
            return Err(fault("rate".into(), format!("{rate} is not a finite number other than zero")));
        }
        if !offset.is_finite() {
            return Err(fault("offset".into(), format!("{offset} is not finite")));
        }
        let (start, end) = (motion.domain().lo(), motion.domain().hi());
        if let Some(joint) = motion.smooth_until(start).filter(|&joint| joint < end) {
            let reason =
                format!("it has a joint at the time {joint:?}, and only smooth motions can be retimed");
            return Err(fault("motion".into(), reason));
        }
        Ok(Self { motion, rate, offset, offset_low: 0.0 })
    }

    /// The motion between `start` and `end` run backwards: at t where the given one is at `start + end − t`, the sum
    /// without rounding.
    ///
    /// # Errors
    /// As [`Retimed::try_new`].
    pub fn try_reversed(motion: M, start: f64, end: f64) -> Result<Self, MotionError> {
        let (offset, offset_low) = two_sum(start, end);
        Ok(Self { offset_low, ..Self::try_new(motion, -1.0, offset)? })
    }

    /// The given motion's time. It is in its domain wherever this motion is defined.
    fn time(&self, t: Interval) -> Interval {
        let [start, end] = [t.lo(), t.hi()].map(|t| self.inner_time(t));
        let [first, last] = if self.rate > 0.0 { [start, end] } else { [end, start] };
        let low = ((first.center + first.rest).next_down() - first.error).next_down();
        let high = ((last.center + last.rest).next_up() + last.error).next_up();
        // Products of intervals are wider by 2⁻⁵⁰⁰, which is long where all times are short; but they know numbers of any size.
        let time = if (high - low).is_finite() && low <= high {
            Interval::new(low, high)
        } else {
            t * self.rate + Interval::point(self.offset) + Interval::point(self.offset_low)
        };
        let inside = time.intersection(self.motion.domain());
        if inside.is_empty() { time } else { inside }
    }

    /// rate·t + offset with all digits: a product and three sums, each with what it loses.
    fn inner_time(&self, t: f64) -> InnerTime {
        let (product, low) = two_product(self.rate, t);
        let (sum, lost) = two_sum(product, self.offset);
        let (part, first) = two_sum(lost, self.offset_low);
        let (rest, second) = two_sum(low, part);
        let underflow = if t != 0.0 && product.abs() < LEAST_PRODUCT { f64::MIN_POSITIVE } else { 0.0 };
        let domain = self.motion.domain();
        let center = if domain.is_empty() { sum } else { sum.clamp(domain.lo(), domain.hi()) };
        // Zero, or what is moved back by the rest.
        let (rest, third) = two_sum(rest, sum - center);
        InnerTime { center, rest, error: up(first.abs() + second.abs() + third.abs()) + underflow }
    }

    /// An end of the domain: the outermost number for time that is certainly not beyond it; `inwards` is the direction.
    fn end_at(&self, end: f64, inwards: f64) -> Option<f64> {
        let mut t = ((end - self.offset) - self.offset_low) / self.rate;
        for _ in 0..STEPS {
            let InnerTime { center, rest, error } = self.inner_time(t);
            // The sum of the center and the rest is beyond the end on the side where their difference has that sign.
            let beyond = (end - center) * (inwards * self.rate.signum());
            let rest = rest * (inwards * self.rate.signum());
            if rest - error >= beyond {
                return Some(t);
            }
            t = if inwards > 0.0 { t.next_up() } else { t.next_down() };
        }
        None
    }

    /// The given motion's set of states at one time of this one, on its own clock.
    ///
    /// About the nearest number c for its time, d = rest: x(c + d) = x + v d within ½d² sup|a|, R(c + d) = R + d\[ω\]R within
    /// ½d²(sup|α| + sup|ω|²), velocities change by d times one of the rates between. Otherwise far from zero, where numbers for time are far apart, the
    /// position would be unknown by as much as the body moves from one to the next.
    fn inner_state(&self, t: f64) -> Kinematics {
        let InnerTime { center, rest, error } = self.inner_time(t);
        if !center.is_finite() {
            return self.motion.enclose_kinematics(self.time(Interval::point(t)));
        }
        let here = self.motion.enclose_kinematics(Interval::point(center));
        let reach = up(rest.abs() + error);
        if reach == 0.0 {
            return here;
        }
        let span = Interval::try_new((center - reach).next_down(), (center + reach).next_up());
        let inside = span.map_or(Interval::EMPTY, |span| span.intersection(self.motion.domain()));
        if inside.is_empty() {
            return self.motion.enclose_kinematics(self.time(Interval::point(t)));
        }
        let around = self.motion.enclose_kinematics(inside);
        let (bend, turn_rate) = (around.linear_rate.bound_length(), around.angular_rate.bound_length());
        let speed = around.linear.bound_length().max(here.linear.bound_length());
        let turn = around.angular.bound_length().max(here.angular.bound_length());
        // Squares of rates or of times alone may be no numbers.
        let (bent, turned) = (0.5 * reach * (reach * bend), reach * turn);
        let moved = here.linear.center * rest;
        let tail = here.position_tail + moved;
        let position_radius = here.position.radius
            + reach * here.linear.radius
            + error * speed
            + bent
            + f64::MIN_POSITIVE
            + 4.0 * UNIT * (length_up(moved) + length_up(tail));
        let changed = |speed: Ball, by: Ball| {
            let center = speed.center + by.center * rest;
            let rounding = 4.0 * UNIT * (length_up(center) + length_up(by.center) * reach);
            let radius = speed.radius + reach * by.radius + error * by.bound_length() + rounding;
            Ball::new(center, up(radius))
        };
        let column = |k: usize| {
            let axis = here.rotation.col(k);
            axis + here.angular.center.cross(axis) * rest
        };
        let rotation = DMat3::from_cols(column(0), column(1), column(2));
        // Entries round by less than a unit of numbers up to 1 and of 4 of d|ω|; nine of them.
        let rotation_radius = here.rotation_radius * (1.0 + turned)
            + reach * here.angular.radius
            + error * turn * (1.0 + here.rotation_radius)
            + 0.5 * (reach * (reach * turn_rate) + turned * turned)
            + 16.0 * UNIT * (1.0 + turned);
        Kinematics {
            position: Ball::new(here.position.center, up(position_radius)),
            position_tail: if tail.is_finite() { tail } else { DVec3::ZERO },
            linear: changed(here.linear, around.linear_rate),
            angular: changed(here.angular, around.angular_rate),
            linear_rate: around.linear_rate,
            angular_rate: around.angular_rate,
            ..here
        }
        .with_rotation(rotation, up(rotation_radius))
    }
}

impl<M: RigidMotion> RigidMotion for Retimed<M> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let InnerTime { center, rest, .. } = self.inner_time(t);
        let (pose, twist) = if rest == 0.0 {
            self.motion.pose_and_twist(center)
        } else {
            let state = self.inner_state(t);
            (state.middle_pose(), Twist { linear: state.linear.center, angular: state.angular.center })
        };
        (pose, Twist { linear: twist.linear * self.rate, angular: twist.angular * self.rate })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.motion.enclose_pose(self.time(t))
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let twist = self.motion.enclose_twist(self.time(t));
        let rate = Interval::point(self.rate);
        IntervalTwist { linear: twist.linear * rate, angular: twist.angular * rate }
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let twist = self.motion.enclose_twist_rate(self.time(t));
        let square = Interval::point(self.rate).sqr();
        IntervalTwist { linear: twist.linear * square, angular: twist.angular * square }
    }

    fn domain(&self) -> Interval {
        let inner = self.motion.domain();
        if inner.is_entire() {
            return inner;
        }
        let (first, last) = if self.rate > 0.0 { (inner.lo(), inner.hi()) } else { (inner.hi(), inner.lo()) };
        let end = |inner: f64, inwards: f64| {
            if inner.is_finite() { self.end_at(inner, inwards) } else { Some(-inwards * f64::INFINITY) }
        };
        match (end(first, 1.0), end(last, -1.0)) {
            (Some(first), Some(last)) => Interval::try_new(first, last).unwrap_or(Interval::EMPTY),
            _ => Interval::EMPTY,
        }
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.enclose_state_about(t, DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.enclose_kinematics(Interval::point(t)).state_about(origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        let inner = if t.lo() == t.hi() {
            self.inner_state(t.lo())
        } else {
            self.motion.enclose_kinematics(self.time(t))
        };
        inner.in_unit_of_time(self.rate, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chain, ConstantTwist, Joint, JointKind, JointValue, Spline, SplineDegree};
    use glam::DQuat;

    fn unit(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn turn(axis: DVec3, times: &[f64], coefficients: &[f64]) -> Joint {
        let value = if times.is_empty() {
            JointValue::try_polynomial(coefficients.to_vec())
        } else {
            JointValue::try_pieces(times.to_vec(), vec![coefficients.to_vec()])
        };
        let kind = JointKind::Revolute { axis, value: value.unwrap() };
        Joint::try_new(DVec3::X, DQuat::IDENTITY, kind).unwrap()
    }

    /// What runs backwards between two times is defined at both, and is there where the given motion is at the other one.
    #[test]
    fn reversed_motions_are_defined_from_start_to_end() {
        let mut seed = 3;
        for round in 0..500 {
            let start = [0.0, 1e5, -3.0, 0.1][round % 4];
            let end = start + 3.0 * unit(&mut seed);
            let joints =
                vec![turn(DVec3::Z, &[start, end], &[0.1, 0.7]), turn(DVec3::Y, &[start, end], &[0.3, 1.0])];
            let chain = Chain::try_new(joints).unwrap();
            let back = Retimed::try_reversed(chain.clone(), start, end).unwrap();
            let domain = back.domain();
            assert_eq!((domain.lo(), domain.hi()), (start, end));
            for (t, other) in [(start, end), (end, start)] {
                let (a, b) = (back.enclose_state(t), chain.enclose_state(other));
                let off = (a.position - b.position).length() + (a.linear + b.linear).length();
                assert!(off < 1e-13, "{a:?} {b:?}");
                assert!(back.enclose_pose(Interval::point(t)).translation.x.contains(b.position.x));
            }
        }
    }

    /// The domain is all that the given motion has: no number for time just outside of it would do.
    #[test]
    fn domains_of_retimed_motions_are_whole_and_no_more() {
        let mut seed = 5;
        for _ in 0..500 {
            let (start, length) = (1e3 * unit(&mut seed), 1.0 + unit(&mut seed));
            let chain = Chain::try_new(vec![turn(DVec3::Z, &[start, start + length], &[0.1, 0.7])]).unwrap();
            let rate = 4.0 * (unit(&mut seed) - 0.5);
            let motion = Retimed::try_new(chain, rate, 10.0 * unit(&mut seed)).unwrap();
            let domain = motion.domain();
            for (t, beyond) in [(domain.lo(), -1.0), (domain.hi(), 1.0)] {
                let time = |t: f64| motion.inner_time(t);
                let is_inside = |at: InnerTime| {
                    let over = if at.rest > 0.0 {
                        at.center + at.rest - (start + length)
                    } else {
                        at.center + at.rest - start
                    };
                    if at.rest > 0.0 { over <= 0.0 } else { over >= 0.0 }
                };
                assert!(is_inside(time(t)));
                // At most a few units further in than need be.
                let unit = (t.abs() + 10.0 / rate.abs()) * 8.0 * f64::EPSILON;
                let out = rate * (t + beyond * unit) + motion.offset;
                assert!(out < start || out > start + length, "{t} {out}");
            }
        }
    }

    /// Far from the origin of time the state is known as well as the given motion's, and it is that of the same motion whose
    /// values were retimed (by hand, exactly).
    #[test]
    fn states_are_sharp_far_from_the_origin_of_time() {
        let mut seed = 7;
        for round in 0..300 {
            let start = [1e5, 1e7, -1e6][round % 3];
            let rate = 3.0 * (unit(&mut seed) - 0.5);
            let offset = -rate * start;
            let spin = DVec3::new(unit(&mut seed), unit(&mut seed), 1.0);
            // x(τ) = τ v and an angle of τ, with τ = rate·t + offset in twice the digits.
            let still = ConstantTwist::REST.with_linear_velocity(DVec3::X * 2.0).with_angular_velocity(spin);
            let motion = Retimed::try_new(still, rate, offset).unwrap();
            let t = start + 2.0 * unit(&mut seed);
            let InnerTime { center, rest, error } = motion.inner_time(t);
            assert!(error <= 1e-26 * start.abs() && rest != 0.0);
            let state = motion.enclose_state(t);
            let wanted = 2.0 * center + 2.0 * rest;
            assert!((state.position.x - wanted).abs() <= state.position_radius, "{round}");
            assert!(state.position_radius < 1e-14 && state.rotation_radius < 1e-13, "{state:?}");
            let (turned, _) = still.pose_and_twist(center);
            let more = DQuat::from_scaled_axis(spin * rest) * turned.rotation;
            let off = state.rotation * DVec3::X - more * DVec3::X;
            assert!(off.length() < 1e-15 + state.rotation_radius, "{round}: {off}");
            let (pose, _) = motion.pose_and_twist(t);
            assert!((pose.translation.x - wanted).abs() < 1e-15 * (1.0 + wanted.abs()) * 4.0);
        }
    }

    /// In any unit of time the state is known as well, and what moves by less than the least number in a unit of time is not at rest.
    #[test]
    fn states_are_as_sharp_in_any_unit_of_time() {
        let wide = |second: i32| {
            let second = 2f64.powi(second);
            let twist = ConstantTwist::REST
                .with_linear_velocity(DVec3::X * (0.3 / second))
                .with_angular_velocity(DVec3::Y * (0.1 / second));
            let motion = Retimed::try_new(twist, -1.5, 0.25 * second).unwrap();
            let state = motion.enclose_state(0.7 * second);
            let over = motion.enclose_kinematics(Interval::new(0.6 * second, 0.7 * second));
            [state.position_radius, state.rotation_radius, over.position.radius, over.rotation_radius]
        };
        let usual = wide(0);
        for second in [-900, -600, -100, 100, 600, 900] {
            let found = wide(second);
            for (found, usual) in found.into_iter().zip(usual) {
                assert!(found <= 2.0 * usual, "{second}: {found:e} {usual:e}");
            }
        }
        let least = 2f64.powi(-565);
        let slow = ConstantTwist::REST.with_linear_velocity(DVec3::X * least);
        let state = Retimed::try_new(slow, least, 0.0).unwrap().enclose_state(1.0);
        assert!(state.linear == DVec3::ZERO && state.linear_radius > 0.0, "{state:?}");
    }

    #[test]
    fn splines_with_one_span_run_backwards() {
        let pose = |x: f64, angle: f64| Pose {
            translation: DVec3::X * x,
            rotation: DQuat::from_rotation_y(angle),
            at: DVec3::ZERO,
        };
        let path =
            Spline::try_through(&[(0.1, pose(0.0, 0.0)), (0.7, pose(1.0, 1.0))], SplineDegree::Quintic)
                .unwrap();
        let back = Retimed::try_reversed(path, 0.1, 0.7).unwrap();
        assert_eq!((back.domain().lo(), back.domain().hi()), (0.1, 0.7));
        assert!(crate::check_motion(&back, Interval::new(0.1, 0.7), 50).is_empty());
    }
}
