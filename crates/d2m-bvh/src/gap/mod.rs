//! Gaps along a direction: when a gap with bounded derivatives can close at the earliest, and along which direction it is wide.

pub(crate) mod discriminant;
pub(crate) mod first_time;
pub(crate) mod widest_gap;
