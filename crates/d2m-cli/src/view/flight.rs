//! Motions as the page takes them: one constant twist after the other.

use d2m::bvh::Window;
use d2m::motion::{AnyMotion, ConstantTwist, RigidMotion};
use serde_json::{Value, json};

/// Pieces of equal length that stand for a window of a motion without constant twists (a link of an arm).
const PIECES: u32 = 2000;

/// A constant twist from `start` to `end`.
#[derive(Debug, Clone)]
pub(crate) struct Flight {
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) motion: ConstantTwist,
}

impl Flight {
    /// As the page reads it: `[t0, t1, t_ref, at, x, q, v, w]`.
    pub(super) fn to_json(&self) -> Value {
        let Self { start, end, motion } = self;
        let q = motion.orientation();
        json!([
            start,
            end,
            motion.reference_time(),
            motion.at().to_array(),
            motion.position().to_array(),
            [q.w, q.x, q.y, q.z],
            motion.linear_velocity().to_array(),
            motion.angular_velocity().to_array(),
        ])
    }
}

/// The flights of a motion over a window, to look at: pieces of a smooth motion fly on from where they start.
pub(crate) fn flights_of(motion: &AnyMotion, window: Window) -> Vec<Flight> {
    let mut flights = Vec::new();
    let mut start = window.start();
    while let Some(piece) = motion.constant_twist_from(start) {
        let end = piece.until.map_or(window.end(), |until| until.min(window.end()));
        flights.push(Flight { start, end, motion: piece.motion });
        if end >= window.end() || end <= start {
            return flights;
        }
        start = end;
    }
    let rest = window.end() - start;
    let time = |k: u32| start + rest * (f64::from(k) / f64::from(PIECES));
    for k in 0..PIECES {
        let (pose, twist) = motion.pose_and_twist(time(k));
        let straight = ConstantTwist::try_new(pose.translation, pose.rotation, twist.linear, twist.angular)
            .and_then(|motion| motion.try_with_at(pose.at)?.try_with_reference_time(time(k)));
        // A motion that is not finite here has been refused by the query, or is not shown.
        if let Ok(motion) = straight {
            flights.push(Flight { start: time(k), end: time(k + 1), motion });
        }
    }
    flights
}
