//! A path of the joints through time, as in a `JointTrajectory` of ROS.

use crate::RobotError;
use d2m_motion::{JointPoints, JointValue};

/// How a path goes from one point to the next.
///
/// ```
/// use d2m_robot::{Interpolation, Trajectory, TrajectoryPoint};
/// let point = |time: f64, angle: f64| TrajectoryPoint::new(time, vec![angle]).with_velocities(vec![0.0]);
/// let path = Trajectory::new(vec!["elbow".into()], vec![point(0.0, 0.0), point(1.0, 1.0)]);
/// assert_eq!(path.interpolation(), Interpolation::Cubic); // velocities are given
/// let straight = path.clone().with_interpolation(Interpolation::Linear);
/// // After a quarter of the time a cubic that starts and ends at rest has done 3/16 − 2/64 of the way.
/// assert_eq!([&path, &straight].map(|path| path.joint_values().unwrap()[0].value(0.25)), [0.15625, 0.25]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Interpolation {
    /// Straight, by positions alone.
    #[default]
    Linear,
    /// The cubic Hermite polynomial of positions and velocities.
    Cubic,
    /// The quintic polynomial of positions, velocities and accelerations.
    Quintic,
}

/// A path: points of named joints at increasing times. It lasts from the first time to the last.
///
/// ```
/// use d2m_robot::{Trajectory, TrajectoryPoint};
/// let point = |time: f64, angle: f64| TrajectoryPoint::new(time, vec![angle]);
/// let path = Trajectory::new(vec!["elbow".into()], vec![point(0.0, 0.0), point(2.0, 1.5)]);
/// assert_eq!(path.joint_values()?[0].value(1.0), 0.75);
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(from = "TrajectoryForm"))]
#[non_exhaustive]
pub struct Trajectory {
    /// The joints that the numbers of each point belong to.
    pub joint_names: Vec<String>,
    /// Two or more.
    pub points: Vec<TrajectoryPoint>,
    /// None: cubic where velocities are given, else straight.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub interpolation: Option<Interpolation>,
}

/// What is read of a path: what a message of ROS has besides says nothing of it.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct TrajectoryForm {
    #[serde(default, rename = "header")]
    _header: serde::de::IgnoredAny,
    joint_names: Vec<String>,
    #[serde(deserialize_with = "d2m_motion::serde_object::all")]
    points: Vec<TrajectoryPoint>,
    #[serde(default)]
    interpolation: Option<Interpolation>,
}

#[cfg(feature = "serde")]
impl From<TrajectoryForm> for Trajectory {
    fn from(form: TrajectoryForm) -> Self {
        Self { joint_names: form.joint_names, points: form.points, interpolation: form.interpolation }
    }
}

/// One point of a path. A list of velocities or accelerations that is empty is not given.
///
/// ```
/// use d2m_robot::TrajectoryPoint;
/// let point = TrajectoryPoint::new(0.5, vec![1.2, -0.3]).with_velocities(vec![0.0, 0.1]);
/// assert_eq!((point.time_from_start, point.positions.len(), point.accelerations.len()), (0.5, 2, 0));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct TrajectoryPoint {
    /// One for each joint: radians, or units of length.
    pub positions: Vec<f64>,
    /// Rates of the positions.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub velocities: Vec<f64>,
    /// Rates of the velocities.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub accelerations: Vec<f64>,
    /// Forces and torques of a ROS message: read, and not used.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub effort: Vec<f64>,
    /// Seconds. In JSON also `{"sec", "nanosec"}`, as ROS writes them.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::ros_time::seconds"))]
    pub time_from_start: f64,
}

impl TrajectoryPoint {
    /// Positions at a time.
    pub const fn new(time_from_start: f64, positions: Vec<f64>) -> Self {
        Self {
            positions,
            velocities: Vec::new(),
            accelerations: Vec::new(),
            effort: Vec::new(),
            time_from_start,
        }
    }

    /// With velocities.
    #[must_use]
    pub fn with_velocities(self, velocities: Vec<f64>) -> Self {
        Self { velocities, ..self }
    }

    /// With accelerations.
    #[must_use]
    pub fn with_accelerations(self, accelerations: Vec<f64>) -> Self {
        Self { accelerations, ..self }
    }
}

impl Trajectory {
    /// Through these points, cubic if the first one has velocities, else straight.
    pub const fn new(joint_names: Vec<String>, points: Vec<TrajectoryPoint>) -> Self {
        Self { joint_names, points, interpolation: None }
    }

