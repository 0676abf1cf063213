//! Triangles that certainly stay near each other for a while.

mod curved;
mod straight;

use crate::units::Units;
use curved::CurvedPair;
use d2m_interval::Interval;
use d2m_lanes::UP;
use d2m_motion::{CertifiedState, Kinematics, RigidMotion};
use glam::DVec3;
use straight::StraightPair;

/// A triangle, and the motion of its body.
///
/// ```
/// use d2m_feature::{MovingTriangle, stay_within};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let resting = MovingTriangle { corners: [DVec3::ZERO, DVec3::X, DVec3::Y], motion: &ConstantTwist::REST };
/// assert!(stay_within(&[resting, resting], 0.0, 1.0, 1e-9)); // they are the same
/// ```
#[derive(Clone, Copy)]
pub struct MovingTriangle<'m> {
    /// Its corners, in the frame of the body.
    pub corners: [DVec3; 3],
    /// How the body moves.
    pub motion: &'m dyn RigidMotion,
}

impl core::fmt::Debug for MovingTriangle<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("MovingTriangle").field("corners", &self.corners).finish_non_exhaustive()
    }
}

/// Two triangles and their bodies in the middle of a span of time, about the place of B there, and their rates over all of it.
///
/// Units of time and of length are powers of two near the span and near the largest of the lengths, so that neither squares of slow motions
/// over long times nor lengths are lost to underflow. Scaling is exact, but for what underflows: less than the least normal number, and
/// of what it takes of an angular velocity, times a length, the rounding of that length is far more.
struct Middle {
    corners: [[DVec3; 3]; 2],
    states: [CertifiedState; 2],
    rates: [Kinematics; 2],
    /// Half of the span.
    half: f64,
    /// Of length, and of time.
    units: Units,
}

impl Middle {
    fn of(triangles: &[MovingTriangle<'_>; 2], from: f64, to: f64) -> Self {
        let middle = (from + 0.5 * (to - from)).clamp(from, to);
        let half = (to - middle).max(middle - from) * UP;
        let origin = triangles[1].motion.pose_and_twist(middle).0.translation;
        let span = Interval::new(from, to);
        let states = triangles.map(|triangle| triangle.motion.enclose_state_about(middle, origin));
        let largest = |triangle: &MovingTriangle<'_>| {
            triangle.corners.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()))
        };
        let size = largest(&triangles[0]).max(largest(&triangles[1]));
        let units = Units::of_states(&states, size, from, to);
        let rates = triangles.map(|triangle| units.kinematics(&triangle.motion.enclose_kinematics(span)));
        Self {
            corners: triangles.map(|triangle| units.points(triangle.corners)),
            states: states.each_ref().map(|state| units.state(state)),
            rates,
            half: units.time(half),
            units,
        }
    }
}

