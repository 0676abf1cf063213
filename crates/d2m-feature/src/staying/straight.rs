//! How long do bodies certainly stay within a distance of each other?
//!
//! At the middle of a span of time every vertex has a place and a velocity, and leaves the straight line of both by at most ½ h² times
//! its acceleration. Three certificates follow for two triangles over the whole span, each with that error and those of placing:
//! an edge passes through a triangle by more than anything moves; two material points part by their relative velocity; a vertex stays
//! within a height of a face, above its inside, while it slides along it. docs/theory/questions.md, "Staying in contact".

use super::Middle;
use crate::{proven_crossing, triangle_distance};
use d2m_lanes::{UP, power_of_two_below};
use d2m_motion::length;
use glam::DVec3;

/// Placing a corner rounds by less than 16u of the lengths of a difference, a product with a matrix and a sum, and its velocity by as much.
const PLACED: f64 = 8.0 * f64::EPSILON;
/// Products of up to five factors and sums of up to twelve such products round by less than this part of the sum of magnitudes.
const PRODUCTS: f64 = 32.0 * f64::EPSILON;

/// Underflow takes 2⁻¹⁰⁷⁵ of a product or less; fewer than 2¹⁰ of these, each times at most 2⁸ (four lengths and more
/// below four), are no more than this.
const LOST: f64 = f64::MIN_POSITIVE;

/// A point that moves straight.
#[derive(Clone, Copy, Debug)]
struct Line {
    place: DVec3,
    velocity: DVec3,
}

impl core::ops::Sub for Line {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { place: self.place - other.place, velocity: self.velocity - other.velocity }
    }
}

impl Line {
    /// In a unit of length that is a power of two: exact, but for less than the least number.
    fn scaled(self, length: f64) -> Self {
        Self { place: self.place / length, velocity: self.velocity / length }
    }

    /// Its largest distance from the origin within `half` of the middle.
    fn reach(&self, half: f64) -> f64 {
        (length(self.place) + half * length(self.velocity)) * UP
    }
}

fn weighted(lines: &[Line; 3], [u, v, w]: [f64; 3]) -> Line {
    let sum = |[p, q, r]: [DVec3; 3]| p * u + q * v + r * w;
    Line { place: sum(lines.map(|line| line.place)), velocity: sum(lines.map(|line| line.velocity)) }
}

/// Two triangles over a span of time.
pub(super) struct StraightPair {
    corners: [[Line; 3]; 2],
    half: f64,
    /// How much further apart or nearer a point of the one and a point of the other may be than their lines.
    error: f64,
}

impl StraightPair {
    /// The span has no joint of the motions inside of it. Where the motions' enclosures know nothing the error is infinite.
    pub(super) fn new(middle: &Middle) -> Self {
        let Middle { corners: given, states, rates, half, .. } = middle;
        let half = *half;
        let bent = |rate: f64| 0.5 * half * half * rate;
        let mut error = bent((rates[0].linear_rate - rates[1].linear_rate).bound_length()) * UP;
        let mut corners = [[Line { place: DVec3::ZERO, velocity: DVec3::ZERO }; 3]; 2];
        for k in 0..2 {
            let (state, turn_rate) = (&states[k], rates[k].angular_rate.bound_length());
            let far = given[k].iter().map(|&p| length(p - state.at)).fold(0.0, f64::max) * UP;
            // At one time nothing turns, however fast it does.
            let turned = half * (length(state.angular) + state.angular_radius + half * turn_rate);
            let bend = (bent(turn_rate) + 0.5 * turned * turned) * far;
            let gone = half * length(state.linear) + turned * far;
            let placed = state.position_radius
                + state.rotation_radius * far
                + PLACED * (far + length(state.position))
                + half * (state.linear_radius + state.angular_radius * far)
                + (turned * (state.rotation_radius * far) + PLACED * gone);
            error += (placed + bend) * UP + f64::MIN_POSITIVE;
            corners[k] = given[k].map(|p| {
                let arm = state.rotation * (p - state.at);
                Line { place: arm + state.position, velocity: state.linear + state.angular.cross(arm) }
            });
        }
        Self { corners, half, error: error * UP }
    }

    /// Proof that the triangles are within `level` of each other at every time of the span; false proves nothing.
    pub(super) fn stay_within(&self, level: f64) -> bool {
        // What is not a number is no proof.
        let level = level - self.error;
        self.error < f64::INFINITY
            && (self.crosses_on() || level >= 0.0 && (self.points_stay(level) || self.vertices_stay(level)))
    }

