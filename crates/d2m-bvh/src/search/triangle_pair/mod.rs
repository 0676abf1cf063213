//! Two triangles: separating axes over time, and the closest points at one time.

pub(crate) mod closest;
mod first_time;
pub(crate) mod pair_scale;
mod refined_directions;
pub(crate) mod separating_axis;
mod turning;
mod turning_edges;
pub(crate) mod widest_gap;
