//! A robot as bodies and joints of a simulation.

use crate::joints::JointType;
use crate::{Robot, RobotError, Srdf};
use d2m_bvh::{MeshTree, Solid, TriMesh};
use d2m_dynamics::{
    Body, BodyId, Groups, Joint, JointKind, Kind, Mass, MassProperties, Simulation, SimulationError, Spring,
};
use d2m_motion::{JointKind as ChainJoint, JointValue, Pose, RigidMotion};
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What carries the root of a simulated robot.
///
/// ```
/// assert_eq!(d2m_robot::Base::default(), d2m_robot::Base::Held);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Base {
    /// It stands still: screwed to the world.
    #[default]
    Held,
    /// Nothing: it falls, walks, flies.
    Free,
}

/// A robot that is to be put into a simulation: its rigid groups of links (those that fixed joints join) as bodies, its joints as
/// joints with their limits, and the damping and dry friction of `<dynamics>`; masses from `<inertial>`, or from closed shapes with a density of
/// 1000 where a whole group has none.
///
/// Joints of one number move as in the file; those that mimic others are free (a remark says so). Floating joints join nothing. Links that a
/// joint joins, and groups of links of which the SRDF disables a pair, pass through each other.
///
/// ```
/// use d2m_dynamics::{Motor, MotorTarget, Simulation, SimulationOptions};
/// use d2m_robot::{Robot, RobotOptions, RobotBodies};
/// let text = r#"<robot name="crane">
///   <link name="post"><collision><geometry><box size="0.2 0.2 2"/></geometry></collision></link>
///   <link name="boom"><inertial><origin xyz="0.6 0 0"/><mass value="8"/>
///       <inertia ixx="0.02" iyy="0.7" izz="0.7"/></inertial>
///     <collision><origin xyz="0.6 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
///   <joint name="swing" type="revolute"><parent link="post"/><child link="boom"/><axis xyz="0 0 1"/>
///     <limit lower="-1" upper="1" effort="10" velocity="1"/><dynamics damping="0.5" friction="0.1"/></joint>
/// </robot>"#;
/// let robot = Robot::parse("crane.urdf", text, &RobotOptions::new())?;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let crane = RobotBodies::new(&robot).add_to(&mut simulation)?;
/// let swing = crane.joints[robot.find_joint("swing").expect("it has one")].expect("it is simulated");
/// simulation.set_motor(swing, Some(Motor::new(MotorTarget::Velocity(0.5))))?;
/// while simulation.time() < 1.0 {
///     simulation.step()?;
/// }
/// assert!((simulation.joint_value(swing) - 0.5).abs() < 0.01);
/// let boom = crane.bodies[1].expect("it has mass");
/// assert_eq!(simulation.mass_properties(boom).expect("it is dynamic").mass, 8.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[must_use]
pub struct RobotBodies<'r> {
    robot: &'r Robot,
    positions: Vec<(String, f64)>,
    base: Base,
    srdf: Option<&'r Srdf>,
    friction: f64,
}

/// Where the parts of a robot are in a simulation.
///
/// ```
/// use d2m_dynamics::{Simulation, SimulationOptions};
/// use d2m_robot::{Robot, RobotBodies, RobotOptions, SimulatedRobot};
/// let text = r#"<robot name="slide">
///   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
///   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
///   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/>
///     <limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
/// </robot>"#;
/// let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let slide: SimulatedRobot = RobotBodies::new(&robot).add_to(&mut simulation)?;
/// assert_eq!((slide.bodies.len(), slide.joints.len()), (2, 1));
/// assert!(slide.bodies[1].is_some() && slide.joints[0].is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SimulatedRobot {
    /// Of each link, in the order of the file, the body that it is part of; none where the root has no shape and is held.
    pub bodies: Vec<Option<BodyId>>,
    /// Of each joint of the robot its number in the simulation; none of fixed and floating ones. Its value there is zero at the
    /// start, whatever the position is.
    pub joints: Vec<Option<usize>>,
    /// What is not simulated as the file states it: one sentence each.
    pub remarks: Vec<String>,
}

impl<'r> RobotBodies<'r> {
    /// Held at its root, in its rest position.
    pub const fn new(robot: &'r Robot) -> Self {
        Self { robot, positions: Vec::new(), base: Base::Held, srdf: None, friction: 0.0 }
    }

    /// With these joints at these positions at the start; the others rest where no path names them.
    pub fn with_positions(mut self, positions: &[(&str, f64)]) -> Self {
        self.positions = positions.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        self
    }

