//! The joints of a robot, each of one number.

use crate::RobotError;
use crate::inertial::JointDynamics;
use crate::urdf::{Origin, Urdf, UrdfJoint, UrdfJointKind};
use d2m_motion::{Joint, JointKind, JointValue};
use glam::DVec3;
use std::collections::{HashMap, HashSet};

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
///
/// ```
/// # let urdf = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"/>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><limit lower="-1" upper="0.5" velocity="2"/></joint>
/// # </robot>"#;
/// use d2m_robot::{Robot, RobotOptions};
/// let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
/// let limits = robot.limits(robot.find_joint("run").expect("the file has it"));
/// assert_eq!((limits.position, limits.velocity), (Some([-1.0, 0.5]), Some(2.0)));
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct JointLimits {
    /// Least and greatest position (radians, or units of length).
    pub position: Option<[f64; 2]>,
    /// Greatest speed.
    pub velocity: Option<f64>,
}

/// The joint that another one follows: `multiplier`·q + `offset`.
///
/// ```
/// # let urdf = r#"<robot name="gripper">
/// #   <link name="palm"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="left"/><link name="right"/>
/// #   <joint name="left" type="prismatic"><parent link="palm"/><child link="left"/><limit lower="0" upper="0.04" velocity="1"/></joint>
/// #   <joint name="right" type="prismatic"><parent link="palm"/><child link="right"/><limit lower="-0.04" upper="0" velocity="1"/>
/// #     <mimic joint="left" multiplier="-1"/></joint>
/// # </robot>"#;
/// use d2m_robot::{Robot, RobotOptions};
/// let robot = Robot::parse("gripper.urdf", urdf, &RobotOptions::new())?;
/// let joint = |name| robot.find_joint(name).expect("the file has it");
/// let follows = robot.mimic(joint("right")).expect("the right finger follows the left one");
/// assert_eq!((follows.joint, follows.multiplier, follows.offset), (joint("left"), -1.0, 0.0));
/// assert_eq!(robot.joint_names(), ["left"]); // a path gives the left finger only
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
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

#[derive(Debug, Clone)]
pub(crate) struct RobotJoint {
    pub(crate) name: String,
    pub(crate) kind: JointType,
    pub(crate) parent: usize,
    pub(crate) child: usize,
    pub(crate) limits: JointLimits,
    pub(crate) mimic: Option<Mimic>,
    pub(crate) dynamics: JointDynamics,
    /// With a value of zero if it moves.
    pub(crate) joint: Joint,
}

impl Origin {
    /// The frame as a joint.
    pub(crate) fn joint(self, kind: JointKind) -> Result<Joint, RobotError> {
        Ok(Joint::try_with_rpy(self.xyz, self.rpy.to_array(), kind)?)
    }
}

/// The joints of a file, those of more than one number divided.
pub(crate) struct JointReader<'a> {
    file: &'a str,
    pub(crate) joints: Vec<RobotJoint>,
    names: HashSet<String>,
    /// What has to be said of joints that do not move as the file states.
    pub(crate) remarks: Vec<String>,
}

/// One number of a joint.
struct Part {
    /// After the name of the joint and a slash, if it has more than one.
    suffix: Option<&'static str>,
    kind: JointType,
    motion: JointKind,
}

impl<'a> JointReader<'a> {
    /// All joints, with the links that they join in `ends`.
    pub(crate) fn read(file: &'a str, urdf: &Urdf, ends: &[[usize; 2]]) -> Result<Self, RobotError> {
        let joints = Vec::with_capacity(urdf.joints.len());
        let mut reader = Self { file, joints, names: HashSet::new(), remarks: Vec::new() };
        for (joint, &ends) in urdf.joints.iter().zip(ends) {
            reader.add(joint, ends)?;
        }
        reader.follow(urdf)?;
        Ok(reader)
    }

    fn fault(&self, joint: &UrdfJoint, reason: impl core::fmt::Display) -> RobotError {
        let reason = format!("joint {:?}: {reason}", joint.name);
        RobotError::Xml { file: self.file.to_owned(), line: joint.line, reason }
    }

    fn remark(&mut self, joint: &UrdfJoint, remark: &str) {
        self.remarks.push(format!("{}, line {}: joint {:?} {remark}", self.file, joint.line, joint.name));
    }

    fn add(&mut self, joint: &UrdfJoint, [parent, child]: [usize; 2]) -> Result<(), RobotError> {
        let parts = self.parts(joint)?;
        if joint.mimic.is_some() && matches!(joint.kind, UrdfJointKind::Planar | UrdfJointKind::Floating) {
            return Err(self.fault(joint, "a joint of more than one number mimics no other"));
        }
        let mut origin = joint.origin;
        for Part { suffix, kind, motion } in parts {
            let name = suffix.map_or(joint.name.clone(), |suffix| format!("{}/{suffix}", joint.name));
            if !self.names.insert(name.clone()) {
                return Err(self.fault(joint, format!("another joint has the name {name:?}")));
            }
            // The first part carries the others.
            let motion =
                core::mem::take(&mut origin).joint(motion).map_err(|error| self.fault(joint, error))?;
            // A file states limits of joints of one number only.
            let limits = if suffix.is_none() { limits_of(joint, kind) } else { JointLimits::default() };
            let dynamics = joint.dynamics;
            self.joints.push(RobotJoint {
                name,
                kind,
                parent,
                child,
                limits,
                mimic: None,
                dynamics,
                joint: motion,
            });
        }
        Ok(())
    }

