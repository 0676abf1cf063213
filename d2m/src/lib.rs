//! Certified continuous collision detection of rigid bodies: when do two moving meshes first touch, where, along
//! which normal – with a proof.
//!
//! This crate re-exports the layers as modules and the names that most users need at its root:
//! [`MeshTree`] (a mesh ready for queries), [`LinearMotion`] and the open [`RigidMotion`] trait, [`time_of_contact`]
//! with [`Moving`], [`Window`], [`QueryOptions`] and its answer [`TimeOfContact`], and [`World`] for many bodies.
//!
//! ```
//! use d2m::{LinearMotion, MeshTree, Moving, QueryOptions, Window, time_of_contact};
//! let ball = MeshTree::new(d2m::shapes::mesh("icosphere?triangles=1280")?);
//! let flying = "x=-3,0,0;v=4,0,0;w=0,0,1".parse::<LinearMotion>()?;
//! let (a, b) = (Moving::new(&ball, &flying), Moving::new(&ball, &LinearMotion::REST));
//! let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default())?;
//! let contact = answer.contact().expect("they meet");
//! assert!(contact.time_lo > 0.24 && contact.time_lo < 0.27);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What each answer certifies, and the tests that back it: `docs/guarantees.md` in the repository.

mod body;
mod broad_phase;
mod world;

pub use body::Body;
pub use world::{BodyId, FirstContact, World, WorldError};

pub use d2m_bvh as bvh;
pub use d2m_feature as feature;
pub use d2m_interval as interval;
pub use d2m_motion as motion;
pub use d2m_root as root;
pub use d2m_shapes as shapes;
pub use glam;

pub use d2m_bvh::{
    Budget, Contact, MeshTree, Mode, Moving, PairCache, QueryOptions, Solid, TimeOfContact, TriMesh, Window,
    contact_exists, time_of_contact, time_of_contact_with,
};
pub use d2m_motion::{LinearMotion, RigidMotion, ScrewMotion};

/// The README's example, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
