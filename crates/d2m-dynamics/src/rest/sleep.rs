//! Sleep: islands whose surfaces have been slow for long enough do not move until something comes close. In a
//! crowd parts of islands sleep: bodies that touch only bodies that have been slow as well.

use crate::Simulation;
use crate::body::rigid_body::RigidBody;
use crate::flight::group::CROWD;
use crate::flight::rows::NEAR;
use crate::rest::quiet::{Quiet, Rest};
use d2m_contact::{ContactPoint, Velocity};
use d2m_mesh::DisjointSets;
use glam::DVec3;

/// In a simulation of more bodies than this parts of heaps sleep while others move. With fewer bodies a step
/// in which all are solved costs little.
const MANY: usize = 256;

impl Simulation {
    /// Do bodies of a heap sleep while others of it move? Among many bodies some always move, and their
    /// effect on sleeping ones is solved as if these were fixed, as long as it stays about what it was.
    pub(crate) fn sleeps_in_parts(&self) -> bool {
        self.len() > MANY && !self.has_joints()
    }

    /// After a step of length `step`: counts how long each body has been slow, and puts islands to sleep that
    /// touch a body, all of whose bodies have been slow long enough, and that touch nothing that moves.
    pub(crate) fn put_to_sleep(&mut self, step: f64) {
        if !self.options.sleeping {
            return;
        }
        let (mut rubs, mut presses) = (vec![false; self.bodies.len()], vec![false; self.bodies.len()]);
        for (&(a, b), pair) in &self.pairs {
            for contact in pair.contacts.iter().filter(|contact| contact.impulse > 0.0) {
                let has_friction = contact.material.friction > 0.0;
                for body in [a, b] {
                    presses[body] = true;
                    rubs[body] |= has_friction;
                }
            }
        }
        let is_crowd = self.len() > CROWD;
        let mut is_driven = vec![false; self.bodies.len()];
        for i in self.joints.iter().filter(|joined| joined.drives()).flat_map(|joined| joined.bodies) {
            is_driven[i] = true;
        }
        for (i, body) in self.bodies.iter_mut().enumerate() {
            if !body.is_dynamic() || body.asleep {
                continue;
            }
            let rest = match (rubs[i], is_crowd) {
                // A body that restores its gap hops, and nothing presses on it meanwhile: its displacement
                // decides.
                (false, true) if !presses[i] => Rest::ByWay,
                (false, _) => Rest::Unbraked,
                // Friction does not brake what motors and springs move, however slow it is, either.
                _ if is_driven[i] => Rest::Unbraked,
                (true, false) => Rest::BySpeed,
                (true, true) => Rest::ByWay,
            };
            let surface = body.surface_after(body.present_velocity(), 0.0);
            body.quiet.go_on(surface, rest, step, &self.options);
        }
        if self.sleeps_in_parts() {
            self.wake_beside_moved();
        }
        if !self.bodies.iter().any(|body| body.quiet.is_long() && !body.asleep) {
            return;
        }
        let mut together = Vec::new();
        let mut held_up = vec![false; self.bodies.len()];
        let mut restless: Vec<bool> = self
            .bodies
            .iter()
            .map(|body| body.is_dynamic() && !body.asleep && !body.quiet.is_long())
            .collect();
        // A body that hops on a heap bears on it all the same.
        let touches = |contact: &ContactPoint| {
            contact.impulse > 0.0 || is_crowd && contact.distance <= NEAR * contact.gap
        };
        for (&(a, b), pair) in &self.pairs {
            let is_held = pair.contacts.iter().any(touches);
            // In a crowd all contacts count: their bodies are solved together, and wake each other, in the
            // next step.
            let is_met = is_crowd && !pair.contacts.is_empty();
            if !is_held && !is_met {
                continue;
            }
            let dynamic = |i: usize| self.bodies[i].is_dynamic();
            let moving = |i: usize| {
                let body = &self.bodies[i];
                let runs = body.surface_velocity != DVec3::ZERO;
                runs || (body.is_kinematic() && body.surface_speed() > 0.0)
            };
            if dynamic(a) && dynamic(b) {
                together.push((a, b));
            }
            held_up[a] |= is_held;
            held_up[b] |= is_held;
            restless[a] |= moving(b);
            restless[b] |= moving(a);
        }
        // Bodies that joints connect fall asleep together. A motor that holds a body counts as its support.
        for joined in self.joints.iter().filter(|joined| !joined.is_gone()) {
            let [a, b] = joined.bodies;
            held_up[a] |= joined.holds();
            held_up[b] |= joined.holds();
            let moves = |i: usize| self.bodies[i].is_kinematic() && self.bodies[i].surface_speed() > 0.0;
            if self.bodies[a].is_dynamic() && self.bodies[b].is_dynamic() {
                together.push((a, b));
            }
            restless[a] |= moves(b);
            restless[b] |= moves(a);
        }
        for (restless, held_up) in restless.iter_mut().zip(&held_up) {
            *restless |= !held_up;
        }
        let in_parts = self.sleeps_in_parts();
        let awake = if in_parts { beside(&restless, &together) } else { connected(&restless, &together) };
        let falls_asleep = |body: &RigidBody, i: usize| body.is_dynamic() && !body.asleep && !awake[i];
        for (i, body) in self.bodies.iter_mut().enumerate() {
            if falls_asleep(body, i) {
                sleep(body, in_parts);
                self.recorder.change(body.id, body.flight);
            }
        }
    }
}

