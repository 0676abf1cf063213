//! Where a path leaves the limits of its joints.

use crate::limit_kind::LimitKind;
use crate::limit_search::{Finding, LimitSearch};
use crate::{JointLimits, Robot};
use d2m_motion::JointValue;

/// A joint that a path takes beyond a limit. Limits are not enforced: the path is checked as it is.
///
/// ```
/// # let urdf = r#"<robot name="two">
/// #   <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
/// #   <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
/// #   <link name="wall"><collision><origin xyz="0 0.7 0"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
/// #   <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
/// #     <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="base"/><child link="wall"/></joint>
/// # </robot>"#;
/// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// # let robot = Robot::parse("two.urdf", urdf, &RobotOptions::new())?;
/// # let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// # let to = |angle: f64, time: f64| {
/// #     let points = vec![TrajectoryPoint::new(0.0, vec![0.0]), TrajectoryPoint::new(time, vec![angle])];
/// #     Trajectory::new(vec!["turn".into()], points)
/// # };
/// use d2m_robot::LimitKind;
/// // Half a radian in a tenth of a second: five a second, where one is allowed.
/// let warnings = scene.limit_warnings(&to(0.5, 0.1))?;
/// assert!(warnings.iter().any(|w| w.joint == "turn" && w.kind == LimitKind::Velocity && w.limit == 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LimitWarning {
    /// The joint.
    pub joint: String,
    /// What is beyond.
    pub kind: LimitKind,
    /// The first time at which it was found beyond (to 2⁻²⁰ of the path).
    pub time: f64,
    /// The index of the point of the path after which that is, on the way to the next.
    pub point: usize,
    /// What it is then; if that is not certain, how far beyond it may be.
    pub value: f64,
    /// The limit that is nearest.
    pub limit: f64,
    /// Is it proven to be beyond? Otherwise the search ended there without a decision, which only numbers do
    /// that doubles hardly hold; where it is beyond later, a second warning says so. No joint leaves its
    /// limits by more than 2⁻⁴⁸ of the largest value from one point to the next, and 2⁻⁴⁹⁸, without a warning
    /// of either kind; rates are known to 2⁻⁸⁰ of the largest position there divided by the time between the
    /// points.
    pub is_certain: bool,
}

impl core::fmt::Display for LimitWarning {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { joint, time, point, value, limit, is_certain, .. } = self;
        let what = match self.kind {
            LimitKind::Position => "position",
            LimitKind::Velocity => "velocity",
        };
        let side = if value < limit { "below" } else { "above" };
        if !is_certain {
            return write!(
                f,
                "joint {joint:?}: whether the {what} is {side} the limit {limit:?} from the time {time:?} on (from points[{point}] on) is not decided: it may be {value:?}"
            );
        }
        write!(
            f,
            "joint {joint:?}: the {what} {value:?} at the time {time:?} (from points[{point}] on) is {side} the limit {limit:?}"
        )
    }
}

impl Robot {
    /// Joints that leave their limits along a path through points at these times, by the values of all joints.
    pub(crate) fn limit_warnings(&self, values: &[JointValue], points: &[f64]) -> Vec<LimitWarning> {
        let mut warnings = Vec::new();
        let [Some(&start), Some(&end)] = [points.first(), points.last()] else { return warnings };
        for (joint, value) in self.joints.iter().zip(values) {
            let JointLimits { position, velocity } = joint.limits;
            let ranges = [
                (LimitKind::Position, position),
                (LimitKind::Velocity, velocity.map(|speed| [-speed, speed])),
            ];
            let mut times = vec![start];
            times.extend(value.times().iter().copied().filter(|&time| start < time && time < end));
            times.push(end);
            for (kind, range) in ranges {
                let Some(range) = range else { continue };
                let found = LimitSearch::new(value, kind, range, end - start).run(&times);
                warnings.extend(found.into_iter().flatten().map(|found| {
                    let Finding { time, value, limit, is_certain } = found;
                    let point = points.partition_point(|&of| of <= time).saturating_sub(1);
                    let point = point.min(points.len().saturating_sub(2));
                    LimitWarning { joint: joint.name.clone(), kind, time, point, value, limit, is_certain }
                }));
            }
        }
        warnings
    }
}
