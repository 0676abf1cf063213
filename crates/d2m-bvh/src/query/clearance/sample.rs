//! Pairs of triangles at single times: proven upper bounds of a clearance, and the way down to a local minimum.

use crate::moving::triangles_of;
use crate::{Moving, Posed, Window};
use d2m_feature::{TriangleDistance, TrianglesAt};
use d2m_mesh::at_rest::{Nearness, near_pair};
use d2m_mesh::margin::direction;
use glam::DVec3;

/// Parts of the window at whose ends the centers of the bodies are compared, and steps from the closest of them.
const FIRST_TIMES: u32 = 8;
const FIRST_STEPS: u32 = 4;
/// A first pair of triangles: a way down both trees and a few steps aside.
const FIRST_PAIR: Nearness = Nearness { steps: 32, slack: 0.0 };
/// The closest pair at a minimum: most searches are shorter.
const CLOSEST: Nearness = Nearness { steps: 1024, slack: 0.0 };
/// A pair on the way down to a minimum: that none is closer by little is most of what a search for the closest one does, and
/// is of no use before the time is.
const ON_THE_WAY: Nearness = Nearness { slack: 1.0 / 64.0, ..CLOSEST };
/// Alternations between the closest time of a pair and a close pair of a time.
const ALTERNATIONS: u32 = 24;
/// Descents, each from the closest pair of the time at which the one before ended.
const DESCENTS: u32 = 8;
/// Evaluations on the way to a pair's closest time.
const EVALUATIONS: u32 = 60;

/// Two triangles at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) time: f64,
    pub(super) triangles: [u32; 2],
    /// Proven: the meshes are within this of each other at the time.
    pub(super) upper: f64,
    /// How fast the distance of the two grows.
    pub(super) rate: f64,
    pub(super) near: TriangleDistance,
    pub(super) points: [DVec3; 2],
    /// They are proven to share a point.
    pub(super) crosses: bool,
}

impl Sample {
    /// Is the distance no more than what placing the triangles may be off by? Half or more of the bound is that then.
    pub(super) fn is_of_rounding(&self) -> bool {
        2.0 * self.near.upper <= self.upper
    }
}

/// The bodies and the window of a query.
#[derive(Clone, Copy)]
pub(super) struct Sampler<'a> {
    pub(super) bodies: [Moving<'a>; 2],
    pub(super) window: Window,
}

