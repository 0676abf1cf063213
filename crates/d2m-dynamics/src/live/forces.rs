//! Forces and impulses from outside.

use crate::{BodyId, Simulation, SimulationError};
use glam::DVec3;

impl Simulation {
    /// Sets the force through the center of mass and the torque on a body over the next step, world axes;
    /// gravity is added. Wakes the body.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// simulation.set_force(body, DVec3::X * 1000.0, DVec3::ZERO)?; // over the next step
    /// let step = simulation.options().step;
    /// simulation.step()?;
    /// let speed = simulation.linear_velocity(body).x;
    /// assert!(speed > 0.0 && speed <= 1.001 * step); // force by mass is one
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::TooLarge`]: a force or torque that is not finite, or that gives a dynamic body a momentum or velocity above
    /// [`Self::LARGEST`] within a unit of time. Nothing changes then.
    pub fn set_force(&mut self, body: BodyId, force: DVec3, torque: DVec3) -> Result<(), SimulationError> {
        let place = self.place(body);
        let body = &mut self.bodies[place];
        body.check_momenta([("force", force), ("torque", torque)], [force, torque])?;
        (body.force, body.torque) = (force, torque);
        self.wake_place(place);
        Ok(())
    }

    /// Adds a force that acts at a point over the next step, both in world axes, to those that act already: a
    /// force through the center of mass with the torque (point − center) × force. Wakes the body.
    ///
    /// # Errors
    /// As [`Self::set_force`].
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Mass, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let cube = simulation.add(&Body::new("cube", cube).with_mass(Mass::Total(1.0)))?;
    /// // Two thrusters on opposite sides: of the torques nothing is left.
    /// for side in [0.5, -0.5] {
    ///     simulation.add_force_at(cube, DVec3::Y * 50.0, DVec3::X * side)?;
    /// }
    /// simulation.step_to(1.0)?;
    /// assert!((simulation.linear_velocity(cube).y - 50.0).abs() < 1e-9); // of the middle of the step
    /// assert!(simulation.angular_velocity(cube).length() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_force_at(&mut self, body: BodyId, force: DVec3, point: DVec3) -> Result<(), SimulationError> {
        let own = &self.bodies[self.place(body)];
        let torque = (point - self.position(body)).cross(force);
        self.set_force(body, own.force + force, own.torque + torque)
    }

    /// Adds an impulse at the center of mass and an angular impulse, world axes. Wakes the body.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// simulation.apply_impulse(body, DVec3::Y * 500.0, DVec3::ZERO)?;
    /// assert_eq!(simulation.linear_velocity(body), DVec3::Y * 0.5); // at once
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::TooLarge`]: an impulse that is not finite, or after which a dynamic body has a momentum or velocity above
    /// [`Self::LARGEST`]. Nothing changes then.
    pub fn apply_impulse(
        &mut self,
        body: BodyId,
        impulse: DVec3,
        angular: DVec3,
    ) -> Result<(), SimulationError> {
        let place = self.place(body);
        let body = &mut self.bodies[place];
        let given = [("impulse", impulse), ("angular impulse", angular)];
        body.check_momenta(given, [impulse, angular])?;
        body.check_momenta(given, [impulse + body.force, angular + body.torque])?;
        if body.is_dynamic() {
            body.momentum += impulse;
            body.angular_momentum += angular;
        }
        self.wake_place(place);
        Ok(())
    }

    /// Adds an impulse that acts at a point, both in world axes: an impulse at the center of mass with the
    /// angular impulse (point − center) × impulse. Wakes the body.
    ///
    /// # Errors
    /// As [`Self::apply_impulse`].
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Mass, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let cube = Body::new("cube", cube).with_mass(Mass::Total(1.0));
    /// let cube = simulation.add(&cube.with_position(DVec3::X * 3.0))?;
    /// simulation.apply_impulse_at(cube, DVec3::Y, DVec3::new(3.5, 0.0, 0.0))?;
    /// simulation.step()?;
    /// // Moments of inertia 1/6.
    /// assert!((simulation.linear_velocity(cube) - DVec3::Y).length() < 1e-12);
    /// assert!((simulation.angular_velocity(cube) - DVec3::Z * 3.0).length() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn apply_impulse_at(
        &mut self,
        body: BodyId,
        impulse: DVec3,
        point: DVec3,
    ) -> Result<(), SimulationError> {
        let arm = point - self.position(body);
        self.apply_impulse(body, impulse, arm.cross(impulse))
    }

    /// Wakes a body if it sleeps: it is simulated again. It falls asleep again if it stays at rest.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// # let floor = Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static);
    /// # simulation.add(&floor.with_position(DVec3::Y * -1.001))?;
    /// let resting = simulation.add(&Body::new("resting", cube))?;
    /// while !simulation.is_asleep(resting) {
    ///     simulation.step()?;
    /// }
    /// simulation.wake(resting);
    /// assert!(!simulation.is_asleep(resting));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn wake(&mut self, body: BodyId) {
        self.wake_place(self.place(body));
    }
}
