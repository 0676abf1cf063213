//! Errors of bodies, scenes and steps.

use crate::shown::shown;
use d2m_bvh::QueryError;
use d2m_mesh::MassError;
use d2m_motion::OutsideDomain;
use glam::DVec3;

/// A fault of a body or a setting of a [`Simulation`](crate::Simulation).
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Simulation, SimulationError, SimulationOptions, StepError};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("one", Arc::clone(&cube)))?;
/// simulation.add(&Body::new("other", cube).with_position(DVec3::Y * 0.9))?;
/// let Err(StepError::Setup(error)) = simulation.step() else { panic!("they overlap by a tenth") };
/// assert!(matches!(&error, SimulationError::Intersecting { a, b, .. } if [a, b].map(|name| &**name) == ["one", "other"]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A setting that must be finite and positive (or not negative) is not.
    #[error("{name} {value:?} must be finite and {wanted}")]
    BadOption {
        /// Its name.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// What it should be.
        wanted: &'static str,
    },
    /// A number of a body that is not finite, negative where it must not be, or a quaternion without direction.
    #[error("body {body}: {name} {value} {reason}")]
    BadBody {
        /// The body's name.
        body: String,
        /// Which number.
        name: &'static str,
        /// The refused value, as text.
        value: String,
        /// What it has to be, or that it cannot be used.
        reason: &'static str,
    },
    /// A joint that cannot be made.
    #[error("joint of {a} and {b}: {name} {value} {reason}")]
    BadJoint {
        /// The first body's name.
        a: String,
        /// The second body's name.
        b: String,
        /// Which part of it.
        name: &'static str,
        /// The refused value, as text.
        value: String,
        /// What it has to be, or that it cannot be used.
        reason: &'static str,
    },
    /// A number in a snapshot's state of a pair of bodies, as the impulse of a contact, that cannot be used.
    #[error("pair of {a} and {b}: {name} {value} {reason}")]
    BadPair {
        /// The first body's name.
        a: String,
        /// The second body's name.
        b: String,
        /// Which part of it.
        name: &'static str,
        /// The refused value, as text.
        value: String,
        /// What it has to be, or that it cannot be used.
        reason: &'static str,
    },
    /// Mass properties that are missing or cannot be used.
    #[error("body {body}: {error}")]
    Mass {
        /// The body's name.
        body: String,
        /// What is wrong with them.
        error: MassError,
    },
    /// Two bodies share a point, or are not proven apart, before anything has moved.
    #[error("bodies {a} and {b} intersect at the start: by about {depth:.3e}, near {}", shown(point.to_array()))]
    Intersecting {
        /// The first body's name.
        a: String,
        /// The second body's name.
        b: String,
        /// About the length of the shortest way, along one of some directions, that frees them of each other.
        depth: f64,
        /// A point near which they intersect, world frame.
        point: DVec3,
    },
    /// A velocity of a body that is not dynamic: it would be ignored, since a kinematic body has its velocity
    /// from its motion.
    #[error(
        "body {body}: {name} {} would be ignored: the body is not dynamic, and a kinematic one has its velocity from its motion",
        shown(value.to_array())
    )]
    VelocityWithoutMotion {
        /// The body's name.
        body: String,
        /// Which velocity.
        name: &'static str,
        /// The refused value.
        value: DVec3,
    },
    /// An impulse, force or torque that is not finite, or that gives a body momenta or velocities above
    /// [`LARGEST`](crate::Simulation::LARGEST).
    #[error(
        "body {body}: {name} {} is too large: momenta and velocities must stay below 1e100",
        shown(value.to_array())
    )]
    TooLarge {
        /// The body's name.
        body: String,
        /// Which quantity.
        name: &'static str,
        /// The refused value.
        value: DVec3,
    },
    /// A pair of bodies that cannot be queried.
    #[error("bodies {a} and {b}: {error}")]
    Query {
        /// The first body's name.
        a: String,
        /// The second body's name.
        b: String,
        /// What is wrong with them.
        error: QueryError,
    },
    /// The motion of a kinematic body does not cover the present time, or all of a step.
    #[error("body {body}: {outside}")]
    OutsideMotion {
        /// The body's name.
        body: String,
        /// The times of the motion and of the step.
        outside: OutsideDomain,
    },
    /// A target with so large a turn in a step that it is not certain which way round a driven body has to
    /// turn.
    #[error(
        "body {body}: the target is too fast: a turn of {turn:?} radians in a step, of which less than 3 can be followed"
    )]
    TargetTooFast {
        /// The body's name.
        body: String,
        /// The angle, the short way round.
        turn: f64,
    },
    /// A snapshot with a body that the simulation does not have: it was removed since, or the snapshot is of another simulation.
    #[error("the snapshot has a body at place {place} that the simulation does not have")]
    Snapshot {
        /// The place of the body.
        place: usize,
    },
}

/// Why a simulation cannot go on. The segments before it stand.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions, StepError};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// // A press comes down on a stone that lies on the ground.
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("ground", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.502))?;
/// simulation.add(&Body::new("stone", Arc::clone(&cube)).with_position(DVec3::Y * 0.5))?;
/// let down = ConstantTwist::REST.with_position(DVec3::Y * 1.55).with_linear_velocity(DVec3::Y * -1.0);
/// simulation.add(&Body::new("press", cube).with_kind(Kind::Kinematic(Arc::new(down))))?;
/// let error = loop {
///     match simulation.step() {
///         Ok(_) => assert!(simulation.time() < 1.0),
///         Err(error) => break error,
///     }
/// };
/// assert!(matches!(&error, StepError::Crushed { crushed, .. } if crushed == "stone"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// Kinematic bodies crush a dynamic body. That is proven: there are multipliers of the contacts of all
    /// squeezed bodies, as they were measured, whose combination no motion obeys (Farkas) that is up to 128
    /// times as fast as the kinematic bodies close in, for as long as these need to use up the room that is
    /// left.
    #[error("at time {time:?}: body {pushing} crushes body {crushed}, which cannot give way")]
    Crushed {
        /// The kinematic body.
        pushing: String,
        /// The dynamic body.
        crushed: String,
        /// When.
        time: f64,
    },
    /// A kinematic body comes down on a dynamic one, and neither room for that nor a proof that there is none was found.
    #[error(
        "at time {time:?}: body {pushing} corners body {cornered}: neither room for it nor a proof that there is none was found"
    )]
    Cornered {
        /// The kinematic body.
        pushing: String,
        /// The body that is held against it.
        cornered: String,
        /// When.
        time: f64,
    },
    /// A kinematic body turns or accelerates so fast that flights of constant twists, 4096 in a step, do not
    /// stay closer to its motion than a hundredth of the gap; or the enclosures of its motion are too wide to
    /// show it. Or a dynamic body turns so fast in its joints that flights, 4096 in a step, tear them by more
    /// than the gap, as with a motor of absurd speed. Or the numbers of a body's flight are beyond doubles, or its velocity,
    /// force or momenta above [`LARGEST`](crate::Simulation::LARGEST).
    #[error(
        "at time {time:?}: body {body} moves too fast, or too unevenly, for the step: take a shorter step or a wider gap"
    )]
    TooFast {
        /// The body.
        body: String,
        /// When.
        time: f64,
    },
    /// A fault of the set-up that the first step finds.
    #[error(transparent)]
    Setup(#[from] SimulationError),
}
