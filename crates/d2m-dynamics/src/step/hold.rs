//! Holding: bodies that can go no further in a step stand still until its end.

use super::event::Event;
use super::slide::{Sliding, slidings};
use super::{Key, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::flight::rows::NEAR;
use crate::flight::solved_body::{body_at, still};
use crate::pairs::closest_features::{AROUND, measure};
use d2m_contact::{ContactPoint, SolverBody, Squeeze, Velocity};
use std::collections::{BTreeMap, BTreeSet};

impl Step<'_> {
    /// Holds the bodies of these events until the end of the step, unless one of them is proven to be
    /// crushed.
    pub(super) fn hold(&mut self, time: f64, events: &[Event]) -> Result<(), StepError> {
        if let Some([pushing, crushed]) = self.proven_crushed(time, events) {
            let name = |i: usize| self.sim.bodies[i].name.to_string();
            return Err(StepError::Crushed { pushing: name(pushing), crushed: name(crushed), time });
        }
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
                return Err(self.cornered(pushing, crushed, time));
            }
            for (i, free) in [a, b].into_iter().zip(is_free) {
                if free {
                    let gravity = self.sim.options.gravity;
                    let body = &mut self.sim.bodies[i];
                    body.advance(time, gravity);
                    body.held = true;
                    body.wake(time);
                    body.fly(Velocity::default(), self.end);
                    self.sim.recorder.change(body.id, body.flight);
                    changed.push(i);
                    self.holding = true;
                }
            }
        }
        // The other bodies of the gathered events fly on as before: they are queried against the held ones.
        let others = events.iter().flat_map(|event| event.bodies).filter(|&i| !self.sim.bodies[i].held);
        let mut seeds: Vec<usize> = others.chain(changed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        self.query(time, &seeds)
    }

    /// Held bodies that a kinematic body meets move again.
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

    /// The kinematic body and the body on which it presses, if the bodies that contacts connect with those of
    /// these events are proven to have no motion with which they keep apart for as long as the kinematic body
    /// takes to close a gap. A kinematic body goes on in its present flight until that ends, and then by its
    /// motion: it may turn back there.
    fn proven_crushed(&mut self, time: f64, events: &[Event]) -> Option<[usize; 2]> {
        if !self.sim.bodies.iter().any(RigidBody::is_driven) {
            return None;
        }
        let (contacts, slides): (Vec<ContactPoint>, Vec<f64>) =
            self.connected_contacts(time, events).into_iter().unzip();
        let mut members: Vec<usize> = contacts.iter().flat_map(|c| [c.a, c.b]).collect();
        members.sort_unstable();
        members.dedup();
        let sim = &*self.sim;
        let solver_body = |&i: &usize| {
            let body = &sim.bodies[i];
            if body.is_dynamic() {
                body_at(body, Velocity::default(), body.inverse_inertia_at(body.orientation))
            } else {
                still(body)
            }
        };
        let bodies: Vec<SolverBody> = members.iter().map(solver_body).collect();
        let place = |body: usize| members.binary_search(&body).unwrap_or_default();
        let squeeze = Squeeze { bodies: &bodies, contacts: &contacts, slides: &slides, place };
        let follow = || members.iter().map(|&i| &sim.bodies[i]).filter(|body| body.is_kinematic());
        let longest = time + sim.options.gap / squeeze.closing();
        let in_flights = follow().map(|body| body.horizon).fold(longest, f64::min);
        let beyond = follow().map(|body| body.goes_on_until(time)).fold(longest, f64::min);
        let contact = squeeze.prove_infeasible(in_flights - time).or_else(|| {
            let contacts = self.with_what_strays(&contacts, beyond)?;
            Squeeze { contacts: &contacts, ..squeeze }.prove_infeasible(beyond - time)
        })?;
        let is_driven = |i: usize| sim.bodies[i].is_driven();
        Some(if is_driven(contact.a) { [contact.a, contact.b] } else { [contact.b, contact.a] })
    }

    /// The contacts, each with as much more room as its kinematic bodies may deviate from their flights until
    /// this time. None: that is not known.
    fn with_what_strays(&self, contacts: &[ContactPoint], until: f64) -> Option<Vec<ContactPoint>> {
        let strays = |i: usize| {
            let body = &self.sim.bodies[i];
            if body.is_kinematic() { body.strays(until) } else { Some(0.0) }
        };
        let with = |c: &ContactPoint| {
            Some(ContactPoint { distance: c.distance + strays(c.a)? + strays(c.b)?, ..*c })
        };
        contacts.iter().map(with).collect()
    }

    /// The contacts within about the gap of all bodies that they connect with those of some events, at a time
    /// of the flights, with the way that each may slide. Those whose direction turns by itself prove nothing.
    fn connected_contacts(&mut self, time: f64, events: &[Event]) -> Vec<Sliding> {
        let mut ring: Vec<usize> = events.iter().flat_map(|event| event.bodies).collect();
        let (mut seen, mut found) = (BTreeSet::new(), BTreeMap::<Key, Vec<Sliding>>::new());
        while !ring.is_empty() {
            ring.retain(|&i| self.sim.bodies[i].is_dynamic() && seen.insert(i));
            let keys = self.partners(&ring);
            let sim = &*self.sim;
            let gap = sim.options.gap;
            ring.clear();
            for key in keys {
                if found.contains_key(&key) {
                    continue;
                }
                let material = sim.material(key.0, key.1);
                // Contacts too close to be measured are no part of a proof.
                let measured =
                    measure(&sim.bodies, key, time, AROUND * gap, gap, material, &[]).unwrap_or_default();
                let is_near = |contact: &ContactPoint| contact.distance <= NEAR * gap;
                let contacts: Vec<ContactPoint> = measured.contacts.into_iter().filter(is_near).collect();
                if !contacts.is_empty() {
                    ring.extend([key.0, key.1]);
                }
                let bodies = [&sim.bodies[key.0], &sim.bodies[key.1]];
                let slidings = contacts.iter().flat_map(|contact| slidings(contact, bodies, time));
                found.insert(key, slidings.filter(|(contact, _)| is_near(contact)).collect());
            }
        }
        found.into_values().flatten().collect()
    }

    /// The error that there is neither a proof that the body is crushed nor room for it.
    fn cornered(&self, pushing: usize, cornered: usize, time: f64) -> StepError {
        let name = |i: usize| self.sim.bodies[i].name.to_string();
        StepError::Cornered { pushing: name(pushing), cornered: name(cornered), time }
    }
}
