//! The reference method's feature tests: the paper's, with interval arithmetic and with its errata repaired.
//!
//! Readable first. The tests work for every [`RigidMotion`](d2m_motion::RigidMotion) through its enclosures; the
//! closed-form tests of the crate are the fast ones.
//!
//! **Range.** Numbers are taken as they are, in intervals that have an absolute width of 2⁻⁵⁰⁰. With lengths and times of 2⁻³⁰⁰ to
//! 2³⁰⁰ that is nothing; beyond, brackets get wide or the search ends undecided, but no contact is missed.

mod closest;
mod direction;
mod edge_edge;
mod face;
mod gamma;
mod jet;
mod options;
mod point_triangle;
mod relative_motion;
mod sphere_over_domain;
mod sphere_sphere;

pub use direction::Direction;
pub use edge_edge::{EdgePair, edge_edge};
pub use face::{Face, PolygonFace, TriangleFace};
pub use jet::PointJet;
pub use options::PaperOptions;
pub use point_triangle::{PointFace, point_polygon, point_triangle};
pub use relative_motion::{Placement, RelativeFrame, RelativeMotion};
pub(crate) use sphere_over_domain::boxes_meet;
pub use sphere_over_domain::{BodyOverDomain, SphereOverDomain, test_sphere_pair};
pub use sphere_sphere::sphere_sphere;
