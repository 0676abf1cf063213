//! Kinematic bodies: they follow a motion by flights of constant twists that stay close to it.

use crate::body::description::Kind;
use crate::body::rigid_body::RigidBody;
use crate::numbers::{is_resolved, is_small};
use crate::{SimulationError, SimulationOptions, StepError};
use d2m_contact::Velocity;
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{CoveredMotion, RigidMotion as _, rotation_vector};
use glam::{DQuat, DVec3};

/// How far the twist of a kinematic flight may lead off the motion between its ends, as a part of the gap.
const OFF_MOTION: f64 = 0.01;
/// The most halvings of the rest of a step to keep to that: down to 4096 flights in a step, which take
/// seconds.
const MOST_HALVINGS: u32 = 12;
/// A motion turns by less than this within a flight, so the shortest turn from its first orientation to its
/// last is the one that it makes. It is below π, with room for rounding.
const MOST_TURN: f64 = 3.0;

/// The parts of a piece over which angular velocities are enclosed.
const PARTS: u32 = 8;

/// The motion from one pose of a body to another.
struct Piece {
    time: Interval,
    length: f64,
    /// The velocity of the flight that joins the poses at both ends.
    velocity: Velocity,
}

/// May a flight have this velocity? One to a pose of absurd numbers has none.
fn is_slow(velocity: Velocity) -> bool {
    is_small(velocity.linear) && is_small(velocity.angular)
}

impl RigidBody {
    /// Starts the next flight of a kinematic body: the twist about its center that leads from its present
    /// pose to that of the motion at the end, as long as the motion is proven to stay close to it. The
    /// present pose is the end of its last flight, which is off the motion by rounding, or by more after an
    /// error that ended that flight. Placing the body on its motion instead could put it into a body that
    /// touches it.
    ///
    /// # Errors
    /// [`StepError::TooFast`] where no flight that is long enough stays close; a motion that does not cover
    /// the step.
    pub(crate) fn follow(&mut self, end: f64, options: &SimulationOptions) -> Result<(), StepError> {
        let start = self.time;
        if matches!(self.kind, Kind::Driven) {
            return self.follow_target(end);
        }
        let Some(motion) = self.covered_motion(start, end)? else { return Ok(()) };
        let mut horizon = motion.motion().smooth_until(start).map_or(end, |joint| end.min(joint));
        for _ in 0..=MOST_HALVINGS {
            let piece = self.piece(motion, [start, horizon], options);
            if is_slow(piece.velocity) && self.bound_deviation(motion, &piece) <= OFF_MOTION * options.gap {
                self.fly(piece.velocity, horizon);
                return Ok(());
            }
            let middle = start + 0.5 * piece.length;
            if !(middle > start && middle < horizon) {
                break;
            }
            horizon = middle;
        }
        Err(StepError::TooFast { body: self.name.to_string(), time: start })
    }

    /// Until when a kinematic body may go on as in its present flight: the next joint of the motion.
    pub(crate) fn goes_on_until(&self, time: f64) -> f64 {
        match &self.kind {
            Kind::Kinematic(motion) => motion.smooth_until(time).unwrap_or(f64::INFINITY),
            _ => self.horizon,
        }
    }

    /// A bound on the distance of a kinematic body, at any time until then, from where its present flight
    /// would lead on; at its horizon it is on its motion. None: none is known.
    pub(crate) fn strays(&self, until: f64) -> Option<f64> {
        if self.horizon >= until {
            return Some(0.0);
        }
        let covered = self.covered_motion(self.horizon, until).ok()??;
        let (motion, span) = (covered.motion(), Interval::new(self.horizon, until));
        let (twist, pose) = (motion.enclose_twist(span), motion.enclose_pose(span));
        let arm = pose.enclose_vector(self.center - pose.at);
        let center = twist.linear + twist.angular.cross(arm);
        let linear = center - IntervalVec3::point(self.flight.linear_velocity());
        let angular = twist.angular - IntervalVec3::point(self.flight.angular_velocity());
        let rate = linear.norm() + angular.norm() * self.radius;
        let off = rate * (Interval::point(until) - Interval::point(self.horizon));
        off.sup().is_finite().then_some(off.sup())
    }

