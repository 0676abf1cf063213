//! Snapshots: the state of a simulation, to be kept and restored.
pub(crate) mod body;
pub(crate) mod contents;
pub(crate) mod pair;
pub(crate) mod state;
