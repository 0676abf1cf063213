//! Certified first contact of moving features: point/triangle, edge/edge, sphere/sphere; static triangle distance.

mod feature_pair;
pub mod paper;

pub use feature_pair::FeaturePair;
