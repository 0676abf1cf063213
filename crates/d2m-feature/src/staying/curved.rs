//! How long do bodies certainly stay within a distance of each other whose motions bend?
//!
//! Seen from B, a corner of A follows a parabola P(s) = p + v s + a s²/2 about the middle of a span, up to a remainder that holds the third
//! derivative and what the enclosures leave open of the second; corners of B rest. A motion that both bodies share takes no part.
//! On each triangle a point wanders whose weights are quadratic in time: their difference is a polynomial of the fourth degree, and no
//! longer than the longest of its Bernstein coefficients. docs/theory/questions.md, "Staying in contact".

use super::Middle;
use crate::{TriangleDistance, estimate_closest_weights, triangle_distance};
use d2m_lanes::{UP, power_of_two};
use d2m_motion::{CertifiedState, RelativeState, length};
use glam::DVec3;

/// A control point takes fewer than 28 operations in a row, on terms of two bodies whose weights, in magnitudes, sum up to 1, 1 and 2: with √3 for
/// the three coordinates that rounds by less than 28·8·√3 = 388 units of the largest length; weights that are normalized, and no less than
/// zero to rounding, are off by 26 more, and places from a corner of B by two.
const WANDERED: f64 = 256.0 * f64::EPSILON;
/// Squares that underflow take less than 2⁻⁵¹¹ from a length. In a remainder it is multiplied by at most three of the turns, each of which is
/// below [`MOST_TURN`] = 2¹⁰ a span.
const LOST: f64 = power_of_two(-450);
/// And where a turn lost that much it is multiplied by a length of which 2⁻⁴⁷ is in the remainder: by a smaller part than this of all.
const LOST_PART: f64 = 1.0 + power_of_two(-40);
/// No certificate over so many radians would hold.
const MOST_TURN: f64 = 1024.0;

/// Weights of a point of a triangle: not negative, with a sum of one to rounding.
fn convex(weights: [f64; 3]) -> [f64; 3] {
    let weights = weights.map(|w| w.max(0.0));
    let sum = weights[0] + weights[1] + weights[2];
    weights.map(|w| w / sum)
}

/// A polynomial of the second degree on [−1, 1], by its coefficients.
type Quadratic<T> = [T; 3];

fn at(curve: &Quadratic<DVec3>, x: f64) -> DVec3 {
    curve[0] + (curve[1] + curve[2] * x) * x
}

/// Two triangles over a span of time that is [−1, 1] here.
pub(super) struct CurvedPair {
    /// From a corner of B, in axes that turn with it.
    corners: [[Quadratic<DVec3>; 3]; 2],
    /// How much further apart or nearer a point of the one and a point of the other may be.
    error: f64,
}

impl CurvedPair {
    /// The span has a length, and no joint of the motions inside of it. Where the motions' enclosures know nothing the error is infinite.
    pub(super) fn new(middle: &Middle) -> Self {
        let Middle { corners: given, states: [a, b], rates: [over_a, over_b], half: h, .. } = middle;
        let h = *h;
        let arms = [given[0].map(|p| p - a.at), given[1].map(|p| p - b.at)];
        let [radius, extent] = arms.map(|arms| arms.map(length).into_iter().fold(0.0, f64::max) * UP);
        // Places of B are from its reference point here.
        let b = CertifiedState { at: DVec3::ZERO, ..*b };
        let relative = RelativeState::of_states([a, &b], [over_a, over_b], h);
        let turn = relative.turn_b().max(relative.bound_turn_speed(1.0));
        let remainder = relative.remainder(radius, extent).bound(h);
        let error = if turn <= MOST_TURN { (remainder + LOST) * LOST_PART } else { f64::INFINITY };
        let base = arms[1][0];
        let moving = arms[0].map(|arm| {
            let jet = relative.point_jet(arm, radius, extent);
            [jet.p - base, jet.v * h, jet.a * (0.5 * h * h)]
        });
        let resting = arms[1].map(|arm| [arm - base, DVec3::ZERO, DVec3::ZERO]);
        Self { corners: [moving, resting], error }
    }

    /// Proof that the triangles are within `level` of each other at every time of the span; false proves nothing.
    ///
    /// Of the points that wander one goes with its triangle, the closest point of the middle, and the other follows it; or both are the closest
    /// ones in the beginning, in the middle and in the end.
    pub(super) fn stay_within(&self, level: f64) -> bool {
        let level = level - self.error;
        // What is not a number is no proof.
        if !(level >= 0.0 && self.error < f64::INFINITY) {
            return false;
        }
        let placed = self.placed();
        let near = triangle_distance(&placed[1][0], &placed[1][1]);
        if near.lower > level {
            return false;
        }
        let middle = weights_of(&near);
        [0, 1].into_iter().any(|k| self.wander(&following(&placed, k, middle[k]), level))
            || self.wander(&closest(&placed, middle), level)
    }