impl Simulation {
    /// Sleeping bodies wake where a body that they touch has moved.
    fn wake_beside_moved(&mut self) {
        let has_moved = |i: usize| {
            let body = &self.bodies[i];
            body.is_dynamic() && !body.asleep && body.quiet.has_moved()
        };
        let mut woken = Vec::new();
        for (&(a, b), pair) in &self.pairs {
            if pair.contacts.is_empty() {
                continue;
            }
            for (i, other) in [(a, b), (b, a)] {
                if self.bodies[i].asleep && has_moved(other) {
                    woken.push(i);
                }
            }
        }
        for i in woken {
            self.bodies[i].wake(self.time);
        }
    }
}

/// The restless bodies, and those that touch them.
fn beside(restless: &[bool], together: &[(usize, usize)]) -> Vec<bool> {
    let mut awake = restless.to_vec();
    for &(a, b) in together {
        awake[a] |= restless[b];
        awake[b] |= restless[a];
    }
    awake
}

/// All bodies that are connected with a restless one.
fn connected(restless: &[bool], together: &[(usize, usize)]) -> Vec<bool> {
    let mut joined = DisjointSets::new(restless.len());
    for &(a, b) in together {
        joined.join([a as u32, b as u32]);
    }
    let mut awake = vec![false; restless.len()];
    let roots: Vec<usize> = (0..restless.len()).map(|i| joined.root(i as u32) as usize).collect();
    for (&root, restless) in roots.iter().zip(restless) {
        awake[root] |= restless;
    }
    roots.into_iter().map(|root| awake[root]).collect()
}

/// The body has no momentum and no motion from now on.
fn sleep(body: &mut RigidBody, in_parts: bool) {
    body.asleep = true;
    body.quiet = if in_parts { body.quiet.drowsy() } else { Quiet::default() };
    // The energy of the momenta is lost, and with it as much of the energy that contacts have added.
    body.gained = (body.gained - body.kinetic_energy()).max(0.0);
    (body.momentum, body.angular_momentum) = Default::default();
    body.fly(Velocity::default(), f64::INFINITY);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::rows::upright;
    use crate::pairs::known::Pair;
    use crate::{Body, Kind, SimulationOptions};
    use d2m_bvh::MeshTree;
    use std::sync::Arc;

    /// A sleeping body wakes where a body that it touches has moved, and stays asleep where that has been
    /// quiet.
    #[test]
    fn what_sleeps_wakes_beside_what_has_moved() {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        for (was_quiet, wakes) in [(false, true), (true, false)] {
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            for k in 0..2 {
                let position = DVec3::Y * (1.001 * f64::from(k));
                simulation.add(&Body::new("cube", Arc::clone(&cube)).with_position(position)).unwrap();
            }
            sleep(&mut simulation.bodies[0], true);
            if was_quiet {
                simulation.bodies[1].quiet = Quiet::default().drowsy();
            }
            let touching = Pair { contacts: vec![upright([0, 1])], ..Pair::new(1e-3) };
            simulation.pairs.insert((0, 1), Box::new(touching));
            simulation.wake_beside_moved();
            assert_eq!(simulation.bodies[0].asleep, !wakes);
        }
    }

    /// Boxes on the ground that happen to hop, so that nothing presses on them as the step ends. In a crowd
    /// they fall asleep within the gap of the ground, and not above it.
    #[test]
    fn what_hops_among_many_is_borne_by_what_is_near() {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.2&y=0.2&z=0.2").unwrap()));
        let slab = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=9&y=0.5&z=9").unwrap()));
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let ground = Body::new("ground", slab).with_kind(Kind::Static).with_position(DVec3::NEG_Y * 0.5);
        simulation.add(&ground).unwrap();
        for k in 0..=CROWD {
            let place = DVec3::new((k % 9) as f64 - 4.0, 0.201, (k / 9) as f64 - 4.0);
            simulation.add(&Body::new("", Arc::clone(&cube)).with_position(place)).unwrap();
        }
        simulation.step().unwrap();
        let high = 7;
        for (&(_, body), pair) in &mut simulation.pairs {
            for contact in &mut pair.contacts {
                contact.impulse = 0.0;
                contact.distance *= if body == high { 10.0 } else { 1.0 };
            }
        }
        (0..3).for_each(|_| simulation.put_to_sleep(1.0));
        let awake = |&i: &usize| simulation.bodies[i].is_dynamic() && !simulation.bodies[i].asleep;
        let awake: Vec<usize> = (0..simulation.bodies.len()).filter(awake).collect();
        assert_eq!(awake, [high]);
    }
}
