//! Certified first contact of moving features: point/triangle, edge/edge, sphere/sphere; static triangle distance.
//!
//! [`PairMotion`] answers for two bodies of constant twist, [`EnclosedPairMotion`] for any motions that can enclose
//! themselves. Every answer is a theorem about the code: docs/theory/features.md. [`paper`] holds the reference
//! method's tests.
//!
//! **Invariant:** this crate knows single features and pairs of them, no meshes and no trees.

mod batch;
mod closest;
mod contact;
mod details;
mod edge_edge;
mod enclosed_pair;
mod exact_sign;
mod feature_pair;
mod options;
mod pair_motion;
pub mod paper;
mod path;
mod point_triangle;
mod sphere_sphere;
mod straight_path;
mod triangle_distance;
mod triangle_intersection;

pub use batch::{EdgeQuad, PointQuad, TriangleQuad};
pub use contact::{ContactBracket, ContactDetails, FirstContact};
pub use enclosed_pair::EnclosedPairMotion;
pub use exact_sign::{orient2d, orient3d};
pub use feature_pair::FeaturePair;
pub use options::ContactOptions;
pub use pair_motion::{PairMotion, PlacedTriangle};
pub use straight_path::StraightPaths;
pub use triangle_distance::{TriangleDistance, TriangleFeature, triangle_distance};
pub use triangle_intersection::triangles_intersect;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
