//! What is added to a robot's scene: bodies of its own, and bodies that its links carry.

use crate::RobotError;
use d2m_bvh::{MeshTree, Solid};
use d2m_motion::{ConstantTwist, Joint, JointKind, RigidMotion};
use d2m_world::SharedMotion;
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// A body that is no part of the robot: at rest, or with a motion of its own.
///
/// ```
/// # let urdf = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// # </robot>"#;
/// use d2m_bvh::{MeshTree, TriMesh};
/// use d2m_robot::{Obstacle, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// use glam::{DQuat, DVec3};
/// use std::sync::Arc;
/// let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
/// let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// // A point with a radius is a ball, exactly.
/// let ball = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO)?));
/// let place = DVec3::new(0.5, 0.0, 0.2);
/// scene.add_obstacle(Obstacle::at_rest("ball", ball, place, DQuat::IDENTITY)?.with_radius(0.05))?;
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 1.0)]);
/// let until = scene.check_path(&path)?.free_until();
/// assert!(until <= 0.4 && until > 0.4 - 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Obstacle {
    pub(crate) name: String,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) motion: SharedMotion,
    pub(crate) solid: Option<Solid>,
    pub(crate) radius: f64,
    pub(crate) is_at_rest: bool,
}

impl Obstacle {
    /// A mesh at rest: a vertex p is at R(orientation)·p + position, the quaternion divided by its norm.
    ///
    /// # Errors
    /// A number that is not finite, or a quaternion that cannot be normalised.
    pub fn at_rest(
        name: impl Into<String>,
        tree: Arc<MeshTree>,
        position: DVec3,
        orientation: DQuat,
    ) -> Result<Self, RobotError> {
        let pose = ConstantTwist::try_new(position, orientation, DVec3::ZERO, DVec3::ZERO)?;
        Ok(Self { is_at_rest: true, ..Self::moving(name, tree, pose) })
    }

    /// A mesh that moves, in the time of the path.
    pub fn moving(
        name: impl Into<String>,
        tree: Arc<MeshTree>,
        motion: impl RigidMotion + Send + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            tree,
            motion: Arc::new(motion),
            solid: None,
            radius: 0.0,
            is_at_rest: false,
        }
    }

    /// With this meaning of its mesh, whether it is watertight or not.
    #[must_use]
    pub fn with_solid(self, solid: Solid) -> Self {
        Self { solid: Some(solid), ..self }
    }

    /// With everything within this distance of its mesh: a point becomes a sphere, a segment a capsule. Finite and not negative.
    #[must_use]
    pub fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }
}

/// A body that a link carries: grasped, or a tool.
///
/// ```
/// # let urdf = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
/// # </robot>"#;
/// use d2m_bvh::{MeshTree, TriMesh};
/// use d2m_robot::{Attached, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// use glam::{DQuat, DVec3};
/// use std::sync::Arc;
/// let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
/// let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// // The cart carries a needle of 0.2 along its way, so that it has to stop earlier than without it.
/// let needle = Arc::new(MeshTree::new(TriMesh::segment(DVec3::ZERO, DVec3::X * 0.2)?));
/// scene.attach(Attached::new("needle", "cart", needle, DVec3::ZERO, DQuat::IDENTITY)?)?;
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 1.0)]);
/// let answer = scene.check_path(&path)?;
/// assert!(answer.free_until() <= 0.25 && answer.free_until() > 0.25 - 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Attached {
    pub(crate) name: String,
    pub(crate) link: String,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) frame: Joint,
    pub(crate) solid: Option<Solid>,
    pub(crate) radius: f64,
}

impl Attached {
    /// A mesh in the frame of a link: a vertex p is at R(orientation)·p + position there.
    ///
    /// # Errors
    /// A number that is not finite, or a quaternion that cannot be normalised.
    pub fn new(
        name: impl Into<String>,
        link: impl Into<String>,
        tree: Arc<MeshTree>,
        position: DVec3,
        orientation: DQuat,
    ) -> Result<Self, RobotError> {
        let frame = Joint::try_new(position, orientation, JointKind::Fixed)?;
        Ok(Self { name: name.into(), link: link.into(), tree, frame, solid: None, radius: 0.0 })
    }

    /// With this meaning of its mesh, whether it is watertight or not.
    #[must_use]
    pub fn with_solid(self, solid: Solid) -> Self {
        Self { solid: Some(solid), ..self }
    }

    /// With everything within this distance of its mesh: a point becomes a sphere, a segment a capsule. Finite and not negative.
    #[must_use]
    pub fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }
}
