//! The energy of rotation in flights that begin with impulses.
//!
//! A flight has the angular momentum of its body in its middle, where the body is turned by half of the
//! flight. For a thin body whose momentum is mostly across its long axis, a small error of that axis'
//! direction is a large spin about it, which turns the body elsewhere still: a solution is found only for
//! flights so short that the axis hardly moves. How short is known beforehand for a body that nothing meets
//! ([`RigidBody::horizon_within`]), and for others only with the impulses of the solution.

use crate::body::rigid_body::RigidBody;
use crate::flight::attempt::Attempt;
use crate::flight::problem::Problem;
use crate::flight::solved_body::moves;
use d2m_contact::{Momenta, add_impulses};
use glam::{DQuat, DVec3};
use std::borrow::Cow;

/// The energy of rotation in a flight may differ by this part from that of the momenta at its start. A
/// solution for its middle is off by 2⁻¹¹ in flights as short as those of bodies that nothing meets; by any
/// factor where none is found.
const MOST_OFF: f64 = 1.0 / 128.0;

impl<'s> Problem<'s> {
    /// Does each body rotate with the energy of its momenta at the start of its flight, and have that at its
    /// end, too? Jointed bodies do not rotate freely: the answer is yes.
    pub(crate) fn keeps_energy_of_turning(&self, attempt: &Attempt) -> bool {
        self.has_rows() || self.turns(attempt).iter().all(|turn| turn.is_flown() && turn.ends_as_it_begins())
    }

    /// Does each body end its flight with the energy of rotation of its start, whatever else its velocity
    /// leads to?
    pub(crate) fn ends_with_energy_of_turning(&self, attempt: &Attempt) -> bool {
        self.has_rows() || self.turns(attempt).iter().all(Turn::ends_as_it_begins)
    }

    fn turns(&self, attempt: &Attempt) -> Vec<Turn<'s>> {
        let mut added = vec![Momenta::default(); self.states.len()];
        add_impulses(&attempt.found.contacts, &mut added, |body| self.place(body));
        let length = attempt.span.remaining;
        let turn = |(k, state): (usize, &'s Cow<'s, RigidBody>)| Turn {
            state,
            momentum: state.angular_momentum
                + state.torque * state.lead.unwrap_or(0.5 * length)
                + added[k].angular,
            spin: attempt.system.bodies[k].velocity.angular,
            length,
            // The momentum of bodies at rest is only rounding of impulses.
            least: state.mass * self.speed() * self.speed(),
        };
        self.states.iter().enumerate().filter(|(_, state)| moves(state)).map(turn).collect()
    }
}

/// The rotation of a body in a flight that begins with an angular momentum.
struct Turn<'s> {
    state: &'s RigidBody,
    momentum: DVec3,
    spin: DVec3,
    length: f64,
    /// Differences of energy below this do not count.
    least: f64,
}

impl Turn<'_> {
    /// Twice the energy of the momentum at an orientation.
    fn of_momentum(&self, orientation: DQuat) -> f64 {
        self.momentum.dot(self.state.inverse_inertia_at(orientation) * self.momentum)
    }

    fn is_due(&self, energy: f64) -> bool {
        let due = self.of_momentum(self.state.orientation);
        (energy - due).abs() <= MOST_OFF * due + self.least
    }

    /// Has the flight the energy of the momentum? A spin in the axes of the body is the same all through the
    /// flight.
    fn is_flown(&self) -> bool {
        let own = self.state.orientation.conjugate() * self.spin;
        self.is_due(own.dot(self.state.inertia * own))
    }

    fn ends_as_it_begins(&self) -> bool {
        self.is_due(self.of_momentum(self.state.turned(self.spin, self.length)))
    }
}
