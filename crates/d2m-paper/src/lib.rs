#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`time_of_contact`] is the paper's query; [`cross_check`] asks both methods, judges both answers and
//! returns a [`CrossCheck`].
//!
//! ## Bodies
//! [`SphereTree`]: the paper's tree. [`Moving`]: a body with its tree and motion.
//!
//! ## Feature tests
//! - [`point_triangle`], [`point_polygon`], [`edge_edge`], [`sphere_sphere`], with [`PaperOptions`].
//! - [`Face`], [`TriangleFace`], [`PolygonFace`]: what a point meets; [`Sphere`], and [`Direction`] for
//!   extents along a direction.
//! - [`PointFace`], [`EdgePair`]: the functions whose first roots are searched.
//!
//! ## Motions
//! [`RelativeMotion`] of two bodies, over a span a [`RelativeFrame`], at one time a [`Placement`], of one
//! point a [`PointJet`].
//!
//! ## Spheres over time
//! [`BodyOverDomain`], [`SphereOverDomain`], [`test_sphere_pair`].
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-paper")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod feature;
mod mesh;

pub use d2m_feature::Sphere;
pub use feature::{
    BodyOverDomain, Direction, EdgePair, Face, PaperOptions, Placement, PointFace, PointJet, PolygonFace,
    RelativeFrame, RelativeMotion, SphereOverDomain, TriangleFace, edge_edge, point_polygon, point_triangle,
    sphere_sphere, test_sphere_pair,
};
pub use glam;
pub use mesh::{CrossCheck, Moving, SphereTree, cross_check, time_of_contact};
