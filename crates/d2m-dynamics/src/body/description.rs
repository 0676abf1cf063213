//! Descriptions of bodies, from which a simulation makes them.

use crate::MassProperties;
use d2m_bvh::{MeshTree, Solid};
use d2m_motion::RigidMotion;
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// The name of a body of one [`Simulation`](crate::Simulation). The name of a removed body never means
/// another one.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let first = simulation.add(&Body::new("first", Arc::clone(&cube)))?;
/// let second = simulation.add(&Body::new("second", cube).with_position(DVec3::X * 3.0))?;
/// assert_eq!((first.index(), second.index(), simulation.name(second)), (0, 1, "second"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId {
    pub(crate) place: u32,
    /// How many bodies have had the place before.
    pub(crate) generation: u32,
}

impl BodyId {
    /// The place of the body. Bodies are numbered in the order in which they were added, from 0; one that is
    /// added after others were removed takes the first free place.
    pub const fn index(self) -> usize {
        self.place as usize
    }
}

/// A motion that a kinematic body follows, whatever meets it.
///
/// ```
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Motion, Simulation, SimulationOptions};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// use std::sync::Arc;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let turning: Motion = Arc::new(ConstantTwist::REST.with_angular_velocity(DVec3::Y));
/// let table = simulation.add(&Body::new("turntable", cube).with_kind(Kind::Kinematic(turning)))?;
/// simulation.step()?;
/// assert!((simulation.angular_velocity(table) - DVec3::Y).length() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type Motion = Arc<dyn RigidMotion + Send + Sync>;

/// What moves a body.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// // A lift that rises by 1 a second, whatever stands on it.
/// let rising = Kind::Kinematic(Arc::new(ConstantTwist::REST.with_linear_velocity(DVec3::Y)));
/// let lift = simulation.add(&Body::new("lift", cube).with_kind(rising))?;
/// simulation.step()?;
/// assert!((simulation.position(lift).y - simulation.time()).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub enum Kind {
    /// Forces and contacts.
    Dynamic,
    /// Nothing.
    Static,
    /// A motion of the mesh frame over the time of the simulation.
    Kinematic(Motion),
    /// [`Simulation::set_target`](crate::Simulation::set_target), step by step: it stands still where none is set.
    Driven,
}

impl core::fmt::Debug for Kind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Dynamic => "Dynamic",
            Self::Static => "Static",
            Self::Kinematic(_) => "Kinematic",
            Self::Driven => "Driven",
        })
    }
}

/// Where the mass of a dynamic body comes from.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Mass, Simulation, SimulationOptions};
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let stone = simulation.add(&Body::new("stone", cube).with_mass(Mass::Total(12.0)))?; // kilograms, say
/// assert!((simulation.mass_properties(stone).expect("it is dynamic").mass - 12.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Mass {
    /// Density of the closed mesh.
    Density(f64),
    /// Mass of the closed mesh, evenly spread.
    Total(f64),
    /// Given; the only choice for open meshes.
    Given(MassProperties),
}

/// A body to be added to a [`Simulation`](crate::Simulation).
///
/// Default: dynamic, mesh frame = world frame, at rest, density 1000, no restitution, no friction; solid if
/// its mesh is watertight.
///
/// ```
/// use d2m_bvh::MeshTree;
/// use d2m_dynamics::{Body, Kind};
/// use glam::DVec3;
/// use std::sync::Arc;
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let floor = Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5);
/// let falling = Body::new("cube", cube).with_position(DVec3::Y).with_restitution(0.8);
/// assert_eq!(falling.restitution, 0.8);
/// assert!(matches!(floor.kind, Kind::Static));
/// # Ok::<(), d2m_shapes::ShapeError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
#[must_use]
pub struct Body {
    /// Name in messages.
    pub name: String,
    /// Mesh and tree, shared with other bodies of the same shape.
    pub tree: Arc<MeshTree>,
    /// What moves it.
    pub kind: Kind,
    /// World position of the mesh frame's origin at the start. A kinematic body takes it from its motion.
    pub position: DVec3,
    /// Turn of the mesh frame at the start; normalised, zero is refused.
    pub orientation: DQuat,
    /// Velocity of the center of mass, world axes.
    pub linear_velocity: DVec3,
    /// Angular velocity, world axes.
    pub angular_velocity: DVec3,
    /// Mass of a dynamic body; the others need none.
    pub mass: Mass,
    /// Coefficient of restitution, from 0 to 1. A contact has the greater one of its two bodies.
    pub restitution: f64,
    /// Coulomb's coefficient of friction. A contact has the mean of those of its two bodies.
    pub friction: f64,
    /// Solid, or only a surface. `None`: solid if the mesh is watertight.
    pub solid: Option<Solid>,
    /// The body is everything within this distance of its mesh. Its mass does not depend on it: that is the
    /// mesh's, or given.
    pub radius: f64,
    /// How fast its velocities fade.
    pub damping: Damping,
    /// Which bodies it may meet. Default: all.
    pub groups: Groups,
    /// Velocity of the surface over the body, mesh axes: friction takes along whatever touches it, as on a
    /// conveyor belt. At a contact only the part along the surface counts. Default zero.
    pub surface_velocity: DVec3,
    /// Whether others meet it or pass through it.
    pub presence: Presence,
}

