//! A user's own motion held against its promises, by samples.
use crate::RigidMotion;
use core::fmt;
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// A promise of [`RigidMotion`] that a motion was caught breaking.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist, check_motion};
/// use glam::DVec3;
/// /// Says that it stands, and moves.
/// struct Liar;
/// const TRUTH: ConstantTwist = ConstantTwist::REST;
/// impl RigidMotion for Liar {
///     fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
///         (Pose { translation: DVec3::X * t, ..Pose::IDENTITY }, Twist::ZERO)
///     }
///     fn enclose_pose(&self, t: Interval) -> IntervalPose { TRUTH.enclose_pose(t) }
///     fn enclose_twist(&self, t: Interval) -> IntervalTwist { TRUTH.enclose_twist(t) }
///     fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist { TRUTH.enclose_twist_rate(t) }
/// }
/// let faults = check_motion(&Liar, Interval::UNIT, 10);
/// assert!(faults.iter().any(|fault| fault.what.contains("pose")), "{faults:?}");
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MotionFault {
    /// The span of time that was checked.
    pub span: Interval,
    /// The method that does not keep its promise, and what of it.
    pub what: &'static str,
    /// What should have been enclosed.
    pub value: DVec3,
    /// Least coordinates of the enclosure.
    pub lower: DVec3,
    /// Greatest coordinates of the enclosure.
    pub upper: DVec3,
}

impl fmt::Display for MotionFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [value, lower, upper] = [self.value, self.lower, self.upper].map(|v| v.to_array());
        let (start, end) = (self.span.lo(), self.span.hi());
        write!(f, "{} from {start:?} to {end:?}: {value:?} is not between {lower:?} and {upper:?}", self.what)
    }
}

/// Samples a motion against its enclosures: which of its promises fails, and where.
///
/// At `samples` times and over spans of several lengths from each: the pose as computed lies in its enclosure, differences
/// of poses and of twists over a span lie in what the enclosures of twist and twist rate allow, enclosures over a part lie
/// inside those over the whole, the certified state agrees, the reference point stays the same, and `smooth_until` lies
/// ahead. An empty answer proves nothing; a fault that is reported is one (up to a rounding of 1e-9 of the values).
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{ConstantTwist, check_motion};
/// let spin = ConstantTwist::REST.with_angular_velocity(glam::DVec3::Z);
/// assert!(check_motion(&spin, Interval::UNIT, 100).is_empty());
/// ```
pub fn check_motion(motion: &dyn RigidMotion, span: Interval, samples: usize) -> Vec<MotionFault> {
    let mut faults = Vec::new();
    let domain = span.intersection(motion.domain());
    if domain.is_empty() || !domain.is_bounded() {
        let [value, lower, upper] = [span.lo(), motion.domain().lo(), motion.domain().hi()].map(DVec3::splat);
        faults.push(MotionFault { span, what: "domain", value, lower, upper });
        return faults;
    }
    for i in 0..=samples {
        let t = domain.lo() + domain.width() * (i as f64 / samples.max(1) as f64);
        for part in [0.0, 1e-4, 1e-2, 0.3] {
            let t = t.min(domain.hi());
            let until = (t + part * domain.width()).min(domain.hi());
            // Promises about derivatives hold piece by piece.
            let until = motion.smooth_until(t).map_or(until, |joint| until.min(joint));
            check_span(motion, t, until.max(t), &mut faults);
        }
    }
    faults
}

/// Rounding of what is computed in plain floating point, per unit of its size.
const SLACK: f64 = 1e-9;

