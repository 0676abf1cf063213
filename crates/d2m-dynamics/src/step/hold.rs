//! Bodies that can go no further in a step stand still until its end.

use super::event::Event;
use super::{Key, Step};
use crate::StepError;
use crate::rigid_body::RigidBody;
use crate::velocity::Velocity;

impl Step<'_> {
    /// The bodies of these events stand still until the end of the step.
    pub(super) fn hold(&mut self, time: f64, events: &[Event]) -> Result<(), StepError> {
        let mut changed = Vec::new();
        for event in events {
            let [a, b] = event.bodies;
            let moving = |i: usize| self.sim.bodies[i].is_driven();
            let free = |body: &RigidBody| body.is_dynamic() && !body.held;
            let is_free = [a, b].map(|i| free(&self.sim.bodies[i]));
            if let Some((pushing, crushed)) = [(a, b, is_free[1]), (b, a, is_free[0])]
                .into_iter()
                .find_map(|(p, c, free)| (moving(p) && !free).then_some((p, c)))
            {
                return Err(self.crushed(pushing, crushed, time));
            }
            if is_free == [false, false] {
                return Err(self.crushed(a, b, time));
            }
            for (i, free) in [a, b].into_iter().zip(is_free) {
                if free {
                    let gravity = self.sim.options.gravity;
                    let body = &mut self.sim.bodies[i];
                    body.advance(time, gravity);
                    body.held = true;
                    body.asleep = false;
                    body.fly(Velocity::default(), self.end);
                    self.sim.recorder.change(body.id, body.flight);
                    changed.push(i);
                    self.holding = true;
                }
            }
        }
        // The other bodies of the events that were gathered fly on as they did: they are queried against those held.
        let others = events.iter().flat_map(|event| event.bodies).filter(|&i| !self.sim.bodies[i].held);
        let mut seeds: Vec<usize> = others.chain(changed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        self.query(time, &seeds)
    }

    /// What stands still, and is met by a body that follows its motion, moves again.
    pub(super) fn release(&mut self, time: f64, seeds: &[usize]) {
        let gravity = self.sim.options.gravity;
        for &i in seeds {
            let body = &mut self.sim.bodies[i];
            if body.held {
                body.advance(time, gravity);
                body.held = false;
            }
        }
        self.holding = self.holding && self.sim.bodies.iter().any(|body| body.held);
    }

    fn crushed(&self, pushing: usize, crushed: usize, time: f64) -> StepError {
        let name = |i: usize| self.sim.bodies[i].name.to_string();
        // Whoever follows its motion against the body that is crushed is the one to name.
        let drives = |i: &usize| self.sim.bodies[*i].is_driven();
        let partner = |key: &Key| if key.0 == crushed { key.1 } else { key.0 };
        let near = self
            .sim
            .pairs
            .iter()
            .filter(|(key, pair)| (key.0 == crushed || key.1 == crushed) && pair.nearest.is_some());
        let driver = near.map(|(key, _)| partner(key)).find(drives);
        let pushing = driver.unwrap_or(pushing);
        StepError::Crushed { pushing: name(pushing), crushed: name(crushed), time }
    }
}
