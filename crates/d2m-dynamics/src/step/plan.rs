//! Flights that an event would cut short are planned again, so that they end about where the event is.

use super::event::{Cause, Event};
use super::{Occasion, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::flight::group::CROWD;
use glam::DVec3;

/// How often flights from one instant are planned again at most.
const MOST_AT_ONCE: u32 = 3;
/// How many flights of bodies are planned again in a whole step: so many, and so many for each body. It is a
/// budget, like the number of events (128 by default): two bodies each; and for crowds in which all meet, the
/// pair that each of two neighbours meets, twice. Crowds of more than `MOST_BODIES` have the budget of that
/// many: something always meets in them, and a plan for all of a thousand bodies costs as much as a step.
/// Flights beyond the budget stay unbalanced in the segments, and in them only.
const MOST_IN_A_STEP: usize = 256;
const MOST_OF_A_BODY: usize = 4;
const MOST_BODIES: usize = 64;
/// The energy that flights cut short may leave unbalanced in the segments, as a part of the largest kinetic
/// energy (the momenta are right in any case): a thirty-second of the 1/128 that `docs/guarantees.md`
/// promises, for the flights of one step that are cut one after the other.
const UNBALANCED: f64 = 1.0 / 4096.0;
/// Flights that are planned again end later than expected by this part of the time by which they were cut:
/// the bodies should meet before.
const SPARE_TIME: f64 = 0.02;

/// How often flights of this step have been planned again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Replans {
    /// The instant at which they begin.
    at: f64,
    at_once: u32,
    /// The number of flights of bodies in the whole step.
    all: usize,
}

impl Step<'_> {
    /// A flight has the velocity of its middle. One that ends early has the velocity of a later time than its
    /// own middle: its energy is off by ½ F·v (H − t), with the force F, the power F·v and the time H − t by
    /// which it is cut. Where the sum of these is too large, the flights that begin now are planned again, to
    /// end at the event. Returns true if they have changed; then the event is void.
    pub(super) fn plan_anew(&mut self, event: &Event) -> Result<bool, StepError> {
        let now = self.sim.time;
        if self.replans.at != now {
            (self.replans.at, self.replans.at_once) = (now, 0);
        }
        if event.cause == Cause::Stuck || self.replans.at_once >= MOST_AT_ONCE || event.time <= now {
            return Ok(false);
        }
        let gravity = self.sim.options.gravity;
        let is_crowd = self.count > CROWD && !self.has_joints;
        let cut = |(i, body): (usize, &RigidBody)| {
            // In a crowd something always meets: an event cuts the flights of its own bodies only, and the
            // others fly on.
            if is_crowd && !event.bodies.contains(&i) {
                return 0.0;
            }
            if !body.is_dynamic() || body.held || body.asleep || body.horizon <= event.time {
                return 0.0;
            }
            0.5 * power(body, gravity).abs() * (body.horizon.min(self.end) - event.time)
        };
        let cuts: Vec<f64> = self.sim.bodies.iter().enumerate().map(cut).collect();
        let sum: f64 = cuts.iter().sum();
        if sum == 0.0 {
            return Ok(false);
        }
        let energy: f64 = self.sim.bodies.iter().map(RigidBody::flight_energy).sum();
        self.sim.greatest_energy = self.sim.greatest_energy.max(energy);
        let most = UNBALANCED * self.sim.greatest_energy;
        if sum <= most {
            return Ok(false);
        }
        let each = most / cuts.iter().filter(|&&cut| cut > 0.0).count() as f64;
        let concerned: Vec<usize> = (0..cuts.len()).filter(|&i| cuts[i] > each).collect();
        let budget = MOST_IN_A_STEP + MOST_OF_A_BODY * self.count.min(MOST_BODIES);
        if self.replans.all + concerned.len() > budget {
            return Ok(false);
        }
        let until = self.expected(event, |i| cuts[i] > each);
        if !(until > now && until < self.end) {
            return Ok(false);
        }
        self.replans.at_once += 1;
        self.replans.all += concerned.len();
        self.planned = Some(until);
        // The event counts if its bodies fly on as they do.
        self.heap.push(core::cmp::Reverse(*event));
        self.resolve(now, concerned, Occasion::Plan { until })?;
        Ok(true)
    }

    /// May the rest of the step keep the plan of a flight that is cut at `time`? Its energy is off by the
    /// power of the forces times the time by which its velocity leads or lags.
    pub(super) fn is_balanced(&self, body: &RigidBody, time: f64) -> bool {
        let lead = body.lead.unwrap_or_default();
        let off = power(body, self.sim.options.gravity).abs() * (lead - 0.5 * (self.end - time)).abs();
        off * self.count as f64 <= UNBALANCED * self.sim.greatest_energy
    }

    /// When the bodies of an event meet if some of them get flights that end then.
    ///
    /// With the acceleration g along the normal between the two bodies, a flight of length L closes at c₀ + g L/2, where the
    /// planned one, of length H, closed at c = c₀ + g H/2; they meet after s at c, so L (c + g (L − H)/2) = s c.
    fn expected(&self, event: &Event, is_planned: impl Fn(usize) -> bool) -> f64 {
        if event.cause != Cause::Contact || !event.bodies.into_iter().any(is_planned) {
            return event.time;
        }
        let (now, gravity) = (self.sim.time, self.sim.options.gravity);
        let bodies = event.bodies.map(|i| &self.sim.bodies[i]);
        let acceleration = |body: &RigidBody| {
            // The effect of contacts on a body is not known before the solve.
            if body.is_dynamic() && body.free {
                gravity + body.force * body.inverse_mass
            } else {
                DVec3::ZERO
            }
        };
        let horizon = bodies[0].horizon.min(bodies[1].horizon).min(self.end);
        let pull = event.normal.dot(acceleration(bodies[0]) - acceleration(bodies[1]));
        let (s, h) = (event.time - now, horizon - now);
        let rate = event.closing - 0.5 * pull * h;
        let root = rate * rate + 2.0 * pull * s * event.closing;
        // The root of L (rate + pull L/2) = s closing that stays finite without pull.
        let length = if root > 0.0 && rate + root.sqrt() > 0.0 {
            (2.0 * s * event.closing / (rate + root.sqrt())).clamp(s, h)
        } else {
            s
        };
        now + length + SPARE_TIME * (h - length)
    }
}

/// The power of the forces on a body in its present flight.
fn power(body: &RigidBody, gravity: DVec3) -> f64 {
    let velocity = body.present_velocity();
    (gravity * body.mass + body.force).dot(velocity.linear) + body.torque.dot(velocity.angular)
}
