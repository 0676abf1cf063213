//! The state of a body: its kind, place and mass. Its flights are in `flight`.

use crate::body::description::{Body, BodyId, Damping, Groups, Kind, Mass, Presence};
use crate::body::turning::Pull;
use crate::numbers::{Numbers, is_small, turn, unusable_of};
use crate::rest::quiet::Quiet;
use crate::shown::shown;
use crate::{MassProperties, SimulationError};
use d2m_bvh::{MeshTree, Moving, QueryError, Solid};
use d2m_contact::{Momenta, Velocity, extreme_eigenvalues};
use d2m_mesh::Faces;
use d2m_motion::{ConstantTwist, CoveredMotion};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// How far along the axes of a body bores are measured, divided by its radius.
pub(crate) const AXES_REACH: f64 = 1.0625;

/// The use of a place in the list of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Body,
    /// A body that others pass through.
    Sensor,
    /// The world of joints with the world: nothing meets it.
    World,
    /// Its body was removed.
    Vacant,
}

impl Role {
    /// Is it a body that a user has added?
    pub(crate) fn is_named(self) -> bool {
        matches!(self, Self::Body | Self::Sensor)
    }
}

/// The target of a body: its center and its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Target {
    pub(crate) position: DVec3,
    pub(crate) orientation: DQuat,
}

/// A body of a simulation. `position` is that of the center of mass.
#[derive(Clone)]
pub(crate) struct RigidBody {
    pub(crate) id: BodyId,
    pub(crate) role: Role,
    pub(crate) name: Arc<str>,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) faces: Arc<Faces>,
    pub(crate) solid: Solid,
    pub(crate) kind: Kind,
    /// Center of mass in the mesh frame (without a mass: the center of its volume or its bounding box).
    pub(crate) center: DVec3,
    /// No point of the body is further from the center; rounded up.
    pub(crate) radius: f64,
    /// The body is everything within this distance of its mesh.
    pub(crate) rounding: f64,
    /// No point of its mesh is nearer to the center than this; zero if the center does not lie in a cavity.
    pub(crate) cavity: f64,
    /// No point of its mesh is nearer than this to the lines through the center along the axes of the mesh
    /// frame, as far as [`AXES_REACH`] says.
    pub(crate) bores: [f64; 3],
    pub(crate) damping: Damping,
    pub(crate) groups: Groups,
    /// In mesh axes.
    pub(crate) surface_velocity: DVec3,
    /// The source of its mass when it is dynamic.
    pub(crate) given: Mass,
    /// Mass and inertia are zero for bodies that forces cannot move.
    pub(crate) mass: f64,
    pub(crate) inverse_mass: f64,
    pub(crate) inertia: DMat3,
    pub(crate) inverse_inertia: DMat3,
    /// The smallest and the largest inverse of a principal moment of inertia.
    pub(crate) moments: [f64; 2],
    pub(crate) restitution: f64,
    pub(crate) friction: f64,

    /// The time of the state below.
    pub(crate) time: f64,
    pub(crate) position: DVec3,
    pub(crate) orientation: DQuat,
    pub(crate) momentum: DVec3,
    pub(crate) angular_momentum: DVec3,
    /// Until when its velocities have faded: to the end of the last step, also where an error ended that early.
    pub(crate) faded: f64,
    /// Force and torque of the user over the next step.
    pub(crate) force: DVec3,
    pub(crate) torque: DVec3,
    /// The present flight, from its reference time until `horizon` at most.
    pub(crate) flight: ConstantTwist,
    pub(crate) horizon: f64,
    /// Changes with every flight and with every change from outside.
    pub(crate) version: u64,
    /// Has it begun a flight since it was added or changed from outside? Before that its velocity is that of
    /// its momenta.
    pub(crate) has_flown: bool,
    /// The target of a driven body at the end of the next step.
    pub(crate) target: Option<Target>,
    /// It stands still until the end of the step.
    pub(crate) held: bool,
    /// The velocity of the present flight is that of the momenta after forces have acted for this time;
    /// negative where the middle of the planned flight has passed. None: a flight has to be planned.
    pub(crate) lead: Option<f64>,
    /// Nothing touches it in this flight.
    pub(crate) free: bool,
    /// The energy account: the energy that contacts have added to the least energy before.
    pub(crate) gained: f64,
    pub(crate) asleep: bool,
    /// For how long it has been quiet.
    pub(crate) quiet: Quiet,
}

