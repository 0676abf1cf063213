//! The relative motion of two bodies: clock and unit, poses at far times, the state at one time of a window.

pub(crate) mod base_pose;
pub(crate) mod frame;
pub(crate) mod local_motion;
pub(crate) mod relative_trajectory;
pub(crate) mod units;
