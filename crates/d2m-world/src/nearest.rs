//! Which of many pairs comes nearest, and which come within a distance.

use crate::Aabb;
use crate::batches::{BOXES, PAIRS};
use crate::swept_bounds::CoveredBody;
use d2m_bvh::{
    Clearance, ClearanceOptions, ClearanceStatus, DistanceOptions, Meter, Moving, Posed, QueryError, Solid,
    Window, clearance, distance_within,
};
use d2m_mesh::parallel::map_in_order;
use std::collections::HashSet;

/// Times at which the pairs' distances are estimated for the order in which they are searched.
const LOOKS: u32 = 9;
/// Pairs from which on distances are estimated at fewer times: the estimates would take more time than the searches then.
const MANY: usize = 1 << 15;
const FEWER_LOOKS: u32 = 2;

/// Some bodies, and the pairs of them that are of interest, by their places in the list.
///
/// ```
/// use d2m_bvh::{ClearanceOptions, MeshTree, Moving, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::PairsOfBodies;
/// use glam::DVec3;
/// let cube = MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?); // edges of length 1
/// let places = [0.0, 3.0, 7.0].map(|x| ConstantTwist::REST.with_position(DVec3::X * x));
/// let bodies = places.each_ref().map(|place| Moving::new(&cube, place));
/// let pairs = PairsOfBodies { bodies: &bodies, pairs: &[[0, 1], [0, 2], [1, 2]], window: Window::UNIT };
/// let nearest = pairs.nearest(&ClearanceOptions::default(), 0.0)?.expect("there are pairs");
/// assert!(nearest.pair == [0, 1] && nearest.clearance.lower <= 2.0 && nearest.clearance.upper >= 2.0);
/// assert_eq!(pairs.below(3.5, &ClearanceOptions::default())?.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PairsOfBodies<'a> {
    /// The bodies.
    pub bodies: &'a [Moving<'a>],
    /// Two places each.
    pub pairs: &'a [[usize; 2]],
    /// The times that count.
    pub window: Window,
}

/// The least distance of one of several pairs.
///
/// ```
/// use d2m_bvh::{ClearanceOptions, MeshTree, Moving, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::PairsOfBodies;
/// use glam::DVec3;
/// let cube = MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?); // edges of length 1
/// let places = [0.0, 3.0, 5.0].map(|x| ConstantTwist::REST.with_position(DVec3::X * x));
/// let bodies = places.each_ref().map(|place| Moving::new(&cube, place));
/// let pairs = PairsOfBodies { bodies: &bodies, pairs: &[[0, 1], [1, 2]], window: Window::UNIT };
/// let nearest = pairs.nearest(&ClearanceOptions::default(), 0.0)?.expect("there are pairs");
/// assert!(nearest.pair == [1, 2] && nearest.clearance.lower <= 1.0 && nearest.clearance.upper >= 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairDistance {
    /// The places of its bodies.
    pub pair: [usize; 2],
    /// Its least distance.
    pub clearance: Clearance,
}

/// Bad input of one of several pairs.
///
/// ```
/// use d2m_bvh::{ClearanceOptions, MeshTree, Moving, Window};
/// use d2m_motion::{ConstantTwist, Keyframes, Pose, Span};
/// use d2m_world::PairsOfBodies;
/// let cube = MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?);
/// let short = Keyframes::try_new(&[(0.0, Pose::IDENTITY), (0.5, Pose::IDENTITY)], Span::Linear)?;
/// let bodies = [Moving::new(&cube, &ConstantTwist::REST), Moving::new(&cube, &short)];
/// let pairs = PairsOfBodies { bodies: &bodies, pairs: &[[0, 1]], window: Window::UNIT };
/// let fault = pairs.nearest(&ClearanceOptions::default(), 0.0).unwrap_err();
/// assert_eq!(fault.pair, [0, 1]); // the second body does not say where it is after 0.5
/// assert!(fault.to_string().starts_with("bodies 0 and 1: "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("bodies {} and {}: {error}", pair[0], pair[1])]
pub struct PairFault {
    /// The places of its bodies.
    pub pair: [usize; 2],
    /// What is wrong with it.
    pub error: QueryError,
}

