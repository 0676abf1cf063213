//! Two triangles: separating axes over time, and the closest points at one time.

pub(crate) mod closest;
pub(crate) mod pair_scale;
mod refined_directions;
pub(crate) mod separating_axis;
mod turning;
mod turning_edges;