    /// With another way from point to point.
    #[must_use]
    pub const fn with_interpolation(mut self, interpolation: Interpolation) -> Self {
        self.interpolation = Some(interpolation);
        self
    }

    /// How the path goes from point to point: as stated, or cubic where velocities are given, else straight.
    pub fn interpolation(&self) -> Interpolation {
        let has_velocities = self.points.first().is_some_and(|point| !point.velocities.is_empty());
        let usual = if has_velocities { Interpolation::Cubic } else { Interpolation::Linear };
        self.interpolation.unwrap_or(usual)
    }

    /// First and last time, if there are points.
    pub fn times(&self) -> Option<[f64; 2]> {
        Some([self.points.first()?.time_from_start, self.points.last()?.time_from_start])
    }

    /// The value of each joint over time, in the order of the names.
    ///
    /// # Errors
    /// No joint, one named twice, fewer than two points, times that are not finite or do not increase, lists of other lengths than
    /// that of the names, numbers that are not finite, velocities or accelerations that the interpolation needs and a point
    /// lacks: with point, joint and value.
    pub fn joint_values(&self) -> Result<Vec<JointValue>, RobotError> {
        self.check_names()?;
        self.check_points()?;
        let interpolation = self.interpolation();
        let times: Vec<f64> = self.points.iter().map(|point| point.time_from_start).collect();
        let values = self.joint_names.iter().enumerate().map(|(joint, name)| {
            let list = |of: fn(&TrajectoryPoint) -> &Vec<f64>| {
                self.points.iter().map(|point| of(point)[joint]).collect::<Vec<f64>>()
            };
            let mut points = JointPoints::new(times.clone(), list(|point| &point.positions));
            if interpolation != Interpolation::Linear {
                points = points.with_velocities(list(|point| &point.velocities));
            }
            if interpolation == Interpolation::Quintic {
                points = points.with_accelerations(list(|point| &point.accelerations));
            }
            JointValue::through(points)
                .map_err(|error| RobotError::path(format!("joint {name:?}"), error.to_string()))
        });
        values.collect()
    }

    fn check_names(&self) -> Result<(), RobotError> {
        if self.joint_names.is_empty() {
            return Err(RobotError::path("joint_names", "it is empty: no joint is named"));
        }
        for (index, name) in self.joint_names.iter().enumerate() {
            if self.joint_names[..index].contains(name) {
                return Err(RobotError::path(
                    format!("joint_names[{index}]"),
                    format!("{name:?} is named twice"),
                ));
            }
        }
        Ok(())
    }

    fn check_points(&self) -> Result<(), RobotError> {
        if self.points.len() < 2 {
            let reason = format!("{} of them: a path needs two or more", self.points.len());
            return Err(RobotError::path("points", reason));
        }
        let interpolation = self.interpolation();
        let mut before: Option<f64> = None;
        for (index, point) in self.points.iter().enumerate() {
            let time = point.time_from_start;
            if !time.is_finite() {
                let place = format!("points[{index}], time_from_start");
                return Err(RobotError::path(place, format!("{time} is not finite")));
            }
            if let Some(earlier) = before.filter(|&earlier| earlier >= time) {
                let place = format!("points[{index}], time_from_start");
                let reason = format!("{time:?} does not come after {earlier:?}: times must increase");
                return Err(RobotError::path(place, reason));
            }
            before = Some(time);
            let lists = [
                ("positions", &point.positions, true),
                ("velocities", &point.velocities, interpolation != Interpolation::Linear),
                ("accelerations", &point.accelerations, interpolation == Interpolation::Quintic),
            ];
            for (name, list, is_needed) in lists {
                if is_needed || !list.is_empty() {
                    self.check_list(&format!("points[{index}], {name}"), list)?;
                }
            }
        }
        Ok(())
    }

    fn check_list(&self, place: &str, list: &[f64]) -> Result<(), RobotError> {
        if list.len() != self.joint_names.len() {
            let reason = format!("{} numbers for {} joints", list.len(), self.joint_names.len());
            return Err(RobotError::path(place, reason));
        }
        match list.iter().position(|number| !number.is_finite()) {
            None => Ok(()),
            Some(joint) => {
                let reason = format!("{} is not finite (joint {:?})", list[joint], self.joint_names[joint]);
                Err(RobotError::path(format!("{place}[{joint}]"), reason))
            }
        }
    }
}