impl PairsOfBodies<'_> {
    /// The least distance of all pairs over the window, enclosed, with the pair that attains its upper end; `None` where there is no pair.
    ///
    /// Pair by pair, that of the nearest samples first: the others are only of interest where they come nearer than what is known, so most
    /// of them are one search that proves that they do not, or boxes that do. What is left of the distance above `above` is as accurate as
    /// the options say, such as above a distance that is to be kept. The budget of the options is one for all pairs.
    ///
    /// # Errors
    /// Bad input of a pair.
    pub fn nearest(&self, options: &ClearanceOptions, above: f64) -> Result<Option<PairDistance>, PairFault> {
        let boxes = self.boxes();
        let meter = Meter::new(&options.budget);
        let mut nearest: Option<PairDistance> = None;
        for pair in self.nearest_first() {
            let mut wanted = options.with_budget(meter.rest());
            if let Some(known) = &nearest {
                let most = known.clearance.upper;
                if !may_come_within(&boxes, pair, most) {
                    continue;
                }
                wanted = finer(wanted, most, above).with_cutoff(most);
            }
            let mut found = self.clearance(pair, &wanted)?;
            if nearest.is_none() && above > 0.0 {
                let wanted = finer(wanted.with_budget(meter.rest()), found.upper, above);
                found = self.clearance(pair, &wanted)?;
            }
            let found = PairDistance { pair, clearance: found };
            nearest = Some(nearest.map_or(found, |known| nearer(known, found)));
        }
        Ok(nearest)
    }

    /// The pairs whose least distance is not proven to be at least `limit`, by that distance. The budget of the options is one for each pair.
    ///
    /// # Errors
    /// Bad input of a pair.
    pub fn below(&self, limit: f64, options: &ClearanceOptions) -> Result<Vec<PairDistance>, PairFault> {
        let boxes = self.boxes();
        let near: Vec<[usize; 2]> =
            self.pairs.iter().copied().filter(|&pair| may_come_within(&boxes, pair, limit)).collect();
        let options = options.with_cutoff(limit);
        let found = map_in_order(&near, PAIRS, |&pair| {
            self.clearance(pair, &options).map(|clearance| PairDistance { pair, clearance })
        });
        let mut found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        found.retain(|found| found.clearance.lower < limit);
        found.sort_by(|x, y| {
            x.clearance.upper.total_cmp(&y.clearance.upper).then_with(|| x.pair.cmp(&y.pair))
        });
        Ok(found)
    }

    /// What the bodies sweep; none of one whose motion does not cover the window, which the query of a pair refuses.
    fn boxes(&self) -> Vec<Option<Aabb>> {
        let (from, to) = (self.window.start(), self.window.end());
        map_in_order(self.bodies, BOXES, |body| {
            CoveredBody::of_moving(body, from, to).ok().map(CoveredBody::swept)
        })
    }

    /// The pairs; first the one that is nearest at a few times, then by the distance of their spheres. It is an order of a search: nothing
    /// is proven by it.
    fn nearest_first(&self) -> Vec<[usize; 2]> {
        let window = self.window;
        let count = if self.pairs.len() < MANY { LOOKS } else { FEWER_LOOKS };
        let times: Vec<f64> = (0..count)
            .map(|look| window.start() + window.length() * (f64::from(look) / f64::from(count - 1)))
            .map(|time| time.min(window.end()))
            .collect();
        let mut looks: Vec<(f64, f64, [usize; 2])> = Vec::with_capacity(self.pairs.len() * times.len());
        for &pair in self.pairs {
            let [a, b] = pair.map(|body| &self.bodies[body]);
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
            let [a, b] = pair.map(|body| &self.bodies[body]);
            let [x, y] = [a, b].map(|of| Posed::new(of.body, of.motion.pose_and_twist(time).0));
            let radii = a.radius + b.radius;
            let options = DistanceOptions::default()
                .with_solid(Solid::Surface)
                .with_cutoff((nearest.0 + radii).max(0.0));
            // What cannot be measured has its place in the order, and its error from the search.
            if let Ok(Some(found)) = distance_within(x, y, &options)
                && found.upper - radii < nearest.0
            {
                nearest = (found.upper - radii, Some(pair));
            }
        }
        let order = nearest.1.into_iter().chain(looks.into_iter().map(|(_, _, pair)| pair));
        let mut seen = HashSet::with_capacity(self.pairs.len());
        order.filter(|pair| seen.insert(*pair)).collect()
    }

    fn clearance(&self, pair: [usize; 2], options: &ClearanceOptions) -> Result<Clearance, PairFault> {
        let [a, b] = pair.map(|body| self.bodies[body]);
        clearance(a, b, self.window, options).map_err(|error| PairFault { pair, error })
    }
}

/// Is a pair not proven further apart than that at all times?
fn may_come_within(boxes: &[Option<Aabb>], pair: [usize; 2], distance: f64) -> bool {
    match pair.map(|body| boxes[body].as_ref()) {
        [Some(a), Some(b)] => a.may_meet(b, distance),
        _ => true,
    }
}

/// What is left of a distance above another one is to be as accurate as the distance itself would be.
fn finer(options: ClearanceOptions, distance: f64, above: f64) -> ClearanceOptions {
    let part = (distance - above) / distance;
    if part > 0.0 { options.with_accuracy((options.accuracy * part).max(f64::EPSILON)) } else { options }
}

/// The enclosure of the lesser of two distances, with the witness of the one that is proven nearer.
fn nearer(one: PairDistance, other: PairDistance) -> PairDistance {
    let lower = one.clearance.lower.min(other.clearance.lower);
    let is_undecided =
        [&one, &other].iter().any(|found| found.clearance.status == ClearanceStatus::Undecided);
    let mut found = if other.clearance.upper < one.clearance.upper { other } else { one };
    found.clearance.lower = lower;
    if is_undecided {
        found.clearance.status = ClearanceStatus::Undecided;
    }
    found
}
