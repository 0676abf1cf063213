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
