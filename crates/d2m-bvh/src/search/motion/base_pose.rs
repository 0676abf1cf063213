//! The pose of a constant-twist motion at one time, accurate however far that time is from the reference time.

use super::local_motion::LocalMotion;
use glam::DVec3;

/// Columns of a 3×3 matrix.
pub(crate) type Columns = [DVec3; 3];

/// An unevaluated sum of two doubles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair(pub(crate) f64, pub(crate) f64);

pub(crate) fn two_sum(a: f64, b: f64) -> Pair {
    let s = a + b;
    let t = s - a;
    Pair(s, (a - (s - t)) + (b - t))
}

fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a; // 2²⁷ + 1
    let high = t - (t - a);
    (high, a - high)
}

fn two_product(a: f64, b: f64) -> Pair {
    let p = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Pair(p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Pair {
    /// The nearest double.
    pub(crate) const fn rounded(self) -> f64 {
        self.0
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let s = two_sum(self.0, other.0);
        two_sum(s.0, s.1 + (self.1 + other.1))
    }
    pub(crate) fn times(self, x: f64) -> Self {
        let p = two_product(self.0, x);
        two_sum(p.0, p.1 + self.1 * x)
    }
    fn mul(self, other: Self) -> Self {
        let p = two_product(self.0, other.0);
        two_sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

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

/// The rotation exp([ω](t − t_ref))·R(q/|q|) at an offset as columns; each entry within 16·2⁻⁵³ of the true one, for
/// an angle of less than 2⁵⁰ radians.
pub(crate) fn rotation_at(motion: &LocalMotion, offset: f64) -> Columns {
    let turning = motion.turning();
    let turn = turning.after(motion.elapsed(offset));
    turning.start().map(|p| turning.wheel(p).at(&turn))
}

/// What the rotation of a motion is at all times: a turn about a fixed axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    /// The orientation at the reference time.
    start: Columns,
    /// Unit vector; zero for a motion without rotation.
    axis: DVec3,
    /// |ω|.
    speed: Pair,
}

/// Sine and 1 − cosine of the angle that a motion has turned by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) sin: f64,
    pub(crate) versine: f64,
}

/// A vector p that turns about a unit axis k: p, k × p and k × (k × p) at the reference time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wheel {
    pub(crate) p: DVec3,
    pub(crate) across: DVec3,
    pub(crate) inward: DVec3,
}

impl Wheel {
    pub(crate) fn at(&self, turn: &Turn) -> DVec3 {
        self.p + self.across * turn.sin + self.inward * turn.versine
    }
}

impl Turning {
    /// From the orientation [x, y, z, w] at the reference time and the angular velocity.
    pub(crate) fn new(orientation: [f64; 4], omega: DVec3) -> Self {
        let (mut axis, mut speed) = (DVec3::ZERO, Pair(0.0, 0.0));
        let largest = omega.abs().max_element();
        if largest > 0.0 {
            // Divided by a power of two, so that no square over- or underflows.
            let unit = power_of_two_below(largest);
            let w = omega / unit;
            let square = two_product(w.x, w.x).add(two_product(w.y, w.y)).add(two_product(w.z, w.z));
            let root = square.0.sqrt();
            let rest = square.add({
                let p = two_product(root, root);
                Pair(-p.0, -p.1)
            });
            let length = two_sum(root, rest.0 / (2.0 * root));
            axis = w / length.0;
            speed = Pair(length.0 * unit, length.1 * unit);
        }
        Self { start: from_quaternion(orientation), axis, speed }
    }

    /// The columns of the orientation at the reference time.
    pub(crate) const fn start(&self) -> Columns {
        self.start
    }

    /// |ω|.
    pub(crate) const fn speed(&self) -> f64 {
        self.speed.0
    }

    /// ω/|ω|; zero for a motion without rotation.
    pub(crate) const fn axis(&self) -> DVec3 {
        self.axis
    }

    /// How a vector that is `p` at the reference time turns.
    pub(crate) fn wheel(&self, p: DVec3) -> Wheel {
        let across = self.axis.cross(p);
        Wheel { p, across, inward: self.axis.cross(across) }
    }

    /// After a time, counted from the reference time.
    pub(crate) fn after(&self, elapsed: Pair) -> Turn {
        if elapsed.0 == 0.0 || self.speed.0 == 0.0 {
            return Turn { sin: 0.0, versine: 0.0 };
        }
        let (sin, versine) = sin_versine(self.speed.mul(elapsed));
        Turn { sin, versine }
    }
}

/// The largest power of two that is not above a positive number; at least the least normal number.
fn power_of_two_below(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & (0x7ff << 52)).max(f64::MIN_POSITIVE)
}

