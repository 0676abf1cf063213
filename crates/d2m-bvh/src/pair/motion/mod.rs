//! The relative motion of two bodies: clock and unit, poses at far times, the state at one time of a window.

pub(crate) mod frame;
pub(crate) mod local_motion;
pub(crate) mod rotation;
pub(crate) mod track;
pub(crate) mod units;
