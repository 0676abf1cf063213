//! A robot: links joined to a tree, with their collision bodies.

use crate::geometry::{LinkBody, ShapeReader};
use crate::packages::read_text;
use crate::urdf::{Origin, Urdf, UrdfJoint, UrdfJointKind};
use crate::{RobotError, RobotOptions, Trajectory};
use d2m_motion::{Arm, Chain, Joint, JointKind, JointValue};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;

/// A robot as a URDF file describes it, with the collision bodies of its links.
///
/// The pose of a child in its parent is T(xyz)·Rz(yaw)·Ry(pitch)·Rx(roll)·J(q), J a turn about or a shift along the normalised
/// axis; the frame of the root link is the world. All numbers are taken as the doubles that they are read as.
///
/// ```
/// use d2m_robot::{Robot, RobotOptions};
/// let text = r#"<robot name="slide">
///   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
///   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
///   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/>
///     <origin xyz="0 0 0.2"/><axis xyz="2 0 0"/><limit lower="-1" upper="1" velocity="0.5"/></joint>
/// </robot>"#;
/// let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// assert_eq!((robot.joint_names(), robot.link_names()), (vec!["run"], vec!["rail", "cart"]));
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Robot {
    name: String,
    file: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<RobotJoint>,
    /// The links as an arm, each after its parent, with values of zero.
    arm: Arm,
    /// Where each link is in the arm.
    places: Vec<usize>,
    remarks: Vec<String>,
}

#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// The joint that carries it.
    pub(crate) joint: Option<usize>,
    pub(crate) bodies: Vec<LinkBody>,
}

#[derive(Debug, Clone)]
pub(crate) struct RobotJoint {
    pub(crate) name: String,
    pub(crate) kind: JointType,
    pub(crate) parent: usize,
    pub(crate) child: usize,
    pub(crate) limits: JointLimits,
    pub(crate) mimic: Option<Mimic>,
    /// With a value of zero if it moves.
    pub(crate) joint: Joint,
}

/// How a joint moves.
///
/// ```
/// # let urdf = r#"<robot name="two">
/// #   <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
/// #   <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
/// #   <link name="wall"><collision><origin xyz="0 0.7 0"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
/// #   <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
/// #     <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="base"/><child link="wall"/></joint>
/// # </robot>"#;
/// use d2m_robot::{JointType, Robot, RobotOptions};
/// let robot = Robot::parse("two.urdf", urdf, &RobotOptions::new())?;
/// let turn = robot.find_joint("turn").expect("the file has it");
/// assert_eq!((robot.joint_type(turn), robot.limits(turn).velocity), (JointType::Revolute, Some(1.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointType {
    /// Not at all.
    Fixed,
    /// It turns within limits.
    Revolute,
    /// It turns without limits.
    Continuous,
    /// It shifts.
    Prismatic,
}

/// Limits of a joint, as far as the file states them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct JointLimits {
    /// Least and greatest position (radians, or units of length).
    pub position: Option<[f64; 2]>,
    /// Greatest speed.
    pub velocity: Option<f64>,
}

/// The joint that another one follows: `multiplier`·q + `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Mimic {
    /// Its index among the robot's joints.
    pub joint: usize,
    /// Factor.
    pub multiplier: f64,
    /// Added then.
    pub offset: f64,
}

