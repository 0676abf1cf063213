//! Bodies as they are described to a simulation.

use crate::MassProperties;
use d2m_bvh::{MeshTree, Solid};
use d2m_motion::RigidMotion;
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// Names a body of one [`Simulation`](crate::Simulation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId(pub(crate) u32);

impl BodyId {
    /// Bodies are numbered in the order in which they were added, from 0.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A motion that a kinematic body follows, whatever meets it.
pub type Motion = Arc<dyn RigidMotion + Send + Sync>;

/// What moves a body.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
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
}

impl core::fmt::Debug for Kind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Dynamic => "Dynamic",
            Self::Static => "Static",
            Self::Kinematic(_) => "Kinematic",
        })
    }
}

/// Where the mass of a dynamic body comes from.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
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
/// Default: dynamic, mesh frame = world frame, at rest, density 1000, no restitution, no friction; solid if its mesh is
/// watertight.
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
    /// Of a dynamic body; the others need none.
    pub mass: Mass,
    /// Coefficient of restitution, from 0 to 1. A contact has the greater one of its two bodies.
    pub restitution: f64,
    /// Coulomb's coefficient of friction. A contact has the mean of those of its two bodies.
    pub friction: f64,
    /// Solid, or only a surface. `None`: solid if the mesh is watertight.
    pub solid: Option<Solid>,
    /// The body is everything within this distance of its mesh. Its mass does not follow from it: that is the mesh's, or given.
    pub radius: f64,
    /// How fast its velocities fade.
    pub damping: Damping,
}

/// How fast the velocities of a dynamic body fade besides what contacts do: each by the factor exp(−rate · step) at the start of a step.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
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
    /// Of the velocity of the center of mass, per unit of time; not negative.
    pub linear: f64,
    /// Of the angular momentum, per unit of time; not negative.
    pub angular: f64,
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
}
