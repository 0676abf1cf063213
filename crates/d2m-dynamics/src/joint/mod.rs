//! Joints: what is asked of them, their rows, and what goes wrong with bodies that they hold.
pub(crate) mod description;
pub(crate) mod energy_gain;
pub(crate) mod position_error;
pub(crate) mod pull;
pub(crate) mod rows;
pub(crate) mod taut;