/// The rotation of q/|q|, q = [x, y, z, w], scaled first so that no square overflows.
fn from_quaternion(q: [f64; 4]) -> Columns {
    let largest = q.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let [x, y, z, w] = q.map(|c| c / largest);
    let two = 2.0 / (x * x + y * y + z * z + w * w);
    let (xx, yy, zz) = (x * x * two, y * y * two, z * z * two);
    let (xy, xz, yz) = (x * y * two, x * z * two, y * z * two);
    let (wx, wy, wz) = (w * x * two, w * y * two, w * z * two);
    [
        DVec3::new(1.0 - (yy + zz), xy + wz, xz - wy),
        DVec3::new(xy - wz, 1.0 - (xx + zz), yz + wx),
        DVec3::new(xz + wy, yz - wx, 1.0 - (xx + yy)),
    ]
}

/// Sine and 1 − cosine of an angle given as a pair: reduced by multiples of π/2 with 2⁻¹⁶⁰ left out, then
/// Taylor polynomials whose remainders on |r| ≤ π/4 are below 2⁻⁵⁷.
fn sin_versine(angle: Pair) -> (f64, f64) {
    use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²: adding it rounds to an integer
    // π/2 less its double, and less that: the second and the third double of π/2.
    const HALF_PI_MIDDLE: f64 = 6.123_233_995_736_766e-17;
    const HALF_PI_LOW: f64 = -1.497_384_904_859_17e-33;
    let shifted = angle.0 * FRAC_2_PI + ROUND;
    let turns = shifted - ROUND;
    let reduced = angle
        .add(two_product(-turns, FRAC_PI_2))
        .add(two_product(-turns, HALF_PI_MIDDLE))
        .add(two_product(-turns, HALF_PI_LOW));
    let (x, y) = (reduced.0, reduced.1);
    let z = x * x;
    let mut odd = 1.0;
    for k in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        odd = 1.0 - odd * (z * (1.0 / (k * (k - 1.0))));
    }
    let mut even = 1.0;
    for k in [18.0, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0] {
        even = 1.0 - even * (z * (1.0 / (k * (k - 1.0))));
    }
    let versine = even * z * 0.5;
    let (sin, cos) = (x * odd + y * (1.0 - versine), 1.0 - (versine + x * y));
    match shifted.to_bits() & 3 {
        0 => (sin, versine + x * y),
        1 => (cos, 1.0 + sin),
        2 => (-sin, 1.0 + cos),
        _ => (-cos, 1.0 - sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use glam::DQuat;

    #[test]
    fn rotations_lie_in_the_enclosures_of_the_motion_crate() {
        let mut seed = 1u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
        };
        for round in 0..2000 {
            let q = DQuat::from_xyzw(next(), next(), next(), next());
            let w = DVec3::new(next(), next(), next()) * 10f64.powi(round % 5 - 2);
            let motion = ConstantTwist::try_new(DVec3::ZERO, q, DVec3::ZERO, w).unwrap();
            let t = next() * 10.0;
            let got = rotation_at(&LocalMotion::unscaled(&motion), t);
            let enclosure = motion.enclose_pose(d2m_interval::Interval::point(t)).rotation.cols();
            for (column, enclosed) in got.iter().zip(enclosure) {
                for (value, interval) in
                    [(column.x, enclosed.x), (column.y, enclosed.y), (column.z, enclosed.z)]
                {
                    assert!(value >= interval.lo() - 2e-15 && value <= interval.hi() + 2e-15);
                    assert!(
                        (value - interval.mid()).abs() < 16.0 / 9_007_199_254_740_992.0 + interval.width()
                    );
                }
            }
        }
    }

    #[test]
    fn far_times_lose_nothing() {
        let motion =
            ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, DVec3::ZERO, DVec3::new(0.0, 0.0, 3.0))
                .unwrap();
        // sin and cos of exactly 300000 radians.
        let got = rotation_at(&LocalMotion::unscaled(&motion), 100_000.0);
        let (sin, cos) = (0.107_063_649_413_132_36, -0.994_252_168_704_872_3);
        assert!((got[0].x - cos).abs() < 1e-14);
        assert!((got[0].y - sin).abs() < 1e-14);
        assert!((got[0].length() - 1.0).abs() < 1e-15);
    }
}
