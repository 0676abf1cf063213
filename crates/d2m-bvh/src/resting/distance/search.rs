//! Best first over pairs of boxes, for the closest pair of triangles.

use super::best::{Best, EXPECTED_WIDTH};
use super::hulls::{Hulls, Measure, Parting};
use super::queue::{Item, Queue};
use crate::allowance::{Allowance, Exhausted};
use crate::resting::node_pair::{Direction, Directions, Scene, Step, Wanted, child, gap_exceeds};
use crate::tree::margin::{UNIT_F64, round_up};
use d2m_feature::triangle_distance;
use d2m_lanes::{Lanes, Task};

/// Node tests and comparisons after which the pairs that wait are a crowd: several times as many as in ordinary queries of
/// a million triangles. They are examined again after twice as many.
const CROWD: u64 = 1 << 13;
/// In place of the version of a pair's direction: a plane of its own was tried.
const PARTED: u32 = u32::MAX;

/// What a search finds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Found {
    Pair(Best),
    /// Every pair is proven to be further apart than the limit less the expected width.
    Beyond,
    /// The enclosure of a pair straddles the limit: without a limit there is an answer.
    Unclear,
    /// The allowance ran out: the closest pair so far, with a lower bound over all.
    Exhausted(Best),
}

/// Best first over pairs of boxes.
///
/// The answer is the pair of triangles with the least (computed upper bound, numbers). A pair is left out only when it
/// is proven that its computed bound is more than the best one so far; so neither the order of the search nor the pair
/// that is compared first has any influence on the answer. Two exceptions: where triangles cross, their bound is zero, the search
/// ends with the first such pair, and another, in a fixed order, chooses the one that is reported; and when a search becomes very
/// long, pairs that a plane proves no closer up to rounding are dropped, so which of many equally close pairs is reported may
/// depend on the search ([`super::hulls`]).
pub(super) struct Search<'a> {
    pub(super) scene: &'a Scene<'a>,
    /// A pair of triangles to compare first.
    pub(super) first: Option<[u32; 2]>,
    /// Pairs beyond this are of no interest, working units.
    pub(super) limit: f64,
    pub(super) allowance: &'a mut Allowance,
}

/// State of a search: the best pair so far.
struct Closest<'a> {
    scene: &'a Scene<'a>,
    best: Option<Best>,
    /// Upper bound of the best pair, or the limit.
    upper: f64,
    /// Rounded up: pairs of boxes at more than this are left out.
    upper_key: f32,
    /// Least lower bound of a pair whose enclosure was wider than expected.
    loose: f64,
    /// The best pair's own direction; before there is one, from center to center.
    along: Direction,
    /// How often that direction has changed.
    version: u32,
}

impl<'a> Closest<'a> {
    fn new(scene: &'a Scene<'a>, limit: f64) -> Self {
        Self {
            scene,
            best: None,
            upper: limit,
            upper_key: round_up(limit),
            loose: f64::INFINITY,
            along: scene.direction(-scene.pose.offset),
            version: 0,
        }
    }

    /// True if the pair is closer than all so far.
    #[inline(always)]
    fn compare(&mut self, triangles: [u32; 2]) -> bool {
        let (a, b) = (self.scene.place(0, triangles[0]), self.scene.place(1, triangles[1]));
        if let Some(best) = &self.best {
            // Along the best pair's own direction: most of its neighbours are left out by this.
            if gap_exceeds(best.distance.direction, &a, &b, self.upper + self.scene.projection) {
                return false;
            }
        }
        let distance = triangle_distance(&a, &b);
        if distance.upper - distance.lower > EXPECTED_WIDTH {
            self.loose = self.loose.min(distance.lower);
        }
        let better = match &self.best {
            _ if distance.upper > self.upper => false,
            None => true,
            Some(best) => (distance.upper, triangles) < (best.distance.upper, best.triangles),
        };
        if better {
            self.best = Some(Best { distance, triangles, lower: 0.0, is_cut_short: false });
            self.upper = distance.upper;
            self.upper_key = round_up(distance.upper);
            if distance.lower > 0.0 {
                self.along = self.scene.direction(distance.direction);
                self.version = self.version.wrapping_add(1);
            }
        }
        better
    }

    /// The best pair with a lower bound over all, when every other pair is at least `waiting` apart.
    fn finished(&self, best: Best, waiting: f64) -> Best {
        let lower = (best.distance.upper - EXPECTED_WIDTH).min(self.loose).min(waiting).max(0.0);
        Best { lower: lower * (1.0 - 2.0 * UNIT_F64), ..best }
    }
}