/// Whether other bodies meet a body or pass through it.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// # let sheet = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.001&y=2&z=2")?));
/// use d2m_dynamics::{Body, Kind, Presence, Simulation, SimulationOptions, TouchChange};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
/// let gate = Body::new("gate", sheet).with_kind(Kind::Static).with_presence(Presence::Sensor);
/// let gate = simulation.add(&gate)?;
/// let bullet = Body::new("bullet", cube).with_position(DVec3::X * -5.0).with_linear_velocity(DVec3::X * 1000.0);
/// let bullet = simulation.add(&bullet)?;
/// // Through the gate within a single step.
/// let touches = simulation.step()?.touches;
/// let changes: Vec<_> = touches.iter().map(|touch| (touch.a, touch.b, touch.change)).collect();
/// assert_eq!(changes, [(gate, bullet, TouchChange::Began), (gate, bullet, TouchChange::Ended)]);
/// assert!((touches[0].time - 4.499e-3).abs() < 1e-6 && (touches[1].time - 5.501e-3).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Presence {
    /// Others meet it.
    #[default]
    Solid,
    /// Others pass through it, and [`StepReport::touches`](crate::StepReport::touches) says when. Between an
    /// end and the next beginning the two are proven clear of each other at every time, however fast they
    /// are.
    Sensor,
}

/// The groups in which a body is, and those whose bodies it may meet, a bit each. Two bodies meet if each is
/// in a group that the other one meets; otherwise they pass through each other.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Groups, Kind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// const GHOSTS: u32 = 1 << 1;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let wall = Body::new("wall", Arc::clone(&cube)).with_kind(Kind::Static);
/// simulation.add(&wall.with_groups(Groups { meets: !GHOSTS, ..Groups::ALL }))?;
/// let ghost = Body::new("ghost", cube).with_position(DVec3::Y * 2.0);
/// let ghost = simulation.add(&ghost.with_groups(Groups { member: GHOSTS, ..Groups::ALL }))?;
/// while simulation.time() < 1.0 {
///     simulation.step()?;
/// }
/// assert!(simulation.position(ghost).y < -2.0); // it fell through
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Groups {
    /// The groups in which the body is.
    pub member: u32,
    /// The groups whose bodies it may meet.
    pub meets: u32,
}

impl Groups {
    /// In all groups, meeting all.
    pub const ALL: Self = Self { member: u32::MAX, meets: u32::MAX };

    /// May a body of these groups and one of others meet?
    pub const fn admit(self, other: Self) -> bool {
        self.member & other.meets != 0 && other.member & self.meets != 0
    }
}

impl Default for Groups {
    fn default() -> Self {
        Self::ALL
    }
}

/// How fast the velocities of a dynamic body fade, apart from contacts: each by the factor exp(−rate · step)
/// at the start of a step. Where an error ends that early, the next one does without the part that they have faded by.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Damping, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
/// let puck = Body::new("puck", cube).with_linear_velocity(DVec3::X).with_damping(Damping { linear: 2.0, angular: 0.0 });
/// let puck = simulation.add(&puck)?;
/// for _ in 0..50 {
///     simulation.step()?;
/// }
/// assert!((simulation.linear_velocity(puck).x - (-1.0_f64).exp()).abs() < 1e-12); // after half a second
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Damping {
    /// Rate of the velocity of the center of mass, per unit of time; not negative.
    pub linear: f64,
    /// Rate of the angular momentum, per unit of time; not negative.
    pub angular: f64,
}

impl Damping {
    /// The rates with their names.
    pub(crate) const fn rates(&self) -> [(&'static str, f64); 2] {
        [("linear damping", self.linear), ("angular damping", self.angular)]
    }
}

impl Body {
    /// A body with the defaults above.
    pub fn new(name: impl Into<String>, tree: Arc<MeshTree>) -> Self {
        Self {
            name: name.into(),
            tree,
            kind: Kind::Dynamic,
            position: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            linear_velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            mass: Mass::Density(1000.0),
            restitution: 0.0,
            friction: 0.0,
            solid: None,
            radius: 0.0,
            damping: Damping::default(),
            groups: Groups::ALL,
            surface_velocity: DVec3::ZERO,
            presence: Presence::Solid,
        }
    }

    /// With this kind.
    pub fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// With the origin of the mesh frame here.
    pub fn with_position(self, position: DVec3) -> Self {
        Self { position, ..self }
    }

    /// With the mesh frame turned so.
    pub fn with_orientation(self, orientation: DQuat) -> Self {
        Self { orientation, ..self }
    }

    /// With this velocity of the center of mass.
    pub fn with_linear_velocity(self, linear_velocity: DVec3) -> Self {
        Self { linear_velocity, ..self }
    }

    /// With this angular velocity, world axes.
    pub fn with_angular_velocity(self, angular_velocity: DVec3) -> Self {
        Self { angular_velocity, ..self }
    }

    /// With this mass.
    pub fn with_mass(self, mass: Mass) -> Self {
        Self { mass, ..self }
    }

    /// With this restitution.
    pub fn with_restitution(self, restitution: f64) -> Self {
        Self { restitution, ..self }
    }

    /// With this friction.
    pub fn with_friction(self, friction: f64) -> Self {
        Self { friction, ..self }
    }

    /// Solid or surface, whatever the mesh says.
    pub fn with_solid(self, solid: Solid) -> Self {
        Self { solid: Some(solid), ..self }
    }

    /// Everything within this distance of the mesh: a point is a sphere then, a segment a capsule, a box a rounded box.
    pub fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// With velocities that fade.
    pub fn with_damping(self, damping: Damping) -> Self {
        Self { damping, ..self }
    }

    /// In these groups, meeting the bodies of these.
    pub fn with_groups(self, groups: Groups) -> Self {
        Self { groups, ..self }
    }

    /// With this presence.
    pub fn with_presence(self, presence: Presence) -> Self {
        Self { presence, ..self }
    }

    /// With a surface of this velocity, mesh axes.
    pub fn with_surface_velocity(self, surface_velocity: DVec3) -> Self {
        Self { surface_velocity, ..self }
    }
}