    /// The triangles in the beginning, in the middle and in the end.
    fn placed(&self) -> [[[DVec3; 3]; 2]; 3] {
        [-1.0, 0.0, 1.0]
            .map(|x| self.corners.each_ref().map(|corners| corners.each_ref().map(|corner| at(corner, x))))
    }

    /// Do two points with these weights at three times stay within the level?
    fn wander(&self, way: &Way, level: f64) -> bool {
        let mut sum = [DVec3::ZERO; 5];
        let mut largest: f64 = 0.0;
        for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
            for (w, p) in quadratics(&way[k]).iter().zip(&self.corners[k]) {
                for (i, &w) in w.iter().enumerate() {
                    for (j, &p) in p.iter().enumerate() {
                        sum[i + j] += p * (sign * w);
                    }
                }
                largest = largest.max(length(p[0]) + length(p[1]) + length(p[2]));
            }
        }
        let [c0, c1, c2, c3, c4] = sum;
        // The Bernstein coefficients on [−1, 1] of 1, x, x², x³ and x⁴.
        let controls = [
            c0 - c1 + c2 - c3 + c4,
            c0 - c1 * 0.5 + c3 * 0.5 - c4,
            c0 - c2 / 3.0 + c4,
            c0 + c1 * 0.5 - c3 * 0.5 - c4,
            c0 + c1 + c2 + c3 + c4,
        ];
        let rounded = WANDERED * largest * UP;
        controls.into_iter().all(|control| (length(control) + rounded) * UP <= level)
    }
}

/// Weights at three times of a point of each triangle.
type Way = [[[f64; 3]; 3]; 2];

fn weights_of(near: &TriangleDistance) -> [[f64; 3]; 2] {
    [near.barycentric_a, near.barycentric_b].map(convex)
}

/// The point with these weights goes with triangle `k`; the closest one of the other triangle follows it.
fn following(placed: &[[[DVec3; 3]; 2]; 3], k: usize, weights: [f64; 3]) -> Way {
    let follows = placed.map(|triangles| {
        convex(estimate_closest_weights(weighted(&triangles[k], weights), &triangles[1 - k]))
    });
    if k == 0 { [[weights; 3], follows] } else { [follows, [weights; 3]] }
}

/// The closest points of each time; those of the middle are known.
fn closest(placed: &[[[DVec3; 3]; 2]; 3], middle: [[f64; 3]; 2]) -> Way {
    let [begin, end] = [&placed[0], &placed[2]].map(|[a, b]| weights_of(&triangle_distance(a, b)));
    [0, 1].map(|k| [begin[k], middle[k], end[k]])
}

fn weighted(points: &[DVec3; 3], weights: [f64; 3]) -> DVec3 {
    points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2]
}

