//! A plane that stays between two bodies over a long span, whatever they do along it.
//!
//! Fitted twists deviate in every direction, so that bodies which slide past each other at a small gap are searched in spans as short
//! as the root of the gap. Along the direction between them they hardly move: docs/theory/motions.md, section 3, "Plane".

use super::furthest::{Furthest, Linear, Patience};
use super::{Advance, EXPECTED, GROWTH};
use crate::{Contact, Moving, SearchCounts};
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::UP;
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;
use d2m_mesh::margin::length;
use d2m_motion::Pose;
use glam::DVec3;

/// A plane is sought for spans of so many lengths of the last one at first, and of at least [`GROWTH`] of them.
const AHEAD: f64 = 64.0;
/// The next span is this part, or this multiple, of one at least and at most.
const LEAST_PART: f64 = 1.0 / 16.0;
const MOST_PART: f64 = 16.0;
/// Node tests that a plane, or a search for a direction of one, counts for in a budget, besides the nodes that are searched for what
/// reaches the furthest.
const TESTS_A_PLANE: u64 = 128;
/// More than the roundings of a support add up to, in parts of the terms that are added: turned directions, products with a vertex
/// and their sums are fewer than 64 times half a unit in the last place of each.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;
/// Part of a radius that a direction's gap is estimated to at first, and the multiple of it from which on that is exact enough: more
/// than what boxes are larger than flat sides in them.
const ABOUT: f64 = 1.0 / 65_536.0; // 2⁻¹⁶
const FAR_ABOUT: f64 = 16.0;
/// Sums of a few numbers below this are finite.
const MOST: f64 = f64::MAX / 64.0;
/// Failures are followed by so many times more fitted spans until the next attempt.
const PATIENCE: u32 = 2;

/// When a plane is sought, and the one that the last span was free by.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneSearch {
    /// Direction and length of span.
    known: Option<(DVec3, f64)>,
    /// Fitted spans that came near until the next attempt, and between attempts.
    wait: u32,
    between: u32,
}

impl PlaneSearch {
    pub(super) const START: Self = Self { known: None, wait: 1, between: 1 };
}

/// How far bodies are apart over a span, along a direction, in units of its length.
struct Gap {
    /// More than the least distance that counts as free by so much, for certain.
    beyond: f64,
    /// What the motions within the span may add.
    lost: f64,
    /// Nodes that were examined.
    nodes: u64,
}

impl Gap {
    const UNKNOWN: Self = Self { beyond: f64::NEG_INFINITY, lost: f64::INFINITY, nodes: 0 };

    /// About the part of the span, or the multiple of it, over which the gap may close: what is lost goes like its third power.
    fn part_that_closes(&self) -> f64 {
        let part = Interval::point(((self.beyond + self.lost) / self.lost).clamp(0.0, f64::MAX));
        EXPECTED * part.cbrt().mid()
    }
}

/// How far a body reaches along a direction, over a span of times m + τ, |τ| ≤ h.
///
/// For a body point e from the reference point, f(τ) = n·x + n·Re has f″ = n·a + Q·Re, Q = n × α + (n × ω) × ω. With c and q the middles of
/// n·a and of Q, f differs by at most ½h²(|n·a − c| + |Q − q||e| + |Q|(r_R + h sup|ω|)|e|) from the parabola with the state in the middle
/// and the second derivative c + q·R₀e. A parabola is nowhere outside of its three Bernstein coefficients, each of which is linear in e.
struct Reach {
    /// The coefficients: a number and a vector in the body frame, about the reference point.
    controls: [(f64, DVec3); 3],
    at: DVec3,
    error: f64,
}