    /// With its root carried so.
    pub const fn with_base(mut self, base: Base) -> Self {
        self.base = base;
        self
    }

    /// With the pairs that it disables.
    pub const fn with_srdf(mut self, srdf: &'r Srdf) -> Self {
        self.srdf = Some(srdf);
        self
    }

    /// With this friction of all links' surfaces.
    pub const fn with_friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }

    /// Adds bodies and joints. That no links are in each other is checked by the next step.
    ///
    /// # Errors
    /// Positions of joints that the robot does not have; a group of links without mass, or with mass and shapes of several radii; planar joints; what the
    /// simulation refuses. The simulation has none of the robot then.
    pub fn add_to(&self, simulation: &mut Simulation) -> Result<SimulatedRobot, RobotError> {
        let mut added = SimulatedRobot {
            bodies: vec![None; self.robot.links.len()],
            joints: vec![None; self.robot.joints.len()],
            remarks: Vec::new(),
        };
        let done = self.add_all(simulation, &mut added);
        if let Err(error) = done {
            for id in added.bodies.into_iter().flatten() {
                simulation.remove(id);
            }
            return Err(error);
        }
        Ok(added)
    }

    fn add_all(&self, simulation: &mut Simulation, added: &mut SimulatedRobot) -> Result<(), RobotError> {
        let robot = self.robot;
        let values = self.values()?;
        let poses: Vec<Pose> =
            robot.chains(&values)?.iter().map(|chain| chain.pose_and_twist(0.0).0).collect();
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for link in 0..robot.links.len() {
            groups.entry(robot.rigid_group(link)).or_default().push(link);
        }
        for (&first, links) in &groups {
            let Some(body) = self.body(first, links, &poses)? else { continue };
            let id = simulation.add(&body).map_err(|error| self.refused(&error))?;
            for &link in links {
                added.bodies[link] = Some(id);
            }
        }
        for (index, joint) in robot.joints.iter().enumerate() {
            let parts = robot.links[joint.child].joints.clone();
            let is_floating =
                parts.len() == 3 && parts.clone().all(|part| robot.joints[part].kind == JointType::Prismatic);
            if joint.kind == JointType::Fixed || is_floating {
                continue;
            }
            if parts.len() > 1 {
                return Err(self.fault(format!("joint {:?}: planar joints are not simulated", joint.name)));
            }
            if joint.mimic.is_some() {
                added.remarks.push(format!("joint {:?} mimics another one and is free here", joint.name));
            }
            let made = self.joint(index, values[index].value(0.0), &poses[joint.child], added)?;
            added.joints[index] = Some(simulation.add_joint(&made).map_err(|error| self.refused(&error))?);
        }
        for a in 0..robot.links.len() {
            for b in a + 1..robot.links.len() {
                let names = [a, b].map(|link| robot.links[link].name.as_str());
                let is_off = self.srdf.is_some_and(|srdf| srdf.disables(names[0], names[1]));
                if let [Some(one), Some(other)] = [added.bodies[a], added.bodies[b]]
                    && one != other
                    && (is_off || robot.is_joined(a, b))
                {
                    simulation.ignore(one, other);
                }
            }
        }
        Ok(())
    }

    /// The values of all joints at the start, also of those that mimic others.
    fn values(&self) -> Result<Vec<JointValue>, RobotError> {
        let names: Vec<String> = self.positions.iter().map(|(name, _)| name.clone()).collect();
        let values = self.positions.iter().map(|&(_, value)| JointValue::try_constant(value));
        let values = values.collect::<Result<Vec<_>, _>>()?;
        self.robot.all_values(&names, values)
    }

    /// The body of a group of links, in the frame of its first one; none of a held root without a shape.
    fn body(&self, first: usize, links: &[usize], poses: &[Pose]) -> Result<Option<Body>, RobotError> {
        let name = self.robot.links[first].name.as_str();
        let frame = Frame::of(&poses[first]);
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let (mut masses, mut radii) = (Vec::new(), Vec::new());
        let mut is_solid = true;
        for &link in links {
            let own = frame.inverse(&Frame::of(&poses[link]));
            for shape in &self.robot.links[link].bodies {
                let placed =
                    own.then(&Frame::of(&Pose::from_rpy(shape.origin.xyz, shape.origin.rpy.to_array())));
                let first = vertices.len() as u32;
                let mesh = shape.tree.mesh();
                vertices.extend(mesh.vertices().iter().map(|v| placed.point(*v)));
                triangles.extend(mesh.triangles().iter().map(|triangle| triangle.map(|v| v + first)));
                radii.push(shape.radius);
                is_solid &= shape.solid == Solid::Filled;
            }
            if let Some(inertial) = self.robot.links[link].inertial {
                let turned = own.then(&Frame::of(&Pose::from_rpy(inertial.position, inertial.rpy)));
                let r = DMat3::from_quat(turned.turn);
                let inertia = r * inertial.inertia * r.transpose();
                masses.push(MassProperties { mass: inertial.mass, center: turned.place, inertia });
            }
        }
        let radius = radii.first().copied().unwrap_or_default();
        if radii.iter().any(|other| *other != radius) {
            let reason =
                "its shapes have several radii (spheres, capsules), or some have none: they make no one body";
            return Err(self.fault(format!("link {name:?}: {reason}")));
        }
        let has_shape = !triangles.is_empty();
        let is_held = self.base == Base::Held && first == self.robot.rigid_group(self.robot.root());
        if !has_shape && is_held {
            return Ok(None);
        }
        let mass = (!masses.is_empty()).then(|| MassProperties::together(&masses));
        let bad = |error: d2m_bvh::MeshError| self.fault(format!("link {name:?}: {error}"));
        let mesh = match (has_shape, mass) {
            (true, _) => TriMesh::try_new(vertices, triangles).map_err(bad)?,
            (false, Some(mass)) => TriMesh::point(mass.center).map_err(bad)?,
            (false, None) => {
                return Err(self.fault(format!("link {name:?} has neither mass nor shape, and is moved")));
            }
        };
        let mut body = Body::new(name, Arc::new(MeshTree::new(mesh)))
            .with_position(frame.place)
            .with_orientation(frame.turn)
            .with_radius(radius)
            .with_friction(self.friction);
        if is_held {
            body = body.with_kind(Kind::Static);
        } else if let Some(mass) = mass {
            body = body.with_mass(Mass::Given(mass));
        }
        if has_shape {
            body = body.with_solid(if is_solid { Solid::Filled } else { Solid::Surface });
        } else {
            body = body.with_groups(Groups { member: 0, meets: 0 });
        }
        Ok(Some(body))
    }

    /// A joint of one number, with its value and where its child is at the start.
    fn joint(
        &self,
        index: usize,
        start: f64,
        child: &Pose,
        added: &SimulatedRobot,
    ) -> Result<Joint, RobotError> {
        let own = &self.robot.joints[index];
        let (kind, axis) = match own.joint.kind() {
            ChainJoint::Prismatic { axis, .. } => (JointKind::Prismatic, *axis),
            ChainJoint::Revolute { axis, .. } => (JointKind::Revolute, *axis),
            _ => (JointKind::Fixed, DVec3::Z),
        };
        let frame = Frame::of(child);
        let axis = frame.turn * axis.normalize();
        let Some(carried) = added.bodies[own.child] else {
            return Err(self.fault(format!("joint {:?} carries nothing", own.name)));
        };
        // Of a joint with the world it is the world that turns against the child, the other way round.
        let mut joint = match added.bodies[own.parent] {
            Some(carrier) => Joint::new(kind, carrier, Some(carried), frame.place).with_axis(axis),
            None => Joint::new(kind, carried, None, frame.place).with_axis(-axis),
        };
        if let Some([lower, upper]) = own.limits.position {
            joint = joint.with_limits([lower - start, upper - start]);
        }
        if own.dynamics.damping > 0.0 {
            joint = joint.with_spring(Spring::new(0.0, own.dynamics.damping, 0.0));
        }
        Ok(joint.with_friction(own.dynamics.friction))
    }

    fn fault(&self, reason: String) -> RobotError {
        RobotError::Robot { file: self.robot.file().to_owned(), reason }
    }

    fn refused(&self, error: &SimulationError) -> RobotError {
        self.fault(error.to_string())
    }
}

/// A frame in another one.
#[derive(Clone, Copy)]
struct Frame {
    place: DVec3,
    turn: DQuat,
}

impl Frame {
    fn of(pose: &Pose) -> Self {
        Self { place: pose.transform_point(DVec3::ZERO), turn: pose.rotation.normalize() }
    }

    fn point(&self, point: DVec3) -> DVec3 {
        self.place + self.turn * point
    }

    fn then(&self, inner: &Self) -> Self {
        Self { place: self.point(inner.place), turn: self.turn * inner.turn }
    }

    /// Another frame, seen from this one.
    fn inverse(&self, other: &Self) -> Self {
        let back = self.turn.conjugate();
        Self { place: back * (other.place - self.place), turn: back * other.turn }
    }
}