/// The weights of the three corners as polynomials on [−1, 1], none of which is negative there, through those of the ends; through those of the
/// middle where that is so: a polynomial c₀ + c₁x + c₂x² is not negative if it is not at the ends and c₀ ≥ c₂.
fn quadratics([begin, middle, end]: &[[f64; 3]; 3]) -> [Quadratic<f64>; 3] {
    let even = [0, 1, 2].map(|i| 0.5 * (begin[i] + end[i]));
    // Between the weights of the middle and the even ones: with a half of each all are enough.
    let lacks = (0..3).map(|i| {
        let lack = even[i] - 2.0 * middle[i];
        if lack > 0.0 { lack / (2.0 * (even[i] - middle[i])) } else { 0.0 }
    });
    let part = lacks.fold(0.0, f64::max);
    [0, 1, 2].map(|i| {
        let middle = middle[i] + (even[i] - middle[i]) * part;
        [middle, 0.5 * (end[i] - begin[i]), even[i] - middle]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MovingTriangle;
    use d2m_motion::{Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};

    /// Triangles whose corners follow parabolas: where points that wander prove that they stay within a level, samples do.
    #[test]
    fn what_wanders_within_a_level_is_never_sampled_beyond() {
        let mut random = KnuthRandom(613);
        let mut claims = [0; 3];
        for round in 0..4000 {
            let bend = [0.0, 0.1, 0.5][round % 3];
            let mut curve = |up: f64| {
                let place = random.vector() * DVec3::new(1.0, 1.0, 0.1) + DVec3::Z * up;
                [place, random.vector() * 0.3, random.vector() * bend]
            };
            let corners = [[(); 3].map(|()| curve(0.0)), [(); 3].map(|()| curve(0.5))];
            let pair = CurvedPair { corners, error: 0.0 };
            let distance = |x: f64| {
                let [a, b] = pair.corners.map(|corners| corners.map(|corner| at(&corner, x)));
                triangle_distance(&a, &b)
            };
            let ends = distance(-1.0).upper.max(distance(0.0).upper).max(distance(1.0).upper);
            let placed = pair.placed();
            let middle = weights_of(&distance(0.0));
            let ways = [
                following(&placed, 0, middle[0]),
                following(&placed, 1, middle[1]),
                closest(&placed, middle),
            ];
            for level in [ends * 1.001, ends * 1.05, ends + 0.3] {
                let found = ways.map(|way| pair.wander(&way, level));
                for (claim, found) in claims.iter_mut().zip(found) {
                    *claim += u32::from(found);
                }
                for k in (0..=40).filter(|_| found.contains(&true)) {
                    let x = f64::from(k) / 20.0 - 1.0;
                    assert!(distance(x).lower <= level, "round {round}: {found:?} {level} at {x}");
                }
            }
        }
        assert!(claims.iter().all(|count| *count > 100), "{claims:?}");
    }

    /// Weights that are positive at three times are never negative, and sum up to one.
    #[test]
    fn weights_are_never_negative() {
        let mut random = KnuthRandom(614);
        for _ in 0..2000 {
            let mut weights = || convex([(); 3].map(|()| (random.unit() - 0.4).max(1e-3)));
            let quadratics = quadratics(&[weights(), weights(), weights()]);
            for k in 0..=64 {
                let x = f64::from(k) / 32.0 - 1.0;
                let now = quadratics.map(|[c0, c1, c2]| c0 + (c1 + c2 * x) * x);
                assert!(
                    now.iter().all(|&w| w > -1e-15) && (now.iter().sum::<f64>() - 1.0).abs() < 1e-14,
                    "{now:?}"
                );
            }
        }
    }

    /// Corners are where the motions have them, up to the error, in any unit of time; an error that were only that of the middle would not do.
    #[test]
    fn corners_follow_their_parabolas_up_to_the_error() {
        let mut random = KnuthRandom(615);
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let mut bends = 0;
        for round in 0..300 {
            let second = [1.0, 1e-120, 1e120, 1e-12][round % 4];
            let mut twist = |turn: f64| {
                ConstantTwist::try_new(
                    random.vector(),
                    glam::DQuat::from_scaled_axis(random.vector() * 3.0),
                    random.vector() / second,
                    random.vector() * turn / second,
                )
                .unwrap()
            };
            let (outer, inner, other) = (twist(2.0), twist(1.0), twist(1.0));
            let slides = JointValue::try_polynomial(vec![0.0, 0.5 / second, 0.7 / second / second]).unwrap();
            let axis = DVec3::new(0.6, 0.0, 0.8);
            let joint = Joint::try_new(
                DVec3::ZERO,
                glam::DQuat::IDENTITY,
                JointKind::Prismatic { axis, value: slides },
            );
            let slides = Chain::try_new(vec![joint.unwrap()]).unwrap();
            let a = Composed::new(outer, Composed::new(slides, inner));
            let b = Composed::new(outer, other);
            let triangles = [MovingTriangle { corners, motion: &a }, MovingTriangle { corners, motion: &b }];
            let (from, long) = (0.3 * second, [0.01, 0.1][round % 2] * second);
            let to = from + long;
            let middle = Middle::of(&triangles, from, to);
            let pair = CurvedPair::new(&middle);
            // Of the third order in the length.
            let half = 0.5 * long / second;
            assert!(pair.error < 1000.0 * half * half * half, "round {round}: {}", pair.error);
            let mut most: f64 = 0.0;
            for k in 0..=16 {
                let time = from + long * (f64::from(k) / 16.0);
                let poses = [a.pose_and_twist(time).0, b.pose_and_twist(time).0];
                let x = (f64::from(k) / 8.0 - 1.0).clamp(-1.0, 1.0);
                let turned = poses[1].rotation.inverse();
                for (corner, curve) in corners.into_iter().zip(&pair.corners[0]) {
                    let place =
                        turned * (poses[0].transform_point(corner) - poses[1].transform_point(DVec3::ZERO));
                    most = most.max((middle.units.point(place) - at(curve, x)).length());
                }
            }
            assert!(most <= pair.error + 1e-14, "round {round}: {most:e} {:e}", pair.error);
            bends += u32::from(most > 1e-3 * pair.error);
        }
        assert!(bends > 200, "{bends}");
    }
}
