//! From the joints that a path names to the values of all joints.

use crate::RobotError;
use crate::{JointType, Mimic, Robot, Trajectory};
use d2m_motion::JointValue;

/// Characters of a list of names in a message at most.
const LONGEST_LIST: usize = 500;

impl Robot {
    /// The value of every joint along a path, by their indices: those that it names, those that follow them, and the others at rest.
    ///
    /// ```
    /// # let urdf = r#"<robot name="gripper">
    /// #   <link name="palm"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="left"/><link name="right"/>
    /// #   <joint name="left" type="prismatic"><parent link="palm"/><child link="left"/><limit lower="0" upper="0.04" velocity="1"/></joint>
    /// #   <joint name="right" type="prismatic"><parent link="palm"/><child link="right"/><limit lower="-0.04" upper="0" velocity="1"/>
    /// #     <mimic joint="left" multiplier="-1"/></joint>
    /// # </robot>"#;
    /// use d2m_robot::{Robot, RobotOptions, Trajectory, TrajectoryPoint};
    /// let robot = Robot::parse("gripper.urdf", urdf, &RobotOptions::new())?;
    /// let points = vec![TrajectoryPoint::new(0.0, vec![0.0]), TrajectoryPoint::new(1.0, vec![0.5])];
    /// let values = robot.joint_values(&Trajectory::new(vec!["left".into()], points))?;
    /// assert_eq!((robot.joint_name(1), values[1].value(0.5)), ("right", -0.25));
    /// # Ok::<(), d2m_robot::RobotError>(())
    /// ```
    ///
    /// # Errors
    /// A path that makes no sense ([`Trajectory::joint_values`]), and joints that the robot does not have.
    pub fn joint_values(&self, path: &Trajectory) -> Result<Vec<JointValue>, RobotError> {
        self.all_values(&path.joint_names, path.joint_values()?)
    }

    /// The value of every joint, by their indices: those that are named, those that follow them, and the others at rest.
    ///
    /// # Errors
    /// A name that is no joint of this robot, or that of a fixed one.
    pub(crate) fn all_values(
        &self,
        names: &[String],
        values: Vec<JointValue>,
    ) -> Result<Vec<JointValue>, RobotError> {
        let mut all: Vec<Option<JointValue>> = vec![None; self.joints.len()];
        for (place, (name, value)) in names.iter().zip(values).enumerate() {
            all[self.moving_joint(place, name)?] = Some(value);
        }
        self.complete(all)
    }

    /// The index of a joint that a path may name.
    pub(crate) fn moving_joint(&self, place: usize, name: &str) -> Result<usize, RobotError> {
        let place = || format!("joint_names[{place}]");
        let Some(joint) = self.find_joint(name) else {
            let mut known = self.joint_names().join(", ");
            if let Some((end, _)) = known.char_indices().nth(LONGEST_LIST) {
                known.truncate(end);
                known.push('…');
            }
            return Err(RobotError::path(place(), format!("{name:?} is no joint of the robot ({known})")));
        };
        if self.joints[joint].kind == JointType::Fixed {
            let reason = format!("the joint {name:?} is fixed (or planar without the <axis> \"0 0 1\")");
            return Err(RobotError::path(place(), reason));
        }
        Ok(joint)
    }

    /// Fills in the joints that follow others and those at rest.
    pub(crate) fn complete(&self, mut all: Vec<Option<JointValue>>) -> Result<Vec<JointValue>, RobotError> {
        for joint in 0..self.joints.len() {
            self.fill(joint, &mut all)?;
        }
        let rest = |(joint, value): (usize, Option<JointValue>)| match value {
            Some(value) => Ok(value),
            None => Ok(JointValue::try_constant(self.rest_position(joint))?),
        };
        all.into_iter().enumerate().map(rest).collect()
    }

    fn fill(&self, joint: usize, all: &mut [Option<JointValue>]) -> Result<(), RobotError> {
        // From the joint back to the first one on the way that is known, and forward again.
        let mut way = vec![];
        let mut at = joint;
        while all[at].is_none() {
            way.push(at);
            match self.joints[at].mimic {
                Some(Mimic { joint, .. }) => at = joint,
                None => break,
            }
        }
        for &joint in way.iter().rev() {
            let value = match self.joints[joint].mimic {
                None => JointValue::try_constant(self.rest_position(joint))?,
                Some(Mimic { joint: leader, multiplier, offset }) => {
                    let leader = all[leader].as_ref().ok_or_else(|| {
                        RobotError::path(format!("joint {:?}", self.joints[joint].name), "it mimics itself")
                    })?;
                    leader.scaled(multiplier, offset).map_err(|error| {
                        RobotError::path(format!("joint {:?}", self.joints[joint].name), error.to_string())
                    })?
                }
            };
            all[joint] = Some(value);
        }
        Ok(())
    }
}
