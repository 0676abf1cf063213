use crate::MeshTree;
use d2m_motion::RigidMotion;

/// A body with its motion.
pub struct Moving<'a, B = MeshTree> {
    /// The body in its own frame.
    pub body: &'a B,
    /// How the body frame moves through the world.
    pub motion: &'a dyn RigidMotion,
}

impl<'a, B> Moving<'a, B> {
    /// A body that moves so.
    pub const fn new(body: &'a B, motion: &'a dyn RigidMotion) -> Self {
        Self { body, motion }
    }
}

impl<B> Clone for Moving<'_, B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<B> Copy for Moving<'_, B> {}

impl<B> core::fmt::Debug for Moving<'_, B> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Moving").field("motion", &self.motion.constant_twist()).finish_non_exhaustive()
    }
}
