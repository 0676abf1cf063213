//! How the reference points of two bodies move past each other.

use super::local_motion::LocalMotion;
use super::pair::{Pair, two_sum};
use glam::DVec3;

/// How the reference point of one body moves against that of another: on a straight line, in pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Track {
    start: [Pair; 3],
    velocity: [Pair; 3],
}

impl Track {
    /// x_A − x_B of the reference points in use.
    pub(crate) fn new(a: &LocalMotion, b: &LocalMotion) -> Self {
        let shift = a.shift() - b.shift();
        let [x, y, z] = given_relative_position(a, b);
        let (v, w) = (a.linear_velocity(), b.linear_velocity());
        Self {
            start: [x.add(Pair(shift.x, 0.0)), y.add(Pair(shift.y, 0.0)), z.add(Pair(shift.z, 0.0))],
            velocity: [two_sum(v.x, -w.x), two_sum(v.y, -w.y), two_sum(v.z, -w.z)],
        }
    }

    /// At an offset, rounded once.
    pub(crate) fn at(&self, offset: f64) -> DVec3 {
        let [x, y, z] = self.start;
        if offset == 0.0 {
            return DVec3::new(x.0, y.0, z.0);
        }
        let one = |k: usize| self.start[k].add(self.velocity[k].times(offset)).0;
        DVec3::new(one(0), one(1), one(2))
    }
}

/// x_A − x_B of the given reference points at the start.
pub(crate) fn given_relative_position(a: &LocalMotion, b: &LocalMotion) -> [Pair; 3] {
    let (p, q) = (a.position(), b.position());
    let apart = [two_sum(p.x, -q.x), two_sum(p.y, -q.y), two_sum(p.z, -q.z)];
    let (since_a, since_b) = (a.elapsed_at_start(), b.elapsed_at_start());
    // Most motions state their pose at the start.
    if since_a.0 == 0.0 && since_b.0 == 0.0 {
        return apart;
    }
    let moved = |since: Pair, speed: f64| if since.0 == 0.0 { Pair(0.0, 0.0) } else { since.times(speed) };
    let one = |k: usize| {
        let both = moved(since_a, a.linear_velocity()[k]).add(moved(since_b, -b.linear_velocity()[k]));
        apart[k].add(both)
    };
    [one(0), one(1), one(2)]
}
