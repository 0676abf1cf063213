//! An articulated arm: all of its links at once.
use crate::error::fault;
use crate::{Chain, Joint, JointValue, MotionError};
use std::sync::Arc;

/// A tree of links, each carried by a joint of an earlier link or of the world.
///
/// ```
/// use d2m_motion::{Arm, Joint, JointKind, JointPoints, JointValue, RigidMotion};
/// use glam::{DQuat, DVec3};
/// let path = JointPoints::new(vec![0.0, 1.0], vec![0.0, std::f64::consts::FRAC_PI_2]);
/// let shoulder = JointKind::Revolute { axis: DVec3::Z, value: JointValue::through(path)? };
/// let mut arm = Arm::default();
/// let upper = arm.add("upper", None, Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, shoulder)?)?;
/// let tool = arm.add("tool", Some(upper), Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Fixed)?)?;
/// let links = arm.links()?;
/// assert!((links[tool].pose_and_twist(1.0).0.translation - DVec3::Y).length() < 1e-15);
/// assert_eq!((links[upper].common_joints(&links[tool]), arm.name(tool)), (1, "tool"));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arm {
    links: Vec<ArmLink>,
}

#[derive(Debug, Clone, PartialEq)]
struct ArmLink {
    name: Arc<str>,
    parent: Option<usize>,
    joint: Joint,
}

impl Arm {
    /// Adds a link by the joint that carries it: after the link `parent`, or after the world. Answers with its index, from 0.
    ///
    /// # Errors
    /// A parent that is no link so far.
    pub fn add(
        &mut self,
        name: impl Into<Arc<str>>,
        parent: Option<usize>,
        joint: Joint,
    ) -> Result<usize, MotionError> {
        let (name, index) = (name.into(), self.links.len());
        if let Some(parent) = parent.filter(|&parent| parent >= index) {
            let reason = format!("its parent {parent} is none of the {index} links before it");
            return Err(fault(format!("link {index} ({name:?})"), reason));
        }
        self.links.push(ArmLink { name, parent, joint });
        Ok(index)
    }

    /// The name of a link.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn name(&self, link: usize) -> &str {
        &self.links[link].name
    }

    /// The link that carries a link; none: the world.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn parent(&self, link: usize) -> Option<usize> {
        self.links[link].parent
    }

    /// The joints that carry the links, in their order.
    pub fn joints(&self) -> impl Iterator<Item = &Joint> {
        self.links.iter().map(|link| &link.joint)
    }

    /// Gives the joint that carries a link another value; a fixed one stays as it is.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn set_value(&mut self, link: usize, value: JointValue) {
        let joint = &mut self.links[link].joint;
        *joint = joint.with_value(value);
    }

    /// The last link that carries both, or is one of them; none: the world.
    ///
    /// # Panics
    /// An index that is no link.
    pub fn last_common(&self, a: usize, b: usize) -> Option<usize> {
        // A link has a greater index than the one that carries it.
        let (mut a, mut b) = (Some(a), Some(b));
        while a != b {
            if a > b {
                a = self.parent(a?);
            } else {
                b = self.parent(b?);
            }
        }
        a
    }

    /// How many links there are.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// The motion of one link.
    ///
    /// # Errors
    /// As [`Arm::links`].
    ///
    /// # Panics
    /// An index that is no link.
    pub fn link(&self, link: usize) -> Result<Chain, MotionError> {
        let way = core::iter::successors(Some(link), |&link| self.links[link].parent);
        let mut joints: Vec<Joint> = way.map(|link| self.links[link].joint.clone()).collect();
        joints.reverse();
        Chain::try_new(joints).map_err(|error| error.within(&format!("link {:?}", self.name(link))))
    }

    /// The motion of every link, in their order. Links share their joints, so pairs of them are seen from the last common one.
    ///
    /// # Errors
    /// Joints on the way to a link whose values have no time in common, with the link's name.
    pub fn links(&self) -> Result<Vec<Chain>, MotionError> {
        let mut chains: Vec<Chain> = Vec::with_capacity(self.links.len());
        for ArmLink { name, parent, joint } in &self.links {
            let chain = match parent {
                Some(parent) => chains[*parent].and(joint.clone()),
                None => Chain::try_new(vec![joint.clone()]),
            };
            chains.push(chain.map_err(|error| error.within(&format!("link {name:?}")))?);
        }
        Ok(chains)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{JointKind, JointPoints, JointValue, RigidMotion};
    use glam::{DQuat, DVec3};

    fn joint(times: [f64; 2]) -> Joint {
        let value = JointValue::through(JointPoints::new(times.to_vec(), vec![0.0, 1.0])).unwrap();
        Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Revolute { axis: DVec3::Z, value }).unwrap()
    }

    #[test]
    fn links_are_the_chains_of_their_joints() {
        let mut arm = Arm::default();
        let joints: Vec<Joint> = (0..5).map(|k| joint([-f64::from(k), 2.0])).collect();
        let parents = [None, Some(0), Some(1), Some(0), None];
        for (k, (joint, parent)) in joints.iter().zip(parents).enumerate() {
            assert_eq!(arm.add(format!("link {k}"), parent, joint.clone()).unwrap(), k);
        }
        let links = arm.links().unwrap();
        for (link, way) in links.iter().zip([&[0][..], &[0, 1], &[0, 1, 2], &[0, 3], &[4]]) {
            let alone = Chain::try_new(way.iter().map(|&k| joints[k].clone()).collect()).unwrap();
            assert_eq!((link, link.domain()), (&alone, alone.domain()));
            assert_eq!(
                arm.link(way.len() - 1 + usize::from(way == [0, 3]) * 2 + usize::from(way == [4]) * 4)
                    .unwrap(),
                alone
            );
        }
        assert_eq!((links[2].common_joints(&links[3]), links[2].common_joints(&links[4])), (1, 0));
    }

    #[test]
    fn faults_name_the_link() {
        let mut arm = Arm::default();
        let message = arm.add("hand", Some(0), joint([0.0, 1.0])).unwrap_err().to_string();
        assert!(message.contains("link 0 (\"hand\"): its parent 0"), "{message}");
        arm.add("arm", None, joint([0.0, 1.0])).unwrap();
        arm.add("hand", Some(0), joint([2.0, 3.0])).unwrap();
        let message = arm.links().unwrap_err().to_string();
        assert!(message.contains("link \"hand\", chain[1], value: its times from 2.0 to 3.0"), "{message}");
    }
}
