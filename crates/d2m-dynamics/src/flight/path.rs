//! The flights of a body, and how long they may be. A flight is a constant twist with the velocity that
//! belongs to the momenta in its middle.

use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::body::turning::Pull;
use crate::numbers::is_small;
use crate::rest::quiet::Surface;
use d2m_bvh::Posed;
use d2m_contact::{Momenta, Velocity};
use d2m_interval::Interval;
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use glam::{DMat3, DQuat, DVec3};
use std::borrow::Cow;

/// How far a tumbling body may turn in one flight, in radians, times the relative difference κ of its moments
/// of inertia. The midpoint rule is the geodesic one: reversible, so its energy oscillates and does not
/// drift. The middle of a flight is off the motion of a free top by h² |ω'|/8 at most, and |ω'| ≤ κ ω² with κ
/// = 1 − I₁/I₃, so the energy is off by (κ ω h)²/8 of itself: 2⁻¹¹ for a sixteenth.
const MOST_TURN: f64 = 1.0 / 16.0;
/// The iteration for the spin in the middle of a flight has failed where it ends further off than this part
/// of the spin. Where it converges each round gains a factor of 3/4 or better, so 2⁻²⁰ in less than its 64
/// rounds.
const FOUND: f64 = 1.0 / 1_048_576.0;
/// The most flights of one body in a step, as long as nothing meets it; a body that turns faster flies longer
/// ones.
const MOST_FLIGHTS: f64 = 1024.0;

/// When the flights of tumbling bodies end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// After equal parts of the time that is left.
    Own,
    /// At halves, quarters, … of the step, counted from its end. Many bodies end their flights at the same
    /// times then.
    Common,
    /// As [`Self::Own`], with the rate at which a jointed body turns.
    Jointed,
}
/// A rest of a flight that is shorter than this part of it, from rounding, is no flight of its own.
const ROUND: f64 = 1e-6;

impl RigidBody {
    /// The pose in the present flight at a time.
    pub(crate) fn pose_at(&self, time: f64) -> Pose {
        self.flight.pose_and_twist(time).0
    }

