//! Rest: islands whose surfaces have been slow for long enough do not move until something comes close.

use crate::Simulation;
use crate::contact::{ContactPoint, NEAR};
use crate::group::CROWD;
use crate::quiet::{Quiet, Rest, Surface};
use crate::rigid_body::RigidBody;
use crate::union::{join, root};
use crate::velocity::Velocity;
use glam::DVec3;

impl Simulation {
    /// After a step of length `step`: counts how long each body has been slow, and puts islands to sleep that touch
    /// something, all of whose bodies have been slow long enough, and that touch nothing that moves.
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
        let is_crowd = self.bodies.len() > CROWD;
        for (i, body) in self.bodies.iter_mut().enumerate() {
            if !body.is_dynamic() || body.asleep {
                continue;
            }
            let rest = match (rubs[i], is_crowd) {
                // What restores the gap lets it hop: what flies says so by its way.
                (false, true) if !presses[i] => Rest::ByWay,
                (false, _) => Rest::Unbraked,
                (true, false) => Rest::BySpeed,
                (true, true) => Rest::ByWay,
            };
            let surface = Surface {
                position: body.position,
                orientation: body.orientation,
                radius: body.radius,
                speed: body.surface_speed(),
            };
            body.quiet.go_on(surface, rest, step, &self.options);
        }
        if !self.bodies.iter().any(|body| body.quiet.is_long() && !body.asleep) {
            return;
        }
        let mut parent: Vec<usize> = (0..self.bodies.len()).collect();
        let mut held_up = vec![false; self.bodies.len()];
        let mut restless: Vec<bool> = self
            .bodies
            .iter()
            .map(|body| body.is_dynamic() && !body.asleep && !body.quiet.is_long())
            .collect();
        // What hops on a heap bears on it all the same.
        let touches = |contact: &ContactPoint| {
            contact.impulse > 0.0 || is_crowd && contact.distance <= NEAR * contact.gap
        };
        for (&(a, b), pair) in &self.pairs {
            let is_held = pair.contacts.iter().any(touches);
            // Whatever is in contact with others is solved with them, and wakes them, in the next step.
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
                join(&mut parent, a, b);
            }
            held_up[a] |= is_held;
            held_up[b] |= is_held;
            restless[a] |= moving(b);
            restless[b] |= moving(a);
        }
        let mut awake = vec![false; self.bodies.len()];
        for (i, held_up) in held_up.iter().enumerate() {
            if restless[i] || !held_up {
                awake[root(&mut parent, i)] = true;
            }
        }
        for (i, body) in self.bodies.iter_mut().enumerate() {
            let top = root(&mut parent, i);
            if body.is_dynamic() && !body.asleep && held_up[i] && !awake[top] {
                sleep(body);
                self.recorder.change(body.id, body.flight);
            }
        }
    }
}

/// No momentum and no motion from now on.
fn sleep(body: &mut RigidBody) {
    body.asleep = true;
    body.quiet = Quiet::default();
    // The energy of the momenta is lost, and so is as much of what contacts have added.
    body.gained = (body.gained - body.kinetic_energy()).max(0.0);
    (body.momentum, body.angular_momentum) = Default::default();
    body.fly(Velocity::default(), f64::INFINITY);
}
