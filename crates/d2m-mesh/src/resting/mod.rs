//! Queries of bodies at rest: contact, distance, closest features, containment.

pub(crate) mod collide;
#[cfg(feature = "audit")]
mod concluded;
pub(crate) mod containment;
pub(crate) mod distance;
mod hollow;
pub(crate) mod node_pair;
pub(crate) mod parts;
pub(crate) mod proximities;
mod rounded;
pub(crate) mod touching;
mod winding;