    fn crosses_on(&self) -> bool {
        let [a, b] = &self.corners;
        // Seen from a point that moves with B.
        let base = (b[0].velocity + b[1].velocity + b[2].velocity) / 3.0;
        let moved = |lines: &[Line; 3]| {
            lines.iter().map(|line| length(line.velocity - base)).fold(0.0, f64::max) * self.half
        };
        let blur = (moved(a).max(moved(b)) * UP + self.error) * UP;
        let places = |lines: &[Line; 3]| lines.map(|line| line.place);
        proven_crossing(&places(a), &places(b), blur)
    }

    /// Two material points, the closest ones of the middle.
    fn points_stay(&self, level: f64) -> bool {
        // From a corner of B; the weights are rounded, and so are the points that they stand for.
        let base = self.corners[1][0];
        let [a, b] = self.corners.map(|lines| lines.map(|line| line - base));
        let near = triangle_distance(&a.map(|line| line.place), &b.map(|line| line.place));
        if near.upper > level {
            return false;
        }
        let apart = weighted(&a, near.barycentric_a) - weighted(&b, near.barycentric_b);
        let furthest = a.iter().chain(&b).map(|line| line.reach(self.half)).fold(0.0, f64::max);
        (apart.reach(self.half) + PRODUCTS * furthest) * UP <= level
    }

    /// Some vertex of the one stays above the inside of the other, within the level of its plane.
    fn vertices_stay(&self, level: f64) -> bool {
        let [a, b] = &self.corners;
        a.iter().any(|vertex| self.slides(*vertex, b, level))
            || b.iter().any(|vertex| self.slides(*vertex, a, level))
    }

