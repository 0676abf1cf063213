//! Two triangles in motion: until when does a fixed direction keep them apart by more than the level?

use super::closest::{Closest, Place, closest};
use super::pair_scale::PairScale;
use super::refined_directions::{middle_direction, refined_directions};
use super::turning::{TurningTriangle, clear_along_turning};
use super::turning_edges::{CrossingEdges, clear_across_edges};
use crate::gap::first_time::{Jets, Lines, first_time, first_time_of_jets, is_open_at};
use crate::gap::widest_gap::{greatest, least, widest_gap, widest_normal};
use crate::pair::motion::frame::Frame;
use d2m_lanes::{Doubles, F64x4, QuadVec};
use d2m_mesh::margin::UP;
use glam::DVec3;

/// Directions that are used are longer than this: lengths and times are about one, and the products of up to four of them and of
/// gaps of at least 2⁻⁵³ are not lost to underflow.
const SHORTEST: f64 = 1e-30;
/// Features are tested themselves where they are closer to the level than so many times as far as the stopping distance is from it.
const FAR_STOPS: f64 = 16.0;

/// What directions that turn leave above the level, in errors of a gap: one for places, three for what rates and accelerations
/// relative to a body that turns err by in addition.
const TURNING_ERRORS: f64 = 4.0;

/// Parts of the time that matters: a direction that lasts for less than the first is tried also as it turns with the bodies, and
/// if the longest is less than the second, so is one in the middle of all.
const SHORT: f64 = 1.0 / 16.0;
const VERY_SHORT: f64 = 1.0 / 256.0;

/// Which derivative an evaluation bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BoundOrder {
    /// One direction and a bound on the acceleration: enough for most queries.
    Second,
    /// Also the normals, and the vertices' own accelerations with a bound on the third derivative: for pairs that stay
    /// close for long.
    Third,
    /// Also directions that turn with a body: for pairs that stay close for longer than that helps.
    Turning,
}

/// What one evaluation of a pair gives.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Evaluation {
    /// Apart by more than the level for at least this long after the frame.
    ClearFor(f64),
    /// Within the stopping distance at the frame's time.
    Near {
        /// The features are further apart than that, yet no direction separates: the triangles cross.
        crossing: bool,
        /// Along the shortest line from A to B, not normalised.
        direction: DVec3,
    },
}

/// Which triangle is below the other along a direction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Low {
    A,
    B,
}

/// The triangles of a pair in the frame of B's tree, and how they move.
struct Placed<'p> {
    a: [DVec3; 3],
    b: &'p [DVec3; 3],
    /// How the bodies move, in the frame of B's tree.
    frame: &'p Frame,
    /// From the reference points to the centers of the trees, body axes.
    arms: &'p [DVec3; 2],
    /// No later time matters, counted from the frame.
    enough: f64,
    order: BoundOrder,
}

/// Vertices of A's triangle (from the tree's center, body axes) moved into B's frame.
#[inline(always)]
pub(crate) fn place_a<D: Doubles>(frame: &Frame, triangle: &[DVec3; 3]) -> [DVec3; 3] {
    [
        place_point::<D>(frame, triangle[0]),
        place_point::<D>(frame, triangle[1]),
        place_point::<D>(frame, triangle[2]),
    ]
}

/// The same for a point.
#[inline(always)]
pub(crate) fn place_point<D: Doubles>(frame: &Frame, point: DVec3) -> DVec3 {
    (frame.rotation.times::<D>(point) + D::load(&frame.apart)).store().to_vec()
}

/// The separating-axis test of a pair at the time of the frame. `triangles`: of A and of B, vertices from the trees' centers,
/// body axes. `enough`: a longer clear time is of no use.
#[inline(always)]
pub(crate) fn separating_axis_test<D: Doubles>(
    frame: &Frame,
    triangles: [&[DVec3; 3]; 2],
    scale: &PairScale,
    enough: f64,
    order: BoundOrder,
) -> Evaluation {
    let placed = Placed::new::<D>(frame, triangles, scale, enough, order);
    let gap = widest_gap::<D>(&placed.a, placed.b);
    let mut direction = gap.direction;
    let (apart, far) = (
        gap.exceeds(scale.level + scale.error),
        gap.exceeds(scale.level + FAR_STOPS * (scale.stop - scale.level)),
    );
    let mut best = 0.0;
    // One piece of code for the three directions: the widest; a normal, which lasts longer than the line to a corner
    // that comes closer when faces slide along each other; near the end that of the closest features, which attains
    // the distance.
    for attempt in if apart { 0 } else { 2 }..3 {
        if attempt == 1 {
            direction = widest_normal(&placed.a, placed.b);
        } else if attempt == 2 {
            let near = closest::<D>(&placed.a, placed.b);
            direction = near.direction;
            // Whatever the direction would prove.
            if near.distance_squared <= scale.stop * scale.stop {
                return Evaluation::Near { crossing: false, direction };
            }
            if order == BoundOrder::Turning {
                best = placed.clear_while_edges_turn(&near, scale, best);
            }
        }
        best = placed.clear_for::<D>(direction, scale, best);
        if order == BoundOrder::Turning && best < SHORT * enough {
            best = placed.clear_while_turning(direction, scale, best);
        }
        let enough_of_it = match order {
            BoundOrder::Second => best >= enough || far,
            BoundOrder::Third => best >= enough || far && attempt == 1,
            BoundOrder::Turning => best >= enough || far && attempt == 1 && best >= SHORT * enough,
        };
        if attempt < 2 && enough_of_it {
            return Evaluation::ClearFor(best);
        }
    }
    if order == BoundOrder::Turning && best < VERY_SHORT * enough {
        best = placed.clear_while_turning(middle_direction(&placed.a, placed.b), scale, best);
    }
    if best == 0.0 {
        best = placed.clear_along_refined::<D>(scale);
    }
    // Further apart than that, and along no direction, they cross, up to rounding.
    if best == 0.0 { Evaluation::Near { crossing: true, direction } } else { Evaluation::ClearFor(best) }
}