impl Robot {
    /// Reads a URDF file and the meshes that it names.
    ///
    /// # Errors
    /// A file that cannot be read, or as [`Robot::parse`].
    pub fn read(path: impl AsRef<Path>, options: &RobotOptions) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let text = read_text(path)?;
        Self::parse(&path.display().to_string(), &text, options)
    }

    /// From the text of a URDF file; meshes are beside the file of that name.
    ///
    /// # Errors
    /// What is no URDF, joints that are floating or planar, links that form no tree, joints that mimic in a circle, meshes that
    /// are missing, packages that nothing resolves, and a robot without any collision geometry: with file, line and name.
    pub fn parse(file: &str, text: &str, options: &RobotOptions) -> Result<Self, RobotError> {
        let urdf = Urdf::parse(file, text)?;
        let fault = |reason: String| RobotError::Robot { file: file.to_owned(), reason };
        let tree = LinkTree::new(file, &urdf)?;
        if urdf.links.iter().all(|link| link.collisions.is_empty()) {
            let count = urdf.links.len();
            return Err(fault(format!(
                "none of the {count} links has collision geometry: nothing can be checked"
            )));
        }
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        let mut reader = ShapeReader::new(file, folder, options);
        let mut links = Vec::with_capacity(urdf.links.len());
        for (link, joint) in urdf.links.iter().zip(&tree.carried_by) {
            let bodies = link.collisions.iter().map(|collision| reader.body(&link.name, collision));
            let bodies = bodies.collect::<Result<_, _>>()?;
            links.push(Link { name: link.name.clone(), joint: *joint, bodies });
        }
        let remarks = reader.remarks;
        let joints = urdf
            .joints
            .iter()
            .zip(&tree.ends)
            .map(|(joint, ends)| read_joint(file, &urdf, joint, *ends))
            .collect::<Result<Vec<_>, _>>()?;
        check_mimics(file, &urdf, &joints)?;
        let (name, file) = (urdf.name, file.to_owned());
        let (arm, places) = arm_of(&links, &joints, &tree.order)?;
        Ok(Self { name, file, links, joints, arm, places, remarks })
    }

    /// Its name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file that it was read from.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The names of the links, in the order of the file.
    pub fn link_names(&self) -> Vec<&str> {
        self.links.iter().map(|link| link.name.as_str()).collect()
    }

    /// The names of the joints that a path has to give: those that move and mimic no other, in the order of the file.
    pub fn joint_names(&self) -> Vec<&str> {
        let free = self.joints.iter().filter(|joint| joint.kind != JointType::Fixed && joint.mimic.is_none());
        free.map(|joint| joint.name.as_str()).collect()
    }

    /// The index of a link.
    pub fn find_link(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|link| link.name == name)
    }

    /// The index of a joint.
    pub fn find_joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// How a joint moves.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn joint_type(&self, joint: usize) -> JointType {
        self.joints[joint].kind
    }

    /// The limits of a joint.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn limits(&self, joint: usize) -> JointLimits {
        self.joints[joint].limits
    }

    /// What a joint follows.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn mimic(&self, joint: usize) -> Option<Mimic> {
        self.joints[joint].mimic
    }

    /// Where a joint stays that no path names: at zero, or in the middle of its limits if zero is outside of them.
    ///
    /// # Panics
    /// An index that is no joint.
    pub fn rest_position(&self, joint: usize) -> f64 {
        match self.joints[joint].limits.position {
            Some([lower, upper]) if !(lower..=upper).contains(&0.0) => 0.5 * lower + 0.5 * upper,
            _ => 0.0,
        }
    }

    /// What is not exact in the bodies of the links, and by how much: one sentence each.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// How many collision bodies a link has.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn body_count(&self, link: usize) -> usize {
        self.links[link].bodies.len()
    }

    /// Does a joint join these links directly?
    pub fn is_joined(&self, a: usize, b: usize) -> bool {
        self.joints
            .iter()
            .any(|joint| [joint.parent, joint.child] == [a, b] || [joint.parent, joint.child] == [b, a])
    }

    /// The link whose frame is the world.
    pub(crate) fn root(&self) -> usize {
        self.links.iter().position(|link| link.joint.is_none()).unwrap_or_default()
    }

    /// The place in the arm of the last link that carries both, or is one of them; none: the world.
    pub(crate) fn last_common(&self, a: usize, b: usize) -> Option<usize> {
        self.arm.last_common(self.places[a], self.places[b])
    }

    /// The index of a link in the robot's arm.
    pub(crate) fn place_in_arm(&self, link: usize) -> usize {
        self.places[link]
    }

    /// The last link on the way to this one that a joint moves, or the root: links of the same never move against each other.
    pub(crate) fn rigid_group(&self, link: usize) -> usize {
        let mut at = link;
        while let Some(joint) =
            self.links[at].joint.filter(|&joint| self.joints[joint].kind == JointType::Fixed)
        {
            at = self.joints[joint].parent;
        }
        at
    }

    /// The motion of every link's frame along a path, in the order of [`Robot::link_names`].
    ///
    /// # Errors
    /// A path that makes no sense, or names joints that the robot does not have.
    pub fn link_motions(&self, path: &Trajectory) -> Result<Vec<Chain>, RobotError> {
        self.chains(&self.all_values(&path.joint_names, path.joint_values()?)?)
    }

    /// The links as an arm with these values of all joints (those of fixed joints are ignored).
    pub(crate) fn arm(&self, values: &[JointValue]) -> Arm {
        let mut arm = self.arm.clone();
        for (joint, value) in self.joints.iter().zip(values) {
            arm.set_value(self.places[joint.child], value.clone());
        }
        arm
    }

    /// The motion of every link's frame, by the value of every joint.
    pub(crate) fn chains(&self, values: &[JointValue]) -> Result<Vec<Chain>, RobotError> {
        let chains = self.arm(values).links()?;
        Ok(self.places.iter().map(|&place| chains[place].clone()).collect())
    }
}

