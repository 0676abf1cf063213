use d2m_bvh::{MeshTree, Moving};
use d2m_motion::RigidMotion;
use std::sync::Arc;

/// A mesh and how it moves: what a [`World`](crate::World) holds. Cheap to clone; bodies may share one tree.
///
/// ```
/// use d2m::{Body, ConstantTwist, MeshTree, RigidMotion};
/// use std::sync::Arc;
/// let tree = Arc::new(MeshTree::new(d2m::shapes::mesh("box")?));
/// let body = Body::new(tree, ConstantTwist::REST);
/// assert_eq!(body.tree().mesh().triangle_count(), 12);
/// assert!(body.motion().constant_twist().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Body {
    tree: Arc<MeshTree>,
    motion: Arc<dyn RigidMotion + Send>,
}

impl Body {
    /// A body with this mesh and motion.
    pub fn new(tree: Arc<MeshTree>, motion: impl RigidMotion + Send + 'static) -> Self {
        Self { tree, motion: Arc::new(motion) }
    }

    /// The same body with another motion.
    pub fn with_motion(&self, motion: impl RigidMotion + Send + 'static) -> Self {
        Self { tree: Arc::clone(&self.tree), motion: Arc::new(motion) }
    }

    /// The mesh with its tree, in the body frame.
    pub fn tree(&self) -> &MeshTree {
        &self.tree
    }

    /// How the body frame moves through the world.
    pub fn motion(&self) -> &dyn RigidMotion {
        &*self.motion
    }

    /// The form that the pair queries take.
    pub fn moving(&self) -> Moving<'_> {
        Moving::new(&self.tree, &*self.motion)
    }
}

impl core::fmt::Debug for Body {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Body")
            .field("triangles", &self.tree.mesh().triangle_count())
            .field("motion", &self.motion.constant_twist())
            .finish_non_exhaustive()
    }
}
