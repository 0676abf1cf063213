//! The flights of a body: constant twists that have the velocity of the momenta in their middle, and how long they may be.

use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::body::turning::Pull;
use crate::rest::quiet::Surface;
use d2m_bvh::Posed;
use d2m_contact::{Momenta, Velocity};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use glam::{DMat3, DQuat, DVec3};

/// What a tumbling body turns in one flight at most, in radians, times how far its moments of inertia are apart. The midpoint rule is the
/// geodesic one: reversible, so its energy oscillates and does not drift; the middle of a flight is off the motion of a free top by
/// h² |ω'|/8 at most, and |ω'| ≤ κ ω² with κ = 1 − I₁/I₃, so the energy by (κ ω h)²/8 of itself: 2⁻¹¹ for a sixteenth.
const MOST_TURN: f64 = 1.0 / 16.0;
/// A spin of the middle of a flight that its iteration leaves off by more of itself is none: that gains a quarter each time or more where it finds
/// one, so 2⁻²⁰ in less than the 64 times that it is tried.
const FOUND: f64 = 1.0 / 1_048_576.0;
/// Flights of one body in a step at most, as long as nothing meets it; a body that turns faster flies longer ones.
const MOST_FLIGHTS: f64 = 1024.0;

/// When flights of bodies that tumble end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// After equal parts of what is left.
    Own,
    /// At halves, quarters, … of the step, counted from its end: of many bodies at the same times, so that these are few.
    Common,
    /// As [`Self::Own`], by the turn that a body makes in joints.
    Jointed,
}
/// Parts of a flight that are left over from the division of a step.
const ROUND: f64 = 1e-6;

impl RigidBody {
    /// Where the flight has it at a time.
    pub(crate) fn pose_at(&self, time: f64) -> Pose {
        self.flight.pose_and_twist(time).0
    }

