//! How near a path comes to a contact.

use crate::path_bodies::PathBodies;
use crate::scene::RobotScene;
use crate::{RobotError, Trajectory};
use d2m_bvh::{
    Clearance, ClearanceOptions, ClearanceStatus, DistanceOptions, Meter, PairCache, Posed, QueryError,
    Solid, clearance, distance_within,
};

/// Times at which the pairs' distances are estimated for the order in which they are searched.
const LOOKS: u32 = 9;

/// The least distance of any checked pair along a path, less the minimum separation.
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
    /// How near a path comes to a contact: the least distance of all pairs that are checked, less the minimum separation, enclosed to
    /// 10⁻⁶ of itself (or four tolerances of the pair). `None` where no pair is checked.
    ///
    /// Pair by pair, that of the nearest samples first: the others are only of interest where they come nearer than what is known, so
    /// most of them are one search that proves that they do not. The budget of the options is one for all pairs.
    ///
    /// # Errors
    /// As [`RobotScene::check_path`].
    pub fn clearance(&self, path: &Trajectory) -> Result<Option<PathClearance>, RobotError> {
        let bodies = self.bodies_along(path)?;
        let least = self.options().min_separation;
        let meter = Meter::new(&self.options().budget);
        let mut nearest: Option<([usize; 2], Clearance)> = None;
        for pair in bodies.nearest_first() {
            let mut options = bodies.clearance_options().with_budget(meter.rest());
            if let Some((_, known)) = &nearest {
                options = finer(options, known.upper, least).with_cutoff(known.upper);
            }
            let mut found = bodies.clearance(pair, &options)?;
            if nearest.is_none() && least > 0.0 {
                let options = finer(options.with_budget(meter.rest()), found.upper, least);
                found = bodies.clearance(pair, &options)?;
            }
            nearest = Some(match nearest {
                Some(known) => nearer(known, (pair, found)),
                None => (pair, found),
            });
        }
        Ok(nearest.map(|([a, b], found)| {
            // Rounded outward: the subtraction errs by less than one step.
            let (lower, upper) = if least == 0.0 {
                (found.lower, found.upper)
            } else {
                ((found.lower - least).next_down(), (found.upper - least).next_up())
            };
            let [a, b] = [a, b].map(|body| bodies.name(body).to_owned());
            PathClearance { lower, upper, time: found.time, a, b, status: found.status }
        }))
    }
}

/// What is left of a distance above the minimum separation is to be as accurate as the distance itself would be.
fn finer(options: ClearanceOptions, distance: f64, least: f64) -> ClearanceOptions {
    let part = (distance - least) / distance;
    if part > 0.0 { options.with_accuracy((options.accuracy * part).max(f64::EPSILON)) } else { options }
}

/// The enclosure of the lesser of two distances, with the witness of the one that is proven nearer.
fn nearer(one: ([usize; 2], Clearance), other: ([usize; 2], Clearance)) -> ([usize; 2], Clearance) {
    let lower = one.1.lower.min(other.1.lower);
    let is_undecided = [&one, &other].iter().any(|(_, found)| found.status == ClearanceStatus::Undecided);
    let (pair, mut found) = if other.1.upper < one.1.upper { other } else { one };
    found.lower = lower;
    if is_undecided {
        found.status = ClearanceStatus::Undecided;
    }
    (pair, found)
}

impl PathBodies<'_> {
    fn clearance_options(&self) -> ClearanceOptions {
        let of_pairs = self.options();
        let options = ClearanceOptions::default().with_solid(of_pairs.solid).with_parallel(of_pairs.parallel);
        of_pairs.tolerance.map_or(options, |tolerance| options.with_tolerance(tolerance))
    }

    /// The pairs that are checked; first the one that is nearest at a few times, then by the distance of their spheres. It is an order
    /// of a search: nothing is proven by it.
    fn nearest_first(&self) -> Vec<[usize; 2]> {
        let window = self.window();
        let times: Vec<f64> = (0..LOOKS)
            .map(|look| window.start() + window.length() * (f64::from(look) / f64::from(LOOKS - 1)))
            .map(|time| time.min(window.end()))
            .collect();
        let mut looks: Vec<(f64, f64, [usize; 2])> = Vec::with_capacity(self.pairs().len() * times.len());
        for &pair in self.pairs() {
            let [a, b] = pair.map(|body| self.moving(body));
            for &time in &times {
                let [p, q] =
                    [a, b].map(|of| of.motion.pose_and_twist(time).0.transform_point(of.body.center()));
                let reach = a.body.radius() + a.radius + b.body.radius() + b.radius;
                looks.push(((p - q).length() - reach, time, pair));
            }
        }
        looks.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut nearest = (f64::INFINITY, None);
        for &(apart, time, pair) in &looks {
            if apart >= nearest.0 {
                break;
            }
            let [a, b] = pair.map(|body| self.moving(body));
            let [x, y] = [a, b].map(|of| Posed::new(of.body, of.motion.pose_and_twist(time).0));
            let radii = a.radius + b.radius;
            let options = DistanceOptions::default()
                .with_solid(Solid::Surface)
                .with_cutoff((nearest.0 + radii).max(0.0));
            // What cannot be measured has its place in the order, and its error from the search.
            if let Ok(Some(found)) = distance_within(x, y, &options, &mut PairCache::new())
                && found.upper - radii < nearest.0
            {
                nearest = (found.upper - radii, Some(pair));
            }
        }
        let mut order: Vec<[usize; 2]> = nearest.1.into_iter().collect();
        for (_, _, pair) in looks {
            if !order.contains(&pair) {
                order.push(pair);
            }
        }
        order
    }

    fn clearance(&self, pair: [usize; 2], options: &ClearanceOptions) -> Result<Clearance, RobotError> {
        let [a, b] = pair.map(|body| self.moving(body));
        clearance(a, b, self.window(), options).map_err(|error| self.fault(pair, error))
    }

    fn fault(&self, pair: [usize; 2], source: QueryError) -> RobotError {
        let [a, b] = pair.map(|body| self.name(body).to_owned());
        RobotError::Query { a, b, source }
    }
}
