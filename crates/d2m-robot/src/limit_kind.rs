//! Which limit of a joint.

/// What is beyond its limit.
///
/// ```
/// # let urdf = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"/>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><limit lower="-1" upper="0.5" velocity="2"/></joint>
/// # </robot>"#;
/// use d2m_robot::{LimitKind, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// let robot = Robot::parse("slide.urdf", urdf, &RobotOptions::new())?;
/// let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 1.0)]);
/// let kinds: Vec<LimitKind> = scene.limit_warnings(&path)?.iter().map(|warning| warning.kind).collect();
/// assert_eq!(kinds, [LimitKind::Position]); // beyond 0.5, at a speed of 1 where 2 is allowed
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimitKind {
    /// The position.
    Position,
    /// The speed.
    Velocity,
}
