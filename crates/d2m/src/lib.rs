#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

#[cfg(feature = "verify")]
pub mod verify;

pub use d2m_bvh as bvh;
#[cfg(feature = "dynamics")]
pub use d2m_dynamics as dynamics;
pub use d2m_feature as feature;
pub use d2m_interval as interval;
#[cfg(feature = "io")]
pub use d2m_io as io;
pub use d2m_motion as motion;
#[cfg(feature = "paper")]
pub use d2m_paper as paper;
#[cfg(feature = "robot")]
pub use d2m_robot as robot;
pub use d2m_root as root;
pub use d2m_shapes as shapes;
pub use d2m_world as world;
pub use glam;

pub use d2m_bvh::{
    Budget, Contact, MeshTree, Mode, Moving, PairCache, Posed, Proximity, ProximityOptions, QueryError,
    QueryOptions, Solid, StartState, TimeOfContact, TriMesh, Window, contact_exists, proximities,
    proximities_with, reduce_proximities, time_of_contact, time_of_contact_with,
};
pub use d2m_bvh::{Distance, collide, distance};
#[doc(hidden)]
pub use d2m_motion::LinearMotion;
pub use d2m_motion::{ConstantTwist, Keyframes, Pose, RigidMotion, ScrewMotion, Twist};
pub use d2m_world::{
    Body, BodyId, FirstContact, Group, PairContact, PairProximities, PlannedMotion, SharedMotion, World,
    WorldError,
};

/// The example of the repository's README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

/// The pages of the guide whose examples are compiled and run.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../../../docs/guide/certified.md")]
    struct Certified;
    #[doc = include_str!("../../../docs/guide/one-pair.md")]
    struct OnePair;
    #[doc = include_str!("../../../docs/guide/meshes.md")]
    struct Meshes;
    #[doc = include_str!("../../../docs/guide/motions.md")]
    struct Motions;
    #[doc = include_str!("../../../docs/guide/tolerances.md")]
    struct Tolerances;
    #[doc = include_str!("../../../docs/guide/how-near.md")]
    struct HowNear;
    #[doc = include_str!("../../../docs/guide/scenes.md")]
    struct Scenes;
    #[doc = include_str!("../../../docs/guide/budgets.md")]
    struct Budgets;
}
