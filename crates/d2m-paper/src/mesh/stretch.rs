//! How finely the time domain is divided, and what rounding costs.

use super::Moving;
use crate::feature::RelativeMotion;
use d2m_interval::{Interval, IntervalVec3};

/// Largest coordinate and rate that a query accepts: its square is far from overflow.
const LARGEST: f64 = 1e60;

/// Are pose, twist and twist rate bounded over the window?
pub(crate) fn is_bounded(moving: &Moving<'_>, window: Interval) -> bool {
    let pose = moving.motion.enclose_pose(window);
    let (twist, rate) = (moving.motion.enclose_twist(window), moving.motion.enclose_twist_rate(window));
    let small = |v: IntervalVec3| [v.x, v.y, v.z].iter().all(|c| c.mag() <= LARGEST);
    small(pose.translation)
        && small(twist.linear)
        && small(twist.angular)
        && small(rate.linear)
        && small(rate.angular)
        && pose.rotation.rows().into_iter().all(small)
}

/// About the part of a body's radius by which one evaluation of the spheres' parabolas may be off.
///
/// Tuned on trials of spot/cow at relative speeds 4 and 512. Ten times more costs 1.4–2 times at speed 512 (leaf spheres
/// are expanded too early), ten times less 3 times at speed 4 (too many stretches).
const SLACK: f64 = 1.0 / 2048.0;

/// The longest stretch of time that is searched with one set of enclosures.
///
/// With relative acceleration A and speed V of points within the bodies' radius R, the lower parabola of s = |γ|² − r²
/// loses about A·R·h² + V·A·h³ over a stretch h, that is a distance of (A h²/2 + V A h³/2R). Each part is kept below
/// [`SLACK`]·R, the second below a tenth of it. This is a choice of speed, not of correctness.
pub(crate) fn longest(bodies: &[Moving<'_>; 2], window: Interval) -> f64 {
    let mut acceleration = 0.0;
    let mut speed = 0.0f64;
    let mut radius = 0.0f64;
    let twists = [0, 1].map(|i: usize| bodies[i].motion.enclose_twist(window));
    for (moving, twist) in bodies.iter().zip(&twists) {
        let sphere = moving.body.bounding_sphere();
        let at = moving.motion.enclose_pose(Interval::point(window.lo())).at;
        let reach = sphere.radius + (sphere.center - at).length();
        acceleration += moving.motion.bound_acceleration(window, reach);
        speed = speed.max(twist.angular.norm().hi() * reach);
        radius = radius.max(sphere.radius);
    }
    speed += (twists[0].linear - twists[1].linear).norm().hi();
    let by_acceleration = (2.0 * SLACK * radius / acceleration).sqrt();
    let by_speed = Interval::point(0.2 * SLACK * radius * radius / (acceleration * speed)).cbrt().lo();
    let longest = by_acceleration.min(by_speed);
    if longest > 0.0 { longest } else { f64::INFINITY }
}

/// Bounds what rounding hides of the relative placement at the ends of the window, as a distance at the body's reach.
pub(crate) fn bound_rounding(
    bodies: &[Moving<'_>; 2],
    relative: &RelativeMotion<'_>,
    window: Interval,
) -> f64 {
    let sphere = bodies[0].body.bounding_sphere();
    [window.lo(), window.hi()]
        .into_iter()
        .flat_map(|t| {
            let place = relative.placement(t);
            [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z].map(|axis| {
                let p = place.enclose_point(sphere.center + axis * sphere.radius);
                (p - p.mid()).norm().hi()
            })
        })
        .fold(0.0, f64::max)
}