impl Reach {
    /// `None` where nothing is known, or numbers are too large for it.
    fn new(body: &Moving<'_>, n: DVec3, span: Interval, middle: f64, origin: DVec3) -> Option<Self> {
        let h = (span.hi() - middle).max(middle - span.lo()) * UP;
        let state = body.motion.enclose_state_about(middle, origin);
        if state.at != body.motion.pose_and_twist(middle).0.at {
            return None;
        }
        let (twist, rate) = (body.motion.enclose_twist(span), body.motion.enclose_twist_rate(span));
        let normal = IntervalVec3::point(n);
        let along = normal.dot(rate.linear);
        let turned = normal.cross(rate.angular) + normal.cross(twist.angular).cross(twist.angular);
        let (c, q) = (along.mid(), turned.mid());
        let reach = (body.body.radius() + length(body.body.center() - state.at)) * UP;
        let long = length(n) * UP;

        let to_body = state.rotation.transpose();
        let across = n.cross(state.angular);
        let (f0, e0) = (n.dot(state.position), to_body * n);
        let (f1, e1) = (n.dot(state.linear) * h, to_body * across * h);
        // The square of a short time alone may be lost to underflow.
        let bent = |rate: f64| 0.5 * h * (h * rate);
        let (f2, e2) = (bent(c), to_body * (q * h) * (0.5 * h));

        let spread = state.rotation_radius + h * twist.angular.norm().hi();
        let now = long * (state.position_radius + reach * state.rotation_radius);
        let first = long * (state.linear_radius + reach * state.angular_radius)
            + reach * length(across) * state.rotation_radius;
        let second = (along - Interval::point(c)).mag()
            + reach * ((turned - IntervalVec3::point(q)).norm().hi() + turned.norm().hi() * spread);
        let size = long * (length(state.position) + reach)
            + h * long * (length(state.linear) + reach * length(state.angular))
            + bent(c.abs() + reach * length(q));
        let error = now + h * first + bent(second) + ROUNDINGS * size;
        // Sums and products of fewer than 32 bounds; what underflow takes is less than the smallest normal number.
        let error = error * (1.0 + 16.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        // No term is larger than the sum of them, so that nothing below is infinite or no number.
        (error < MOST && size < MOST).then(|| Self {
            controls: [(f0 - f1 + f2, e0 - e1 + e2), (f0 - f2, e0 - e2), (f0 + f1 + f2, e0 + e1 + e2)],
            at: state.at,
            error,
        })
    }

    /// The greatest value of each coefficient over the points of a body, with the errors: along n, or against it.
    fn furthest(&self, search: &mut Furthest<'_>, sense: Sense) -> [f64; 3] {
        let at = self.at;
        let along = self.controls.map(|(value, gradient)| match sense {
            Sense::Along => Linear { value, gradient, at },
            Sense::Against => Linear { value, gradient, at }.opposite(),
        });
        let first = search.most(&along[0]);
        // Over no time all three are the same.
        let [second, third] =
            [1, 2].map(|k| if along[k] == along[0] { first } else { search.most(&along[k]) });
        [first, second, third].map(|value| value + self.error)
    }
}

/// Which way along a direction.
#[derive(Clone, Copy)]
enum Sense {
    Along,
    Against,
}

impl Advance<'_> {
    /// Proven free until the end of a span, by the plane that the span before was free by.
    pub(super) fn behind_the_plane(&mut self) -> Option<f64> {
        let (n, mut long) = self.plane.known.take()?;
        let least = GROWTH * self.expected_span(self.largest);
        while long >= least && !self.meter.is_exhausted() {
            let until = (self.now + long).min(self.end_of_piece()?);
            let gap = self.gap_until(n, until)?;
            let next = gap.part_that_closes().clamp(LEAST_PART, MOST_PART) * (until - self.now);
            if gap.beyond > 0.0 {
                #[cfg(feature = "audit")]
                self.conclude(Place::Plane, until, self.tolerance, 0.0);
                self.plane = PlaneSearch { known: Some((n, next)), ..PlaneSearch::START };
                return Some(until);
            }
            long = next.min(0.5 * long);
        }
        None
    }

    /// After fitted twists came near: looks for a plane between the bodies, for spans that are longer than the next one of those.
    pub(super) fn seek_plane(&mut self, contact: &Contact) {
        let (remaining, span) = (self.window.end() - self.now, self.expected_span(self.largest));
        if self.plane.wait > 1 {
            self.plane.wait -= 1;
        } else if remaining > AHEAD * span {
            self.plane.between = self.plane.between.saturating_mul(PATIENCE);
            self.plane.wait = self.plane.between;
            self.plane.known = self.best_normal(contact).map(|n| (n, AHEAD * span));
        }
    }