    pub(crate) fn posed_at(&self, time: f64) -> Posed<'_> {
        Posed::new(&self.tree, self.pose_at(time))
    }

    /// Velocity of a flight of some length: forces are those of its middle, or of the middle of the planned flight that it is
    /// the rest of; gyroscopic terms those of its own middle.
    pub(crate) fn flight_velocity(&self, length: f64, gravity: DVec3) -> Velocity {
        let lead = self.lead.unwrap_or(0.5 * length);
        let linear = (self.momentum + self.force_with(gravity) * lead) * self.inverse_mass;
        let angular = self.midpoint_spin(self.angular_momentum + self.torque * lead, length, None);
        Velocity { linear, angular }
    }

    /// The angular velocity ω with ω = R I⁻¹ Rᵀ L at R = exp([ω] h/2) R₀: a flight of length h with it has the angular momentum
    /// L in its middle, and so have all the flights of a body that nothing meets. Under a pull it is the ω with (R I Rᵀ + G) ω = L + G ω₀.
    /// Of a thin body that turns too far in a flight for that to be found it is the turn about L.
    pub(crate) fn midpoint_spin(&self, angular_momentum: DVec3, h: f64, pull: Option<Pull>) -> DVec3 {
        let sum = angular_momentum + pull.map_or(DVec3::ZERO, |pull| pull.stiffness * pull.free);
        let spin = |orientation: DQuat| {
            if pull.is_some() {
                return self.inverse_inertia_under(orientation, pull) * sum;
            }
            let r = DMat3::from_quat(orientation);
            r * (self.inverse_inertia * (r.transpose() * sum))
        };
        let (mut omega, mut change) = (spin(self.orientation), 0.0);
        for _ in 0..64 {
            let next = spin(self.turned(omega, 0.5 * h));
            change = (next - omega).abs().max_element();
            omega = next;
            if change <= 2.0 * f64::EPSILON * omega.abs().max_element() {
                break;
            }
        }
        let is_found = change <= FOUND * omega.abs().max_element();
        if is_found || pull.is_some() { omega } else { self.precession(sum).unwrap_or(omega) }
    }

    /// The turn about an angular momentum L that has as much of it along L as there is: ω = L (L·L)/(L·R I Rᵀ L). The long axis of a thin body goes
    /// round L so while the body spins about that axis, how often whatever. In the body's own axes L stays what it is, so its energy ½ L·R I⁻¹ Rᵀ L
    /// is the same at the end of the flight, and that of the flight is no more (Cauchy and Schwarz). None: no moment of inertia is about L.
    fn precession(&self, angular_momentum: DVec3) -> Option<DVec3> {
        let own = self.orientation.conjugate() * angular_momentum;
        let about = own.dot(self.inertia * own);
        (about > 0.0).then(|| angular_momentum * (angular_momentum.length_squared() / about))
    }

    /// The orientation after a turn with an angular velocity for a time.
    pub(crate) fn turned(&self, omega: DVec3, time: f64) -> DQuat {
        // Less than whole turns, as almost always, need no flight.
        let vector = omega * time;
        if vector.abs().max_element() < 1.0 {
            return (Pose::from_rotation_vector(DVec3::ZERO, vector).rotation * self.orientation).normalize();
        }
        let spin = ConstantTwist::try_new(DVec3::ZERO, self.orientation, DVec3::ZERO, omega);
        spin.map_or(self.orientation, |spin| spin.pose_and_twist(time).0.rotation)
    }

    /// How long the next flight may be at most: the step, or what a body that tumbles takes for a small turn. It depends on the energy
    /// alone, which a free body keeps: so all its flights are of one length, as the reversibility of the midpoint rule asks for. What joints
    /// hold keeps no energy of its own: there it is the turn that the body makes, which of a thin bar is much less than it could make.
    pub(crate) fn horizon_within(&self, end: f64, step: f64, splits: Splits) -> f64 {
        let left = end - self.time;
        if !self.is_dynamic() || left <= 0.0 {
            return end;
        }
        let turn = self.inverse_inertia_at(self.orientation) * self.angular_momentum;
        let energy = self.angular_momentum.dot(turn);
        let fastest = match splits {
            Splits::Jointed => turn.length(),
            Splits::Own | Splits::Common => (energy * self.moments[1]).max(0.0).sqrt(),
        };
        let tumbles = (1.0 - self.moments[0] / self.moments[1]) * fastest;
        if tumbles.is_nan() || tumbles * left <= MOST_TURN {
            return end;
        }
        let length = (MOST_TURN / tumbles).max(step / MOST_FLIGHTS);
        let parts = |whole: f64| (whole / length - ROUND).ceil().max(1.0);
        let horizon = match splits {
            Splits::Own | Splits::Jointed if parts(left) <= 1.0 => end,
            Splits::Own | Splits::Jointed => self.time + left / parts(left),
            Splits::Common => {
                let part = step / f64::from((parts(step) as u32).next_power_of_two());
                end - ((left / part - ROUND).ceil() - 1.0) * part
            }
        };
        if horizon > self.time && horizon < end { horizon } else { end }
    }

    /// Starts a flight at `time`, of which exactly these numbers are certified and reported.
    pub(crate) fn fly(&mut self, velocity: Velocity, horizon: f64) {
        self.flight = ConstantTwist::REST
            .with_at(self.center)
            .with_position(self.position)
            .with_orientation(self.orientation)
            .with_linear_velocity(velocity.linear)
            .with_angular_velocity(velocity.angular)
            .with_reference_time(self.time);
        self.horizon = horizon;
        self.version += 1;
        self.has_flown = true;
    }

    /// [`Self::fly`], if the flight has numbers.
    ///
    /// # Errors
    /// [`StepError::TooFast`] where the velocity, or the way or the turn to the horizon, is beyond doubles.
    pub(crate) fn try_fly(&mut self, velocity: Velocity, horizon: f64) -> Result<(), StepError> {
        let length = horizon - self.time;
        let is_known =
            (self.position + velocity.linear * length).is_finite() && (velocity.angular * length).is_finite();
        if !is_known {
            return Err(StepError::TooFast { body: self.name.to_string(), time: self.time });
        }
        self.fly(velocity, horizon);
        Ok(())
    }

    /// Where the body is at a time, with the velocities of its momenta: for the first line of a run, whether or not it has flown before.
    pub(crate) fn first_flight(&self, time: f64) -> ConstantTwist {
        // What is beyond all numbers is an error of the step that begins.
        let known = Some(self.velocity()).filter(|v| v.linear.is_finite() && v.angular.is_finite());
        let velocity = known.filter(|_| self.is_dynamic()).unwrap_or_default();
        self.flight
            .with_position(self.position)
            .with_orientation(self.orientation)
            .with_linear_velocity(velocity.linear)
            .with_angular_velocity(velocity.angular)
            .with_reference_time(time)
    }

    /// The velocity that a user sees: that of the last flight, or the one given before the first.
    pub(crate) fn shown_velocity(&self) -> Velocity {
        if self.is_dynamic() && !self.has_flown && !self.asleep {
            return self.velocity();
        }
        self.present_velocity()
    }

    /// The velocity of the present flight.
    pub(crate) fn present_velocity(&self) -> Velocity {
        Velocity { linear: self.flight.linear_velocity(), angular: self.flight.angular_velocity() }
    }

    /// Does the present flight lead nowhere?
    pub(crate) fn stands_still(&self) -> bool {
        self.present_velocity() == Velocity::default()
    }

    /// Speed that no point of the surface exceeds in this flight.
    pub(crate) fn surface_speed(&self) -> f64 {
        self.present_velocity().surface_speed(self.radius)
    }

    /// How fast a point of this body and one of another may come together in their present flights.
    pub(crate) fn bound_approach(&self, other: &Self) -> f64 {
        let speed = |body: &Self| if body.has_flown { body.shown_velocity() } else { body.velocity() };
        let (a, b) = (speed(self), speed(other));
        (a.linear - b.linear).length() + a.angular.length() * self.radius + b.angular.length() * other.radius
    }

    /// Moves the state along the flight: forces act on the momenta for as long as it lasted.
    pub(crate) fn advance(&mut self, time: f64, gravity: DVec3) {
        if time > self.time {
            let pose = self.pose_at(time);
            (self.position, self.orientation) = (pose.translation, pose.rotation);
            let elapsed = time - self.time;
            if self.is_dynamic() && !self.held && !self.asleep {
                let force = self.force_with(gravity);
                let middle = (self.momentum + force * (0.5 * elapsed)) * self.inverse_mass;
                let off = force.dot(middle - self.flight.linear_velocity()) * elapsed;
                self.gained = self.gained.max(0.0) + off;
                self.momentum += force * elapsed;
                self.angular_momentum += self.torque * elapsed;
            }
            self.time = time;
            self.lead = self.lead.map(|lead| lead - elapsed);
        }
    }

    /// Where its surface is after a flight with this velocity.
    pub(crate) fn surface_after(&self, velocity: Velocity, length: f64) -> Surface {
        Surface {
            position: self.position + velocity.linear * length,
            orientation: self.turned(velocity.angular, length),
            radius: self.radius,
            speed: velocity.surface_speed(self.radius),
        }
    }

    /// How much faster its surface is after this.
    pub(crate) fn gain(&self, added: Momenta) -> f64 {
        let angular = self.inverse_inertia_at(self.orientation) * added.angular;
        Velocity { linear: added.linear * self.inverse_mass, angular }.surface_speed(self.radius)
    }

    /// The kinetic energy of the present flight, at its start.
    pub(crate) fn flight_energy(&self) -> f64 {
        if !self.is_dynamic() || self.asleep || self.held {
            return 0.0;
        }
        let spin = self.flight.orientation().conjugate() * self.flight.angular_velocity();
        0.5 * (self.mass * self.flight.linear_velocity().length_squared() + spin.dot(self.inertia * spin))
    }
}
