//! Two triangles: separating axes over time, and the closest points at one time.

pub(crate) mod closest;
mod refined_directions;
pub(crate) mod separating_axis;
