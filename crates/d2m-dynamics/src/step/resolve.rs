//! Velocities of the flights that begin at an event.

use super::{Occasion, Step};
use crate::group::{Clock, Solved, islands, solve};
use crate::{BodyId, ContactImpulse, StepError, parallel};
use glam::DVec3;

impl Step<'_> {
    /// Solves the velocities of the seeds and of all that are in contact with them, and starts their flights.
    pub(super) fn resolve(
        &mut self,
        time: f64,
        seeds: Vec<usize>,
        occasion: Occasion,
    ) -> Result<(), StepError> {
        let (group, contacts) = self.group(time, seeds, occasion)?;
        let gravity = self.sim.options.gravity;
        let end = self.end;
        for &i in &group {
            let body = &mut self.sim.bodies[i];
            if body.is_kinematic() && (occasion == Occasion::Start || body.horizon <= time) {
                body.time = time;
                body.follow(end, self.sim.options.gap);
                self.sim.recorder.change(BodyId(i as u32), body.flight);
            }
        }
        if let Occasion::Plan { .. } = occasion {
            let is_one = |i: usize| group.binary_search(&i).is_ok();
            self.undoable.retain(|contact| !(is_one(contact.a) || is_one(contact.b)));
        } else {
            self.impulses.append(&mut self.undoable);
        }
        let until = if let Occasion::Plan { until } = occasion { until } else { end };
        let clock = Clock { now: time, end: until };
        let found = islands(&self.sim.bodies, contacts);
        let (bodies, options, energy) = (&self.sim.bodies, &self.sim.options, self.sim.greatest_energy);
        let solved = parallel::map(found, |island| solve(bodies, &island, clock, options, energy));
        let mut flying = vec![false; self.sim.bodies.len()];
        for part in solved {
            for push in &part.bodies {
                let body = &mut self.sim.bodies[push.body];
                body.push(push.impact);
                body.unpushed = Some(body.momenta());
                body.push(push.rest);
                body.fly(push.velocity, push.horizon);
                body.free = false;
                flying[push.body] = true;
            }
            self.keep(part, occasion);
        }
        for &i in &group {
            let body = &mut self.sim.bodies[i];
            if body.is_dynamic() && !body.held && !flying[i] {
                let horizon = body.horizon_within(until, self.sim.options.step);
                let velocity = body.flight_velocity(horizon, gravity);
                body.fly(velocity, horizon);
                (body.free, body.unpushed) = (true, None);
            }
            if body.is_dynamic() && !body.held {
                self.sim.recorder.change(BodyId(i as u32), body.flight);
            }
        }
        self.query(time, &group)
    }

    /// Keeps the impulses until the flights are flown, and those of the step's own solve for the next one to begin with.
    fn keep(&mut self, solved: Solved, occasion: Occasion) {
        if occasion == Occasion::Start {
            for contact in &solved.rests {
                if let Some(pair) = self.sim.pairs.get_mut(&(contact.a, contact.b))
                    && let Some(kept) = pair.contacts.iter_mut().find(|c| c.feature == contact.feature)
                {
                    *kept = *contact;
                }
            }
        }
        self.impulses.extend(solved.impacts);
        self.undoable.extend(solved.rests);
    }

    /// The impulses of the present instant are those of the segment that ends here.
    pub(super) fn report_impulses(&mut self) {
        self.impulses.append(&mut self.undoable);
        for contact in self.impulses.drain(..) {
            let impulse = contact.total();
            if impulse != DVec3::ZERO {
                self.sim.recorder.contact(ContactImpulse {
                    a: BodyId(contact.a as u32),
                    b: BodyId(contact.b as u32),
                    point: contact.point,
                    normal: contact.normal,
                    impulse: -impulse,
                    time: self.sim.time,
                });
            }
        }
    }
}
