//! Where a path leaves the limits of its joints.

use crate::{JointLimits, Robot};
use d2m_interval::Interval;
use d2m_motion::JointValue;

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
    /// What it is then.
    pub value: f64,
    /// The limit that is nearest.
    pub limit: f64,
}

impl core::fmt::Display for LimitWarning {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { joint, time, point, value, limit, .. } = self;
        let what = match self.kind {
            LimitKind::Position => "position",
            LimitKind::Velocity => "velocity",
        };
        let side = if value < limit { "below" } else { "above" };
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
            for (kind, range) in ranges {
                let Some([lower, upper]) = range else { continue };
                let enclose = |t: Interval| match kind {
                    LimitKind::Position => value.enclose(t),
                    LimitKind::Velocity => value.enclose_rate(t),
                };
                let mut times = vec![start];
                times.extend(value.times().iter().copied().filter(|&time| start < time && time < end));
                times.push(end);
                let search =
                    Search { enclose: &enclose, lower, upper, shortest: (end - start) * SHORTEST_PART };
                let mut left = MOST_STEPS;
                let pieces =
                    times.windows(2).find_map(|piece| search.first_beyond(piece[0], piece[1], &mut left));
                if let Some(Beyond { time, value, limit }) = pieces {
                    let point = points.partition_point(|&of| of <= time).saturating_sub(1);
                    let point = point.min(points.len().saturating_sub(2));
                    warnings.push(LimitWarning {
                        joint: joint.name.clone(),
                        kind,
                        time,
                        point,
                        value,
                        limit,
                    });
                }
            }
        }
        warnings
    }
}

/// Spans of this part of the path are halved no more.
const SHORTEST_PART: f64 = 1.0 / (1 << 20) as f64;
/// Spans that are evaluated for one joint: a joint that only grazes its limit needs a few hundred.
const MOST_STEPS: usize = 20_000;

struct Beyond {
    time: f64,
    value: f64,
    limit: f64,
}

struct Search<'a> {
    enclose: &'a dyn Fn(Interval) -> Interval,
    lower: f64,
    upper: f64,
    shortest: f64,
}

impl Search<'_> {
    /// The first time at which the value is certainly beyond its limits, halving spans in which it may be.
    fn first_beyond(&self, start: f64, end: f64, left: &mut usize) -> Option<Beyond> {
        let mut spans = vec![[start, end]];
        while let Some([lo, hi]) = spans.pop() {
            if let Some(beyond) = self.at(Interval::point(lo), lo) {
                return Some(beyond);
            }
            let over = (self.enclose)(Interval::new(lo, hi));
            *left = left.saturating_sub(1);
            if (self.lower <= over.lo() && over.hi() <= self.upper) || *left == 0 {
                continue;
            }
            let middle = Interval::new(lo, hi).mid();
            if hi - lo <= self.shortest || !(lo < middle && middle < hi) {
                // The end as seen from inside: the rate may jump there.
                let last = Interval::new(middle.max(lo), hi);
                if let Some(beyond) = self.at(last, hi) {
                    return Some(beyond);
                }
                continue;
            }
            spans.push([middle, hi]);
            spans.push([lo, middle]);
        }
        None
    }

    fn at(&self, span: Interval, time: f64) -> Option<Beyond> {
        let value = (self.enclose)(span);
        let limit = if value.hi() < self.lower {
            self.lower
        } else if value.lo() > self.upper {
            self.upper
        } else {
            return None;
        };
        Some(Beyond { time, value: value.mid(), limit })
    }
}