    /// Starts the flight of a driven body that ends at its target; at rest where it has none.
    fn follow_target(&mut self, end: f64) -> Result<(), StepError> {
        let Some(target) = self.target else {
            self.fly(Velocity::default(), f64::INFINITY);
            return Ok(());
        };
        let length = end - self.time;
        let velocity = Velocity {
            linear: (target.position - self.position) / length,
            angular: rotation_vector(target.orientation * self.orientation.conjugate()) / length,
        };
        if !is_slow(velocity) {
            return Err(StepError::TooFast { body: self.name.to_string(), time: self.time });
        }
        // One that is there already stands still for good: no later step gives it another flight.
        let horizon = if velocity == Velocity::default() { f64::INFINITY } else { end };
        self.fly(velocity, horizon);
        Ok(())
    }

    /// The motion of a kinematic body over some times; none for other bodies.
    ///
    /// # Errors
    /// It does not cover them.
    pub(crate) fn covered_motion(
        &self,
        from: f64,
        to: f64,
    ) -> Result<Option<CoveredMotion<'_>>, SimulationError> {
        let Kind::Kinematic(motion) = &self.kind else { return Ok(None) };
        let outside = |outside| SimulationError::OutsideMotion { body: self.name.to_string(), outside };
        CoveredMotion::try_new(&**motion, from, to).map(Some).map_err(outside)
    }

    /// The center and the axes at a time of a motion of the mesh frame.
    fn place_by(&self, motion: CoveredMotion<'_>, time: f64) -> (DVec3, DQuat) {
        let (pose, _) = motion.motion().pose_and_twist(time);
        (pose.transform_point(self.center), pose.rotation.normalize())
    }

    /// The motion between two times. Where they are so near that its poses do not say how fast it is, it has its
    /// velocity at the start.
    fn piece(&self, motion: CoveredMotion<'_>, [start, end]: [f64; 2], options: &SimulationOptions) -> Piece {
        let length = end - start;
        let (pose, twist) = motion.motion().pose_and_twist(start);
        let arm = pose.transform_vector(self.center - pose.at);
        let extent = self.position.length() + arm.length() + self.radius;
        let velocity = if is_resolved(extent, length, OFF_MOTION, options) {
            let (last_x, last_q) = self.place_by(motion, end);
            Velocity {
                linear: (last_x - self.position) / length,
                angular: rotation_vector(last_q * self.orientation.conjugate()) / length,
            }
        } else {
            Velocity { linear: twist.velocity_of(arm), angular: twist.angular }
        };
        Piece { time: Interval::new(start, end), length, velocity }
    }

    /// A bound on the distance of a point of the body in the motion from that in the flight, between the ends
    /// of a piece, at which both agree.
    ///
    /// The center flies straight between two points of its path: it is off by at most h²/8 of its largest
    /// acceleration. With E = R P⁻¹ of the orientations R of the motion and P of the flight, E turns with ω −
    /// E ω₀, and the component of that along E's own axis is that of ω − ω₀. So the angle of E, which is zero
    /// at both ends, is at most half of the integral of
    /// ω − ω₀|.
    fn bound_deviation(&self, motion: CoveredMotion<'_>, piece: &Piece) -> f64 {
        let motion = motion.motion();
        let &Piece { time, length, velocity } = piece;
        let spin = motion.enclose_twist(time).angular;
        // False, too, if it is no number.
        let turns_by_less = spin.norm().hi() * length < MOST_TURN;
        if !turns_by_less {
            return f64::INFINITY;
        }
        let rate = motion.enclose_twist_rate(time);
        let pose = motion.enclose_pose(time);
        // From the reference point to the center; a component along the axis of a spin causes no
        // acceleration.
        let arm = pose.enclose_vector(self.center - pose.at);
        let acceleration = rate.linear + rate.angular.cross(arm) + spin.cross(spin.cross(arm));
        let bend = acceleration.norm().hi() * (0.125 * length * length);
        let off = |part: Interval| {
            let spin = motion.enclose_twist(part).angular - IntervalVec3::point(velocity.angular);
            spin.norm().hi() * (part.hi() - part.lo())
        };
        let at = |k: u32| time.lo() + length * (f64::from(k) / f64::from(PARTS));
        let parts = (0..PARTS).map(|k| Interval::new(at(k), at(k + 1).min(time.hi())));
        bend + 0.5 * parts.map(off).sum::<f64>() * self.radius
    }
}
