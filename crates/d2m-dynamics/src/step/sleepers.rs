//! Bodies that sleep in a heap of which parts move.

use super::connected::{Group, Sleepers};
use super::{Occasion, Step};
use crate::flight_length::Clock;
use crate::group::Solved;
use crate::momenta::Momenta;
use crate::velocity::Velocity;
use std::collections::BTreeMap;

/// What sleeps wakes, when the step ends, where what touches it does more to it than what it has borne: by this part of all that it bears
/// in a step and of the resting speed, which its surface would gain. Where it is all of that it is solved with what touches it.
const DISTURBED: f64 = 0.5;
/// The part of the resting speed in that where bodies meet: what they bring is there only once.
const MET: f64 = 1.0 / 8.0;

/// What is done to a body that sleeps: what more than it has borne from what is solved, and all impulses that it bears in that time.
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    momenta: Momenta,
    borne: f64,
}

impl Step<'_> {
    /// A body that slept moves from `time` on. What has pressed on it at this instant, and is about to be solved again, has pressed on
    /// what holds it.
    pub(super) fn wake(&mut self, i: usize, time: f64, occasion: Occasion) {
        let body = &mut self.sim.bodies[i];
        body.wake(time);
        self.woken[i] = Some(time);
        if matches!(occasion, Occasion::Expected | Occasion::Plan { .. }) {
            for contact in self.undoable.iter().filter(|c| c.a == i || c.b == i) {
                body.push(contact.exerted(usize::from(contact.b == i)));
            }
        }
    }

    /// Was this body woken at this time?
    pub(super) fn has_woken(&self, i: usize, time: f64) -> bool {
        self.woken[i] == Some(time)
    }

    /// Of these bodies those that are solved from the begin: where parts of heaps sleep, what sleeps is not, unless something that follows a
    /// motion meets it.
    pub(super) fn awake_or_driven(&self, mut seeds: Vec<usize>, sleepers: Sleepers) -> Vec<usize> {
        let bodies = &self.sim.bodies;
        if sleepers == Sleepers::Bear && !seeds.iter().any(|&i| bodies[i].is_kinematic()) {
            seeds.retain(|&i| !bodies[i].asleep);
        }
        seeds
    }

    /// The bodies that sleep and that these solutions hit, ascending; those that they do less to wake when the step ends.
    pub(super) fn hit(
        &mut self,
        group: &Group,
        solved: &[Solved],
        clock: Clock,
        occasion: Occasion,
    ) -> Vec<usize> {
        let bodies = &self.sim.bodies;
        let is_plan = matches!(occasion, Occasion::Plan { .. });
        if group.sleepers == Sleepers::Wake || is_plan || !bodies.iter().any(|body| body.asleep) {
            return Vec::new();
        }
        let mut changes: BTreeMap<usize, Change> = BTreeMap::new();
        let mut add = |i: usize, by: Momenta, borne: f64| {
            if bodies[i].asleep {
                let change = changes.entry(i).or_default();
                change.momenta = change.momenta + by;
                change.borne += borne;
            }
        };
        for contact in solved.iter().flat_map(|part| part.rests.iter().chain(&part.impacts)) {
            add(contact.a, contact.exerted(0), 0.0);
            add(contact.b, contact.exerted(1), 0.0);
        }
        // What has been solved in this step before has borne its part already.
        let begins = |i: usize| clock.now == self.start || self.has_woken(i, clock.now);
        let length = clock.end - clock.now;
        for (&(a, b), pair) in &self.sim.pairs {
            for (i, other, borne) in [(a, b, pair.borne[0]), (b, a, pair.borne[1])] {
                let is_anew = group.is_member[other] && begins(other);
                let more = if is_anew { borne.times(-length) } else { Momenta::default() };
                add(i, more, borne.linear.length() * length);
            }
        }
        let resting = self.sim.options.resting_speed() * if occasion.is_event() { MET } else { 1.0 };
        let (mut hit, mut disturbed) = (Vec::new(), Vec::new());
        for (i, Change { momenta, borne }) in changes {
            let body = &bodies[i];
            let gained = Velocity {
                linear: momenta.linear * body.inverse_mass,
                angular: body.inverse_inertia_at(body.orientation) * momenta.angular,
            };
            let most = resting + borne * body.inverse_mass;
            let part = gained.surface_speed(body.radius) / most;
            if part > 1.0 {
                hit.push(i);
            } else if part > DISTURBED {
                disturbed.push(i);
            }
        }
        self.disturbed.extend(disturbed);
        hit
    }
}