/// Proof that two triangles are within `level` of each other at every time from `from` to `to`, without a joint of their motions between;
/// false proves nothing, also of a span that ends before it begins. O(1): halve a span that is not proven.
///
/// An edge that passes through a triangle, two material points or a vertex above a face are shown to stay near, by states at the middle of the
/// span and bounds on accelerations; then points that wander on both triangles (docs/theory/questions.md, "Staying in contact").
///
/// ```
/// use d2m_feature::{MovingTriangle, stay_within};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let sliding = ConstantTwist::REST.with_position(DVec3::Z * 0.1).with_linear_velocity(DVec3::X * 0.5);
/// let triangles = [&ConstantTwist::REST, &sliding].map(|motion| MovingTriangle { corners, motion });
/// assert!(stay_within(&triangles, 0.0, 1.0, 0.1001) && !stay_within(&triangles, 0.0, 1.0, 0.0999));
/// ```
pub fn stay_within(triangles: &[MovingTriangle<'_>; 2], from: f64, to: f64, level: f64) -> bool {
    // What is no number is no span and no level.
    if !(from <= to && level >= 0.0) {
        return false;
    }
    let middle = Middle::of(triangles, from, to);
    let level = middle.units.length(level);
    StraightPair::new(&middle).stay_within(level) || to > from && CurvedPair::new(&middle).stay_within(level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::power_of_two;
    use d2m_motion::{ConstantTwist, Retimed};
    use d2m_testing::{Draw, KnuthRandom};

    /// Exact scalings of lengths and of times change no claim: also where the square of a rate of turning, times a length, is no number.
    #[test]
    fn claims_are_the_same_in_any_unit_of_length_and_of_time() {
        let mut random = KnuthRandom(616);
        let mut claims = 0;
        for round in 0..300 {
            let mut body = |up: f64| {
                let corners = [(); 3].map(|()| random.vector() * DVec3::new(1.0, 1.0, 0.1) + DVec3::Z * up);
                (corners, random.vector() * 0.1, random.vector() * [0.1, 1.0][round % 2])
            };
            let bodies = [body(0.0), body(0.3)];
            let found = |length: i32, time: i32| {
                let (meter, second) = (power_of_two(length), power_of_two(time));
                let motions = bodies.map(|(_, linear, angular)| {
                    ConstantTwist::REST
                        .with_linear_velocity(linear * (meter / second))
                        .with_angular_velocity(angular / second)
                });
                let triangles = [0, 1]
                    .map(|k| MovingTriangle { corners: bodies[k].0.map(|p| p * meter), motion: &motions[k] });
                let over =
                    [0.0, 0.3, 0.5, 0.8].map(|level| stay_within(&triangles, 0.0, second, level * meter));
                (over, stay_within(&triangles, second, second, 0.5 * meter))
            };
            let usual = found(0, 0);
            claims += usual.0.into_iter().map(u32::from).sum::<u32>();
            for (length, time) in [
                (0, 900),
                (0, -900),
                (-130, 480),
                (-100, 490),
                (150, -600),
                (100, 500),
                (-900, 0),
                (900, 0),
                (-900, -900),
                (900, 900),
                (-400, 500),
            ] {
                assert_eq!(found(length, time), usual, "round {round}: {length} {time}");
            }
        }
        assert!(claims > 100, "{claims}");
    }

    /// A velocity that is no number, over a time that is as long as numbers go.
    #[test]
    fn what_goes_by_less_than_the_least_number_does_not_stay() {
        let (meter, least, long) = (power_of_two(-133), power_of_two(-565), power_of_two(997));
        let corners = [DVec3::ZERO, DVec3::X * meter, DVec3::Y * meter];
        let slow = ConstantTwist::REST
            .with_position(DVec3::Z * (-3.0 * meter))
            .with_linear_velocity(DVec3::Z * (5.0 * least));
        let slower = Retimed::try_new(slow, least, 0.0).unwrap();
        // From a height of 0 to 2, at 1 in the middle.
        let motions: [&dyn RigidMotion; 2] = [&slower, &ConstantTwist::REST];
        let triangles = motions.map(|motion| MovingTriangle { corners, motion });
        assert!(!stay_within(&triangles, 0.6 * long, long, 1.1 * meter));
    }

    /// Triangles that cross are within no distance below zero, and nothing is known of times in reverse order, or that are none.
    #[test]
    fn what_is_no_span_or_no_level_is_not_proven() {
        let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        let upright = [DVec3::new(1.0, 1.0, -1.0), DVec3::ONE, DVec3::new(3.0, 3.0, 1.0)];
        let triangles =
            [floor, upright].map(|corners| MovingTriangle { corners, motion: &ConstantTwist::REST });
        assert!(stay_within(&triangles, 0.0, 1.0, 0.0) && stay_within(&triangles, 1.0, 1.0, 0.0));
        let [none, never] = [f64::NAN, f64::INFINITY];
        for (from, to, level) in [
            (0.0, 1.0, -1.0),
            (0.0, 1.0, none),
            (1.0, 0.0, 1.0),
            (none, 1.0, 1.0),
            (0.0, none, 1.0),
            (0.0, never, 1.0),
            (-never, never, 1.0),
            (-f64::MAX, f64::MAX, 1.0),
        ] {
            assert!(!stay_within(&triangles, from, to, level), "{from} {to} {level}");
        }
    }
}
