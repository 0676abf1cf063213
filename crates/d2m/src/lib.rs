#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Make a [`TriMesh`] of your vertices and triangles, a [`MeshTree`] of the mesh (once), a [`Moving`] of the
//! tree and a motion (once a query), and ask [`time_of_contact`].
//!
//! ## Meshes
//! [`TriMesh`], [`MeshTree`]; shapes to try with: [`shapes`]; files: [`io`].
//!
//! ## Motions
//! - [`ConstantTwist`], [`ScrewMotion`], [`Keyframes`] (joined by a [`Span`]), [`Spline`], and [`AnyMotion`]
//!   for what is known at run time only.
//! - Arms: [`Arm`], [`Chain`], [`Joint`], [`JointKind`], [`JointValue`], [`JointPoints`].
//! - [`Composed`] and [`Retimed`]: motions made of motions. [`RigidMotion`]: the trait, for one of your own.
//! - [`Pose`], [`Twist`]: where a body is, and how fast it moves.
//!
//! ## Two bodies that move
//! - [`Moving`]: a body with its motion; [`Window`]: the times in question.
//! - [`time_of_contact`], [`time_of_contact_with`] (keeps a [`PairCache`]), [`time_of_contact_batch`],
//!   [`contact_exists`].
//! - [`clearance()`], [`clearance_batch`]: how near? [`contact_spans`]: when in contact? [`departure`]: when
//!   do they part?
//!
//! ## Two bodies at rest
//! [`Posed`]: a body with its pose. [`collide`], [`distance`], [`proximities`], [`proximities_with`],
//! [`reduce_proximities`].
//!
//! ## Many bodies
//! [`World`] of [`Body`]s, each with a [`BodyId`], a [`SharedMotion`] and perhaps a [`Group`];
//! [`PlannedMotion`] for what a body might do.
//!
//! ## Answers
//! - [`TimeOfContact`] with a [`Contact`]: [`Evidence`], [`StartState`].
//! - [`Clearance`], [`ClearanceStatus`]; [`ContactSpan`], [`SpanStatus`]; [`Departure`].
//! - [`Distance`], [`Proximity`].
//! - Of worlds: [`FirstContact`], [`PairContact`], [`PairProximities`], [`PairClearance`], [`PairSpans`] with [`join_spans`].
//!
//! ## Options and budgets
//! - [`QueryOptions`]: [`Solid`], [`Mode`], [`Start`]; [`ClearanceOptions`], [`ProximityOptions`].
//! - [`Budget`], [`Meter`], [`Canceller`], [`CancelFlag`].
//!
//! ## Errors
//! [`QueryError`], [`MeshError`], [`MotionError`], [`WorldError`]: bad input, with index and value. Hard
//! cases are no errors.
//!
//! ## Layers
//! Each is a crate of its own: [`interval`], [`motion`], [`root`], [`feature`], [`mesh`], [`bvh`], [`shapes`],
//! [`world`], with the features of their names [`dynamics`], [`io`], [`paper`], [`robot`], [`verify`], and
//! [`glam`](https://docs.rs/glam) for vectors.
//!
#![cfg_attr(not(feature = "dynamics"), doc = "[`dynamics`]: ./index.html#features")]
#![cfg_attr(not(feature = "io"), doc = "[`io`]: ./index.html#features")]
#![cfg_attr(not(feature = "paper"), doc = "[`paper`]: ./index.html#features")]
#![cfg_attr(not(feature = "robot"), doc = "[`robot`]: ./index.html#features")]
#![cfg_attr(not(feature = "verify"), doc = "[`verify`]: ./index.html#features")]
#![doc(html_root_url = "https://docs.rs/d2m")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

#[cfg(feature = "audit")]
pub mod audit;
#[cfg(feature = "verify")]
pub mod verify;

pub use d2m_bvh as bvh;
#[cfg(feature = "dynamics")]
pub use d2m_dynamics as dynamics;
pub use d2m_feature as feature;
pub use d2m_interval as interval;
#[cfg(feature = "io")]
pub use d2m_io as io;
pub use d2m_mesh as mesh;
pub use d2m_motion as motion;
#[cfg(feature = "paper")]
pub use d2m_paper as paper;
#[cfg(feature = "robot")]
pub use d2m_robot as robot;
pub use d2m_root as root;
pub use d2m_shapes as shapes;
pub use d2m_world as world;
pub use glam;

// One pair of moving bodies.
#[doc(inline)]
pub use d2m_bvh::{
    Budget, CancelFlag, Canceller, Clearance, ClearanceOptions, ClearanceStatus, Contact, ContactSpan,
    Departure, Evidence, Meter, Mode, Moving, PairCache, QueryError, QueryOptions, Solid, SpanStatus, Start,
    StartState, TimeOfContact, Window, clearance, clearance_batch, contact_exists, contact_spans, departure,
    time_of_contact, time_of_contact_batch, time_of_contact_with,
};
// Meshes, and one pair at rest.
#[doc(inline)]
pub use d2m_bvh::{
    Distance, MeshError, MeshTree, Posed, Proximity, ProximityOptions, TriMesh, collide, distance,
    proximities, proximities_with, reduce_proximities,
};
// How a body moves.
#[doc(inline)]
pub use d2m_motion::{
    AnyMotion, Arm, Chain, Composed, ConstantTwist, Joint, JointKind, JointPoints, JointValue, Keyframes,
    MotionError, Pose, Retimed, RigidMotion, ScrewMotion, Span, Spline, Twist,
};
// Many bodies.
#[doc(inline)]
pub use d2m_world::{
    Body, BodyId, FirstContact, Group, PairClearance, PairContact, PairProximities, PairSpans, PlannedMotion,
    SharedMotion, World, WorldError, join_spans,
};