/// The links in an order in which each comes after its parent, and the place of each in it.
fn arm_of(links: &[Link], joints: &[RobotJoint], order: &[usize]) -> Result<(Arm, Vec<usize>), RobotError> {
    let mut arm = Arm::default();
    let mut places = vec![0; links.len()];
    for &link in order {
        let (parent, joint) = match links[link].joint {
            None => (None, Joint::try_new(DVec3::ZERO, glam::DQuat::IDENTITY, JointKind::Fixed)?),
            Some(joint) => (Some(joints[joint].parent), joints[joint].joint.clone()),
        };
        // The root carries its children, but its frame is the world: nothing to compute.
        let parent = parent.filter(|&parent| links[parent].joint.is_some()).map(|parent| places[parent]);
        places[link] = arm.add(links[link].name.as_str(), parent, joint)?;
    }
    Ok((arm, places))
}

impl Origin {
    /// The frame as a joint.
    pub(crate) fn joint(self, kind: JointKind) -> Result<Joint, RobotError> {
        Ok(Joint::try_with_rpy(self.xyz, self.rpy.to_array(), kind)?)
    }
}

fn read_joint(
    file: &str,
    urdf: &Urdf,
    joint: &UrdfJoint,
    [parent, child]: [usize; 2],
) -> Result<RobotJoint, RobotError> {
    let fault = |reason: String| RobotError::Xml { file: file.to_owned(), line: joint.line, reason };
    let zero = JointValue::try_constant(0.0)?;
    let (kind, motion) = match joint.kind {
        UrdfJointKind::Fixed => (JointType::Fixed, JointKind::Fixed),
        UrdfJointKind::Revolute => {
            (JointType::Revolute, JointKind::Revolute { axis: joint.axis, value: zero })
        }
        UrdfJointKind::Continuous => {
            (JointType::Continuous, JointKind::Revolute { axis: joint.axis, value: zero })
        }
        UrdfJointKind::Prismatic => {
            (JointType::Prismatic, JointKind::Prismatic { axis: joint.axis, value: zero })
        }
    };
    let has_position = matches!(kind, JointType::Revolute | JointType::Prismatic);
    let limits = match joint.limit {
        None => JointLimits::default(),
        Some(limit) => JointLimits {
            position: has_position.then_some([limit.lower, limit.upper]),
            // A speed of zero or less is no limit that anything could keep.
            velocity: limit.velocity.filter(|&velocity| velocity > 0.0),
        },
    };
    let mimic = match &joint.mimic {
        Some(mimic) if kind != JointType::Fixed => {
            let index = urdf.joints.iter().position(|other| other.name == mimic.joint).ok_or_else(|| {
                fault(format!("joint {:?} mimics {:?}, which is no joint", joint.name, mimic.joint))
            })?;
            Some(Mimic { joint: index, multiplier: mimic.multiplier, offset: mimic.offset })
        }
        _ => None,
    };
    let name = joint.name.clone();
    let joint = joint.origin.joint(motion).map_err(|error| fault(format!("joint {name:?}: {error}")))?;
    Ok(RobotJoint { name, kind, parent, child, limits, mimic, joint })
}

