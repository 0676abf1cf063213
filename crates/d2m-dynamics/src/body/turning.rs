//! A brake on rotation.

use glam::{DMat3, DVec3};

/// A brake on the change of a body's spin ([`crate::joint::pull`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pull {
    /// How far the body's oscillation advances in a flight: the square of an angle.
    pub(crate) speed: f64,
    /// Angular impulse divided by change of spin, world axes.
    pub(crate) stiffness: DMat3,
    /// The spin without impulses.
    pub(crate) free: DVec3,
}
