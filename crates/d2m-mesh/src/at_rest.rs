//! What queries of moving bodies ask at an instant, for those who write one: how bodies meet, which one holds a part of the
//! other, which triangles are near each other or share a point. Each ends with a count of steps or a [`Meter`](crate::Meter).

pub use crate::resting::collide::{is_contained, some_colliding_pairs};
pub use crate::resting::containment::{Held, held_vertex};
pub use crate::resting::distance::{Nearness, bound_distance_metered, near_pair};
pub use crate::resting::touching::inside::{holds, middle_of_boxes};
pub use crate::resting::touching::{Meeters, Meeting, Touch};
