//! The bodies of a scene as a path moves them.

use crate::scene::RobotScene;
use crate::{RobotError, Trajectory};
use d2m_bvh::{Moving, QueryOptions, Window};
use d2m_world::SharedMotion;

/// All bodies of a scene along one path, and the pairs of them that are checked: for queries of single pairs.
///
/// ```
/// # let urdf = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
/// # </robot>"#;
/// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// # let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
/// # let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// # let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// # let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(2.0, 1.0)]);
/// let bodies = scene.bodies_along(&path)?;
/// // Each pair that is checked is a query of two moving bodies, as any other.
/// for &[a, b] in bodies.pairs() {
///     let (a_name, b_name) = (bodies.name(a), bodies.name(b));
///     let options = bodies.pair_options([a, b]);
///     let answer = d2m_bvh::time_of_contact(bodies.moving(a), bodies.moving(b), bodies.window(), &options)?;
///     assert_eq!(answer.contact().is_some(), [a_name, b_name].contains(&"cart") && [a_name, b_name].contains(&"stop"));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PathBodies<'a> {
    scene: &'a RobotScene,
    /// By the places of the scene's parts.
    motions: Vec<SharedMotion>,
    window: Window,
}

impl RobotScene {
    /// The bodies of the scene as a path moves them.
    ///
    /// ```
    /// # let urdf = r#"<robot name="slide">
    /// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    /// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
    /// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/><limit lower="-1" upper="0.6" velocity="2"/></joint>
    /// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
    /// # </robot>"#;
    /// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
    /// # let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
    /// # let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
    /// # let to = |x: f64| {
    /// #     let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
    /// #     Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, x)])
    /// # };
    /// let bodies = scene.bodies_along(&to(0.3))?;
    /// assert_eq!((bodies.len(), bodies.window().end()), (3, 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`RobotScene::check_path`].
    pub fn bodies_along(&self, path: &Trajectory) -> Result<PathBodies<'_>, RobotError> {
        let values = self.robot.all_values(&path.joint_names, path.joint_values()?)?;
        let window = Self::window_of(path.times().unwrap_or_default())?;
        let mut motions: Vec<SharedMotion> =
            self.parts.iter().map(|part| self.world.body(part.id).shared_motion()).collect();
        for planned in self.plan(&self.robot.arm(&values), |_| true)? {
            motions[planned.body.index()] = planned.motion;
        }
        Ok(PathBodies { scene: self, motions, window })
    }
}

impl PathBodies<'_> {
    /// How many there are: collision bodies of links, attached bodies and obstacles.
    pub fn len(&self) -> usize {
        self.motions.len()
    }

    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.motions.is_empty()
    }

    /// A body in the form that pair queries take.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn moving(&self, body: usize) -> Moving<'_> {
        let part = &self.scene.parts[body];
        let of = self.scene.world.body(part.id);
        Moving { solid: of.solid(), ..Moving::new(of.tree(), &*self.motions[body]) }.with_radius(part.radius)
    }

    /// The name of the body, or that of the link that it belongs to.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn name(&self, body: usize) -> &str {
        &self.scene.parts[body].name
    }

    /// The pairs that are checked.
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.scene.pairs
    }

    /// From the first to the last time of the path.
    pub const fn window(&self) -> Window {
        self.window
    }

    /// The options of all pairs that have none of their own.
    pub const fn options(&self) -> &QueryOptions {
        self.scene.options()
    }

    /// The options of a pair, with its own minimum separation and start if it has them.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn pair_options(&self, pair: [usize; 2]) -> QueryOptions {
        self.scene.pair_options(pair)
    }
}