    /// Of the contact's normal and those of its two triangles, from A to B, the one along which the bodies are furthest apart now, if they
    /// are at all.
    fn best_normal(&mut self, contact: &Contact) -> Option<DVec3> {
        self.count(&SearchCounts { node_tests: TESTS_A_PLANE, ..SearchCounts::default() });
        let poses = self.poses_at(self.now);
        let triangles = [contact.triangle_a, contact.triangle_b];
        let faces = [0, 1].map(|k| {
            let [p, q, r] = self.bodies[k].body.mesh().corners(triangles[k] as usize);
            let n = poses[k].0.transform_vector((q - p).cross(r - p)).normalize_or_zero();
            if n.dot(contact.normal) < 0.0 { -n } else { n }
        });
        let all = [contact.normal, faces[0], faces[1]];
        let known = all.into_iter().filter(|n| n.is_finite() && *n != DVec3::ZERO);
        let poses = poses.map(|(pose, _)| pose);
        let gaps = known.map(|n| (n, self.gap_now(n, &poses, triangles)));
        let best = gaps.max_by(|x, y| x.1.total_cmp(&y.1));
        best.filter(|(_, gap)| *gap > 0.0).map(|(n, _)| n)
    }

    /// About how far the bodies are apart along a direction now, less the least distance that counts as free; no more than zero where
    /// they are not. It chooses a direction and proves nothing.
    fn gap_now(&mut self, n: DVec3, poses: &[Pose; 2], triangles: [u32; 2]) -> f64 {
        let [a, b] = [0, 1].map(|k| self.bodies[k].body);
        let [along, against] = poses.map(|pose| Linear {
            value: n.dot(pose.translation - poses[1].translation),
            gradient: pose.rotation.inverse() * n,
            at: pose.at,
        });
        let against = against.opposite();
        let mut of_a = Furthest::beginning_with(a, triangles[0]);
        let mut of_b = Furthest::beginning_with(b, triangles[1]);
        let level = self.options.min_separation + self.tolerance;
        let mut gap = f64::INFINITY;
        // Many boxes reach about as far as a side does: exactly only where that matters.
        for slack in [ABOUT * a.radius().min(b.radius()), 0.0] {
            let high = of_a.about_most(&along, Patience { slack, enough: -level - of_b.first(&against) });
            let low = of_b.about_most(&against, Patience { slack, enough: -level - high });
            gap = -level - (high + low);
            if gap <= 0.0 || gap > FAR_ABOUT * slack {
                break;
            }
        }
        let node_tests = of_a.nodes + of_b.nodes;
        self.count(&SearchCounts { node_tests, ..SearchCounts::default() });
        gap
    }

    /// How far the bodies stay apart along the direction up to a time; `None` where time has no numbers in between.
    fn gap_until(&mut self, n: DVec3, until: f64) -> Option<Gap> {
        let middle = self.now + 0.5 * (until - self.now);
        // What is not a number is not ahead.
        if !(self.now < middle && middle < until) {
            return None;
        }
        let gap = self.gap_along(n, Interval::new(self.now, until), middle);
        self.count(&SearchCounts { node_tests: TESTS_A_PLANE + gap.nodes, ..SearchCounts::default() });
        Some(gap)
    }

