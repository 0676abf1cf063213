use d2m_bvh::{MeshTree, Moving, Solid};
use d2m_motion::RigidMotion;
use std::sync::Arc;

/// A motion that a [`Body`] holds, shared.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_world::SharedMotion;
/// use std::sync::Arc;
/// let motion: SharedMotion = Arc::new(ConstantTwist::REST);
/// assert!(motion.constant_twist().is_some());
/// ```
pub type SharedMotion = Arc<dyn RigidMotion + Send + Sync>;

/// A mesh and how it moves: what a [`World`](crate::World) holds. Cheap to clone; bodies may share one tree.
///
/// ```
/// use d2m_bvh::{MeshTree, Solid};
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use d2m_world::{Body, Group};
/// use std::sync::Arc;
/// let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box")?));
/// let body = Body::new(tree, ConstantTwist::REST).with_solid(Solid::Surface).with_group(Group(1));
/// assert_eq!(body.tree().mesh().triangle_count(), 12);
/// assert!(body.motion().constant_twist().is_some());
/// assert_eq!((body.solid(), body.group()), (Some(Solid::Surface), Some(Group(1))));
/// assert_eq!(body.with_radius(0.25).radius(), 0.25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Body {
    tree: Arc<MeshTree>,
    motion: SharedMotion,
    solid: Option<Solid>,
    group: Option<Group>,
    radius: f64,
}

/// Names a group of bodies, for [`World::ignore_groups`](crate::World::ignore_groups): a number that the user chooses.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{QueryOptions, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, Group, World};
/// const STONES: Group = Group(1);
/// let mut world = World::new(QueryOptions::default());
/// for _ in 0..2 {
///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST).with_group(STONES));
/// }
/// assert_eq!(world.contacts(Window::UNIT)?.len(), 1); // on top of each other
/// world.ignore_groups(STONES, STONES, true);
/// assert_eq!(world.contacts(Window::UNIT)?.len(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Group(pub u32);

impl Body {
    /// A body with this mesh and motion.
    pub fn new(tree: Arc<MeshTree>, motion: impl RigidMotion + Send + 'static) -> Self {
        Self::with_shared(tree, Arc::new(motion))
    }

    /// A body with this mesh and a motion that others may hold too.
    pub fn with_shared(tree: Arc<MeshTree>, motion: SharedMotion) -> Self {
        Self { tree, motion, solid: None, group: None, radius: 0.0 }
    }

    /// The same body with another motion.
    pub fn with_motion(&self, motion: impl RigidMotion + Send + 'static) -> Self {
        Self { motion: Arc::new(motion), ..self.clone() }
    }

    /// The same body with this meaning of its mesh, instead of that of the world's options.
    ///
    /// What is inside a solid body from the start is in contact with it, be it solid or an open sheet; nothing is inside of a
    /// surface.
    #[must_use]
    pub fn with_solid(mut self, solid: Solid) -> Self {
        self.solid = Some(solid);
        self
    }

    /// The same body in this group, instead of in none.
    #[must_use]
    pub const fn with_group(mut self, group: Group) -> Self {
        self.group = Some(group);
        self
    }

    /// The same body with a radius: it is everything within this distance of its mesh, so that a point is a sphere, a segment a capsule
    /// and a box a rounded box ([`Moving::with_radius`]). What is negative or not finite is refused by the next query of one of its pairs.
    #[must_use]
    pub const fn with_radius(mut self, radius: f64) -> Self {
        self.radius = radius;
        self
    }

    /// The mesh with its tree, in the body frame.
    pub fn tree(&self) -> &MeshTree {
        &self.tree
    }

    /// How the body frame moves through the world.
    pub fn motion(&self) -> &dyn RigidMotion {
        &*self.motion
    }

    /// The motion, to be shared with another body or plan.
    pub fn shared_motion(&self) -> SharedMotion {
        Arc::clone(&self.motion)
    }

    /// What the mesh means; none: what the world's options say.
    pub const fn solid(&self) -> Option<Solid> {
        self.solid
    }

    /// The group that the body is in.
    pub const fn group(&self) -> Option<Group> {
        self.group
    }

    /// The distance from its mesh within which everything belongs to the body.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// The form that the pair queries take.
    pub fn moving(&self) -> Moving<'_> {
        Moving { solid: self.solid, radius: self.radius, ..Moving::new(&self.tree, &*self.motion) }
    }

    pub(crate) fn set_motion(&mut self, motion: SharedMotion) {
        self.motion = motion;
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
