//! The energy that jointed bodies gain from one flight to the next one.
//!
//! Joints do no work. The sum of kinetic and potential energy in the middle of a flight differs from that in
//! the middle of the next one only by terms of the second order in the angles by which bodies turn in a
//! flight. Where a chain whips round these terms are large, and mostly positive: then flights have to be
//! shorter.

use crate::SimulationOptions;
use crate::body::rigid_body::RigidBody;
use crate::flight::solved_body::moves;
use d2m_contact::{ContactPoint, Law, System, Velocity};
use glam::DVec3;
use std::borrow::Cow;

/// The part of the kinetic energy that a flight may gain; bodies count with the energy of a fall of one step
/// at least.
const MOST_GAINED: f64 = 1.0 / 256.0;

/// Energies of an island's bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gained {
    /// The increase of kinetic and potential energy together.
    pub(crate) energy: f64,
    /// The kinetic energy before, now or after a fall of one step, whichever is largest.
    motion: f64,
}

impl Gained {
    /// The increase from the middle of the present flights to that of flights of this length from `now` on,
    /// with the velocities of a system.
    pub(crate) fn of(
        states: &[Cow<'_, RigidBody>],
        system: &System,
        options: &SimulationOptions,
        [now, length]: [f64; 2],
    ) -> Self {
        let fallen = Velocity { linear: options.gravity * options.step, angular: DVec3::ZERO };
        let mut sum = Self { energy: 0.0, motion: 0.0 };
        for (state, body) in states.iter().zip(&system.bodies).filter(|(state, _)| moves(state)) {
            let (before, next) = (state.shown_velocity(), body.velocity);
            let energies = [before, next, fallen].map(|velocity| energy_of_motion(state, velocity));
            let flown = now - state.flight.reference_time();
            let way = (before.linear * flown + next.linear * length) * 0.5;
            sum.energy += energies[1] - energies[0] - state.mass * options.gravity.dot(way);
            sum.motion += energies.into_iter().fold(0.0, f64::max);
        }
        sum
    }

    /// Is the increase larger than that of the terms of the second order may be?
    pub(crate) fn is_much(self) -> bool {
        self.energy > MOST_GAINED * self.motion
    }
}

/// The kinetic energy. A spin in the axes of the body is the same all through a flight.
fn energy_of_motion(state: &RigidBody, velocity: Velocity) -> f64 {
    let spin = state.orientation.conjugate() * velocity.angular;
    0.5 * (state.mass * velocity.linear.length_squared() + spin.dot(state.inertia * spin))
}

/// Do joints connect these bodies, and do no motors, springs, forces or kinematic bodies work on them?
pub(crate) fn is_of_joints_alone(states: &[Cow<'_, RigidBody>], contacts: &[&ContactPoint]) -> bool {
    let works = |contact: &&ContactPoint| match contact.row.map(|row| (row.law, row.target)) {
        Some((Law::Range { lo, hi, softness }, rate)) => {
            softness > 0.0 || rate != 0.0 && lo.is_finite() && hi.is_finite()
        }
        _ => contact.running != [0.0; 2],
    };
    let is_pushed = |state: &RigidBody| state.force != DVec3::ZERO || state.torque != DVec3::ZERO;
    contacts.iter().any(|contact| contact.row.is_some())
        && !contacts.iter().any(works)
        && !states.iter().any(|state| if moves(state) { is_pushed(state) } else { !state.stands_still() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Simulation};
    use d2m_bvh::MeshTree;
    use d2m_contact::SolverBody;
    use std::sync::Arc;

    fn cube(velocity: DVec3) -> (RigidBody, SimulationOptions) {
        let options = SimulationOptions::default();
        let mut simulation = Simulation::new(options).unwrap();
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
        simulation.add(&Body::new("cube", tree).with_linear_velocity(velocity)).unwrap();
        (simulation.bodies[0].clone(), options)
    }

    fn gained(velocity: DVec3, next: DVec3) -> Gained {
        let (state, options) = cube(velocity);
        let velocity = Velocity { linear: next, angular: DVec3::ZERO };
        let inverse_inertia = state.inverse_inertia;
        let body = SolverBody { inverse_mass: state.inverse_mass, inverse_inertia, velocity };
        let system = System::new(vec![body], &[], |_| 0);
        Gained::of(&[Cow::Owned(state)], &system, &options, [0.0, 0.01])
    }

    /// A body that begins to fall, or is thrown, has hardly less energy in the middle of its first flight.
    #[test]
    fn what_falls_gains_nothing() {
        for speed in [0.0, 3.0, -3.0] {
            let start = DVec3::new(1.0, speed, 0.0);
            let found = gained(start, start - DVec3::Y * (0.5 * 9.81 * 0.01));
            assert!(found.energy <= 0.0 && found.energy > -0.3 * found.motion, "{found:?}");
            assert!(!found.is_much());
        }
        assert!(gained(DVec3::X, DVec3::X * 1.01).is_much());
    }
}