impl Sampler<'_> {
    /// Two triangles at a time of the window.
    pub(super) fn pair_at(&self, triangles: [u32; 2], time: f64) -> Sample {
        let placed = TrianglesAt::new(&triangles_of(&self.bodies, triangles), time);
        let near = placed.distance();
        let along = direction(near.point_b - near.point_a);
        Sample {
            time,
            triangles,
            upper: placed.bound_distance(&near),
            rate: -placed.closing_speed(&near, along),
            near,
            points: [placed.world(near.point_a), placed.world(near.point_b)],
            crosses: near.upper == 0.0 && placed.certainly_cross(),
        }
    }

    /// A close pair at a time.
    fn closest_at(&self, time: f64, first: Option<[u32; 2]>, wanted: Nearness) -> Sample {
        let [a, b] = self.bodies.map(|moving| Posed::new(moving.body, moving.motion.pose_and_twist(time).0));
        // Poses that a static query refuses have pairs too: any bounds the distance.
        let found = near_pair(a, b, first, wanted).ok().flatten().or(first).unwrap_or([0; 2]);
        self.pair_at(found, time)
    }

    /// A first upper bound: the closest pair of the time at which the bodies' centers are closest, followed down to a minimum.
    pub(super) fn first(&self, width: impl Fn(f64) -> f64) -> Sample {
        let time = self.time_of_centers();
        if self.is_an_end(time) {
            return self.settle_closest(self.closest_at(time, None, CLOSEST), &width);
        }
        self.settle(self.closest_at(time, None, FIRST_PAIR), width)
    }

    /// Bodies that are closest at an end of the window have their minimum there: what is sought there first is what is wanted.
    fn is_an_end(&self, time: f64) -> bool {
        time == self.window.start() || time == self.window.end()
    }

    /// About when the centers of the bodies are closest: the closest of a few times, and Gauss and Newton's steps from there.
    fn time_of_centers(&self) -> f64 {
        let (start, end) = (self.window.start(), self.window.end());
        let length = self.window.length();
        let (mut best, mut least) = (start, f64::INFINITY);
        for part in 0..=FIRST_TIMES {
            let time = (start + length * (f64::from(part) / f64::from(FIRST_TIMES))).min(end);
            let (apart, _) = self.centers(time);
            if apart.length_squared() < least {
                (best, least) = (time, apart.length_squared());
            }
        }
        for _ in 0..FIRST_STEPS {
            let (apart, speed) = self.centers(best);
            let time = (best - apart.dot(speed) / speed.length_squared()).clamp(start, end);
            if time.is_nan() || time == best || self.centers(time).0.length_squared() >= least {
                break;
            }
            (best, least) = (time, self.centers(time).0.length_squared());
        }
        best
    }

    /// The center of A from that of B, and how fast that changes.
    fn centers(&self, time: f64) -> (DVec3, DVec3) {
        let [(p, v), (q, w)] = self.bodies.map(|moving| {
            let (pose, twist) = moving.motion.pose_and_twist(time);
            let center = pose.transform_point(moving.body.center());
            (center, twist.velocity_of(center - pose.translation))
        });
        (p - q, v - w)
    }

    /// Follows a close pair of a time to a minimum, then the bodies to the closest pair of that time, until nothing comes closer by a
    /// part of the width that is wanted of an enclosure.
    pub(super) fn settle(&self, from: Sample, width: impl Fn(f64) -> f64) -> Sample {
        let at_once = self.is_an_end(from.time);
        let wanted = if at_once { CLOSEST } else { ON_THE_WAY };
        let best = closer(from, self.closest_at(from.time, Some(from.triangles), wanted));
        if at_once {
            return self.settle_closest(best, &width);
        }
        let lowest = self.descend(best, &width);
        let nearest = self.closest_at(lowest.time, Some(lowest.triangles), CLOSEST);
        let best = closer(lowest, nearest);
        if nearest.upper >= lowest.upper - wanted_of(&lowest, &width) {
            return best;
        }
        self.settle_closest(best, &width)
    }

    /// The same from the closest pair of a time.
    fn settle_closest(&self, from: Sample, width: impl Fn(f64) -> f64) -> Sample {
        let mut best = from;
        for _ in 0..DESCENTS {
            let lowest = self.descend(best, &width);
            if lowest.time == best.time {
                break;
            }
            let nearest = self.closest_at(lowest.time, Some(lowest.triangles), CLOSEST);
            let done = nearest.upper >= lowest.upper - wanted_of(&lowest, &width);
            best = closer(lowest, nearest);
            if done {
                break;
            }
        }
        best
    }

    /// Follows a pair to its closest time, then the bodies to a close pair of that time, until nothing comes closer by much. Where pair
    /// after pair comes closer the same way, steps are doubled.
    fn descend(&self, from: Sample, width: impl Fn(f64) -> f64) -> Sample {
        let mut best = from;
        let mut last = 0.0;
        for _ in 0..ALTERNATIONS {
            if best.near.upper == 0.0 {
                break;
            }
            let wanted = wanted_of(&best, &width);
            let lowest = self.closest_time(best, wanted);
            let step = lowest.time - best.time;
            let doubled =
                if step * last > 0.0 && (2.0 * last).abs() > step.abs() { 2.0 * last } else { step };
            if step == 0.0 {
                break;
            }
            let (start, end) = (self.window.start(), self.window.end());
            let far =
                self.closest_at((best.time + doubled).clamp(start, end), Some(lowest.triangles), ON_THE_WAY);
            let is_far = far.upper < best.upper - wanted;
            let next = if is_far || doubled == step {
                far
            } else {
                self.closest_at(lowest.time, Some(lowest.triangles), ON_THE_WAY)
            };
            let next = closer(lowest, next);
            last = next.time - best.time;
            let done = next.upper >= best.upper - wanted;
            best = closer(best, next);
            if done {
                break;
            }
        }
        best
    }

    /// A time at which the pair is locally closest, to `wanted`.
    fn closest_time(&self, from: Sample, wanted: f64) -> Sample {
        let downhill = -from.rate.signum();
        let end = if downhill > 0.0 { self.window.end() } else { self.window.start() };
        if from.near.upper == 0.0 || from.rate == 0.0 || from.rate.is_nan() || from.time == end {
            return from;
        }
        let at = |time: f64| self.pair_at(from.triangles, time);
        let mut low = from;
        let mut step = 0.5 * from.near.upper / from.rate.abs();
        for _ in 0..EVALUATIONS {
            let time = low.time + downhill * step;
            let beyond = (time - end) * downhill >= 0.0 || time.is_nan();
            let time = if beyond { end } else { time };
            if time == low.time {
                return low;
            }
            let next = at(time);
            let turned = next.rate * downhill >= 0.0 || next.near.upper >= low.near.upper;
            if turned {
                return self.between(low, next, wanted);
            }
            low = next;
            if beyond || low.near.upper == 0.0 {
                return low;
            }
            step *= 2.0;
        }
        low
    }

    /// The closest time between one at which the pair approaches and a later (or earlier) one by which it has turned.
    fn between(&self, mut low: Sample, mut high: Sample, wanted: f64) -> Sample {
        let mut best = closer(low, high);
        for evaluation in 0..EVALUATIONS {
            if best.near.upper == 0.0 {
                return best;
            }
            let span = high.time - low.time;
            // By secants of the rates, where they differ in sign; every third time the middle.
            let part = low.rate / (low.rate - high.rate);
            let part = if part > 0.0 && part < 1.0 && evaluation % 3 != 2 { part } else { 0.5 };
            let time = low.time + part.clamp(0.01, 0.99) * span;
            let gain =
                (low.rate.abs() * (time - low.time).abs()).min(high.rate.abs() * (high.time - time).abs());
            if time == low.time || time == high.time || gain <= 0.1 * wanted {
                return best;
            }
            let middle = self.pair_at(low.triangles, time);
            best = closer(best, middle);
            if middle.rate * span >= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        best
    }
}

/// What counts as closer: a part of the width that is wanted of an enclosure.
fn wanted_of(best: &Sample, width: impl Fn(f64) -> f64) -> f64 {
    0.1 * width(best.upper)
}

/// The closer one; the first of two that are equal. What is not a number is never closer.
pub(super) fn closer(a: Sample, b: Sample) -> Sample {
    if b.upper < a.upper || a.upper.is_nan() { b } else { a }
}
