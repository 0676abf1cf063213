//! First contact under any [`RigidMotion`](d2m_motion::RigidMotion): conservative advancement on certified distances.
//!
//! At a time t the bodies are at least d apart (static distance of the poses as computed, less what the enclosures of
//! the true poses leave open). No point moves faster against a point of the other body than
//! V = |v_A − v_B| + |ω_A|ρ_A + |ω_B|ρ_B, with twists enclosed over [t, t + h] and ρ the reach of a body from its
//! followed point. So until t + min(h, (d − level)/V) the bodies stay further apart than the level.

use super::contact::{Contact, StartState, TimeOfContact};
use super::distance::{Distance, distance};
use crate::{Evidence, Moving, Posed, QueryError, QueryOptions, Solid, Window};
use d2m_feature::FeaturePair;
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{Pose, Twist};
use glam::DVec3;
use std::time::Instant;

/// Node tests that one static distance counts for in a budget.
const TESTS_PER_DISTANCE: u64 = 256;
/// Most static distances of one query without a budget.
const MOST_DISTANCES: u64 = 1 << 18;

/// Distance of the bodies at one time, with what the poses leave open.
struct Look {
    distance: Distance,
    lower: f64,
    upper: f64,
    /// How far the true poses may be from those of the distance, both bodies together.
    open: f64,
    twists: [Twist; 2],
    poses: [Pose; 2],
}

/// The query; bad options were refused before.
pub(super) fn time_of_contact(
    bodies: [Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
) -> Result<TimeOfContact, QueryError> {
    let reach = bodies.map(|m| {
        let at = m.motion.pose_and_twist(window.start()).0.at;
        (m.body.radius() + (m.body.center() - at).length()) * (1.0 + 1e-15)
    });
    let tolerance = options.tolerance.unwrap_or(1e-10 * bodies[0].body.radius().max(bodies[1].body.radius()));
    let level = options.min_separation + tolerance;
    let most = options.budget.node_tests.map_or(MOST_DISTANCES, |tests| tests / TESTS_PER_DISTANCE);
    let deadline = options.budget.wall_clock.and_then(|time| Instant::now().checked_add(time));
    let (mut t, mut step, mut taken) = (window.start(), window.length(), 0);
    loop {
        if taken >= most || deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            return Ok(TimeOfContact::Undecided { clear_until: t });
        }
        taken += 1;
        let look = look(&bodies, reach, t, options)?;
        let at_start = t == window.start();
        let error = look.upper - look.lower;
        if at_start && (look.distance.state != StartState::Apart || look.lower <= level + tolerance) {
            let state = if look.distance.state == StartState::Apart {
                StartState::Touching
            } else {
                look.distance.state
            };
            let evidence = evidence(&bodies, &look, level)?;
            let meeting = Meeting { time: t, evidence };
            return Ok(TimeOfContact::Contact(describe(&bodies, &look, (t, meeting), tolerance, state)));
        }
        if look.lower <= level + tolerance + error {
            let meeting = reached_by(&bodies, reach, &look, (t, window.end()), (options, level))?;
            return Ok(TimeOfContact::Contact(describe(
                &bodies,
                &look,
                (t, meeting),
                tolerance,
                StartState::Apart,
            )));
        }
        if t >= window.end() {
            return Ok(TimeOfContact::Separated);
        }
        // Twists over a span about as long as the step that comes out.
        let mut until = (t + 2.0 * step).min(window.end()).max(t.next_up());
        let mut free = advance(&bodies, reach, (t, until), look.lower - level);
        while free < 0.25 * (until - t) && until > t.next_up() {
            until = (t + 2.0 * free).min(until).max(t.next_up());
            free = advance(&bodies, reach, (t, until), look.lower - level);
        }
        step = free;
        let next = if free >= until - t { until } else { (t + free).next_down().min(until) };
        if free == 0.0 {
            // The enclosures bound no speed (infinite, not a number): nothing can be promised beyond this time.
            return Ok(TimeOfContact::Undecided { clear_until: t });
        }
        if next <= t {
            // The time left is below the resolution of time itself.
            let meeting = match evidence(&bodies, &self::look(&bodies, reach, until, options)?, level)? {
                Evidence::Early => Meeting { time: t, evidence: Evidence::Early },
                evidence => Meeting { time: until, evidence },
            };
            return Ok(TimeOfContact::Contact(describe(
                &bodies,
                &look,
                (t, meeting),
                tolerance,
                StartState::Apart,
            )));
        }
        t = next;
    }
}

