#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Make a [`TriMesh`] of your vertices and triangles, a [`MeshTree`] of the mesh (once), a [`Posed`] of the
//! tree and a pose, and ask for the [`distance()`] of two.
//!
//! ## Meshes and trees
//! - [`TriMesh`], from and to [`MeshArrays`]; [`MAX_COORDINATE`] bounds its numbers. [`Topology`] (with its
//!   [`Edge`]s) and [`Validation`] say what kind of mesh it is, [`MeshParts`] and [`MeshPart`] which parts
//!   hold each other.
//! - [`MassProperties`] of a closed mesh: mass, center of mass and inertia ([`MassError`]); [`PrincipalAxes`] of a
//!   symmetric matrix.
//! - [`MeshTree`]: the tree of boxes. [`EnclosingSphere`]: the smallest sphere about points.
//!
//! ## Two bodies at rest
//! - [`Posed`]: a body with its pose; [`Solid`]: what belongs to a body.
//! - [`collide`], [`collide_within`], [`colliding_pairs`], [`try_colliding_pair`]: do they touch, and where?
//! - [`distance()`], [`distance_within`], [`bound_distance`]: how far apart? A [`Distance`] or
//!   [`DistanceBounds`], with [`DistanceOptions`]; how they stand: [`StartState`].
//! - [`proximities`], [`proximities_with`], [`proximities_within`], [`reduce_proximities`]: where are they
//!   locally closest: the contact manifold. Each a [`Proximity`]; [`ProximityOptions`].
//!
//! ## Budgets
//! - [`Budget`] limits the work, [`Canceller`] and its [`CancelFlag`] end it from another thread, [`Meter`]
//!   counts it ([`Exhausted`]); [`Stop`] is what of it comes from outside.
//! - [`InstructionSet`]: which vector instructions are used; the answers do not depend on it.
//!
//! ## Queries of your own
//! - [`node`]: the boxes of a tree. [`at_rest`]: questions at an instant. [`margin`]: outward roundings.
//! - [`Simplex`]: the point of a hull that is nearest to the origin. [`Faces`]: triangles at vertices, and how far
//!   flat parts of a surface go on. [`DisjointSets`]: what hangs together.
//!
//! ## Errors
//! [`QueryError`], [`MeshError`], [`TreeError`], [`TreeFileError`]: bad input, with index and value. Hard
//! cases are no errors.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-mesh")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

pub mod at_rest;
#[cfg(feature = "audit")]
pub mod audit;
mod budget;
mod cancel;
mod enclosing_sphere;
mod error;
mod faces;
pub mod margin;
mod mass;
mod mesh;
mod meter;
mod nearest_point;
pub mod node;
pub mod parallel;
mod posed;
mod resting;
mod solid;
mod start_state;
mod tree;

pub use budget::Budget;
pub use cancel::{CancelFlag, Canceller};
pub use d2m_lanes::InstructionSet;
pub use enclosing_sphere::EnclosingSphere;
pub use error::QueryError;
pub use faces::Faces;
pub use glam;
pub use mass::{MassError, MassProperties, PrincipalAxes};
pub use mesh::{DisjointSets, Edge, MAX_COORDINATE, MeshArrays, MeshError, Topology, TriMesh, Validation};
pub use meter::{Exhausted, Meter, Stop};
pub use nearest_point::Simplex;
pub use posed::Posed;
pub use resting::collide::{collide, collide_within, colliding_pairs, try_colliding_pair};
pub use resting::distance::{
    Distance, DistanceBounds, DistanceOptions, bound_distance, distance, distance_within,
};
pub use resting::parts::{MeshPart, MeshParts};
pub use resting::proximities::{
    Proximity, ProximityOptions, proximities, proximities_with, proximities_within, reduce_proximities,
};
pub use solid::Solid;
pub use start_state::StartState;
pub use tree::{MeshTree, TreeError, TreeFileError};
