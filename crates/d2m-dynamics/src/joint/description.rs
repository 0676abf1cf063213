//! The descriptions of joints between bodies.

use crate::BodyId;
use glam::{BVec3, DVec3};

/// The motion that a joint leaves free.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.1&y=0.1&z=0.1")?));
/// use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// // A bead on a vertical wire falls, and does not turn.
/// let bead = simulation.add(&Body::new("bead", cube).with_angular_velocity(DVec3::X))?;
/// let wire = Joint::new(JointKind::Prismatic, bead, None, DVec3::ZERO).with_axis(DVec3::Y);
/// simulation.add_joint(&wire)?;
/// while simulation.time() < 0.5 {
///     simulation.step()?;
/// }
/// assert!(simulation.position(bead).y < -1.0 && simulation.angular_velocity(bead).length() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum JointKind {
    /// Nothing.
    Fixed,
    /// To turn about the axis.
    Revolute,
    /// To move along the axis.
    Prismatic,
    /// To turn about the point.
    Spherical,
    /// All but the locked directions: displacements of the center of mass along these axes of the world, and
    /// turns about them. Of one body, with the world: [`Joint::locks`].
    Locked {
        /// The axes along which it may not move.
        ways: BVec3,
        /// The axes about which it may not turn. With two or three the turn drifts by up to 3e-4 radians
        /// (measured); with one the angular velocity is zero.
        turns: BVec3,
    },
}

/// The target of a motor.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.1&y=0.1&z=0.1")?));
/// use d2m_dynamics::{Body, Joint, JointKind, Motor, MotorTarget, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let wheel = simulation.add(&Body::new("wheel", cube))?;
/// let turning = Motor::new(MotorTarget::Velocity(3.0));
/// simulation.add_joint(&Joint::new(JointKind::Revolute, wheel, None, DVec3::ZERO).with_motor(turning))?;
/// simulation.step()?;
/// assert!((simulation.angular_velocity(wheel).length() - 3.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MotorTarget {
    /// A rate of the joint's value.
    Velocity(f64),
    /// A value of the joint.
    Position(f64),
}

/// Drives the value of a revolute joint (an angle, by a torque) or of a prismatic one (a length, by a force).
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.1&y=0.1&z=0.1")?));
/// use d2m_dynamics::{Body, Joint, JointKind, Motor, MotorTarget, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
/// let slide = simulation.add(&Body::new("slide", cube))?; // 8 kilograms
/// let mut weak = Motor::new(MotorTarget::Velocity(100.0));
/// weak.most = 4.0; // newtons
/// let rail = Joint::new(JointKind::Prismatic, slide, None, DVec3::ZERO).with_axis(DVec3::X).with_motor(weak);
/// simulation.add_joint(&rail)?;
/// while simulation.time() < 1.0 {
///     simulation.step()?;
/// }
/// // It cannot reach its speed: it gives what it has, half a metre per square second.
/// assert!((simulation.linear_velocity(slide).length() - 0.5 * simulation.time()).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motor {
    /// Its target.
    pub target: MotorTarget,
    /// The largest force or torque. Default: unbounded, except against an obstacle: there it stalls.
    #[cfg_attr(feature = "serde", serde(with = "unbounded"))]
    pub most: f64,
    /// Force divided by the distance to the position. Zero: as stiff as necessary.
    pub stiffness: f64,
    /// Force divided by the rate, of a motor with a stiffness.
    pub damping: f64,
}

impl Motor {
    /// A motor as strong and as stiff as necessary.
    #[must_use]
    pub const fn new(target: MotorTarget) -> Self {
        Self { target, most: f64::INFINITY, stiffness: 0.0, damping: 0.0 }
    }
}

/// A spring at a joint's value, of the force stiffness (rest − value) − damping rate. It is solved for the
/// end of a step: stable for any stiffness.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.1&y=0.1&z=0.1")?));
/// use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions, Spring};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let load = simulation.add(&Body::new("load", cube))?;
/// let spring = Spring::new(800.0, 80.0, 0.0);
/// let guide = Joint::new(JointKind::Prismatic, load, None, DVec3::ZERO).with_axis(DVec3::Y).with_spring(spring);
/// let guide = simulation.add_joint(&guide)?;
/// while simulation.time() < 5.0 {
///     simulation.step()?;
/// }
/// // It hangs where the spring carries its weight: 8 kg times 9.81 over 800 newtons a metre.
/// assert!((simulation.joint_value(guide).abs() - 8.0 * 9.81 / 800.0).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spring {
    /// Force divided by length, or torque divided by angle.
    pub stiffness: f64,
    /// Force divided by rate.
    pub damping: f64,
    /// The value at which it is slack.
    pub rest: f64,
}