/// From a contact back in time: proofs that pairs are apart before it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BackwardCertificate {
    /// The frame of the contact with all velocities reversed ([`Frame::reversed`]): a bound on the acceleration holds
    /// backwards as well as forwards.
    pub(crate) reversed: Frame,
    /// The direction of the contact, not normalised, or zero: most pairs that are near it are apart along it too.
    pub(crate) direction: DVec3,
}

/// Are the triangles further apart than the level all the time from `span` before the contact up to its time? True
/// only if that is proven.
#[inline(always)]
pub(crate) fn apart_since<D: Doubles>(
    contact: &BackwardCertificate,
    triangles: [&[DVec3; 3]; 2],
    scale: &PairScale,
    span: f64,
) -> bool {
    let placed = Placed::new::<D>(&contact.reversed, triangles, scale, span, BoundOrder::Second);
    placed.is_clear_along::<D>(contact.direction, scale)
        || placed.is_clear_along::<D>(widest_gap::<D>(&placed.a, placed.b).direction, scale)
}

/// Positions and rates of the vertices of two triangles that are apart along a direction.
struct Along<D> {
    of_a: Lines<D>,
    of_b: Lines<D>,
    low: Low,
    /// The direction, made longer when it is very short, its length, and the gap along it that counts as none.
    n: DVec3,
    length: f64,
    need: f64,
}

impl<D: Doubles> Along<D> {
    /// Those of the lower triangle and those of the other one.
    #[inline(always)]
    fn in_order(&self) -> [Lines<D>; 2] {
        if self.low == Low::A { [self.of_a, self.of_b] } else { [self.of_b, self.of_a] }
    }
}

