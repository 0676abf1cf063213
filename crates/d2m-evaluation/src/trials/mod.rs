//! Trials: two motions over [0, 1], read from a file or drawn from a seed.
mod file;
mod generate;

pub(crate) use file::{read, write};
pub(crate) use generate::{Law, generate};

use glam::{DQuat, DVec3};

/// A body point r is at R(t) r + x(t) with x(t) = position + t·velocity and
/// R(t) = exp(\[angular_velocity\] t)·R(rotation), t in [0, 1], everything in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Movement {
    /// Orientation at t = 0, unit to rounding; the mathematics normalises it.
    pub(crate) rotation: DQuat,
    /// Position of the body's origin at t = 0.
    pub(crate) position: DVec3,
    /// Units per unit of time.
    pub(crate) velocity: DVec3,
    /// Radians per unit of time.
    pub(crate) angular_velocity: DVec3,
}

/// One query: both bodies' movements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    pub(crate) a: Movement,
    pub(crate) b: Movement,
}

#[cfg(test)]
mod tests;
