//! The joints of a simulation: added, removed, driven and read. Their rows in the solver:
//! [`crate::joint::rows`].

use crate::joint::rows::Joined;
use crate::{Joint, Motor, Simulation, SimulationError};

impl Simulation {
    /// Joins two bodies, or one with the world, where they are. The pair is ignored unless the joint says
    /// otherwise. Returns the number of the joint.
    ///
    /// ```
    /// use d2m_bvh::MeshTree;
    /// use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// use std::sync::Arc;
    /// let bar = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let arm = simulation.add(&Body::new("arm", bar))?;
    /// let pin = Joint::new(JointKind::Revolute, arm, None, DVec3::X * -0.5);
    /// simulation.add_joint(&pin)?;
    /// while simulation.time() < 1.0 {
    ///     simulation.step()?;
    ///     let end = simulation.pose(arm).transform_point(DVec3::X * -0.5);
    ///     assert!((end + DVec3::X * 0.5).length() < 1e-4);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::BadJoint`]: numbers that cannot be used, or no body that could move. Nothing changes then.
    pub fn add_joint(&mut self, joint: &Joint) -> Result<usize, SimulationError> {
        let a = self.place(joint.a);
        let joined = if let Some(b) = joint.b.map(|b| self.place(b)).or(self.world) {
            Joined::try_new(joint, [a, b], [a, b].map(|i| &self.bodies[i]))?
        } else {
            // A place is given to the world once nothing is refused any more.
            let world = self.new_world()?;
            let made = Joined::try_new(joint, [a, self.next_index()], [&self.bodies[a], &world])?;
            self.settle_world(world, None);
            made
        };
        let [_, b] = joined.bodies;
        if !joint.collide {
            self.ignored.insert((a.min(b), a.max(b)));
        }
        self.joints.push(joined);
        self.drop_known(a);
        self.drop_known(b);
        Ok(self.joints.len() - 1)
    }

    /// Removes a joint; its number never means another one. Its bodies go on passing through each other if
    /// they did, since they mostly overlap at a joint; [`Self::heed`] has them meet again.
    ///
    /// # Panics
    /// If there is no such joint, or it was taken out.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let hung = simulation.add(&Body::new("hung", cube))?;
    /// let nail = simulation.add_joint(&Joint::new(JointKind::Spherical, hung, None, DVec3::Y))?;
    /// simulation.step()?;
    /// assert!(simulation.position(hung).y.abs() < 1e-9);
    /// simulation.remove_joint(nail);
    /// simulation.step()?;
    /// assert!(simulation.position(hung).y < -1e-4 && simulation.joint(nail).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn remove_joint(&mut self, joint: usize) {
        let places = self.there(joint).bodies;
        self.joints[joint].take_out();
        for place in places {
            self.drop_known(place);
        }
    }

    /// A joint, if it was not removed.
    pub fn joint(&self, joint: usize) -> Option<&Joint> {
        self.joints.get(joint).filter(|joined| !joined.is_gone()).map(|joined| &joined.joint)
    }

    /// Sets the motor of a joint, or none; a robot is driven by this from step to step. Wakes its bodies. They may
    /// have become static since the joint was added: the motor acts once one of them is dynamic.
    ///
    /// # Errors
    /// [`SimulationError::BadJoint`]: numbers that cannot be used. Nothing changes then.
    ///
    /// # Panics
    /// If there is no such joint, or it was taken out.
    pub fn set_motor(&mut self, joint: usize, motor: Option<Motor>) -> Result<(), SimulationError> {
        let joined = self.there(joint);
        let changed = Joint { motor, ..joined.joint.clone() };
        Joined::check_numbers(&changed, joined.bodies.map(|place| &self.bodies[place]))?;
        self.joints[joint].joint = changed;
        for place in self.joints[joint].bodies {
            self.wake_place(place);
        }
        Ok(())
    }

    fn there(&self, joint: usize) -> &Joined {
        let joined = &self.joints[joint];
        assert!(!joined.is_gone(), "joint {joint} was taken out, or one of its bodies");
        joined
    }

    /// The value of a joint: how far b has turned about the axis, or moved along it, against a; zero for
    /// other kinds.
    ///
    /// # Panics
    /// If there is no such joint, or it was taken out.
    pub fn joint_value(&self, joint: usize) -> f64 {
        let joined = self.there(joint);
        joined.value(joined.bodies.map(|i| &self.bodies[i]))
    }
}
