//! Bodies that are changed from outside, between two steps.

use crate::SimulationError;
use crate::body::description::{Body, Kind, Presence};
use crate::body::rigid_body::{RigidBody, Role, Target, rest};
use crate::numbers::unusable_of;
use crate::rest::quiet::Quiet;
use d2m_bvh::{MeshTree, TriMesh};
use d2m_contact::Velocity;
use d2m_mesh::Faces;
use d2m_motion::rotation_vector;
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// A target turns a body by less than this in a step, so that the shortest way round is the one meant; below
/// π, with room for rounding.
const MOST_TURN: f64 = 3.0;

impl RigidBody {
    /// The body somewhere else, at rest until its next flight, with its velocities. None: numbers that are
    /// too large.
    pub(crate) fn moved(&self, position: DVec3, orientation: DQuat, time: f64) -> Option<Self> {
        let flight = rest(self.center, position, orientation, time)?;
        let angular = self.velocity().angular;
        let mut moved = Self { position, orientation, flight, ..self.clone() };
        if moved.is_dynamic() {
            moved.set_velocity(Velocity { linear: self.velocity().linear, angular });
        }
        Some(moved)
    }

    /// Checks that the body may be sent there in a step from a time.
    pub(crate) fn check_target(&self, target: Target, time: f64) -> Result<(), SimulationError> {
        let is_driven = matches!(self.kind, Kind::Driven);
        if !is_driven || self.moved(target.position, target.orientation, time).is_none() {
            return Err(self.bad_target(&target));
        }
        let turn = rotation_vector(target.orientation * self.orientation.conjugate()).length();
        if turn.is_nan() || turn >= MOST_TURN {
            return Err(SimulationError::TargetTooFast { body: self.name.to_string(), turn });
        }
        Ok(())
    }

    pub(crate) fn bad_target(&self, target: &impl core::fmt::Debug) -> SimulationError {
        let kind = if matches!(self.kind, Kind::Driven) { "" } else { " of a body that is not driven" };
        let value = format!("{target:?}{kind}");
        unusable_of(&self.name, "target", value)
    }

    /// Sets the momenta of a dynamic body to those of these velocities.
    pub(crate) fn set_velocity(&mut self, velocity: Velocity) {
        let r = DMat3::from_quat(self.orientation);
        self.momentum = velocity.linear * self.mass;
        self.angular_momentum = r * (self.inertia * (r.transpose() * velocity.angular));
    }

    /// The same body with another kind, at its place. The points of a kinematic body go on with the
    /// velocities of its flight, also where its center of mass is another point than the center of its motion.
    pub(crate) fn with_kind(&self, kind: Kind, time: f64) -> Result<Self, SimulationError> {
        let velocity = match kind {
            Kind::Dynamic if self.is_dynamic() => self.velocity(),
            Kind::Dynamic => self.present_velocity(),
            _ => Velocity::default(),
        };
        let described = Body {
            name: self.name.to_string(),
            tree: Arc::clone(&self.tree),
            kind,
            position: self.position - self.orientation * self.center,
            orientation: self.orientation,
            linear_velocity: velocity.linear,
            angular_velocity: velocity.angular,
            mass: self.given,
            restitution: self.restitution,
            friction: self.friction,
            solid: Some(self.solid),
            radius: self.rounding,
            damping: self.damping,
            groups: self.groups,
            surface_velocity: self.surface_velocity,
            presence: Presence::Solid,
        };
        let mut made = Self::try_new(&described, Arc::clone(&self.faces), time)?;
        if made.is_dynamic() && made.center != self.center {
            // The velocity so far is that of another point.
            let arm = made.orientation * (made.center - self.center);
            let linear = velocity.linear + velocity.angular.cross(arm);
            made.set_velocity(Velocity { linear, ..velocity });
            let given = [("velocity", linear), ("angular velocity", velocity.angular)];
            made.check_momenta(given, [DVec3::ZERO; 2])?;
        }
        let (force, torque) = if made.is_dynamic() { (self.force, self.torque) } else { Default::default() };
        let faded = if self.is_dynamic() { self.faded } else { made.faded };
        let (id, role, version) = (self.id, self.role, self.version);
        Ok(Self { id, role, faded, force, torque, version, ..made })
    }

    /// Starts anew at the present place: the last flight is forgotten.
    pub(crate) fn renew(&mut self, time: f64) {
        self.flight = self
            .flight
            .with_position(self.position)
            .with_orientation(self.orientation)
            .with_linear_velocity(DVec3::ZERO)
            .with_angular_velocity(DVec3::ZERO)
            .with_reference_time(time);
        self.time = time;
        self.horizon = f64::INFINITY;
        self.version += 1;
        (self.has_flown, self.held, self.free, self.asleep) = (false, false, false, false);
        self.lead = None;
        (self.gained, self.quiet) = (0.0, Quiet::default());
    }

    /// Frees the place of the body, and lets go of its mesh.
    pub(crate) fn vacate(&mut self) {
        if let Ok(nothing) = TriMesh::point(DVec3::ZERO) {
            self.faces = Arc::new(Faces::new(&nothing));
            self.tree = Arc::new(MeshTree::new(nothing));
        }
        (self.role, self.kind, self.target) = (Role::Vacant, Kind::Static, None);
        (self.mass, self.inverse_mass) = (0.0, 0.0);
        (self.inertia, self.inverse_inertia) = (DMat3::ZERO, DMat3::ZERO);
        (self.momentum, self.angular_momentum) = Default::default();
        (self.force, self.torque) = Default::default();
    }
}