    /// With d = p − q₀, e = q₁ − q₀, f = q₂ − q₀ and N = e × f, all linear or quadratic in time: the height is d·N/|N|, and the foot is
    /// inside where N·(d × f), N·(e × d) and what they leave of N·N are not negative.
    ///
    /// Of four lengths below 10⁻⁸¹ the product is none: all are taken in a unit in which the longest is from one to two. What underflow
    /// takes of products there is less than [`LOST`], which is no part of what is claimed.
    fn slides(&self, vertex: Line, face: &[Line; 3], level: f64) -> bool {
        let lines = [vertex - face[0], face[1] - face[0], face[2] - face[0]];
        let longest = lines.iter().map(|line| line.reach(self.half)).fold(self.error, f64::max);
        let unit = power_of_two_below(longest);
        let [d, e, f] = lines.map(|line| line.scaled(unit));
        let (h, level, error) = (self.half, level / unit, self.error / unit);
        let [n0, n1, n2] = [
            e.place.cross(f.place),
            e.velocity.cross(f.place) + e.place.cross(f.velocity),
            e.velocity.cross(f.velocity),
        ];
        let magnitude = e.reach(h) * f.reach(h);
        let turned = (length(n1) + length(n2) * h) * h + PRODUCTS * magnitude;
        let least = length(n0) - turned;
        let c = [
            d.place.dot(n0),
            d.velocity.dot(n0) + d.place.dot(n1),
            d.velocity.dot(n1) + d.place.dot(n2),
            d.velocity.dot(n2),
        ];
        let height = c[0].abs() + (c[1].abs() + (c[2].abs() + c[3].abs() * h) * h) * h;
        let height = height + PRODUCTS * magnitude * (d.reach(h) + error) + LOST;
        // Also where something is not a number.
        if !(least > 0.0 && height * UP <= level * least) {
            return false;
        }
        let most = length(n0) + turned;
        let product = |x: Line| most * x.reach(h) * (d.reach(h) + error);
        let known = |x: Line| length(n0) * length(x.place) * length(d.place);
        let slack = |x: Line| (product(x) - known(x)) + PRODUCTS * product(x) + LOST;
        let [towards_e, towards_f] = [n0.dot(d.place.cross(f.place)), n0.dot(e.place.cross(d.place))];
        let (loss_e, loss_f) = (slack(f), slack(e));
        towards_e >= loss_e
            && towards_f >= loss_f
            && least * least - towards_e - towards_f - loss_e - loss_f - PRODUCTS * most * most >= LOST
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::power_of_two;
    use d2m_testing::{Draw, KnuthRandom};

    /// Triangles whose vertices move straight, each its own way: where a certificate says that they stay within a level, samples do.
    #[test]
    fn what_stays_within_a_level_is_never_sampled_beyond() {
        let mut random = KnuthRandom(271);
        let mut claims = [0; 2];
        for round in 0..4000 {
            let half = [0.05, 0.3, 1.0][round % 3];
            let mut line = |up: f64| Line {
                place: random.vector() * DVec3::new(1.0, 1.0, 0.1) + DVec3::Z * up,
                velocity: random.vector(),
            };
            let corners = [[(); 3].map(|()| line(0.0)), [(); 3].map(|()| line(0.5))];
            let pair = StraightPair { corners, half, error: 0.0 };
            let distance = |s: f64| {
                let [a, b] = pair.corners.map(|lines| lines.map(|line| line.place + line.velocity * s));
                triangle_distance(&a, &b)
            };
            let ends = distance(-half).upper.max(distance(half).upper);
            for level in [ends * 1.001, ends * 1.05, ends + 0.5 * half] {
                let found = [pair.points_stay(level), pair.vertices_stay(level)];
                if !found.contains(&true) {
                    continue;
                }
                for (claim, found) in claims.iter_mut().zip(found) {
                    *claim += u32::from(found);
                }
                for k in 0..=40 {
                    let time = half * (f64::from(k) / 20.0 - 1.0);
                    assert!(distance(time).lower <= level, "round {round}: {found:?} {level} at {time}");
                }
            }
        }
        assert!(claims.iter().all(|count| *count > 5), "{claims:?}");
    }

    /// Exact scalings of lengths change no claim, as long as lengths are numbers.
    #[test]
    fn claims_are_the_same_in_any_unit() {
        let mut random = KnuthRandom(272);
        let mut claims = 0;
        for round in 0..3000 {
            let mut line = |up: f64| Line {
                place: random.vector() * DVec3::new(1.0, 1.0, 0.1) + DVec3::Z * up,
                velocity: random.vector() * 0.01,
            };
            let corners = [[(); 3].map(|()| line(0.0)), [(); 3].map(|()| line(0.3))];
            let level = [0.3, 0.5, 0.8][round % 3];
            let found = |length: i32| {
                let unit = power_of_two(length);
                let moved = |line: Line| Line { place: line.place * unit, velocity: line.velocity * unit };
                let corners = corners.map(|lines| lines.map(moved));
                let pair = StraightPair { corners, half: 1.5, error: 0.0 };
                [pair.points_stay(level * unit), pair.vertices_stay(level * unit)]
            };
            let usual = found(0);
            claims += u32::from(usual[1]);
            for length in [-270, -300, -340, -500, 190, 300] {
                assert_eq!(found(length), usual, "round {round}: {length}");
            }
        }
        assert!(claims > 20, "{claims}");
    }

    /// Needles that cross, of which a crossing point is found up to some 1e-8 of their length: what turns about that point parts where they
    /// cross.
    #[test]
    fn points_that_stay_are_as_far_apart_as_their_weights_say() {
        let mut random = KnuthRandom(273);
        let mut parted = 0;
        for _ in 0..3000 {
            let mut needle = || {
                let (p, q) = (random.vector(), random.vector());
                [p, q, p + (q - p) * 0.3 + random.vector() * 1e-9]
            };
            let (a, b) = (needle(), needle());
            // A point of an edge of B comes to lie in A.
            let (v, w) = (random.unit(), random.unit());
            let by = a[0] + (a[1] - a[0]) * (0.3 * v) + (a[2] - a[0]) * (0.5 * w)
                - (b[0] + (b[1] - b[0]) * random.unit());
            let still = [a, b.map(|p| p + by)].map(|t| t.map(|place| Line { place, velocity: DVec3::ZERO }));
            let near = triangle_distance(&a, &still[1].map(|line| line.place));
            let found = weighted(&still[0], near.barycentric_a).place;
            let off = found.distance(weighted(&still[1], near.barycentric_b).place);
            let (along, across) = (a[1] - a[0], (a[1] - a[0]).cross(b[1] - b[0]));
            let turned =
                still[0].map(|line| Line { velocity: across * along.dot(line.place - found), ..line });
            let ends = [turned, still[1]].map(|lines| lines.map(|line| line.place + line.velocity));
            let level = 1e-3 * off;
            if near.upper == 0.0 && off > 1e-9 && triangle_distance(&ends[0], &ends[1]).lower > level {
                parted += 1;
                let pair = StraightPair { corners: [turned, still[1]], half: 1.0, error: 0.0 };
                assert!(!pair.points_stay(level), "{turned:?} {still:?} {level}");
            }
        }
        assert!(parted > 100, "{parted}");
    }

    /// In the plane of a face so small that no product of its sides is a number, far beside it.
    #[test]
    fn nothing_is_above_a_face_that_it_is_far_from() {
        let rest = |place: DVec3| Line { place, velocity: DVec3::ZERO };
        for size in [1e-75, 1e-90, 1e-110, 1e-160, 1e-200] {
            for far in [3.0 * size, 1e-60, 1.0] {
                let face = [DVec3::ZERO, DVec3::X * size, DVec3::Y * size].map(rest);
                let spike =
                    [DVec3::X * far, DVec3::new(far, size, far), DVec3::new(far, -size, far)].map(rest);
                let pair = StraightPair { corners: [face, spike], half: 0.5, error: 0.0 };
                assert!(!pair.stay_within(0.5 * far), "{size:e} {far:e}");
                assert!(pair.stay_within(1.1 * far) || far == 1.0, "{size:e} {far:e}");
            }
        }
    }
}