impl Task for Search<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        let Self { scene, first, limit, allowance } = self;
        let mut closest = Closest::new(scene, limit);
        if let Some(triangles) = first {
            closest.compare(triangles);
        }
        let mut queue = Queue::default();
        let mut next = Some(Item { key: 0.0, pair: [0; 2], version: 0 });
        // Descend greedily to a pair of triangles, as long as that is closer than the one before; then best first.
        let mut descending = closest.best.is_none();
        let (mut steps, mut patience) = (0, CROWD);
        let mut hulls: Option<Hulls> = None;
        loop {
            if next.is_none() && steps >= patience {
                patience = 2 * steps;
                match (&mut closest.best, queue.least_key()) {
                    // No lower bound above zero is proven, whatever the other pairs are.
                    (Some(best), _) if best.distance.upper <= EXPECTED_WIDTH => {
                        queue.clear();
                        best.is_cut_short = true;
                    }
                    // Once more from the beginning: nodes high up may be parted by one plane.
                    (Some(_), Some(least)) if hulls.is_none() && Hulls::pay_off(scene, steps) => {
                        hulls = Hulls::new(scene, allowance).ok();
                        if hulls.is_some() {
                            queue.clear();
                            queue.push(Item { key: least, pair: [0; 2], version: closest.version });
                        }
                    }
                    _ => {}
                }
            }
            let Some(Item { key, pair, version }) = next.take().or_else(|| queue.pop()) else { break };
            if key > closest.upper_key || closest.upper == 0.0 {
                break;
            }
            if allowance.step().is_err() {
                // A pair of triangles is compared before the search, so that there is a best one.
                let Some(best) = closest.best else { return Found::Unclear };
                let least = queue.least_key().map_or(key, |other| other.min(key));
                return Found::Exhausted(closest.finished(best, f64::from(least)));
            }
            steps += 1;
            // The bound along the newest direction is cheap, and often much better than the one that was known.
            let is_newest = version == closest.version || version == PARTED;
            let newer = if is_newest { 0.0 } else { scene.bound_along(pair, &closest.along) };
            if newer > closest.upper_key {
                continue;
            }
            if newer > key {
                queue.push(Item { key: newer, pair, version: closest.version });
                continue;
            }
            let step = scene.step(pair);
            if let (Some(hulls), Some(best), Step::Expand { .. }) = (&mut hulls, &closest.best, &step)
                && version != PARTED
            {
                let best = Measure { upper: closest.upper, direction: best.distance.direction };
                match hulls.part(pair, best, steps, allowance) {
                    Ok(Parting::Beyond) => continue,
                    Ok(Parting::AtLeast(bound)) if bound > key => {
                        queue.push(Item { key: bound, pair, version: PARTED });
                        continue;
                    }
                    // The next step ends the search where the allowance ran out.
                    Ok(Parting::AtLeast(_)) | Err(Exhausted) => {}
                }
            }
            match step {
                Step::Expand { wide, node } => {
                    let wanted = Wanted {
                        along: &closest.along,
                        enough: closest.upper_key,
                        directions: if hulls.is_some() { Directions::OfEdges } else { Directions::Usual },
                    };
                    let bounds = scene.bounds::<L>((wide, node), pair[1 - wide], &wanted);
                    let mut least: Option<Item> = None;
                    for (lane, &bound) in bounds.used().iter().enumerate() {
                        // Also when the bound is not a number.
                        let bound = if bound > key { bound } else { key };
                        if bound > closest.upper_key {
                            continue;
                        }
                        let pair = child(pair, wide, node, lane);
                        let found = Item { key: bound, pair, version: closest.version };
                        match &mut least {
                            Some(so_far) if descending => {
                                let (keep, push) =
                                    if found.key < so_far.key { (found, *so_far) } else { (*so_far, found) };
                                *so_far = keep;
                                queue.push(push);
                            }
                            _ if descending => least = Some(found),
                            _ => queue.push(found),
                        }
                    }
                    next = least;
                }
                Step::Compare(triangles) => {
                    // On as long as it pays: each closer pair has a better direction for all that follow.
                    descending = closest.compare(triangles);
                }
            }
        }
        match closest.best {
            Some(best) => Found::Pair(closest.finished(best, f64::INFINITY)),
            None if closest.loose <= limit => Found::Unclear,
            None => Found::Beyond,
        }
    }
}
