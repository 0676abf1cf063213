//! A body of the velocity solve.

use crate::body::velocity::Velocity;
use glam::DMat3;

/// What the solver needs of a body. A body that impulses cannot move has no inverse masses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolverBody {
    pub(crate) inverse_mass: f64,
    /// World axes.
    pub(crate) inverse_inertia: DMat3,
    pub(crate) velocity: Velocity,
}
