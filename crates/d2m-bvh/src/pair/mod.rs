//! Two bodies that move, and what of them can be proven apart at once: their boxes, their triangles.

pub(crate) mod boxes;
#[cfg(feature = "audit")]
pub(crate) mod concluded;
pub(crate) mod motion;
pub(crate) mod relative_trajectory;
pub(crate) mod scene;
pub(crate) mod triangles;
pub(crate) mod witness;
