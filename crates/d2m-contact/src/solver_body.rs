//! A body as impulses see it.

use crate::velocity::Velocity;
use glam::{DMat3, DVec3};

/// What a solution needs of a body. A body that impulses cannot move has no inverse mass and no inverse inertia.
///
/// ```
/// use d2m_contact::{SolverBody, Velocity};
/// use glam::DVec3;
/// let belt = SolverBody { velocity: Velocity { linear: DVec3::X, angular: DVec3::ZERO }, ..SolverBody::FIXED };
/// assert_eq!(belt.inverse_mass, 0.0); // nothing stops it
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SolverBody {
    /// Zero: impulses do not move it.
    pub inverse_mass: f64,
    /// About the center of mass, world axes; symmetric.
    pub inverse_inertia: DMat3,
    /// With the impulses that there are.
    pub velocity: Velocity,
}

impl SolverBody {
    /// What stands still, whatever pushes it.
    pub const FIXED: Self = Self {
        inverse_mass: 0.0,
        inverse_inertia: DMat3::ZERO,
        velocity: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
    };
}