    fn parts(&mut self, joint: &UrdfJoint) -> Result<Vec<Part>, RobotError> {
        let zero = JointValue::try_constant(0.0)?;
        let shift = |axis| JointKind::Prismatic { axis, value: zero.clone() };
        let turn = |axis| JointKind::Revolute { axis, value: zero.clone() };
        let one = |kind, motion| vec![Part { suffix: None, kind, motion }];
        let shifts = |names: &[(&'static str, DVec3)]| {
            let part = |&(suffix, axis): &(&'static str, DVec3)| Part {
                suffix: Some(suffix),
                kind: JointType::Prismatic,
                motion: shift(axis),
            };
            names.iter().map(part).collect::<Vec<_>>()
        };
        Ok(match joint.kind {
            UrdfJointKind::Fixed => one(JointType::Fixed, JointKind::Fixed),
            UrdfJointKind::Revolute => one(JointType::Revolute, turn(joint.axis)),
            UrdfJointKind::Continuous => one(JointType::Continuous, turn(joint.axis)),
            UrdfJointKind::Prismatic => one(JointType::Prismatic, shift(joint.axis)),
            UrdfJointKind::Planar if joint.has_axis && is_along_z(joint.axis) => {
                let mut parts = shifts(&[("x", DVec3::X), ("y", DVec3::Y)]);
                parts.push(Part {
                    suffix: Some("theta"),
                    kind: JointType::Continuous,
                    motion: turn(DVec3::Z),
                });
                parts
            }
            UrdfJointKind::Planar => {
                self.remark(
                    joint,
                    "is planar and stays at zero: it moves (as x, y and theta) where its <axis> is \"0 0 1\", for \
                     which its <origin> can be turned",
                );
                one(JointType::Fixed, JointKind::Fixed)
            }
            UrdfJointKind::Floating => {
                self.remark(
                    joint,
                    "is floating: it shifts by trans_x, trans_y and trans_z, and does not turn",
                );
                shifts(&[("trans_x", DVec3::X), ("trans_y", DVec3::Y), ("trans_z", DVec3::Z)])
            }
        })
    }

    /// Who follows whom.
    fn follow(&mut self, urdf: &Urdf) -> Result<(), RobotError> {
        let by_name: HashMap<String, usize> =
            self.joints.iter().enumerate().map(|(index, joint)| (joint.name.clone(), index)).collect();
        for of in &urdf.joints {
            // A fixed joint has no value, whatever it mimics.
            let Some(mimic) = of.mimic.as_ref().filter(|_| of.kind != UrdfJointKind::Fixed) else { continue };
            let Some(&leader) = by_name.get(&mimic.joint) else {
                let reason =
                    format!("joint {:?} mimics {:?}, which is no joint of one number", of.name, mimic.joint);
                return Err(RobotError::Xml { file: self.file.to_owned(), line: of.line, reason });
            };
            self.joints[by_name[&of.name]].mimic =
                Some(Mimic { joint: leader, multiplier: mimic.multiplier, offset: mimic.offset });
        }
        // Whose chain of leaders is known to end.
        let mut ends = vec![false; self.joints.len()];
        for of in &urdf.joints {
            let Some(&index) = by_name.get(&of.name) else { continue };
            let (mut at, mut way) = (index, HashSet::new());
            while let Some(Mimic { joint: next, .. }) = self.joints[at].mimic.filter(|_| !ends[at]) {
                if !way.insert(at) {
                    let reason = format!("joint {:?} mimics itself in the end", of.name);
                    return Err(RobotError::Xml { file: self.file.to_owned(), line: of.line, reason });
                }
                at = next;
            }
            for joint in way {
                ends[joint] = true;
            }
        }
        Ok(())
    }
}

/// The limits of a joint of one number.
fn limits_of(joint: &UrdfJoint, kind: JointType) -> JointLimits {
    let Some(limit) = joint.limit else { return JointLimits::default() };
    let has_position = matches!(kind, JointType::Revolute | JointType::Prismatic);
    JointLimits {
        position: has_position.then_some([limit.lower, limit.upper]),
        // A speed of zero or less is no limit that anything could keep.
        velocity: limit.velocity.filter(|&velocity| velocity > 0.0),
    }
}

/// Is it z times some number above zero?
fn is_along_z(axis: DVec3) -> bool {
    axis.x == 0.0 && axis.y == 0.0 && axis.z > 0.0
}