/// Every joint that mimics gets at one that does not.
fn check_mimics(file: &str, urdf: &Urdf, joints: &[RobotJoint]) -> Result<(), RobotError> {
    for (index, joint) in joints.iter().enumerate() {
        let mut at = index;
        for _ in 0..=joints.len() {
            let Some(Mimic { joint: next, .. }) = joints[at].mimic else { break };
            at = next;
        }
        if joints[at].mimic.is_some() {
            let reason = format!("joint {:?} mimics itself in the end", joint.name);
            return Err(RobotError::Xml { file: file.to_owned(), line: urdf.joints[index].line, reason });
        }
    }
    Ok(())
}

/// How the links hang together.
struct LinkTree {
    /// Of each joint: parent and child.
    ends: Vec<[usize; 2]>,
    /// Of each link.
    carried_by: Vec<Option<usize>>,
    order: Vec<usize>,
}

impl LinkTree {
    fn new(file: &str, urdf: &Urdf) -> Result<Self, RobotError> {
        let robot_fault = |reason: String| RobotError::Robot { file: file.to_owned(), reason };
        let fault = |line: u32, reason: String| RobotError::Xml { file: file.to_owned(), line, reason };
        if urdf.links.is_empty() {
            return Err(robot_fault("the robot has no link".to_owned()));
        }
        let mut by_name = HashMap::new();
        for (index, link) in urdf.links.iter().enumerate() {
            if by_name.insert(link.name.as_str(), index).is_some() {
                return Err(fault(link.line, format!("a second link has the name {:?}", link.name)));
            }
        }
        let mut joint_names = HashMap::new();
        let mut carried_by: Vec<Option<usize>> = vec![None; urdf.links.len()];
        let mut ends = Vec::with_capacity(urdf.joints.len());
        for (index, joint) in urdf.joints.iter().enumerate() {
            let name = &joint.name;
            if joint_names.insert(name.as_str(), index).is_some() {
                return Err(fault(joint.line, format!("a second joint has the name {name:?}")));
            }
            let end = |side: &str, link: &str| {
                let reason = || format!("joint {name:?}: the {side} {link:?} is no link");
                by_name.get(link).copied().ok_or_else(|| fault(joint.line, reason()))
            };
            let [parent, child] = [end("parent", &joint.parent)?, end("child", &joint.child)?];
            if let Some(other) = carried_by[child].replace(index) {
                let other = &urdf.joints[other].name;
                let reason = format!("joints {other:?} and {name:?} both carry the link {:?}", joint.child);
                return Err(fault(joint.line, reason));
            }
            ends.push([parent, child]);
        }
        let roots: Vec<usize> = (0..urdf.links.len()).filter(|&link| carried_by[link].is_none()).collect();
        match roots[..] {
            [_] => {}
            [] => {
                return Err(robot_fault("every link is carried by another one: there is no root".to_owned()));
            }
            [first, second, ..] => {
                let [first, second] = [first, second].map(|link| &urdf.links[link].name);
                let reason = format!(
                    "{} links are carried by no joint, {first:?} and {second:?} among them: one root is needed",
                    roots.len()
                );
                return Err(robot_fault(reason));
            }
        }
        let mut children = vec![Vec::new(); urdf.links.len()];
        for &[parent, child] in &ends {
            children[parent].push(child);
        }
        let mut order = roots;
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(&children[link]);
            next += 1;
        }
        if order.len() < urdf.links.len() {
            let lost = (0..urdf.links.len()).find(|link| !order.contains(link)).unwrap_or_default();
            let reason = format!("the link {:?} is carried by itself in the end", urdf.links[lost].name);
            return Err(fault(urdf.links[lost].line, reason));
        }
        Ok(Self { ends, carried_by, order })
    }
}
