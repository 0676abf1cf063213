use crate::MeshTree;
use d2m_motion::Pose;

/// A body at rest in a pose.
///
/// The pose is taken at its word: the body point p is at R·(p − at) + x in real arithmetic, where R is the rotation of
/// the quaternion divided by its length, so a quaternion that is unit only up to rounding costs nothing.
#[derive(Clone, Copy, Debug)]
pub struct Posed<'a> {
    /// The body in its own frame.
    pub body: &'a MeshTree,
    /// Where the body frame is in the world.
    pub pose: Pose,
}

impl<'a> Posed<'a> {
    /// A body in this pose.
    pub const fn new(body: &'a MeshTree, pose: Pose) -> Self {
        Self { body, pose }
    }

    /// A body whose frame is the world frame.
    pub const fn at_rest(body: &'a MeshTree) -> Self {
        Self { body, pose: Pose::IDENTITY }
    }
}