fn check_span(motion: &dyn RigidMotion, t: f64, until: f64, faults: &mut Vec<MotionFault>) {
    let span = Interval::new(t, until);
    if let Some(joint) = motion.smooth_until(t).filter(|&joint| joint.is_nan() || joint <= t) {
        let [value, lower, upper] = [joint, t.next_up(), motion.domain().hi()].map(DVec3::splat);
        faults.push(MotionFault { span, what: "smooth_until", value, lower, upper });
    }
    let (pose, twist, rate) =
        (motion.enclose_pose(span), motion.enclose_twist(span), motion.enclose_twist_rate(span));
    let mut hold = |what: &'static str, value: DVec3, enclosure: IntervalVec3, size: f64| {
        let wide = DVec3::splat(SLACK * (size + value.abs().max_element()));
        let outside = (enclosure.lo() - wide).cmpgt(value) | (enclosure.hi() + wide).cmplt(value);
        // Also what is no number is a fault.
        if outside.any() || !value.is_finite() {
            faults.push(MotionFault { span, what, value, lower: enclosure.lo(), upper: enclosure.hi() });
        }
    };
    let (now, speed) = motion.pose_and_twist(t);
    hold("at", now.at, IntervalVec3::point(pose.at), 0.0);
    let state = motion.enclose_state(t);
    for time in [t, t + 0.37 * (until - t)] {
        let (p, w) = motion.pose_and_twist(time);
        hold("enclose_pose, translation", p.translation, pose.translation, 0.0);
        for (axis, column) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().zip(pose.rotation.cols()) {
            hold("enclose_pose, rotation", p.rotation * axis, column, 1.0);
        }
        hold("enclose_twist, linear", w.linear, twist.linear, 0.0);
        hold("enclose_twist, angular", w.angular, twist.angular, 0.0);
        let part = motion.enclose_kinematics(Interval::point(time));
        hold(
            "enclose_kinematics",
            part.position.center + part.position_tail,
            pose.translation,
            part.position.radius / SLACK,
        );
    }
    hold("enclose_state, position", state.position, pose.translation, state.position_radius / SLACK);
    hold("enclose_state, linear", state.linear, twist.linear, state.linear_radius / SLACK);
    hold("enclose_state, angular", state.angular, twist.angular, state.angular_radius / SLACK);
    let h = until - t;
    if h > 0.0 {
        // A difference over a span is the span times a value of the derivative's hull (mean value, coordinate by coordinate).
        let inside = t + 0.37 * h;
        let (later, faster) = motion.pose_and_twist(inside);
        let size = |a: DVec3, b: DVec3| (a.length() + b.length()) / (inside - t) * 1e-3;
        // What rounding leaves open of both states, for instance by an axis that is far away.
        let other = motion.enclose_state(inside);
        let open = |a: f64, b: f64| (a + b) / (inside - t) / SLACK;
        let by = |a: DVec3, b: DVec3| (b - a) / (inside - t);
        let moved = by(now.translation, later.translation);
        let places =
            size(now.translation, later.translation) + open(state.position_radius, other.position_radius);
        hold("enclose_twist, linear (moved)", moved, twist.linear, places);
        let (dv, dw) = (by(speed.linear, faster.linear), by(speed.angular, faster.angular));
        hold("enclose_twist_rate, linear", dv, rate.linear, size(speed.linear, faster.linear));
        hold("enclose_twist_rate, angular", dw, rate.angular, size(speed.angular, faster.angular));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ConstantTwist, IntervalPose, IntervalTwist, Pose, Twist};

    /// A turning body with one promise broken.
    struct Broken(ConstantTwist, &'static str);

    impl RigidMotion for Broken {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            self.0.pose_and_twist(t)
        }
        fn enclose_pose(&self, t: Interval) -> IntervalPose {
            self.0.enclose_pose(if self.1 == "enclose_pose" { Interval::point(t.lo()) } else { t })
        }
        fn enclose_twist(&self, t: Interval) -> IntervalTwist {
            let twist = self.0.enclose_twist(t);
            let slow = IntervalTwist { angular: twist.angular * Interval::point(0.5), ..twist };
            if self.1 == "enclose_twist" { slow } else { twist }
        }
        fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
            let rate = self.0.enclose_twist_rate(t);
            let other = IntervalTwist { linear: rate.linear + DVec3::X, ..rate };
            if self.1 == "enclose_twist_rate" { other } else { rate }
        }
        fn smooth_until(&self, t: f64) -> Option<f64> {
            (self.1 == "smooth_until").then_some(t - 0.5)
        }
    }

    #[test]
    fn broken_promises_are_named() {
        let turn = ConstantTwist::REST.with_angular_velocity(DVec3::Z).with_linear_velocity(DVec3::X);
        for what in ["enclose_pose", "enclose_twist", "enclose_twist_rate", "smooth_until"] {
            let faults = check_motion(&Broken(turn, what), Interval::new(0.0, 2.0), 10);
            assert!(faults.iter().any(|fault| fault.what.starts_with(what)), "{what}: {faults:?}");
        }
        assert!(check_motion(&Broken(turn, ""), Interval::new(0.0, 2.0), 10).is_empty());
        assert_eq!(check_motion(&turn, Interval::EMPTY, 10)[0].what, "domain");
    }
}
