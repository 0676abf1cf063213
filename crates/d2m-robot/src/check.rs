//! Checks of paths, and of a planner's edges.

use crate::answer::{PathAnswer, PathContact};
use crate::broad_phase::BroadPhase;
use crate::limits::LimitWarning;
use crate::part::Owner;
use crate::scene::RobotScene;
use crate::{RobotError, Trajectory};
use d2m_bvh::Window;
use d2m_mesh::parallel::map_in_order;
use d2m_motion::{Arm, JointPoints, JointValue};
use d2m_world::{BodyId, FirstContact, PlannedMotion, Threads, WorldError};
use std::sync::Arc;

impl RobotScene {
    /// Is a path free of contact, until when, and which pair meets first?
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
    /// // The stop begins at 0.45, and half of the cart is 0.05 long.
    /// let answer = scene.check_path(&to(0.5))?;
    /// assert!(answer.free_until() <= 0.8 && answer.free_until() > 0.8 - 1e-8);
    /// assert!(scene.check_path(&to(0.39))?.is_free());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A path that makes no sense ([`Trajectory::joint_values`]), joints that the robot does not have, and obstacles whose motions
    /// do not cover the path.
    pub fn check_path(&self, path: &Trajectory) -> Result<PathAnswer, RobotError> {
        let values = self.robot.joint_values(path)?;
        let [start, end] = path.times().unwrap_or_default();
        self.check_values(&values, [start, end], Threads::All)
    }

    /// Where a path leaves the limits of its joints, which are not enforced.
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
    /// assert!(scene.limit_warnings(&to(0.5))?.is_empty());
    /// let beyond = scene.limit_warnings(&to(1.0))?; // 0.6 is allowed
    /// assert!(beyond[0].joint == "run" && (beyond[0].time - 0.6).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`RobotScene::check_path`].
    pub fn limit_warnings(&self, path: &Trajectory) -> Result<Vec<LimitWarning>, RobotError> {
        let values = self.robot.joint_values(path)?;
        let points: Vec<f64> = path.points.iter().map(|point| point.time_from_start).collect();
        Ok(self.robot.limit_warnings(&values, &points))
    }

    /// For a planner: checks of straight edges between configurations of these joints. All that edges share is kept.
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
    /// let edges = scene.edges(&["run"])?;
    /// assert!(edges.check(&[-0.5], &[0.3])?.is_free());
    /// assert!(scene.edges(&["run", "run"]).is_err() && scene.edges(&["walk"]).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A name that is no joint of the robot that moves, or one named twice.
    pub fn edges(&self, joint_names: &[&str]) -> Result<EdgeChecker<'_>, RobotError> {
        let mut joints = Vec::with_capacity(joint_names.len());
        for (place, name) in joint_names.iter().enumerate() {
            let joint = self.robot.moving_joint(place, name)?;
            if joints.contains(&joint) {
                return Err(RobotError::path(
                    format!("joint_names[{place}]"),
                    format!("{name:?} is named twice"),
                ));
            }
            joints.push(joint);
        }
        Ok(EdgeChecker { scene: self, joints })
    }

    pub(crate) fn check_values(
        &self,
        values: &[JointValue],
        times: [f64; 2],
        threads: Threads,
    ) -> Result<PathAnswer, RobotError> {
        let window = Self::window_of(times)?;
        let arm = self.robot.arm(values);
        let candidates = BroadPhase::new(self, &arm).candidates(window)?;
        if candidates.is_empty() {
            return Ok(PathAnswer::Free { until: window.end() });
        }
        let mut is_wanted = vec![false; self.parts.len()];
        for candidate in &candidates {
            is_wanted[candidate.a.index()] = true;
            is_wanted[candidate.b.index()] = true;
        }
        let plan = self.plan(&arm, |part| is_wanted[part])?;
        let end = window.end();
        let first = self.world.first_contact_among(&plan, &candidates, window, threads);
        let first = first.map_err(|error| self.named(error))?;
        let name = |id: BodyId| self.name_of(id).to_owned();
        Ok(match first {
            FirstContact::Separated => PathAnswer::Free { until: end },
            FirstContact::Contact { a, b, contact, .. } => {
                let bodies = [a.index(), b.index()];
                PathAnswer::Contact(Box::new(PathContact { a: name(a), b: name(b), bodies, contact }))
            }
            FirstContact::Undecided { clear_until, a, b, .. } => {
                PathAnswer::Undecided { free_until: clear_until, a: name(a), b: name(b) }
            }
        })
    }

    /// The time of a path.
    pub(crate) fn window_of([start, end]: [f64; 2]) -> Result<Window, RobotError> {
        Window::try_new(start, end)
            .map_err(|error| RobotError::path("points", format!("times from {start:?} to {end:?}: {error}")))
    }

    /// The motions of the wanted parts among those that links carry, themselves and what is attached to them.
    pub(crate) fn plan(
        &self,
        arm: &Arm,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Result<Vec<PlannedMotion>, RobotError> {
        let mut plan = Vec::with_capacity(self.parts.len());
        for (place, part) in self.parts.iter().enumerate() {
            let (link, frame) = match &part.owner {
                Owner::Link { link, frame } => (*link, frame.as_ref()),
                Owner::Attached { link, frame } => (*link, Some(frame)),
                Owner::Obstacle { .. } => continue,
            };
            if !is_wanted(place) {
                continue;
            }
            let chain = arm.link(self.robot.place_in_arm(link))?;
            let chain = match frame {
                None => chain,
                Some(frame) => chain.and(frame.clone())?,
            };
            plan.push(PlannedMotion { body: part.id, motion: Arc::new(chain) });
        }
        Ok(plan)
    }

    fn name_of(&self, body: BodyId) -> &str {
        &self.parts[body.index()].name
    }

    fn named(&self, error: WorldError) -> RobotError {
        let name = |id: BodyId| self.name_of(id).to_owned();
        match error {
            WorldError::Pair { a, b, error } => RobotError::Query { a: name(a), b: name(b), source: error },
            WorldError::OutsideMotion { body, outside } => {
                RobotError::Body { name: name(body), reason: outside.to_string() }
            }
            other => RobotError::path("points", other.to_string()),
        }
    }
}

