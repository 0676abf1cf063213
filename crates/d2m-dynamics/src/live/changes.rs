//! Changes of a running simulation, between two steps.

use crate::body::description::{Damping, Groups, Kind};
use crate::body::rigid_body::{RigidBody, Target};
use crate::numbers::{Fault, check_surface, material_fault, turn, unusable_of};
use crate::shown::{shown, shown_turn};
use crate::{BodyId, Motion, Simulation, SimulationError};
use d2m_contact::{Material, Velocity};
use d2m_motion::Pose;
use glam::DVec3;

impl Simulation {
    /// Puts the mesh frame of a dynamic or static body somewhere else, at once. The body keeps its
    /// velocities, and is awake.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`] if it would intersect a body that it meets there (it may touch it,
    /// up to rounding); [`SimulationError::BadBody`] for numbers that cannot be used, and for a body that
    /// follows its motion or its targets. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Kind, Simulation, SimulationError, SimulationOptions};
    /// # use d2m_motion::Pose;
    /// # use glam::{DQuat, DVec3};
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
    /// let cube = simulation.add(&Body::new("cube", cube).with_position(DVec3::Y * 0.6))?;
    /// simulation.step()?;
    /// let at = |y: f64| Pose::new(DVec3::Y * y, DQuat::IDENTITY);
    /// assert!(matches!(simulation.set_pose(cube, at(0.3)), Err(SimulationError::Intersecting { .. })));
    /// assert!(simulation.position(cube).y > 0.59);
    /// simulation.set_pose(cube, at(3.0))?;
    /// assert_eq!(simulation.position(cube), DVec3::Y * 3.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_pose(&mut self, body: BodyId, pose: Pose) -> Result<(), SimulationError> {
        let place = self.place(body);
        let own = &self.bodies[place];
        let bad = |value: String| unusable_of(&own.name, "pose", value);
        let there = || shown(pose.translation.to_array());
        if own.is_kinematic() {
            return Err(bad(format!("{} of a body that follows its motion", there())));
        }
        let target = target(own, pose);
        let moved = target.and_then(|target| own.moved(target.position, target.orientation, self.time));
        let moved = moved.ok_or_else(|| bad(format!("{}, {}", there(), shown_turn(pose.rotation))))?;
        let Velocity { linear, angular } = moved.velocity();
        moved.check_with_forces([("velocity", linear), ("angular velocity", angular)])?;
        self.replace(place, moved)
    }

    /// Gives a dynamic body a velocity of its center of mass and an angular velocity, world axes, and wakes
    /// it.
    ///
    /// # Errors
    /// [`SimulationError::VelocityWithoutMotion`] for other bodies, [`SimulationError::TooLarge`]. Nothing
    /// changes then.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let cube = simulation.add(&Body::new("cube", cube))?;
    /// simulation.step()?;
    /// simulation.set_velocity(cube, DVec3::X, DVec3::ZERO)?;
    /// assert_eq!(simulation.linear_velocity(cube), DVec3::X);
    /// simulation.step_to(1.01)?;
    /// assert!((simulation.position(cube).x - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_velocity(
        &mut self,
        body: BodyId,
        linear: DVec3,
        angular: DVec3,
    ) -> Result<(), SimulationError> {
        let place = self.place(body);
        let own = &self.bodies[place];
        if !own.is_dynamic() {
            let body = own.name.to_string();
            return Err(SimulationError::VelocityWithoutMotion { body, name: "velocity", value: linear });
        }
        let given = [("velocity", linear), ("angular velocity", angular)];
        for (name, value) in given {
            if !value.is_finite() {
                return Err(SimulationError::TooLarge { body: own.name.to_string(), name, value });
            }
        }
        let mut changed = own.clone();
        changed.set_velocity(Velocity { linear, angular });
        changed.faded = f64::NEG_INFINITY;
        changed.check_with_forces(given)?;
        self.bodies[place] = changed;
        self.drop_known(place);
        Ok(())
    }

    /// Sets the gravity from now on, and wakes all bodies.
    ///
    /// # Errors
    /// A gravity that is not finite. Nothing changes then.
    ///
    /// ```
    /// # use d2m_dynamics::{Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// simulation.set_gravity(DVec3::Y * -1.62)?; // on the Moon
    /// assert_eq!(simulation.options().gravity.y, -1.62);
    /// assert!(simulation.set_gravity(DVec3::NAN).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_gravity(&mut self, gravity: DVec3) -> Result<(), SimulationError> {
        let options = self.options.with_gravity(gravity);
        options.check()?;
        self.options = options;
        for place in 0..self.bodies.len() {
            self.wake_place(place);
        }
        Ok(())
    }

    /// Sets the restitution and friction of a body from now on, and wakes the bodies that touch it.
    ///
    /// # Errors
    /// A restitution outside [0, 1], a friction that is negative or not finite. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let [a, b] = [0, 1].map(|_| simulation.add(&Body::new("cube", Arc::clone(&cube))));
    /// let (a, b) = (a?, b?);
    /// simulation.set_material(a, 0.5, 0.8)?;
    /// let pair = simulation.pair(a, b);
    /// assert_eq!((pair.restitution, pair.friction), (0.5, 0.4)); // the greater one, the mean
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_material(
        &mut self,
        body: BodyId,
        restitution: f64,
        friction: f64,
    ) -> Result<(), SimulationError> {
        check_material(restitution, friction)?;
        let place = self.place(body);
        let own = &mut self.bodies[place];
        (own.restitution, own.friction) = (restitution, friction);
        self.drop_known(place);
        Ok(())
    }

    /// Sets how fast the velocities of a body fade from now on.
    ///
    /// # Errors
    /// Rates that are negative or not finite. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    pub fn set_damping(&mut self, body: BodyId, damping: Damping) -> Result<(), SimulationError> {
        let place = self.place(body);
        for (name, value) in damping.rates() {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SimulationError::BadOption { name, value, wanted: "not negative" });
            }
        }
        self.bodies[place].damping = damping;
        self.wake_place(place);
        Ok(())
    }

    /// Sets the velocity of a running surface from now on, mesh axes
    /// ([`Body::surface_velocity`](crate::Body::surface_velocity)).
    ///
    /// # Errors
    /// A velocity that is not finite, or of which the rounding alone, 2⁻⁵² of it, closes contacts by more than a
    /// sixteenth of the gap in a step. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let long = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let belt = Body::new("belt", long).with_kind(Kind::Static).with_friction(0.5);
    /// let belt = simulation.add(&belt)?;
    /// let parcel = Body::new("parcel", cube).with_position(DVec3::Y * 1.001).with_friction(0.5);
    /// let parcel = simulation.add(&parcel)?;
    /// simulation.set_surface_velocity(belt, DVec3::X * 0.5)?;
    /// while simulation.time() < 1.0 {
    ///     simulation.step()?;
    /// }
    /// assert!((simulation.linear_velocity(parcel).x - 0.5).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_surface_velocity(&mut self, body: BodyId, velocity: DVec3) -> Result<(), SimulationError> {
        let place = self.place(body);
        check_surface(&self.bodies[place].name, velocity, &self.options)?;
        self.bodies[place].surface_velocity = velocity;
        self.drop_known(place);
        Ok(())
    }

    /// Sets which bodies a body may meet from now on.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`] if it intersects one that it would meet. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    pub fn set_groups(&mut self, body: BodyId, groups: Groups) -> Result<(), SimulationError> {
        let place = self.place(body);
        let changed = RigidBody { groups, ..self.bodies[place].clone() };
        self.replace(place, changed)
    }

    /// Makes a body dynamic, static, kinematic or driven, at its present place, or at that of its motion. A
    /// dynamic one that was kinematic goes on with the velocity of its last flight; joints stay.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`] if it intersects a body that it would meet; missing mass properties;
    /// a motion that does not cover the present time. Nothing changes then.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let held = simulation.add(&Body::new("held", cube).with_kind(Kind::Static))?;
    /// simulation.step()?;
    /// simulation.set_kind(held, Kind::Dynamic)?; // let go
    /// simulation.step()?;
    /// assert!(simulation.position(held).y < 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_kind(&mut self, body: BodyId, kind: Kind) -> Result<(), SimulationError> {
        let place = self.place(body);
        let changed = self.bodies[place].with_kind(kind, self.time)?;
        changed.check_with_forces([("force", changed.force), ("torque", changed.torque)])?;
        self.replace(place, changed)
    }

    /// Gives a body another motion; it is kinematic from now on: [`Self::set_kind`].
    ///
    /// # Errors
    /// As [`Self::set_kind`].
    ///
    /// # Panics
    /// If the body was removed.
    pub fn set_motion(&mut self, body: BodyId, motion: Motion) -> Result<(), SimulationError> {
        self.set_kind(body, Kind::Kinematic(motion))
    }

    /// Sets where the mesh frame of a driven body ([`Kind::Driven`]) will be at the end of the next step,
    /// however long that is: its center flies straight there while it turns the short way round. It stands
    /// still there until it has another target.
    ///
    /// # Errors
    /// [`SimulationError::TargetTooFast`]: a turn of 3 radians or more, for which it is not certain which way
    /// round is meant. [`SimulationError::BadBody`]: numbers that cannot be used, a body that is not driven.
    /// Nothing changes then. A step too short for the way is
    /// [`StepError::TooFast`](crate::StepError::TooFast), and a body that is crushed on the way
    /// [`StepError::Crushed`](crate::StepError::Crushed), with the names.
    ///
    /// # Panics
    /// If the body was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
    /// # use d2m_motion::Pose;
    /// # use glam::{DQuat, DVec3};
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let hand = simulation.add(&Body::new("hand", cube).with_kind(Kind::Driven))?;
    /// simulation.set_target(hand, Pose::new(DVec3::X * 0.02, DQuat::from_rotation_z(0.1)))?;
    /// simulation.step()?;
    /// assert!((simulation.position(hand).x - 0.02).abs() < 1e-15);
    /// simulation.step()?; // stands still
    /// assert!((simulation.position(hand).x - 0.02).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_target(&mut self, body: BodyId, pose: Pose) -> Result<(), SimulationError> {
        let place = self.place(body);
        let own = &self.bodies[place];
        let target = target(own, pose).ok_or_else(|| own.bad_target(&pose))?;
        own.check_target(target, self.time)?;
        self.bodies[place].target = Some(target);
        Ok(())
    }

    /// Lets these two bodies pass through each other from now on. A body and itself are no pair: nothing
    /// changes.
    ///
    /// # Panics
    /// If one of them was removed.
    pub fn ignore(&mut self, a: BodyId, b: BodyId) {
        let key = self.key(a, b);
        if key.0 == key.1 {
            return;
        }
        self.ignored.insert(key);
        self.drop_known(key.0);
        self.drop_known(key.1);
    }

    /// Lets these two bodies meet again, after [`Self::ignore`] or a joint.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`] if they intersect. Nothing changes then.
    ///
    /// # Panics
    /// If one of them was removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Simulation, SimulationError, SimulationOptions};
    /// # use d2m_motion::Pose;
    /// # use glam::{DQuat, DVec3};
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let [a, b] = [0, 1].map(|_| simulation.add(&Body::new("cube", Arc::clone(&cube))));
    /// let (a, b) = (a?, b?);
    /// simulation.ignore(a, b);
    /// simulation.step()?; // in each other
    /// assert!(matches!(simulation.heed(a, b), Err(SimulationError::Intersecting { .. })));
    /// simulation.set_pose(b, Pose::new(DVec3::X * 2.0, DQuat::IDENTITY))?;
    /// simulation.heed(a, b)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn heed(&mut self, a: BodyId, b: BodyId) -> Result<(), SimulationError> {
        let key = self.key(a, b);
        if !self.ignored.remove(&key) {
            return Ok(());
        }
        if let Err(error) = self.check_pair(key.0, key.1) {
            self.ignored.insert(key);
            return Err(error);
        }
        for place in [key.0, key.1] {
            self.drop_known(place);
            self.unchecked.insert(place);
        }
        Ok(())
    }

    /// Sets the restitution and friction of one pair, in place of those that follow from its bodies. A body
    /// and itself are no pair: nothing changes.
    ///
    /// # Errors
    /// A restitution outside [0, 1], a friction that is negative or not finite. Nothing changes then.
    ///
    /// # Panics
    /// If one of them was removed.
    pub fn set_pair(
        &mut self,
        a: BodyId,
        b: BodyId,
        restitution: f64,
        friction: f64,
    ) -> Result<(), SimulationError> {
        check_material(restitution, friction)?;
        let key = self.key(a, b);
        self.materials.extend((key.0 != key.1).then_some((key, Material::new(restitution, friction))));
        self.drop_known(key.0);
        self.drop_known(key.1);
        Ok(())
    }

    /// Restitution and friction of a pair: those of [`Self::set_pair`], else the greater restitution and the
    /// mean friction of the two bodies.
    ///
    /// # Panics
    /// If one of them was removed.
    pub fn pair(&self, a: BodyId, b: BodyId) -> Material {
        self.material(self.place(a), self.place(b))
    }

    /// The places of two bodies, the smaller one first.
    fn key(&self, a: BodyId, b: BodyId) -> (usize, usize) {
        let (a, b) = (self.place(a), self.place(b));
        (a.min(b), a.max(b))
    }
}

fn check_material(restitution: f64, friction: f64) -> Result<(), SimulationError> {
    material_fault(restitution, friction).map_or(Ok(()), |Fault { name, value, wanted, .. }| {
        Err(SimulationError::BadOption { name, value, wanted })
    })
}

/// The center and the axes of a body whose mesh frame has this pose; none: the numbers are not finite.
fn target(body: &RigidBody, pose: Pose) -> Option<Target> {
    let orientation = turn(pose.rotation)?;
    let position = Pose { rotation: orientation, ..pose }.transform_point(body.center);
    position.is_finite().then_some(Target { position, orientation })
}
