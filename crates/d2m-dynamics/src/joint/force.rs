//! Springs, soft motors and friction of joints: forces, whose impulse in a flight depends on how long it is.
//!
//! A flight may end before its step does, where joints are not met at the end of a longer one, where a
//! kinematic body begins its next flight, or at an event. Up to where its flight was planned to end a force has
//! acted by the impulse that it was solved with; the next flight has its impulse from there on.

use crate::joint::description::{Joint, Motor, MotorTarget};
use d2m_contact::Law;

/// The part of a joint's position error that a step corrects.
pub(crate) const TAKEN_BACK: f64 = 0.2;

/// A force along the value of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Force {
    Spring,
    Motor,
    Friction,
}

/// Until when the forces of a joint have acted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Acted {
    /// By the impulses of the last solution, and of the one before, which may take its place.
    #[cfg_attr(feature = "serde", serde(with = "never"))]
    until: f64,
    #[cfg_attr(feature = "serde", serde(with = "never"))]
    before: f64,
    /// From when on they act in the next flight.
    #[cfg_attr(feature = "serde", serde(with = "never"))]
    pub(crate) from: f64,
}

impl Default for Acted {
    /// They have never acted.
    fn default() -> Self {
        let never = f64::NEG_INFINITY;
        Self { until: never, before: never, from: never }
    }
}

impl Acted {
    /// Are these times, or never? A snapshot may have others.
    pub(crate) fn is_known(&self) -> bool {
        [self.until, self.before, self.from].into_iter().all(|time| time < f64::INFINITY)
    }

    /// A flight begins at this time, with other impulses than the last solution has found or after these.
    pub(crate) fn begin(&mut self, time: f64, is_solved_again: bool) {
        if !is_solved_again {
            self.before = self.until;
        }
        self.from = time.max(self.before);
    }

    /// That flight is planned to end at this time.
    pub(crate) fn fly_until(&mut self, end: f64) {
        self.until = self.before.max(end);
    }
}

impl Joint {
    /// The laws of the joint's forces, and their rates, if they act for this time.
    pub(crate) fn laws_of_forces(&self, value: f64, time: f64) -> Vec<(Law, f64)> {
        self.forces().map(|force| self.law_of(force, value, time)).collect()
    }

    fn forces(&self) -> impl Iterator<Item = Force> {
        let spring = self.spring.filter(|spring| spring.stiffness + spring.damping > 0.0);
        let is_soft = |target: MotorTarget| matches!(target, MotorTarget::Position(_));
        let motor = self.motor.filter(|motor| motor.stiffness > 0.0 && is_soft(motor.target));
        let friction = self.friction > 0.0;
        let forces =
            [spring.map(|_| Force::Spring), motor.map(|_| Force::Motor), friction.then_some(Force::Friction)];
        forces.into_iter().flatten()
    }

    /// The law of a force that acts for this time, and its rate. Springs and motors are implicit: they have the
    /// force of the value and the rate at the end, so that no stiffness is too large. One whose impulse for
    /// each unit of rate is so small that its inverse is no number has none: below 2⁻¹⁰²⁴ it changes no momentum.
    fn law_of(&self, force: Force, value: f64, time: f64) -> (Law, f64) {
        let none = (Law::Range { lo: 0.0, hi: 0.0, softness: 0.0 }, 0.0);
        let soft = |stiffness: f64, damping: f64, off: f64, most: f64| {
            let softness = 1.0 / (time * (time * stiffness + damping));
            if softness == f64::INFINITY {
                return none;
            }
            let law = Law::Range { lo: -most * time, hi: most * time, softness };
            (law, off * time * stiffness * softness)
        };
        match (force, self.spring, self.motor) {
            _ if time <= 0.0 => none,
            (Force::Spring, Some(spring), _) => {
                soft(spring.stiffness, spring.damping, spring.rest - value, f64::INFINITY)
            }
            (Force::Motor, _, Some(motor)) => {
                let (MotorTarget::Velocity(aim) | MotorTarget::Position(aim)) = motor.target;
                soft(motor.stiffness, motor.damping, aim - value, motor.most)
            }
            (Force::Friction, ..) => {
                let most = self.friction * time;
                (Law::Range { lo: -most, hi: most, softness: 0.0 }, 0.0)
            }
            (Force::Spring | Force::Motor, ..) => none,
        }
    }
}

impl Motor {
    /// The rate that it brings about at once, unless it is soft.
    pub(crate) fn hard_rate(&self, value: f64, step: f64) -> Option<f64> {
        match self.target {
            MotorTarget::Velocity(rate) => Some(rate),
            MotorTarget::Position(_) if self.stiffness > 0.0 => None,
            MotorTarget::Position(place) => Some(TAKEN_BACK * (place - value) / step),
        }
    }
}

/// Times that may be never, for formats without infinity.
#[cfg(feature = "serde")]
mod never {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes fields by reference")]
    pub(super) fn serialize<S: Serializer>(time: &f64, to: S) -> Result<S::Ok, S::Error> {
        (*time > f64::NEG_INFINITY).then_some(*time).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Option::<f64>::deserialize(from).map(|time| time.unwrap_or(f64::NEG_INFINITY))
    }
}