    /// How far the bodies are apart at all times of a span, along a direction from A to B.
    fn gap_along(&self, n: DVec3, span: Interval, middle: f64) -> Gap {
        let [a, b] = &self.bodies;
        let origin = b.motion.pose_and_twist(middle).0.translation;
        let [Some(ahead), Some(behind)] = [a, b].map(|body| Reach::new(body, n, span, middle, origin)) else {
            return Gap::UNKNOWN;
        };
        let [mut of_a, mut of_b] = [a, b].map(|body| Furthest::new(body.body));
        let (high, low) =
            (ahead.furthest(&mut of_a, Sense::Along), behind.furthest(&mut of_b, Sense::Against));
        // −(high + low), rounded down: the sum is off by half a unit in its last place.
        let gaps = high.into_iter().zip(low).map(|(high, low)| -(high + low).next_up());
        // Four roundings at most, of half a unit in the last place each.
        let level = (self.options.min_separation + self.tolerance) * length(n) * (1.0 + 4.0 * f64::EPSILON);
        let beyond = (gaps.fold(f64::INFINITY, f64::min) - level).next_down();
        Gap { beyond, lost: ahead.error + behind.error, nodes: of_a.nodes + of_b.nodes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshTree, TriMesh};
    use d2m_motion::{Chain, Joint, JointKind, JointValue, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom, Surface};
    use glam::DQuat;

    /// A joint of a random axis that turns, or slides if its number is that of the one that does.
    fn joint(random: &mut KnuthRandom, number: usize, sliding: usize) -> Joint {
        let value =
            JointValue::try_polynomial((0..4).map(|_| 2.0 * random.signed()).collect::<Vec<_>>()).unwrap();
        let axis = random.vector();
        let kind = if number == sliding {
            JointKind::Prismatic { axis, value }
        } else {
            JointKind::Revolute { axis, value }
        };
        Joint::try_new(random.vector(), DQuat::IDENTITY, kind).unwrap()
    }

    /// No vertex is ever beyond the greatest coefficient, and what is lost goes like the third power of the span.
    #[test]
    fn a_body_stays_within_its_reach() {
        let mut random = KnuthRandom(17);
        let tree = MeshTree::new(Surface::cube(0.5).map(|p| p + DVec3::X).into_mesh(TriMesh::try_new));
        for round in 0..200 {
            let joints = (0..3).map(|k| joint(&mut random, k, round % 3)).collect();
            let motion = Chain::try_new(joints).unwrap();
            let body = Moving::new(&tree, &motion);
            let (n, middle) = (random.vector(), random.signed());
            let mut lost = f64::INFINITY;
            for half in [0.015_625, 0.007_812_5, 0.003_906_25] {
                let span = Interval::new(middle - half, middle + half);
                let reach = Reach::new(&body, n, span, middle, DVec3::ONE).unwrap();
                for (sense, sign) in [(Sense::Against, -1.0), (Sense::Along, 1.0)] {
                    let most = reach.furthest(&mut Furthest::new(&tree), sense);
                    let most = most.into_iter().fold(f64::NEG_INFINITY, f64::max);
                    for k in -8..=8 {
                        let (pose, _) = motion.pose_and_twist(middle + half * f64::from(k) / 8.0);
                        for vertex in tree.mesh().vertices() {
                            let at = sign * n.dot(pose.transform_point(*vertex) - DVec3::ONE);
                            assert!(at <= most + 1e-13, "{round} {half} {k}: {at} {most}");
                        }
                    }
                }
                assert!(reach.error < 0.2 * lost, "{round} {half}: {} after {lost}", reach.error);
                lost = reach.error;
            }
        }
    }

    /// Nor in a unit of time whose square is no number.
    #[test]
    fn what_accelerates_stays_within_its_reach_in_short_times() {
        let (meter, second) = (2f64.powi(-90), 2f64.powi(-540));
        let tree = MeshTree::new(Surface::cube(0.5).map(|p| p * meter).into_mesh(TriMesh::try_new));
        let value = JointValue::try_polynomial(vec![0.0, 0.0, meter / second / second]).unwrap();
        let kind = JointKind::Prismatic { axis: DVec3::X, value };
        let joint = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap();
        let motion = Chain::try_new(vec![joint]).unwrap();
        let body = Moving::new(&tree, &motion);
        let reach =
            Reach::new(&body, DVec3::X, Interval::new(0.0, second), 0.5 * second, DVec3::ZERO).unwrap();
        let most = reach.furthest(&mut Furthest::new(&tree), Sense::Along);
        let most = most.into_iter().fold(f64::NEG_INFINITY, f64::max);
        assert!((1.5..1.5 + 1e-9).contains(&(most / meter)), "{most:e}");
    }

    /// What is known of nothing, or too large, is never apart.
    #[test]
    fn what_is_not_a_number_is_unknown() {
        let tree = MeshTree::new(Surface::cube(0.5).into_mesh(TriMesh::try_new));
        let flies = d2m_motion::ConstantTwist::REST.with_linear_velocity(DVec3::X * 1e300);
        let body = Moving::new(&tree, &flies);
        for n in [DVec3::X, DVec3::X * 1e10, DVec3::splat(f64::NAN)] {
            assert!(Reach::new(&body, n, Interval::new(0.0, 1e20), 1e10, DVec3::ZERO).is_none());
        }
        assert!(Gap::UNKNOWN.beyond < 0.0 && Gap::UNKNOWN.part_that_closes() == 0.0);
    }
}
