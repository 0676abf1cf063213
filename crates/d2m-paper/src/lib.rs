#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod feature;
mod mesh;

pub use d2m_feature::Sphere;
pub use feature::{
    BodyOverDomain, Direction, EdgePair, Face, PaperOptions, Placement, PointFace, PointJet, PolygonFace,
    RelativeFrame, RelativeMotion, SphereOverDomain, TriangleFace, edge_edge, point_polygon, point_triangle,
    sphere_sphere, test_sphere_pair,
};
pub use mesh::{CrossCheck, Moving, SphereTree, cross_check, time_of_contact};
