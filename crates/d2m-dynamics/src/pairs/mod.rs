//! Pairs of bodies: which are near each other, what is proven of their flights, and their contacts.
pub(crate) mod clearance;
pub(crate) mod closest_features;
#[cfg(feature = "audit")]
pub(crate) mod concluded;
pub(crate) mod inside;
pub(crate) mod known;
pub(crate) mod neighbors;
pub(crate) mod part_of_flight;
pub(crate) mod touches;
pub(crate) mod warm_start;
