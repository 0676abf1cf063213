//! Certified first contact of moving features: point/triangle, edge/edge, sphere/sphere; static triangle distance.

mod exact_sign;
mod feature_pair;
pub mod paper;
mod triangle_distance;
mod triangle_intersection;

pub use exact_sign::{orient2d, orient3d};
pub use feature_pair::FeaturePair;
pub use triangle_distance::{TriangleDistance, TriangleFeature, triangle_distance};
pub use triangle_intersection::triangles_intersect;
