//! What the static queries share: the relative pose with its error, the test of a box against eight boxes, the
//! constants of one query. The bounds are derived in docs/theory/static-queries.md.

mod axes;
mod directions;
mod node_test;
mod placed_box;
mod relative_pose;
mod scene;
#[cfg(test)]
pub(crate) mod tests;
mod triangles;

pub(crate) use relative_pose::{InversePose, RelativePose};
pub(crate) use scene::{Direction, Directions, RestingScene, Step, Wanted, child};
pub(crate) use triangles::{gap_exceeds, proven_apart};
