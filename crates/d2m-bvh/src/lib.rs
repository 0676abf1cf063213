#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Make a [`TriMesh`] of your vertices and triangles, a [`MeshTree`] of the mesh (once), a [`Moving`] of the
//! tree and a motion (once a query), and ask [`time_of_contact`].
//!
//! ## Meshes and trees
//! - [`TriMesh`], from and to [`MeshArrays`]; [`MAX_COORDINATE`] bounds its numbers. [`Topology`] (with its
//!   [`Edge`]s) and [`Validation`] say what kind of mesh it is, [`MeshParts`] and [`MeshPart`] which parts
//!   hold each other.
//! - [`MeshTree`]: the tree of boxes. [`EnclosingSphere`]: the smallest sphere about points.
//!
//! ## Two bodies that move
//! - [`Moving`]: a body with its motion; [`Window`]: the times in question.
//! - [`time_of_contact`]: the first contact. [`time_of_contact_with`] keeps a [`PairCache`] from query to
//!   query, [`time_of_contact_batch`] asks about many pairs, [`time_of_contact_counted`] says what was done.
//! - [`contact_exists`]: only whether there is one.
//! - [`clearance()`] and [`clearance_batch`]: how near the bodies come. [`contact_spans`]: when they are in
//!   contact. [`departure`]: when they part.
//!
//! ## Two bodies at rest
//! All of this, and meshes and trees, are those of the crate `d2m-mesh`.
//! - [`Posed`]: a body with its pose.
//! - [`collide`], [`collide_within`], [`colliding_pairs`], [`try_colliding_pair`]: do they touch, and where?
//! - [`distance`], [`distance_within`], [`bound_distance`]: how far apart?
//! - [`proximities`], [`proximities_with`], [`proximities_within`], [`reduce_proximities`]: where are they
//!   locally closest: the contact manifold.
//!
//! ## Answers
//! - [`TimeOfContact`], with a [`Contact`]: its [`Evidence`], its [`StartState`], [`TimeBracket`].
//! - [`Clearance`] and [`ClearanceStatus`]; [`ContactSpan`] and [`SpanStatus`]; [`Departure`].
//! - [`Distance`], [`DistanceBounds`], [`Proximity`].
//! - [`Answered`] and [`SearchCounts`]: an answer with the work that it took.
//!
//! ## Options and budgets
//! - [`QueryOptions`]: [`Solid`], [`Mode`], [`Start`], tolerance, minimum separation. [`ClearanceOptions`],
//!   [`DistanceOptions`], [`ProximityOptions`].
//! - [`Budget`] limits the work, [`Canceller`] and its [`CancelFlag`] end it from another thread, [`Meter`]
//!   counts it ([`Exhausted`]).
//! - [`InstructionSet`]: which vector instructions are used; the answers do not depend on it.
//!
//! ## Errors
//! [`QueryError`], [`MeshError`], [`TreeError`], [`TreeFileError`]: bad input, with index and value. Hard
//! cases are no errors.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-bvh")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

#[cfg(feature = "audit")]
pub mod audit {
    //! What the engine concludes on its way, for a listener that proves it again.
    #[doc(inline)]
    pub use d2m_mesh::audit::*;
}
mod contact;
mod covered_pair;
mod evidence;
mod gap;
mod moving;
mod options;
mod pair;
mod pair_cache;
mod query;
mod skip;
mod time;
mod walk;
mod window;

pub use contact::{Contact, TimeBracket, TimeOfContact};
#[doc(inline)]
pub use d2m_mesh::{
    Budget, CancelFlag, Canceller, Distance, DistanceBounds, DistanceOptions, Edge, EnclosingSphere,
    Exhausted, InstructionSet, MAX_COORDINATE, MeshArrays, MeshError, MeshPart, MeshParts, MeshTree, Meter,
    Posed, Proximity, ProximityOptions, QueryError, Solid, StartState, Topology, TreeError, TreeFileError,
    TriMesh, Validation, bound_distance, collide, collide_within, colliding_pairs, distance, distance_within,
    proximities, proximities_with, proximities_within, reduce_proximities, try_colliding_pair,
};
pub use evidence::Evidence;
pub use glam;
pub use moving::Moving;
pub use options::{Mode, QueryOptions, Start};
pub use pair_cache::PairCache;
pub use query::{
    Clearance, ClearanceOptions, ClearanceStatus, ContactSpan, Departure, SpanStatus, clearance,
    clearance_batch, contact_exists, contact_spans, departure, time_of_contact, time_of_contact_batch,
    time_of_contact_counted, time_of_contact_with,
};
pub use walk::counts::{Answered, SearchCounts};
pub use window::Window;
