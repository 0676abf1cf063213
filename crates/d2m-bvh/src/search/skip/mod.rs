//! Time that is skipped at once: volumes that the bodies sweep, and what a screw motion leaves alone.

pub(crate) mod helix;
mod picture;
pub(crate) mod swept;
