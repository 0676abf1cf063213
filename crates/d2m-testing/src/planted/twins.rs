//! Metamorphic twins of planted contacts: lengths and times multiplied by powers of two.

use super::families::Planted;
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// Lengths alone, times alone, both; far beyond where products of three lengths over- or underflow.
pub const SCALES: [(i32, i32); 22] = [
    (1, 0),
    (127, 0),
    (130, 0),
    (-180, 0),
    (-250, 0),
    (333, 0),
    (600, 0),
    (-600, 0),
    (900, 0),
    (-900, 0),
    (0, 1),
    (0, -1),
    (0, 180),
    (0, -180),
    (0, 366),
    (0, -366),
    (0, 900),
    (0, -900),
    (-100, 100),
    (450, -450),
    (-450, 450),
    (300, 300),
];

/// `2ᵏ` for −1022 ≤ k ≤ 1023.
pub fn power(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// `x·2ᵏ`, `None` if that is neither zero nor a normal number.
pub fn scaled(x: f64, k: i32) -> Option<f64> {
    let half = k / 2;
    let there = (x * power(half)) * power(k - half);
    (there == 0.0 && x == 0.0 || there.is_normal()).then_some(there)
}

/// A point, `None` if a coordinate leaves the normal numbers.
pub fn scaled_point(p: DVec3, k: i32) -> Option<DVec3> {
    Some(DVec3::new(scaled(p.x, k)?, scaled(p.y, k)?, scaled(p.z, k)?))
}

fn scaled_motion(motion: &ConstantTwist, length: i32, time: i32) -> Option<ConstantTwist> {
    ConstantTwist::try_new(
        scaled_point(motion.position(), length)?,
        motion.orientation(),
        scaled_point(motion.linear_velocity(), length - time)?,
        scaled_point(motion.angular_velocity(), -time)?,
    )
    .ok()?
    .try_with_reference_time(scaled(motion.reference_time(), time)?)
    .ok()?
    .try_with_at(scaled_point(motion.at(), length)?)
    .ok()
}

/// The same contact with lengths times `2^length` and times times `2^time`.
pub fn scaled_query(query: &Planted, length: i32, time: i32) -> Option<Planted> {
    let point = |p: DVec3| scaled_point(p, length);
    Some(Planted {
        a: [point(query.a[0])?, point(query.a[1])?],
        b: [point(query.b[0])?, point(query.b[1])?, point(query.b[2])?],
        motion_a: scaled_motion(&query.motion_a, length, time)?,
        motion_b: scaled_motion(&query.motion_b, length, time)?,
        window: (scaled(query.window.0, time)?, scaled(query.window.1, time)?),
        time: scaled(query.time, time)?,
        ..query.clone()
    })
}