impl RigidBody {
    pub(crate) fn try_new(body: &Body, faces: Arc<Faces>, time: f64) -> Result<Self, SimulationError> {
        let bad = |name: &'static str, value: String| unusable_of(&body.name, name, value);
        let vectors = [
            ("position", body.position),
            ("velocity", body.linear_velocity),
            ("angular velocity", body.angular_velocity),
            ("surface velocity", body.surface_velocity),
        ];
        let [linear, angular] = body.damping.rates();
        let numbers = Numbers {
            body: &body.name,
            vectors: &vectors,
            orientation: body.orientation,
            restitution: body.restitution,
            friction: body.friction,
            not_negative: &[("radius", body.radius), linear, angular],
        };
        numbers.check()?;
        let given = vectors[1..3].iter().find(|(_, v)| *v != DVec3::ZERO);
        if let (Kind::Static | Kind::Kinematic(_) | Kind::Driven, Some(&(name, value))) = (&body.kind, given)
        {
            return Err(SimulationError::VelocityWithoutMotion { body: body.name.clone(), name, value });
        }
        let mesh = body.tree.mesh();
        let given = |error| SimulationError::Mass { body: body.name.clone(), error };
        let properties = match (&body.kind, body.mass) {
            (Kind::Dynamic, Mass::Density(density)) => {
                Some(MassProperties::try_from_density(mesh, density).map_err(given)?)
            }
            (Kind::Dynamic, Mass::Total(mass)) => {
                Some(MassProperties::try_from_mass(mesh, mass).map_err(given)?)
            }
            (Kind::Dynamic, Mass::Given(p)) => {
                Some(MassProperties::try_new(p.mass, p.center, p.inertia).map_err(given)?)
            }
            _ => None,
        };
        let center = properties.map_or_else(|| middle(&body.tree), |p| p.center);
        let farthest = mesh.triangles().iter().flatten().map(|&v| {
            let arm = mesh.vertices()[v as usize] - center;
            arm.length()
        });
        // A difference, three squares, two sums and a root: five roundings of relative size 2⁻⁵³ are fewer than 8ε.
        let radius = farthest.fold(0.0, f64::max) * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        let radius = if body.radius > 0.0 { (radius + body.radius).next_up() } else { radius };
        let kind = body.kind.clone();
        let (mesh_position, orientation) = match &kind {
            Kind::Kinematic(motion) => {
                let outside = |outside| SimulationError::OutsideMotion { body: body.name.clone(), outside };
                let covered = CoveredMotion::try_new(&**motion, time, time).map_err(outside)?;
                let (pose, _) = covered.motion().pose_and_twist(time);
                (pose.transform_point(DVec3::ZERO), pose.rotation.normalize())
            }
            _ => (body.position, turn(body.orientation).unwrap_or_default()),
        };
        let position = mesh_position + orientation * center;
        let (mass, inertia) = properties.map_or((0.0, DMat3::ZERO), |p| (p.mass, p.inertia));
        let dynamic = properties.is_some();
        let inverse_inertia = if dynamic { inertia.inverse() } else { DMat3::ZERO };
        let rotation = DMat3::from_quat(orientation);
        if body.solid == Some(Solid::Filled) && !body.tree.is_watertight() {
            return Err(bad("solid", "of a mesh that is not watertight".to_owned()));
        }
        let solid =
            body.solid.unwrap_or(if body.tree.is_watertight() { Solid::Filled } else { Solid::Surface });
        let rest = rest(center, position, orientation, time)
            .ok_or_else(|| bad("position", shown(position.to_array())))?;
        let made = Self {
            id: BodyId { place: 0, generation: 0 },
            role: if body.presence == Presence::Sensor { Role::Sensor } else { Role::Body },
            name: body.name.as_str().into(),
            tree: Arc::clone(&body.tree),
            faces,
            solid,
            kind,
            center,
            radius,
            rounding: body.radius,
            cavity: body.tree.bound_distance_from_point(center),
            bores: DVec3::AXES.map(|axis| {
                let reach = axis * (AXES_REACH * radius);
                body.tree.bound_distance_from_segment([center - reach, center + reach])
            }),
            damping: body.damping,
            groups: body.groups,
            surface_velocity: body.surface_velocity,
            given: body.mass,
            mass,
            inverse_mass: if dynamic { 1.0 / mass } else { 0.0 },
            inertia,
            inverse_inertia,
            moments: extreme_eigenvalues(inverse_inertia),
            restitution: body.restitution,
            friction: body.friction,
            time,
            position,
            orientation,
            momentum: body.linear_velocity * mass,
            angular_momentum: rotation * (inertia * (rotation.transpose() * body.angular_velocity)),
            faded: f64::NEG_INFINITY,
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            flight: rest,
            horizon: f64::INFINITY,
            version: 0,
            has_flown: false,
            target: None,
            held: false,
            lead: None,
            free: false,
            gained: 0.0,
            asleep: false,
            quiet: Quiet::default(),
        };
        let velocities = [("velocity", body.linear_velocity), ("angular velocity", body.angular_velocity)];
        made.check_momenta(velocities, [DVec3::ZERO; 2])?;
        Ok(made)
    }