impl Spring {
    /// With this stiffness and damping, slack at `rest`.
    #[must_use]
    pub const fn new(stiffness: f64, damping: f64, rest: f64) -> Self {
        Self { stiffness, damping, rest }
    }
}

/// A joint of two bodies, or of one and the world. [`Simulation::add_joint`](crate::Simulation::add_joint)
/// adds it.
///
/// Its value is the angle by which b has turned against a about the axis, or the length by which it has moved
/// along it; it is zero where the joint is added. Where b is the world, a body a that moves along the axis
/// therefore has a negative value. Joints hold to rounding in velocities, in the middle of each flight;
/// position errors at the ends of flights are corrected by the next ones. Flights are certified whether there
/// are joints or not.
///
/// ```
/// # use std::sync::Arc;
/// # let bar = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05")?));
/// use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let door = simulation.add(&Body::new("trapdoor", bar))?;
/// let hinge = Joint::new(JointKind::Revolute, door, None, DVec3::X * -0.5).with_limits([-0.5, 0.5]);
/// let hinge = simulation.add_joint(&hinge)?;
/// while simulation.time() < 1.0 {
///     simulation.step()?;
/// }
/// assert!((simulation.joint_value(hinge).abs() - 0.5).abs() < 1e-3); // it has fallen to its limit
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// The motion that it leaves free.
    pub kind: JointKind,
    /// The first body.
    pub a: BodyId,
    /// The second body; none: the world.
    pub b: Option<BodyId>,
    /// In the world frame, where the bodies are when it is added.
    pub point: DVec3,
    /// In the world frame, for revolute and prismatic joints; of any length but zero.
    pub axis: DVec3,
    /// The smallest and the largest value.
    pub limits: Option<[f64; 2]>,
    /// A motor that drives its value.
    pub motor: Option<Motor>,
    /// A spring that pulls its value back.
    pub spring: Option<Spring>,
    /// The largest force or torque of dry friction.
    pub friction: f64,
    /// May the two bodies touch? Otherwise they pass through each other.
    pub collide: bool,
}

impl Joint {
    /// A joint of two bodies at a point, along z, without limits, motor, spring and friction.
    pub const fn new(kind: JointKind, a: BodyId, b: Option<BodyId>, point: DVec3) -> Self {
        let axis = DVec3::Z;
        let (limits, motor, spring) = (None, None, None);
        Self { kind, a, b, point, axis, limits, motor, spring, friction: 0.0, collide: false }
    }

    /// Locks of one body: displacements of its center of mass along these axes of the world, and turns about
    /// them, are not possible from when they are added.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Joint, Simulation, SimulationOptions};
    /// # use glam::{BVec3, DVec3};
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let thrown = Body::new("thrown", cube).with_linear_velocity(DVec3::new(1.0, 2.0, 3.0));
    /// let thrown = simulation.add(&thrown)?;
    /// // In a plane: no way along z, no turn but about z.
    /// let flat = BVec3::new(false, false, true);
    /// simulation.add_joint(&Joint::locks(thrown, flat, !flat))?;
    /// while simulation.time() < 0.5 {
    ///     simulation.step()?;
    /// }
    /// let place = simulation.position(thrown);
    /// assert!(place.z.abs() < 1e-9 && (place.x - 0.5).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn locks(body: BodyId, ways: BVec3, turns: BVec3) -> Self {
        Self::new(JointKind::Locked { ways, turns }, body, None, DVec3::ZERO)
    }

    /// With this axis.
    pub const fn with_axis(mut self, axis: DVec3) -> Self {
        self.axis = axis;
        self
    }

    /// With these limits of the value.
    pub const fn with_limits(mut self, limits: [f64; 2]) -> Self {
        self.limits = Some(limits);
        self
    }

    /// Driven by this motor.
    pub const fn with_motor(mut self, motor: Motor) -> Self {
        self.motor = Some(motor);
        self
    }

    /// With this spring.
    pub const fn with_spring(mut self, spring: Spring) -> Self {
        self.spring = Some(spring);
        self
    }

    /// With this dry friction.
    pub const fn with_friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }

    /// With bodies that may touch each other, or not.
    pub const fn with_collide(mut self, collide: bool) -> Self {
        self.collide = collide;
        self
    }
}

/// Numbers that may be infinite, for formats without infinity.
#[cfg(feature = "serde")]
mod unbounded {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes fields by reference")]
    pub(super) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(*value).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Option::<f64>::deserialize(from).map(|value| value.unwrap_or(f64::INFINITY))
    }
}
