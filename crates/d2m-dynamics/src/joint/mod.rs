//! Joints: their descriptions, their rows, and the treatment of bodies that oscillate or snap taut between
//! them.
pub(crate) mod acting;
pub(crate) mod description;
pub(crate) mod energy_gain;
pub(crate) mod force;
pub(crate) mod position_error;
pub(crate) mod pull;
pub(crate) mod rows;
pub(crate) mod taut;