/// How long, at most to the end of the span, a gap of `room` cannot close.
fn advance(bodies: &[Moving<'_>; 2], reach: [f64; 2], (from, to): (f64, f64), room: f64) -> f64 {
    let span = Interval::new(from, to);
    let [a, b] = [0, 1].map(|k| bodies[k].motion.enclose_twist(span));
    let spin = a.angular.norm() * Interval::point(reach[0]) + b.angular.norm() * Interval::point(reach[1]);
    let speed = ((a.linear - b.linear).norm() + spin).hi();
    let length = to - from;
    // Not a number or infinite speed: no progress, which ends as undecided or at the resolution of time.
    if speed * length * (1.0 + 1e-14) < room {
        length
    } else {
        let free = room / speed * (1.0 - 1e-14);
        if free.is_nan() { 0.0 } else { free.min(length) }
    }
}

fn look(
    bodies: &[Moving<'_>; 2],
    reach: [f64; 2],
    t: f64,
    options: &QueryOptions,
) -> Result<Look, QueryError> {
    let state = bodies.map(|m| m.motion.pose_and_twist(t));
    let poses = state.map(|(pose, _)| pose);
    let mut open = 0.0;
    for k in 0..2 {
        let truth = bodies[k].motion.enclose_pose(Interval::point(t));
        let turned = IntervalMat3::from_quat_normalized(poses[k].rotation).cols();
        let columns = truth.rotation.cols();
        let turn: Interval = [0, 1, 2].map(|i| (columns[i] - turned[i]).norm_squared()).into_iter().sum_up();
        let shift = (truth.translation - IntervalVec3::point(poses[k].translation)).norm();
        open += (shift + turn.sqrt() * Interval::point(reach[k])).hi();
    }
    if !open.is_finite() {
        return Err(QueryError::BadMotion { body: usize::from(poses[0].translation.is_finite()) });
    }
    let found =
        distance(Posed::new(bodies[0].body, poses[0]), Posed::new(bodies[1].body, poses[1]), options.solid)?;
    Ok(Look {
        open,
        lower: found.lower - open * (1.0 + 1e-15),
        upper: found.upper + open * (1.0 + 1e-15),
        distance: found,
        twists: state.map(|(_, twist)| twist),
        poses,
    })
}

/// Sum of three intervals.
trait SumUp {
    fn sum_up(self) -> Interval;
}

impl<I: Iterator<Item = Interval>> SumUp for I {
    fn sum_up(self) -> Interval {
        self.fold(Interval::ZERO, |sum, x| sum + x)
    }
}

/// What is proven of the meeting, and for a time not after which one.
#[derive(Clone, Copy)]
struct Meeting {
    time: f64,
    evidence: Evidence,
}

/// What is proven of the meeting at the time of the look.
fn evidence(bodies: &[Moving<'_>; 2], look: &Look, level: f64) -> Result<Evidence, QueryError> {
    if look.distance.state == StartState::Contained {
        // Moving from the poses of the distance to the true ones brings no surface to the other one.
        let [a, b] = [0, 1].map(|k| Posed::new(bodies[k].body, look.poses[k]));
        let surfaces = distance(a, b, Solid::Surface)?;
        if surfaces.lower > look.open {
            return Ok(Evidence::Crossing);
        }
    }
    Ok(if look.upper <= level { Evidence::Near } else { Evidence::Early })
}

/// A time by which something is proven of the meeting; `from` when a few tries find none.
fn reached_by(
    bodies: &[Moving<'_>; 2],
    reach: [f64; 2],
    at: &Look,
    (from, end): (f64, f64),
    (options, level): (&QueryOptions, f64),
) -> Result<Meeting, QueryError> {
    let target = options.min_separation + 0.5 * (level - options.min_separation);
    let (mut t, mut upper, mut closing) = (from, at.upper, closing_speed(at));
    let mut shown = evidence(bodies, at, level)?;
    for _ in 0..6 {
        let passed = closing.is_nan() || closing <= 0.0 || t >= end;
        if shown > Evidence::Early || passed {
            break;
        }
        t = (t + (upper - target) / closing).max(t.next_up()).min(end);
        let look = look(bodies, reach, t, options)?;
        shown = evidence(bodies, &look, level)?;
        if look.distance.state != StartState::Apart {
            break;
        }
        (upper, closing) = (look.upper, closing_speed(&look));
    }
    Ok(Meeting { time: if shown > Evidence::Early { t } else { from }, evidence: shown })
}

fn closing_speed(look: &Look) -> f64 {
    let at = |k: usize, p: DVec3| look.twists[k].velocity_of(p - look.poses[k].translation);
    (at(0, look.distance.point_a) - at(1, look.distance.point_b)).dot(look.distance.normal)
}

fn describe(
    bodies: &[Moving<'_>; 2],
    look: &Look,
    (time_lo, meeting): (f64, Meeting),
    tolerance: f64,
    start: StartState,
) -> Contact {
    let found = &look.distance;
    let triangles = [found.triangle_a, found.triangle_b];
    let corners = [0, 1].map(|k| bodies[k].body.mesh().triangles()[triangles[k] as usize]);
    Contact {
        time_lo,
        time_hi: meeting.time,
        evidence: meeting.evidence,
        separation: if start == StartState::Overlapping || start == StartState::Contained {
            0.0
        } else {
            look.upper
        },
        tolerance,
        normal: found.normal,
        point_a: found.point_a,
        point_b: found.point_b,
        feature: feature(corners, triangles, [found.barycentric_a, found.barycentric_b]),
        triangle_a: triangles[0],
        triangle_b: triangles[1],
        barycentric_a: found.barycentric_a,
        barycentric_b: found.barycentric_b,
        closing_speed: closing_speed(look),
        start,
    }
}

/// The features that hold the witness points, by the weights that are zero.
fn feature(corners: [[u32; 3]; 2], triangles: [u32; 2], weights: [[f64; 3]; 2]) -> FeaturePair {
    let corner = |k: usize| (0..3).find(|&i| weights[k][i] == 1.0);
    let edge = |k: usize| {
        let opposite = (0..3).find(|&i| weights[k][i] == 0.0)?;
        let (p, q) = (corners[k][(opposite + 1) % 3], corners[k][(opposite + 2) % 3]);
        Some([p.min(q), p.max(q)])
    };
    if let Some(i) = corner(0) {
        return FeaturePair::VertexFace { vertex: corners[0][i], face: triangles[1] };
    }
    if let Some(j) = corner(1) {
        return FeaturePair::FaceVertex { face: triangles[0], vertex: corners[1][j] };
    }
    if let (Some(edge_a), Some(edge_b)) = (edge(0), edge(1)) {
        return FeaturePair::EdgeEdge { edge_a, edge_b };
    }
    // Faces that cross, or rounding of a weight: the heaviest corner of A.
    let heaviest = (0..3).max_by(|&i, &j| weights[0][i].total_cmp(&weights[0][j])).unwrap_or(0);
    FeaturePair::VertexFace { vertex: corners[0][heaviest], face: triangles[1] }
}
