//! Bodies in the form that the contact solver takes.

use crate::body::rigid_body::RigidBody;
use d2m_contact::{SolverBody, Velocity};
use glam::DMat3;

/// Do impulses move it? A sleeping body bears others as a fixed one does, until it wakes.
pub(crate) fn moves(state: &RigidBody) -> bool {
    state.is_dynamic() && !state.held && !state.asleep
}

pub(crate) fn body_at(state: &RigidBody, velocity: Velocity, inverse_inertia: DMat3) -> SolverBody {
    SolverBody { inverse_mass: state.inverse_mass, inverse_inertia, velocity }
}

/// A body that impulses do not move, with its present velocity.
pub(crate) fn still(state: &RigidBody) -> SolverBody {
    SolverBody { inverse_mass: 0.0, inverse_inertia: DMat3::ZERO, velocity: state.present_velocity() }
}

pub(crate) fn world_inertia(state: &RigidBody) -> (f64, DMat3) {
    let r = DMat3::from_quat(state.orientation);
    (state.mass, r * state.inertia * r.transpose())
}
