//! How far bodies go and turn.

use crate::output::{digits, note};
use d2m::bvh::{QueryError, Window};
use d2m::interval::Interval;
use d2m::motion::{AnyMotion, RigidMotion};
use std::f64::consts::TAU;

/// What a motion does in a window, as a person checks it. It is an estimate: nothing else depends on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Travel {
    /// Length of the path of the point that the motion follows.
    pub(crate) way: f64,
    /// Sum of all turning, radians.
    pub(crate) turn: f64,
}

/// Turns up to this are one whole turn, which is no surprise: their sum rounds. It only decides about a warning.
const ONE_TURN: f64 = TAU * (1.0 + 1e-9);

impl Travel {
    /// Sums speeds at the middles of equal parts of the window.
    pub(crate) fn of(motion: &AnyMotion, window: Window) -> Self {
        const PARTS: u32 = 1024;
        if let Some(twist) = motion.constant_twist() {
            let [way, turn] =
                [twist.linear_velocity(), twist.angular_velocity()].map(|v| v.length() * window.length());
            return Self { way, turn };
        }
        let part = window.length() / f64::from(PARTS);
        let (mut way, mut turn) = (0.0, 0.0);
        for index in 0..PARTS {
            let (_, twist) = motion.pose_and_twist(window.start() + part * (f64::from(index) + 0.5));
            way += twist.linear.length() * part;
            turn += twist.angular.length() * part;
        }
        Self { way, turn }
    }
}

impl Travel {
    /// [`Self::turns_far`] of what [`Self::of`] sums, which is not summed where the fastest turn that is possible is not enough.
    pub(crate) fn of_turns_far(motion: &AnyMotion, window: Window) -> bool {
        let (span, times) = (Interval::new(window.start(), window.end()), motion.domain());
        if times.lo() <= span.lo() && span.hi() <= times.hi() {
            // What is not a number is no bound.
            let fastest = motion.enclose_twist(span).angular.norm().hi();
            if fastest * window.length() <= TAU {
                return false;
            }
        }
        Self::of(motion, window).turns_far()
    }
}

impl Travel {
    /// Does the body turn more than once? Often degrees were meant.
    pub(crate) fn turns_far(self) -> bool {
        // Queries refuse the largest ones.
        self.turns_more_than_once() && self.turn < QueryError::MOST_ANGLE
    }

    pub(crate) fn turns_more_than_once(self) -> bool {
        self.turn > ONE_TURN
    }
}

/// Warns of a body that turns more than once.
pub(crate) fn warn_of_turn(place: &str, travel: Travel) {
    if travel.turns_far() {
        note(&format!(
            "d2m: warning: {place}: the body turns {} times in the window; angles are radians, or degrees with deg behind the number",
            digits(travel.turn / TAU)
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::glam::{DQuat, DVec3};
    use d2m::motion::{Chain, ConstantTwist, Joint, JointKind, JointValue};

    /// Also of a joint that turns as far, but not steadily, so that its fastest turn is no bound that is enough.
    #[test]
    fn bodies_that_turn_more_than_once_are_known_without_their_sum_too() {
        let window = Window::UNIT;
        for (angle, turns_far) in [(0.1, false), (6.2, false), (6.4, true), (100.0, true)] {
            let twist = ConstantTwist::REST.with_angular_velocity(DVec3::Z * angle);
            let mut motions: Vec<AnyMotion> = vec![twist.into()];
            for coefficients in [vec![0.0, angle], vec![0.0, 0.0, angle]] {
                let value = JointValue::try_polynomial(coefficients).unwrap();
                let kind = JointKind::Revolute { axis: DVec3::Z, value };
                let joint = Joint::try_new(DVec3::X, DQuat::IDENTITY, kind).unwrap();
                motions.push(Chain::try_new(vec![joint]).unwrap().into());
            }
            for motion in &motions {
                assert_eq!(Travel::of(motion, window).turns_far(), turns_far, "{angle}");
                assert_eq!(Travel::of_turns_far(motion, window), turns_far, "{angle}");
            }
        }
    }
}
