//! Rest: islands whose surfaces have been slow for long enough do not move until something comes close.

use crate::contact::ContactPoint;
use crate::rigid_body::RigidBody;
use crate::union::{join, root};
use crate::velocity::Velocity;
use crate::{Simulation, SimulationOptions};
use glam::DVec3;

/// How long, in seconds of gravity's scale or plain units of time without gravity.
const QUIET_TIME: f64 = 0.5;
/// The part of the gap by which a surface may move in that time.
const QUIET_WAY: f64 = 0.1;

/// Of the speed of quiet bodies, the part that counts as standing still: what no friction brakes goes on at any other speed.
const STILL: f64 = 1.0 / 1024.0;
/// By how much more a body may be faster than it was in its quiet time.
const GROWTH: f64 = 1.0625;

fn quiet_speed(options: &SimulationOptions) -> f64 {
    QUIET_WAY * options.gap / QUIET_TIME
}

impl Simulation {
    /// After a step of length `step`: counts how long each body has been slow, and puts islands to sleep that touch
    /// something, all of whose bodies have been slow long enough, and that touch nothing that moves.
    pub(crate) fn put_to_sleep(&mut self, step: f64) {
        if !self.options.sleeping {
            return;
        }
        let limit = quiet_speed(&self.options);
        let mut rubs = vec![false; self.bodies.len()];
        let is_rubbed = |c: &ContactPoint| c.impulse > 0.0 && c.material.friction > 0.0;
        for (&(a, b), _) in self.pairs.iter().filter(|(_, pair)| pair.contacts.iter().any(is_rubbed)) {
            (rubs[a], rubs[b]) = (true, true);
        }
        let still = STILL * limit;
        for (body, rubs) in self.bodies.iter_mut().zip(rubs) {
            if !body.is_dynamic() || body.asleep {
                continue;
            }
            let speed = body.surface_speed();
            let slow = speed <= (if rubs { limit } else { still }) && !body.held;
            // What a force speeds up is not at rest, however slow it is.
            if slow && speed <= GROWTH * body.slowest + still {
                body.quiet += step;
                body.slowest = body.slowest.min(speed);
            } else {
                (body.quiet, body.slowest) = (0.0, speed);
            }
        }
        if !self.bodies.iter().any(|body| body.quiet >= QUIET_TIME && !body.asleep) {
            return;
        }
        let mut parent: Vec<usize> = (0..self.bodies.len()).collect();
        let mut held_up = vec![false; self.bodies.len()];
        let mut restless: Vec<bool> = self
            .bodies
            .iter()
            .map(|body| body.is_dynamic() && !body.asleep && body.quiet < QUIET_TIME)
            .collect();
        let pressed = |contact: &ContactPoint| contact.impulse > 0.0;
        for (&(a, b), pair) in &self.pairs {
            if !pair.contacts.iter().any(pressed) {
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
            (held_up[a], held_up[b]) = (true, true);
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
    body.quiet = 0.0;
    // The energy of the momenta is lost, and so is as much of what contacts have added.
    body.gained = (body.gained - body.kinetic_energy()).max(0.0);
    (body.momentum, body.angular_momentum) = Default::default();
    body.fly(Velocity::default(), f64::INFINITY);
}
