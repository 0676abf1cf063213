use crate::MeshTree;
use d2m_motion::Pose;

/// A body at rest in a pose.
///
/// The pose is taken at its word: the body point p is at R·(p − at) + x in real arithmetic, where R is the rotation of
/// the quaternion divided by its length, so a quaternion that is unit only up to rounding costs nothing.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, Solid, distance};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 3.0, ..Pose::IDENTITY });
/// let apart = distance(Posed::at_rest(&tree), above, Solid::Filled)?;
/// assert!(apart.lower <= 2.0 && 2.0 <= apart.upper); // from the tip at height 1
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
