#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod accurate_cross;
mod closest;
mod contact;
mod details;
mod edge_edge;
mod enclosed_pair;
mod exact_sign;
mod feature_pair;
mod motion_in_units;
mod options;
mod pair_motion;
mod path;
mod point_triangle;
mod rigid_query;
mod rounding;
mod sphere;
mod sphere_sphere;
mod straight_path;
mod triangle_distance;
mod triangle_intersection;
mod units;

pub use contact::{ContactBracket, ContactDetails, FirstContact};
pub use enclosed_pair::EnclosedPairMotion;
pub use exact_sign::{orient2d, orient3d};
pub use feature_pair::FeaturePair;
pub use options::ContactOptions;
pub use pair_motion::{PairMotion, PlacedTriangle};
pub use sphere::Sphere;
pub use straight_path::StraightPaths;
pub use triangle_distance::{TriangleDistance, TriangleFeature, triangle_distance};
pub use triangle_intersection::triangles_intersect;
