//! The bodies of a scene as a path moves them.

use crate::scene::RobotScene;
use crate::{RobotError, Trajectory};
use d2m_bvh::{Moving, QueryOptions, Window};
use d2m_world::SharedMotion;

/// All bodies of a scene along one path, and the pairs of them that are checked: for queries of single pairs.
pub struct PathBodies<'a> {
    scene: &'a RobotScene,
    /// By the places of the scene's parts.
    motions: Vec<SharedMotion>,
    window: Window,
}

impl RobotScene {
    /// The bodies of the scene as a path moves them.
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