impl<'p> Placed<'p> {
    #[inline(always)]
    fn new<D: Doubles>(
        frame: &'p Frame,
        [a, b]: [&'p [DVec3; 3]; 2],
        scale: &'p PairScale,
        enough: f64,
        order: BoundOrder,
    ) -> Self {
        Self { a: place_a::<D>(frame, a), b, frame, arms: &scale.arms, enough, order }
    }

    /// The angular velocities.
    #[inline(always)]
    fn omegas(&self) -> [DVec3; 2] {
        [self.frame.omega_a.to_vec(), self.frame.omega_b.to_vec()]
    }

    /// The arms.
    #[inline(always)]
    fn arms(&self) -> [DVec3; 2] {
        let [of_a, of_b] = *self.arms;
        [self.frame.rotation.transform(of_a), of_b]
    }

    /// The triangles along a direction, if they are further apart than `level` along it.
    #[inline(always)]
    fn along<D: Doubles>(&self, n: DVec3, scale: &PairScale, level: f64) -> Option<Along<D>> {
        let mut n = n;
        let mut length = n.length();
        // Its largest coordinate is above the shortest, too, and it stays as it is.
        let is_long = length > 2.0 * SHORTEST;
        if !is_long {
            n = lengthened(n);
            length = n.length();
        }
        let a = QuadVec::<D>::new([self.a[0], self.a[1], self.a[2], self.a[2]]);
        let b = QuadVec::<D>::new([self.b[0], self.b[1], self.b[2], self.b[2]]);
        let (pa, pb) = (a.dot(n), b.dot(n));
        let (forward, backward) = (pb.min_element() - pa.max_element(), pa.min_element() - pb.max_element());
        let a_is_low = forward > backward;
        let gap = if a_is_low { forward } else { backward };
        let need = (level + scale.error) * length;
        // Not when n is zero or not a number either, nor so short that its square is lost to underflow.
        let separated = gap > need && length > SHORTEST;
        if !separated {
            return None;
        }
        let [omega_a, omega_b] = self.omegas();
        let (turn_a, turn_b) = (n.cross(omega_a), n.cross(omega_b));
        let drift = n.dot(self.frame.velocity.to_vec()) - turn_a.dot(self.frame.apart.to_vec());
        let (ra, rb) = (a.dot(turn_a) + D::splat(drift), b.dot(turn_b));
        Some(Along {
            of_a: Lines { at: pa, rate: ra },
            of_b: Lines { at: pb, rate: rb },
            low: if a_is_low { Low::A } else { Low::B },
            n,
            length,
            need,
        })
    }

    /// Whether the direction keeps the pair further apart than the level for all the time that matters: now and at the end, for the bound
    /// on the gap is concave. No root is needed.
    #[inline(always)]
    fn is_clear_along<D: Doubles>(&self, n: DVec3, scale: &PairScale) -> bool {
        let Some(along) = self.along::<D>(n, scale, scale.level) else { return false };
        let [low, high] = along.in_order();
        is_open_at(self.enough * UP, low, high, along.need, scale.acceleration * along.length)
    }

    /// The larger of `known` and the time for which the direction keeps the pair further apart than the level that pairs are advanced to.
    #[inline(always)]
    fn clear_for<D: Doubles>(&self, n: DVec3, scale: &PairScale, known: f64) -> f64 {
        let Some(along) = self.along::<D>(n, scale, scale.target()) else { return known };
        let s = if self.order == BoundOrder::Second {
            let [low, high] = along.in_order();
            first_time(low, high, along.need, scale.acceleration * along.length, self.enough)
        } else {
            // Written out: a closure is not inlined into code for other instruction sets.
            let of_a = Lines { at: three(along.of_a.at), rate: three(along.of_a.rate) };
            let of_b = Lines { at: three(along.of_b.at), rate: three(along.of_b.rate) };
            self.clear_for_jets(along.n, scale, along.need, along.low, [of_a, of_b])
        };
        if s > known { s } else { known }
    }

    /// The largest time along directions that are made accurate for slivers and for edges that are nearly parallel: needed
    /// only where the others separate nothing although the features are apart, or where triangles cross.
    #[cold]
    #[inline(never)]
    fn clear_along_refined<D: Doubles>(&self, scale: &PairScale) -> f64 {
        let mut best = 0.0;
        for direction in refined_directions(&self.a, self.b) {
            best = self.clear_for::<D>(direction, scale, best);
        }
        best
    }

    /// The larger of `known` and the time for which the direction, turned with one of the bodies, keeps the pair further apart than
    /// the level that pairs are advanced to.
    #[cold]
    #[inline(never)]
    fn clear_while_turning(&self, n: DVec3, scale: &PairScale, known: f64) -> f64 {
        let n = lengthened(n);
        let length = n.length();
        // Not when it is no number either.
        let is_direction = length > SHORTEST;
        if !is_direction {
            return known;
        }
        let need = (scale.target() + TURNING_ERRORS * scale.error) * length;
        let [a, b] = self.turning_triangles();
        let with_b = clear_along_turning(n, &b, &a, need, self.enough);
        let with_a = clear_along_turning(n, &a, &b, need, self.enough);
        with_a.max(with_b).max(known)
    }

    /// The larger of `known` and the time for which the direction across both edges, where the closest points lie on two, keeps the
    /// pair further apart than the level that pairs are advanced to.
    #[cold]
    #[inline(never)]
    fn clear_while_edges_turn(&self, near: &Closest, scale: &PairScale, known: f64) -> f64 {
        let [Place::Edge(i), Place::Edge(j)] = near.places else { return known };
        let crossing = CrossingEdges { edges: [i, j], points: near.points };
        let need = scale.target() + TURNING_ERRORS * scale.error;
        let [a, b] = self.turning_triangles();
        clear_across_edges(&crossing, &a, &b, need, self.enough).max(known)
    }

    /// The triangles as they turn with their bodies.
    fn turning_triangles(&self) -> [TurningTriangle; 2] {
        let ([omega_a, omega_b], [arm_a, arm_b]) = (self.omegas(), self.arms());
        let center = self.frame.apart.to_vec();
        let a = TurningTriangle {
            corners: self.a.map(|corner| corner - center),
            center,
            velocity: self.frame.velocity.to_vec(),
            omega: omega_a,
            arm: arm_a,
        };
        let b = TurningTriangle {
            corners: *self.b,
            center: DVec3::ZERO,
            velocity: DVec3::ZERO,
            omega: omega_b,
            arm: arm_b,
        };
        [a, b]
    }

    /// The same with the vertices' own accelerations; positions and rates along `n`, of A and of B, are given, and which
    /// is below the other.
    #[inline(never)]
    fn clear_for_jets(
        &self,
        n: DVec3,
        scale: &PairScale,
        need: f64,
        low: Low,
        [of_a, of_b]: [Lines<[f64; 3]>; 2],
    ) -> f64 {
        let (Lines { at: pa, rate: ra }, Lines { at: pb, rate: rb }) = (of_a, of_b);
        let a_is_low = low == Low::A;
        let (a, b, length) = (&self.a, self.b, n.length());
        let [omega_a, omega_b] = self.omegas();
        let (turn_a, turn_b) = (n.cross(omega_a), n.cross(omega_b));
        // |n·(ω × (ω × e))| = |(n × ω)·(ω × e)| ≤ |n × ω||ω||e|, and the same times |ω| for the next derivative.
        let [bound_a, bound_b] = self.centripetal_along(scale, turn_a, turn_b);
        let m = (bound_a + bound_b).min(scale.acceleration * length) * UP;
        let quad = |v: &[f64; 3]| F64x4::new([v[0], v[1], v[2], v[2]]);
        let (line_a, line_b) =
            (Lines { at: quad(&pa), rate: quad(&ra) }, Lines { at: quad(&pb), rate: quad(&rb) });
        let (low, high) = if a_is_low { (line_a, line_b) } else { (line_b, line_a) };
        let s = first_time(low, high, need, m, self.enough);
        let speed = if a_is_low { least(&rb) - greatest(&ra) } else { least(&ra) - greatest(&rb) };
        let nearest = if a_is_low {
            rate_of_least(&pb, &rb) - rate_of_greatest(&pa, &ra)
        } else {
            rate_of_least(&pa, &ra) - rate_of_greatest(&pb, &rb)
        };
        let is_even = m * s <= PATIENCE * speed.abs() && nearest - speed <= PATIENCE * speed.abs();
        if s >= self.enough || is_even {
            return s;
        }
        let jerk = (bound_a * omega_a.length() + bound_b * omega_b.length()) * UP;
        let bend_a = omega_a * omega_a.dot(n) - n * omega_a.length_squared();
        let bend_b = omega_b * omega_b.dot(n) - n * omega_b.length_squared();
        let [arm_a, arm_b] = self.arms();
        let arm_a = arm_a - self.frame.apart.to_vec();
        let aa = [bend_a.dot(a[0] + arm_a), bend_a.dot(a[1] + arm_a), bend_a.dot(a[2] + arm_a)];
        let ab = [bend_b.dot(b[0] + arm_b), bend_b.dot(b[1] + arm_b), bend_b.dot(b[2] + arm_b)];
        let (of_a, of_b) = (Jets { at: pa, rate: ra, bend: aa }, Jets { at: pb, rate: rb, bend: ab });
        s.max(if a_is_low {
            first_time_of_jets(&of_a, &of_b, need, jerk, self.enough)
        } else {
            first_time_of_jets(&of_b, &of_a, need, jerk, self.enough)
        })
    }

    /// |n × ω||ω|ρ of both bodies.
    #[inline(always)]
    fn centripetal_along(&self, scale: &PairScale, turn_a: DVec3, turn_b: DVec3) -> [f64; 2] {
        let [omega_a, omega_b] = self.omegas();
        let one = |centripetal: f64, turn: DVec3, omega: DVec3| {
            let square = omega.length_squared();
            if square > 0.0 { centripetal * (turn.length_squared() / square).sqrt() } else { 0.0 }
        };
        [one(scale.centripetal[0], turn_a, omega_a), one(scale.centripetal[1], turn_b, omega_b)]
    }
}

/// The direction, made longer when it is very short; zero stays zero.
#[cold]
#[inline(never)]
fn lengthened(n: DVec3) -> DVec3 {
    let size = n.abs().max_element();
    if size > SHORTEST || size == 0.0 { n } else { n / size }
}

/// The first three of four.
#[inline(always)]
fn three<D: Doubles>(values: D) -> [f64; 3] {
    let [x, y, z, _] = values.store().0;
    [x, y, z]
}

/// The rate of the vertex that is first along the direction.
#[inline(always)]
fn rate_of_least(at: &[f64; 3], rate: &[f64; 3]) -> f64 {
    let first = usize::from(at[1] < at[0]);
    if at[2] < at[first] { rate[2] } else { rate[first] }
}

/// The rate of the vertex that is last along the direction.
#[inline(always)]
fn rate_of_greatest(at: &[f64; 3], rate: &[f64; 3]) -> f64 {
    let last = usize::from(at[1] > at[0]);
    if at[2] > at[last] { rate[2] } else { rate[last] }
}

/// The first bound is good enough when the acceleration changes speeds by less than this part of them, and when the nearest
/// vertices are, up to this part, as fast as the fastest ones: those of a triangle that turns about a tip close a hundred
/// times faster than the tip.
const PATIENCE: f64 = 0.1;