    pub(crate) fn posed_at(&self, time: f64) -> Posed<'_> {
        Posed::new(&self.tree, self.pose_at(time))
    }

    /// The velocity of a flight of some length. Forces act until its middle, or until the middle of the
    /// planned flight of which this is the rest; gyroscopic terms are those of its own middle.
    pub(crate) fn flight_velocity(&self, length: f64, gravity: DVec3) -> Velocity {
        let lead = self.lead.unwrap_or(0.5 * length);
        let linear = (self.momentum + self.force_with(gravity) * lead) * self.inverse_mass;
        let angular = self.midpoint_spin(self.angular_momentum + self.torque * lead, length, None);
        Velocity { linear, angular }
    }

    /// The angular velocity ω with ω = R I⁻¹ Rᵀ L at R = exp([ω] h/2) R₀. A flight of length h with it has
    /// the angular momentum L in its middle, and so have all the flights of a body that nothing meets. Under
    /// a pull it is the ω with (R I Rᵀ + G) ω = L + G ω₀. For a thin body that turns too far in a flight the
    /// iteration fails; then it is the turn about L.
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

    /// The turn about an angular momentum L with all of L along its axis: ω = L (L·L)/(L·R I Rᵀ L). The long
    /// axis of a thin body goes round L so while the body spins about that axis, however often. L stays the
    /// same in the body's axes, so the energy ½ L·R I⁻¹ Rᵀ L is the same at the end of the flight, and that
    /// of the flight is no more (Cauchy and Schwarz). None: the moment of inertia about L is zero.
    fn precession(&self, angular_momentum: DVec3) -> Option<DVec3> {
        let own = self.orientation.conjugate() * angular_momentum;
        let about = own.dot(self.inertia * own);
        (about > 0.0).then(|| angular_momentum * (angular_momentum.length_squared() / about))
    }

    /// The orientation after a turn at an angular velocity for some time.
    pub(crate) fn turned(&self, omega: DVec3, time: f64) -> DQuat {
        // Turns of less than a radian, as almost all are, need no flight.
        let vector = omega * time;
        if vector.abs().max_element() < 1.0 {
            return (Pose::from_rotation_vector(DVec3::ZERO, vector).rotation * self.orientation).normalize();
        }
        let spin = ConstantTwist::try_new(DVec3::ZERO, self.orientation, DVec3::ZERO, omega);
        spin.map_or(self.orientation, |spin| spin.pose_and_twist(time).0.rotation)
    }

    /// The latest end of the next flight: that of the step, or earlier for a body that tumbles. The length
    /// depends on the energy alone, which a free body keeps: so all its flights have one length, as the
    /// reversibility of the midpoint rule requires. A jointed body does not keep its energy: there the length
    /// depends on the rate at which it turns, which for a thin bar is much less than its energy would allow.
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

    /// Starts a flight at `time`. Exactly these numbers are certified and reported.
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

    /// [`Self::fly`], if all numbers of the flight can be used.
    ///
    /// # Errors
    /// [`StepError::TooFast`] where the way or the turn to the horizon is beyond doubles, and where the velocity, the
    /// force or the momenta at the horizon exceed [`LARGEST`](crate::Simulation::LARGEST), which no state may.
    pub(crate) fn try_fly(
        &mut self,
        velocity: Velocity,
        horizon: f64,
        gravity: DVec3,
    ) -> Result<(), StepError> {
        let (length, force) = (horizon - self.time, self.force_with(gravity));
        let is_known =
            (self.position + velocity.linear * length).is_finite() && (velocity.angular * length).is_finite();
        let (linear, angular) =
            (self.momentum + force * length, self.angular_momentum + self.torque * length);
        let are_small = [velocity.linear, velocity.angular, force, linear, angular].into_iter().all(is_small);
        if !(is_known && are_small) {
            return Err(StepError::TooFast { body: self.name.to_string(), time: self.time });
        }
        self.fly(velocity, horizon);
        Ok(())
    }

    /// The pose with the velocities of the momenta at a time: for the first line of a run, whether or not the
    /// body has flown before.
    pub(crate) fn first_flight(&self, time: f64) -> ConstantTwist {
        // The step that begins reports velocities that are not finite as an error.
        let known = Some(self.velocity()).filter(|v| v.linear.is_finite() && v.angular.is_finite());
        let velocity = known.filter(|_| self.is_dynamic()).unwrap_or_default();
        self.flight
            .with_position(self.position)
            .with_orientation(self.orientation)
            .with_linear_velocity(velocity.linear)
            .with_angular_velocity(velocity.angular)
            .with_reference_time(time)
    }

    /// The velocity that a user sees: that of the last flight, or the given one before the first.
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

    /// Is the velocity of the present flight zero?
    pub(crate) fn stands_still(&self) -> bool {
        self.present_velocity() == Velocity::default()
    }

    /// A speed that no point of the surface exceeds in this flight.
    pub(crate) fn surface_speed(&self) -> f64 {
        self.present_velocity().surface_speed(self.radius)
    }

    /// A bound on the speed at which a point of this body and one of another may approach in their present
    /// flights.
    pub(crate) fn bound_approach(&self, other: &Self) -> f64 {
        let speed = |body: &Self| if body.has_flown { body.shown_velocity() } else { body.velocity() };
        let (a, b) = (speed(self), speed(other));
        (a.linear - b.linear).length() + a.angular.length() * self.radius + b.angular.length() * other.radius
    }

    /// The body where its present flight leads until this time, with the momenta that it has. A kinematic body
    /// goes on in its flight while others begin theirs.
    pub(crate) fn at(&self, time: f64) -> Cow<'_, Self> {
        if self.time == time || self.stands_still() {
            return Cow::Borrowed(self);
        }
        let pose = self.pose_at(time);
        Cow::Owned(Self { position: pose.translation, orientation: pose.rotation, time, ..self.clone() })
    }

    /// Moves the state along the flight to a time; forces change the momenta for the time between.
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

    /// Lets the velocities fade from its time until the end of a step. Where an error ended the last one early
    /// they have faded for a part of that already.
    pub(crate) fn damp(&mut self, end: f64) {
        let time = end - self.time.max(self.faded);
        if !self.is_dynamic() || time <= 0.0 {
            return;
        }
        self.faded = end;
        // The nearest number to the exponential, with the same bits everywhere.
        let factor = |rate: f64| Interval::point(-rate * time).exp().mid();
        if self.damping.linear > 0.0 {
            self.momentum *= factor(self.damping.linear);
        }
        if self.damping.angular > 0.0 {
            self.angular_momentum *= factor(self.damping.angular);
        }
    }

    /// The surface after a flight with this velocity.
    pub(crate) fn surface_after(&self, velocity: Velocity, length: f64) -> Surface {
        Surface {
            position: self.position + velocity.linear * length,
            orientation: self.turned(velocity.angular, length),
            radius: self.radius,
            speed: velocity.surface_speed(self.radius),
        }
    }

    /// By how much these momenta would raise the speed of its surface.
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