    /// Checks two additions to the momenta, linear and angular, with the given quantities behind them and
    /// their names. They are refused if they are not finite, or if the body would have momenta or velocities
    /// above [`Simulation::LARGEST`](crate::Simulation::LARGEST).
    pub(crate) fn check_momenta(
        &self,
        given: [(&'static str, DVec3); 2],
        [linear, angular]: [DVec3; 2],
    ) -> Result<(), SimulationError> {
        // Numbers that are NaN are refused, too.
        let refuse = |(name, value): (&'static str, DVec3)| {
            Err(SimulationError::TooLarge { body: self.name.to_string(), name, value })
        };
        if !linear.is_finite() || !is_small(self.momentum + linear) {
            return refuse(given[0]);
        }
        if !angular.is_finite() || !is_small(self.angular_momentum + angular) {
            return refuse(given[1]);
        }
        if !is_small((self.momentum + linear) * self.inverse_mass) {
            return refuse(given[0]);
        }
        let turn = self.inverse_inertia_at(self.orientation) * (self.angular_momentum + angular);
        if !is_small(turn) {
            return refuse(given[1]);
        }
        Ok(())
    }

    /// Checks the momenta, with the given quantities that they come from, also once the force and torque of the user
    /// have acted for a unit of time.
    pub(crate) fn check_with_forces(&self, given: [(&'static str, DVec3); 2]) -> Result<(), SimulationError> {
        self.check_momenta(given, [DVec3::ZERO; 2])?;
        self.check_momenta(given, [self.force, self.torque])
    }

    pub(crate) fn is_dynamic(&self) -> bool {
        self.inverse_mass > 0.0
    }

    pub(crate) fn is_kinematic(&self) -> bool {
        matches!(self.kind, Kind::Kinematic(_) | Kind::Driven)
    }

    /// A driven body that stands still and has no target.
    fn is_parked(&self) -> bool {
        matches!(self.kind, Kind::Driven) && self.target.is_none() && self.stands_still()
    }

    /// Is it a kinematic body that moves?
    pub(crate) fn is_driven(&self) -> bool {
        self.is_kinematic() && !self.stands_still()
    }

    /// Does it move, or may it be moved, in this step?
    pub(crate) fn is_awake(&self) -> bool {
        (self.is_dynamic() && !self.asleep) || (self.is_kinematic() && !self.is_parked())
    }

    /// Wakes it if it sleeps: it is simulated again from this time on.
    pub(crate) fn wake(&mut self, time: f64) {
        if self.asleep {
            self.asleep = false;
            self.time = time;
            self.lead = None;
        }
    }

    /// The velocity of a running surface, world axes.
    pub(crate) fn surface_velocity_at(&self, orientation: DQuat) -> DVec3 {
        orientation * self.surface_velocity
    }

    /// The body on a motion, as a solid or a surface, as it is.
    pub(crate) fn moving_on<'a>(&'a self, motion: &'a ConstantTwist) -> Moving<'a> {
        Moving::new(&*self.tree, motion).with_solid(self.solid).with_radius(self.rounding)
    }

    /// The force of gravity and of the user.
    pub(crate) fn force_with(&self, gravity: DVec3) -> DVec3 {
        self.force + gravity * self.mass
    }

    pub(crate) fn momenta(&self) -> Momenta {
        Momenta { linear: self.momentum, angular: self.angular_momentum }
    }

    pub(crate) fn push(&mut self, added: Momenta) {
        self.momentum += added.linear;
        self.angular_momentum += added.angular;
    }

    /// Takes back an impulse of this instant.
    pub(crate) fn retract(&mut self, pushed: Momenta) {
        let before = self.kinetic_energy();
        self.push(-pushed);
        self.gained += self.kinetic_energy() - before;
    }

    /// The kinetic energy of the momenta.
    pub(crate) fn kinetic_energy(&self) -> f64 {
        let turn = self.inverse_inertia_at(self.orientation) * self.angular_momentum;
        0.5 * (self.momentum.length_squared() * self.inverse_mass + self.angular_momentum.dot(turn))
    }

    /// The limit of the energy account: the energy of the forces' impulse over half a step, and that of a
    /// lift by a gap.
    pub(crate) fn energy_limit(&self, gravity: DVec3, step: f64, gap: f64) -> f64 {
        let force = self.force_with(gravity);
        let (linear, angular) = (force * (0.5 * step), self.torque * (0.5 * step));
        let turn = self.inverse_inertia_at(self.orientation) * angular;
        0.5 * (linear.length_squared() * self.inverse_mass + angular.dot(turn)) + force.length() * gap
    }

    /// The velocity of the momenta at `time`.
    pub(crate) fn velocity(&self) -> Velocity {
        let r = DMat3::from_quat(self.orientation);
        let angular = r * (self.inverse_inertia * (r.transpose() * self.angular_momentum));
        Velocity { linear: self.momentum * self.inverse_mass, angular }
    }

    pub(crate) fn inverse_inertia_at(&self, orientation: DQuat) -> DMat3 {
        let r = DMat3::from_quat(orientation);
        r * self.inverse_inertia * r.transpose()
    }

    /// The inverse inertia against changes of the spin, with the brake of a pull.
    pub(crate) fn inverse_inertia_under(&self, orientation: DQuat, pull: Option<Pull>) -> DMat3 {
        let Some(pull) = pull else { return self.inverse_inertia_at(orientation) };
        let r = DMat3::from_quat(orientation);
        (r * self.inertia * r.transpose() + pull.stiffness).inverse()
    }

    /// Moves the body by a velocity in one unit of time.
    pub(crate) fn shift(&mut self, by: Velocity) {
        self.position += by.linear;
        self.orientation = self.turned(by.angular, 1.0).normalize();
        self.flight = self.flight.with_position(self.position).with_orientation(self.orientation);
    }

    /// The error of a query of this body and another one.
    pub(crate) fn query_error(&self, other: &Self, error: QueryError) -> SimulationError {
        SimulationError::Query { a: self.name.to_string(), b: other.name.to_string(), error }
    }
}

/// A flight at rest. None: the numbers are not finite, or too large.
pub(crate) fn rest(center: DVec3, position: DVec3, orientation: DQuat, time: f64) -> Option<ConstantTwist> {
    ConstantTwist::try_new(position, orientation, DVec3::ZERO, DVec3::ZERO)
        .and_then(|flight| flight.try_with_at(center))
        .and_then(|flight| flight.try_with_reference_time(time))
        .ok()
}

/// The center of a mesh without mass: that of its volume if it is closed, else of its bounding box.
fn middle(tree: &MeshTree) -> DVec3 {
    if tree.is_watertight() {
        let solid = MassProperties::of_enclosed(tree.mesh());
        if solid.center.is_finite() && (solid.center - tree.center()).length() <= 2.0 * tree.radius() {
            return solid.center;
        }
    }
    DVec3::ZERO
}
