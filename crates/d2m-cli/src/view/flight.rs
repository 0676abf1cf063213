//! Motions as the page takes them: one constant twist after the other.

use d2m::bvh::Window;
use d2m::motion::{ConstantTwist, RigidMotion};

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
    /// As the page reads it: t0, t1, t_ref, at, x, q (w first), v, w.
    pub(super) fn numbers(&self) -> [f64; 19] {
        let Self { start, end, motion } = self;
        let q = motion.orientation();
        let [at, x] = [motion.at(), motion.position()].map(|p| p.to_array());
        let [v, w] = [motion.linear_velocity(), motion.angular_velocity()].map(|p| p.to_array());
        let t = motion.reference_time();
        [
            *start, *end, t, at[0], at[1], at[2], x[0], x[1], x[2], q.w, q.x, q.y, q.z, v[0], v[1], v[2],
            w[0], w[1], w[2],
        ]
    }

    /// Does the flight, if it went on, bring each point within `reach` of the reference point to where the other one has it,
    /// up to a distance, at both ends of the other? Rounded: it decides what is drawn.
    fn stands_for(&self, other: &Self, reach: f64, distance: f64) -> bool {
        [other.start, other.end].into_iter().all(|t| {
            let [(p, _), (q, _)] = [&self.motion, &other.motion].map(|motion| motion.pose_and_twist(t));
            let shift = (p.translation - q.translation).length();
            // Unit quaternions that differ by d turn by about 2·|d|.
            let [a, b] = [p.rotation, q.rotation];
            let turn = 2.0 * (a - b).length().min((a + b).length());
            shift + turn * reach <= distance
        })
    }
}

/// Adds a flight, or lets the last one stand for it where nobody could see the difference.
pub(crate) fn push_thinned(flights: &mut Vec<Flight>, flight: Flight, reach: f64) {
    /// Part of a body's size that no screen shows.
    const UNSEEN: f64 = 1e-4;
    match flights.last_mut() {
        Some(last) if last.end == flight.start && last.stands_for(&flight, reach, UNSEEN * reach) => {
            last.end = flight.end;
        }
        _ => flights.push(flight),
    }
}

/// The flights of a motion over a window, to look at: pieces of a smooth motion fly on from where they start.
pub(crate) fn flights_of(motion: &dyn RigidMotion, window: Window) -> Vec<Flight> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn what_nobody_sees_is_left_out_and_what_is_seen_stays() {
        let flight = |start: f64, x: f64, v: f64| Flight {
            start,
            end: start + 1.0,
            motion: ConstantTwist::REST
                .with_position(DVec3::X * x)
                .with_linear_velocity(DVec3::X * v)
                .with_reference_time(start),
        };
        let mut flights = Vec::new();
        // A body that rests with a shiver, then leaves.
        for k in 0..50 {
            push_thinned(&mut flights, flight(f64::from(k), 1e-6 * f64::from(k % 2), 0.0), 1.0);
        }
        assert_eq!((flights.len(), flights[0].end), (1, 50.0));
        push_thinned(&mut flights, flight(50.0, 0.0, 0.01), 1.0);
        assert_eq!(flights.len(), 2);
        // A creep that no single step shows is not lost: it is measured from what stands for it.
        for k in 0..1000 {
            push_thinned(&mut flights, flight(51.0 + f64::from(k), 0.01 + 1e-6 * f64::from(k), 0.0), 1.0);
        }
        let last = flights.last().unwrap();
        let shown = last.motion.position().x;
        assert!(
            (shown - 0.01 - 1e-6 * 999.0).abs() <= 1.1e-4 && flights.len() > 8,
            "{shown} {}",
            flights.len()
        );
    }
}
