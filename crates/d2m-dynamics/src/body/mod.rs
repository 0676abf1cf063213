//! Bodies: their descriptions, states, masses and motions.
pub(crate) mod compound;
pub(crate) mod description;
pub(crate) mod kinematic;
pub(crate) mod rigid_body;
pub(crate) mod turning;
