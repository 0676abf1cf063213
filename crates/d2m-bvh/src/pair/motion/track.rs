//! How the reference points of two bodies move past each other.

use super::local_motion::LocalMotion;
use core::ops::Mul;
use d2m_lanes::DoubleDouble;
use glam::DVec3;

/// How the reference point of one body moves against that of another: on a straight line, in pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Track {
    start: [DoubleDouble; 3],
    velocity: [DoubleDouble; 3],
}

impl Track {
    /// x_A − x_B of the reference points in use.
    pub(crate) fn new(a: &LocalMotion, b: &LocalMotion) -> Self {
        let shift = a.shift() - b.shift();
        let [x, y, z] = given_relative_position(a, b);
        let (v, w) = (a.linear_velocity(), b.linear_velocity());
        Self {
            start: [
                x.add_sloppily(DoubleDouble::new(shift.x, 0.0)),
                y.add_sloppily(DoubleDouble::new(shift.y, 0.0)),
                z.add_sloppily(DoubleDouble::new(shift.z, 0.0)),
            ],
            velocity: [
                DoubleDouble::from_sum(v.x, -w.x),
                DoubleDouble::from_sum(v.y, -w.y),
                DoubleDouble::from_sum(v.z, -w.z),
            ],
        }
    }

    /// At an offset, rounded once.
    pub(crate) fn at(&self, offset: f64) -> DVec3 {
        let [x, y, z] = self.start;
        if offset == 0.0 {
            return DVec3::new(x.hi, y.hi, z.hi);
        }
        let one = |k: usize| self.start[k].add_sloppily(self.velocity[k].mul(offset)).hi;
        DVec3::new(one(0), one(1), one(2))
    }
}

/// x_A − x_B of the given reference points at the start.
pub(crate) fn given_relative_position(a: &LocalMotion, b: &LocalMotion) -> [DoubleDouble; 3] {
    let (p, q) = (a.position(), b.position());
    let apart = [
        DoubleDouble::from_sum(p.x, -q.x),
        DoubleDouble::from_sum(p.y, -q.y),
        DoubleDouble::from_sum(p.z, -q.z),
    ];
    let (since_a, since_b) = (a.elapsed_at_start(), b.elapsed_at_start());
    // Most motions state their pose at the start.
    if since_a.hi == 0.0 && since_b.hi == 0.0 {
        return apart;
    }
    let moved = |since: DoubleDouble, speed: f64| {
        if since.hi == 0.0 { DoubleDouble::new(0.0, 0.0) } else { since.mul(speed) }
    };
    let one = |k: usize| {
        let both =
            moved(since_a, a.linear_velocity()[k]).add_sloppily(moved(since_b, -b.linear_velocity()[k]));
        apart[k].add_sloppily(both)
    };
    [one(0), one(1), one(2)]
}
