#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`PairMotion`] is two moving bodies over a window; its methods answer when a point meets a triangle, an edge an
//! edge, a sphere a [`Sphere`].
//!
//! ## Motions
//! - [`PairMotion`]: motions of any kind, constant twists in closed form. [`PlacedTriangle`]: one triangle for many points.
//! - [`StraightPaths`]: four vertices on straight paths, for meshes that deform.
//!
//! ## Spheres about bodies
//! - [`MovingSphere`]: whether and how long two of them stay apart ([`FirstMeeting`]), for a square root or two.
//!
//! ## Triangles
//! - [`stay_within`]: do two of them ([`MovingTriangle`]) stay near each other for a while?
//! - [`TrianglesAt`]: two of them at one time.
//!
//! ## Options and answers
//! - [`ContactOptions`]: tolerance, minimum separation, limits.
//! - [`FirstContact`]: separated, a [`ContactBracket`], or undecided. [`ContactDetails`]: where and how, in
//!   plain numbers. [`FeaturePair`]: which features.
//!
//! ## At rest
//! - [`triangle_distance()`]: a [`TriangleDistance`] with its witnesses, each on a [`TriangleFeature`].
//! - [`estimate_closest_point`], [`estimate_closest_weights`]: the point of a triangle closest to another one, to rounding.
//! - [`proven_crossing`]: of triangles whose vertices are known up to an error.
//! - [`triangles_intersect`], [`orient2d`], [`orient3d`], [`triple_product_sign`]: exact.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-feature")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod accurate_cross;
mod closest;
mod contact;
mod details;
mod edge_edge;
mod enclosed_pair;
mod exact_sign;
mod feature_pair;
mod features;
mod motion_in_units;
mod moving_sphere;
mod options;
mod pair_motion;
mod path;
mod point_triangle;
mod proven_crossing;
mod rigid_query;
mod rounding;
mod sphere;
mod sphere_sphere;
mod staying;
mod straight_path;
mod triangle_distance;
mod triangle_intersection;
mod triangles_at;
mod twist_pair;
mod units;

pub use closest::{estimate_closest_point, estimate_closest_weights};
pub use contact::{ContactBracket, ContactDetails, FirstContact};
pub use exact_sign::{orient2d, orient3d, triple_product_sign};
pub use feature_pair::FeaturePair;
pub use glam;
pub use moving_sphere::{FirstMeeting, MovingSphere};
pub use options::ContactOptions;
pub use pair_motion::{PairMotion, PlacedTriangle};
pub use proven_crossing::proven_crossing;
pub use sphere::Sphere;
pub use staying::{MovingTriangle, stay_within};
pub use straight_path::StraightPaths;
pub use triangle_distance::{TriangleDistance, TriangleFeature, triangle_distance};
pub use triangle_intersection::triangles_intersect;
pub use triangles_at::TrianglesAt;
