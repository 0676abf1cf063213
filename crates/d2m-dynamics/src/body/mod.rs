//! Bodies: what they are, where they are, what they weigh and follow.
pub(crate) mod compound;
pub(crate) mod description;
pub(crate) mod kinematic;
pub(crate) mod rigid_body;
pub(crate) mod turning;
