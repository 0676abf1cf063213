//! Flights that events would cut are planned anew, to end about where the event is.

use super::event::{Cause, Event};
use super::{Occasion, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::flight::group::CROWD;
use glam::DVec3;

/// Times that flights from one and the same instant are planned anew.
const MOST_AT_ONCE: u32 = 3;
/// And flights of bodies that are planned anew in a whole step: so many, and so many for each body there is. A budget, like the
/// number of events, which is 128 by default: two bodies each; and for crowds in which all meet, the pair that each of two
/// neighbours meets, twice. Crowds of more bodies than so many have the budget of that many: there is always something that meets, and a
/// plan for all of a thousand bodies costs as much as a step. What goes beyond it is left unbalanced in the segments, and in them only.
const MOST_IN_A_STEP: usize = 256;
const MOST_OF_A_BODY: usize = 4;
const MOST_BODIES: usize = 64;
/// The part of the greatest kinetic energy that a flight's early end may leave unbalanced in the segments (the momenta are right in
/// any case): a thirty-second of the 1/128 that `docs/guarantees.md` promises, for the flights of one step that are cut one after the other.
const UNBALANCED: f64 = 1.0 / 4096.0;
/// How much later than expected a flight that is planned anew ends, as a part of what it was cut by: the body should meet what it meets before that.
const SPARE_TIME: f64 = 0.02;

/// How often flights of this step have been planned anew.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Replans {
    /// At which instant.
    at: f64,
    at_once: u32,
    /// Flights of bodies, in the whole step.
    all: usize,
}

impl Step<'_> {
    /// A flight has the velocity of its middle. One that ends early has the velocity of a later time than its own middle: with
    /// the force F, of the power F·v, and the time H − t by which it is cut, its energy is off by ½ F·v (H − t). Where the sum
    /// of these counts, the flights that begin now are planned again, to end at the event. True if the flights are others now;
    /// then the event is none.
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
            // In a crowd there is always something that meets: it cuts its own bodies' flights, and the others fly on.
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
        // Its bodies may fly on as they do.
        self.heap.push(core::cmp::Reverse(*event));
        self.resolve(now, concerned, Occasion::Plan { until })?;
        Ok(true)
    }

    /// May the rest of the step keep the plan of a flight that is cut at `time`? Its energy is then off by the power of the
    /// forces times what its velocity leads or lags.
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
            // What contacts do to a body is not known before the solve.
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

/// Of the forces on a body in its present flight.
fn power(body: &RigidBody, gravity: DVec3) -> f64 {
    let velocity = body.present_velocity();
    (gravity * body.mass + body.force).dot(velocity.linear) + body.torque.dot(velocity.angular)
}