/// Checks of straight edges between two configurations, as sampling planners need them. Time runs from 0 to 1.
///
/// ```
/// # use d2m_robot::{Robot, RobotOptions, RobotScene};
/// # let text = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
/// # </robot>"#;
/// # let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// # let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// let edges = scene.edges(&["run"])?;
/// assert!(edges.check(&[0.0], &[0.39])?.is_free());
/// let last_valid = edges.check(&[0.0], &[0.8])?.free_until();
/// assert!(last_valid < 0.5 && last_valid > 0.5 - 1e-8);
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Clone)]
pub struct EdgeChecker<'a> {
    scene: &'a RobotScene,
    joints: Vec<usize>,
}

impl EdgeChecker<'_> {
    /// The edge from one configuration to another: positions of the named joints, in their order.
    ///
    /// # Errors
    /// Configurations of another length, or with a number that is not finite.
    pub fn check(&self, from: &[f64], to: &[f64]) -> Result<PathAnswer, RobotError> {
        for (name, configuration) in [("from", from), ("to", to)] {
            if configuration.len() != self.joints.len() {
                let reason = format!("{} numbers for {} joints", configuration.len(), self.joints.len());
                return Err(RobotError::path(name, reason));
            }
            if let Some(index) = configuration.iter().position(|number| !number.is_finite()) {
                let reason = format!("{} is not finite", configuration[index]);
                return Err(RobotError::path(format!("{name}[{index}]"), reason));
            }
        }
        let robot = &self.scene.robot;
        let mut values: Vec<Option<JointValue>> = vec![None; robot.joints.len()];
        for (place, &joint) in self.joints.iter().enumerate() {
            let points = JointPoints::new(vec![0.0, 1.0], vec![from[place], to[place]]);
            values[joint] = Some(JointValue::through(points)?);
        }
        self.scene.check_values(&robot.complete(values)?, [0.0, 1.0], Threads::Own)
    }
    /// Many edges, on all threads (feature `rayon`); the answers in their order, with the bits of [`EdgeChecker::check`].
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
    /// let edges = scene.edges(&["run"])?;
    /// let ends = [([0.0], [0.3]), ([0.0], [0.6])];
    /// let answers = edges.check_all(ends.iter().map(|(from, to)| (&from[..], &to[..])))?;
    /// assert_eq!(answers.iter().map(|answer| answer.is_free()).collect::<Vec<_>>(), [true, false]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`EdgeChecker::check`], with the index of the edge: the first one that is refused.
    pub fn check_all<'e>(
        &self,
        edges: impl IntoIterator<Item = (&'e [f64], &'e [f64])>,
    ) -> Result<Vec<PathAnswer>, RobotError> {
        let edges: Vec<_> = edges.into_iter().enumerate().collect();
        let check = |&(index, (from, to)): &(usize, (&[f64], &[f64]))| {
            self.check(from, to).map_err(|error| RobotError::path(format!("edge {index}"), error.to_string()))
        };
        map_in_order(&edges, 1, check).into_iter().collect()
    }
}
