//! How near a path comes to a contact.

use crate::path_bodies::PathBodies;
use crate::scene::RobotScene;
use crate::{RobotError, Trajectory};
use d2m_bvh::{ClearanceOptions, ClearanceStatus, Meter, Moving};
use d2m_world::{PairDistance, PairFault, PairsOfBodies};

/// The least distance of any checked pair along a path, less the minimum separation.
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
/// # let mut scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// # scene.ignore("cart", "rail");
/// // The cart goes to 0.3; the stop begins at 0.45, and half of the cart is 0.05 long.
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 0.3)]);
/// let nearest = scene.clearance(&path)?.expect("a pair is checked");
/// assert_eq!([nearest.a.as_str(), nearest.b.as_str()], ["cart", "stop"]);
/// assert!(nearest.lower <= 0.1 && 0.1 <= nearest.upper && nearest.upper - nearest.lower < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathClearance {
    /// Proven: no pair comes nearer at any time. Below zero where bodies may be nearer than the minimum separation.
    pub lower: f64,
    /// Proven: the pair below is at most this far apart at the time below.
    pub upper: f64,
    /// When.
    pub time: f64,
    /// The link or body that is nearest.
    pub a: String,
    /// The other one of that pair.
    pub b: String,
    /// What is known: of all pairs, so one that ran out of its budget makes all undecided.
    pub status: ClearanceStatus,
}

impl RobotScene {
    /// How near a path comes to a contact: the least distance of all pairs that are checked, enclosed to 10⁻⁶ of itself (or four
    /// tolerances of the pair), less the minimum separation. `None` where no pair is checked.
    ///
    /// Pair by pair, that of the nearest samples first: the others are only of interest where they come nearer than what is known, so
    /// most of them are one search that proves that they do not. The budget of the options is one for all pairs.
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
    /// let nearest = scene.clearance(&to(0.3))?.expect("pairs are checked");
    /// // The cart stays 0.1 above the rail, and ends 0.1 before the stop.
    /// assert!(nearest.lower <= 0.1 && 0.1 <= nearest.upper && nearest.a == "rail" || nearest.b == "stop");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`RobotScene::check_path`].
    pub fn clearance(&self, path: &Trajectory) -> Result<Option<PathClearance>, RobotError> {
        let bodies = self.bodies_along(path)?;
        let moving: Vec<Moving<'_>> = (0..bodies.len()).map(|body| bodies.moving(body)).collect();
        let meter = Meter::new(&self.options().budget);
        let mut nearest: Option<PathClearance> = None;
        for (least, pairs) in bodies.pairs_by_separation() {
            let pairs = PairsOfBodies { bodies: &moving, pairs: &pairs, window: bodies.window() };
            let options = bodies.clearance_options().with_budget(meter.rest());
            let found = pairs.nearest(&options, least).map_err(|fault| bodies.fault(fault))?;
            let found = found.map(|found| bodies.above(found, least));
            nearest = match (nearest, found) {
                (Some(one), Some(other)) => Some(one.or_nearer(other)),
                (one, other) => one.or(other),
            };
        }
        Ok(nearest)
    }
}

impl PathClearance {
    /// That of the pairs of both.
    fn or_nearer(self, other: Self) -> Self {
        let lower = self.lower.min(other.lower);
        let is_undecided = [&self, &other].iter().any(|found| found.status == ClearanceStatus::Undecided);
        let mut found = if other.upper < self.upper { other } else { self };
        found.lower = lower;
        if is_undecided {
            found.status = ClearanceStatus::Undecided;
        }
        found
    }
}

impl PathBodies<'_> {
    fn clearance_options(&self) -> ClearanceOptions {
        let of_pairs = self.options();
        let options = ClearanceOptions::default().with_solid(of_pairs.solid).with_parallel(of_pairs.parallel);
        of_pairs.tolerance.map_or(options, |tolerance| options.with_tolerance(tolerance))
    }

    /// The pairs that are checked, by the separations that they are to keep.
    fn pairs_by_separation(&self) -> Vec<(f64, Vec<[usize; 2]>)> {
        let mut all: Vec<(f64, Vec<[usize; 2]>)> = Vec::new();
        for &pair in self.pairs() {
            let least = self.pair_options(pair).min_separation;
            match all.iter_mut().find(|(other, _)| *other == least) {
                Some((_, pairs)) => pairs.push(pair),
                None => all.push((least, vec![pair])),
            }
        }
        all
    }

    /// A distance above the separation that is to be kept.
    fn above(
        &self,
        PairDistance { pair: [a, b], clearance: found }: PairDistance,
        least: f64,
    ) -> PathClearance {
        // Rounded outward: the subtraction errs by less than one step.
        let (lower, upper) = if least == 0.0 {
            (found.lower, found.upper)
        } else {
            ((found.lower - least).next_down(), (found.upper - least).next_up())
        };
        let [a, b] = [a, b].map(|body| self.name(body).to_owned());
        PathClearance { lower, upper, time: found.time, a, b, status: found.status }
    }

    fn fault(&self, PairFault { pair, error: source }: PairFault) -> RobotError {
        let [a, b] = pair.map(|body| self.name(body).to_owned());
        RobotError::Query { a, b, source }
    }
}
