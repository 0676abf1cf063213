//! Ensure disjointness, take a step back (section V of the paper): certified, not hoped.

use super::Moving;
use super::distance::{ClosestPair, MeshDistance, enclose_distance};
use crate::feature::RelativeMotion;
use d2m_interval::Interval;
use glam::DVec3;

/// A time at which the bodies are certainly disjoint, with what separates them there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disjoint {
    pub(crate) time: f64,
    pub(crate) distance: MeshDistance,
    pub(crate) pair: ClosestPair,
}

/// The separation left at `lo`, in units of δ: at least the first, at most the second.
const BAND: [f64; 2] = [1.0, 3.0];
/// What the search aims for.
const AIM: f64 = 1.5;
/// Distances beyond this are not measured.
const CUTOFF: f64 = 64.0;
/// A halving of the double range takes fewer steps than this.
const MOST_STEPS: u32 = 400;

/// Finds a time of the span at which the distance of the meshes is certainly in \[δ, 3δ\].
///
/// The span ends at the certified lower end of the contact's bracket, called the root, so every time before it is free; it
/// starts at a time at which the distance exceeds δ. The distance is a continuous function of time, so a time with 2δ lies between, and
/// a secant step, or halving where that leaves the bracket, finds it. The paper steps back by δ/v_n instead, which is
/// unbounded for a grazing contact and measures nothing.
///
/// ```text
///  distance │╲
///        3δ ┼─╲──────
///           │  ╲ ← lo is taken here, and the distance measured there
///         δ ┼───╲────
///           └────┴─ root    t
/// ```
///
/// Where no double has a distance in the band (speeds above 1e6 scales per unit of time or so), the last time with a
/// larger distance is returned: disjoint all the same. `None` only if no time with a positive distance was found.
pub(crate) fn step_back(
    bodies: &[Moving<'_>; 2],
    relative: &RelativeMotion<'_>,
    span: Interval,
    closing_speed: f64,
    tolerance: f64,
) -> Option<Disjoint> {
    let (start, root) = (span.lo(), span.hi());
    let measure = |t: f64| {
        let place = relative.placement(t);
        enclose_distance(bodies[0].body, bodies[1].body, &place, CUTOFF * tolerance)
    };
    let speed = if closing_speed > 0.0 && closing_speed.is_finite() { closing_speed } else { 1.0 };
    // Distances: `near` below the band, `far` above it.
    let (mut near, mut near_distance) = (root, 0.0f64);
    let mut far: Option<(f64, f64)> = None;
    let mut stride = AIM * tolerance / speed;
    let mut time = (root - stride).clamp(start, root);
    let mut best: Option<Disjoint> = None;
    for step in 0..MOST_STEPS {
        let distance = measure(time);
        if distance.lower >= BAND[0] * tolerance {
            let better = best.is_none_or(|b| distance.upper.min(f64::MAX) < b.distance.upper);
            if let Some(pair) = distance.closest
                && better
            {
                best = Some(Disjoint { time, distance, pair });
            }
            if distance.upper <= BAND[1] * tolerance {
                break;
            }
            far = Some((time, distance.upper.min(CUTOFF * tolerance)));
        } else {
            near = time;
            near_distance = distance.lower;
        }
        let next = match far {
            Some((far_time, far_distance)) => {
                let share = (AIM * tolerance - near_distance) / (far_distance - near_distance);
                let secant = near + (far_time - near) * share;
                let inside = far_time < secant && secant < near;
                if inside && step % 3 != 2 && far_distance < CUTOFF * tolerance {
                    secant
                } else {
                    0.5 * far_time + 0.5 * near
                }
            }
            None if time <= start => break,
            None => {
                stride *= 4.0;
                (root - stride).max(start)
            }
        };
        if far.is_some_and(|(far_time, _)| next <= far_time || next >= near) {
            break;
        }
        time = next;
    }
    if best.is_none() {
        let time = far.map_or(start, |(t, _)| t);
        let place = relative.placement(time);
        let distance = enclose_distance(bodies[0].body, bodies[1].body, &place, f64::INFINITY);
        if distance.lower > 0.0 {
            best = distance.closest.map(|pair| Disjoint { time, distance, pair });
        }
    }
    best
}

/// About the relative velocity of the point at `point` (world) at time `t`: B's there minus A's there.
pub(crate) fn estimate_relative_velocity(bodies: &[Moving<'_>; 2], t: f64, point: DVec3) -> DVec3 {
    let velocity = |m: &Moving<'_>| {
        let (pose, twist) = m.motion.pose_and_twist(t);
        twist.velocity_of(point - pose.translation)
    };
    velocity(&bodies[1]) - velocity(&bodies[0])
}
