//! Where the bodies are at one time, and the gap between two parts of them along a direction.
use crate::closest::closest;
use crate::directions::{Axis, Direction, between, faces_and_sides};
use crate::{Body, TimeSpan};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{CertifiedState, Kinematics};
use glam::{DMat3, DVec3};

/// A radius of a ball. Of what is no radius nothing is known: a ball without a vector would prove everything.
fn known(radius: f64) -> f64 {
    if radius >= 0.0 { radius } else { f64::INFINITY }
}

/// The vectors within `radius` of `center`; all of them where either is no finite number.
pub(crate) fn around(center: DVec3, radius: f64) -> IntervalVec3 {
    IntervalVec3::around(center, known(radius))
}

/// The matrices within `radius` (operator norm) of `m`.
pub(crate) fn rotations(m: DMat3, radius: f64) -> IntervalMat3 {
    IntervalMat3::around(m, known(radius))
}

/// What the motion of a mesh's center is over a span, the length of which is the unit of its time: intervals know no squares of rates over
/// long times, and no short ones.
pub(crate) fn kinematics(body: &Body<'_>, span: TimeSpan) -> Kinematics {
    let times = Interval::point(span.from).hull(Interval::point(span.to));
    let over = body.motion.enclose_kinematics(times);
    let length = span.to - span.from;
    // Rounded by less than half of this part.
    over.in_unit_of_time(length, f64::EPSILON * length).following(body.mesh.center)
}

/// A part of a body is all that is between these points (or boxes), from its mesh's center in body axes.
pub(crate) type Part<'p> = &'p [IntervalVec3];

/// A direction along which two parts may be further apart than a distance D: N·(x − p) > D|N| says so. D|N| ≤ D(N² + c²)/(2c), which is
/// smooth where |N| changes; c is about |N|.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Separation {
    pub(crate) direction: Direction,
    /// 1, or −1 for the opposite direction.
    pub(crate) sign: f64,
    pub(crate) distance: f64,
    pub(crate) about: f64,
}

impl Separation {
    /// D/(2c).
    pub(crate) fn per_square(&self) -> Interval {
        Interval::point(self.distance) / (Interval::point(self.about) * 2.0)
    }
}

/// The second body seen from the first (the *base*) at one time: its point Q (from its mesh's center) is at x = turn·Q + offset from
/// the base's center, in the base's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub(crate) time: f64,
    turn: IntervalMat3,
    back: IntervalMat3,
    offset: IntervalVec3,
    /// Middles of these, for guesses.
    pub(crate) turn_guess: DMat3,
    pub(crate) offset_guess: DVec3,
    pub(crate) axes: [Axis; 15],
    /// Where the bodies are in the world, seen from a point near both.
    states: [CertifiedState; 2],
}

impl Instant {
    pub(crate) fn new(bodies: &[Body<'_>; 2], time: f64) -> Self {
        // Near the bodies, so that their positions lose nothing far from the world's origin.
        let near = bodies[0].motion.pose_and_twist(time).0.translation;
        let origin = if near.is_finite() { near } else { DVec3::ZERO };
        let state =
            |body: &Body<'_>| body.motion.enclose_state_about(time, origin).following(body.mesh.center);
        Self::of_states(time, &bodies.each_ref().map(state))
    }

    /// What holds at all times of a span; as wide as the bodies move in it.
    pub(crate) fn over(bodies: &[Body<'_>; 2], span: TimeSpan) -> Self {
        let over = bodies.each_ref().map(|body| kinematics(body, span));
        Self::of_states(span.from, &over.map(|body| body.state_about(over[0].position.center)))
    }

    fn of_states(time: f64, states: &[CertifiedState; 2]) -> Self {
        let [turn_a, turn_b] = states.map(|state| rotations(state.rotation, state.rotation_radius));
        let [at_a, at_b] = states.map(|state| around(state.position, state.position_radius));
        let (turn, offset) = (turn_a.transpose() * turn_b, turn_a.transpose() * (at_b - at_a));
        let (back, turn_guess, offset_guess) = (turn.transpose(), turn.mid(), offset.mid());
        let axes = Axis::of_boxes(&turn_guess);
        Self { time, turn, back, offset, turn_guess, offset_guess, axes, states: *states }
    }

    /// A point of the other body, seen from the base.
    pub(crate) fn seen(&self, q: IntervalVec3) -> IntervalVec3 {
        self.turn * q + self.offset
    }

    /// A point of the base, seen from the other body.
    pub(crate) fn seen_back(&self, p: IntervalVec3) -> IntervalVec3 {
        self.back * (p - self.offset)
    }

    /// About a point of the other body, seen from the base.
    pub(crate) fn guess(&self, q: DVec3) -> DVec3 {
        self.turn_guess * q + self.offset_guess
    }

    /// By how much N·(x − p) is certainly above what is needed, over all points p of the base's part and x of the other's.
    pub(crate) fn above(&self, separation: &Separation, parts: [Part<'_>; 2]) -> f64 {
        let n = separation.direction.at(&self.turn, &self.back);
        let [base, other] = [0, 1].map(|k| {
            let along = parts[k].iter().map(|&p| n[k].dot(p));
            along.reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
        });
        let gap = n[0].dot(self.offset) + other - base;
        // The length is the same for both bodies, and for one of them it may be exact.
        let square = n[0].norm_squared().min(n[1].norm_squared());
        let needed = (square + Interval::point(separation.about).sqr()) * separation.per_square();
        (gap * separation.sign - needed).lo()
    }

    /// Encloses the distance of two triangles: it is at least a gap along a direction, and at most that of two of their points.
    pub(crate) fn distance(&self, corners: &[[IntervalVec3; 3]; 2]) -> Interval {
        let [a, b] = [0, 1].map(|k| corners[k].map(|p| self.placed(k, p)));
        let (upper, turn) = (self.most_distance(corners), DMat3::IDENTITY);
        let guess = [a, b].map(|t| t.map(|p| p.middle.mid()));
        let directions = faces_and_sides(&guess).into_iter().chain(between(&guess, &turn, DVec3::ZERO));
        let gaps = directions.map(|direction| {
            // Any vector is a direction, along it or against it.
            let n = Axis::new(direction, &turn).n[0];
            let gap = b.map(|q| a.map(|p| (q.middle - p.middle).dot_point(n)));
            let gap = gap.into_iter().flatten().reduce(Interval::hull).map_or(0.0, Interval::mig);
            // By the length of a direction that may be zero nothing is divided.
            let length = Interval::point(IntervalVec3::point(n).norm().hi());
            if gap > 0.0 { (Interval::point(gap) / length).lo() } else { 0.0 }
        });
        let off = [a, b].map(|t| t.into_iter().fold(Interval::ZERO, |most, p| most.max(p.off)));
        let lower = (Interval::point(gaps.fold(0.0, f64::max)) - off[0] - off[1]).lo().clamp(0.0, upper);
        Interval::point(lower).hull(Interval::point(upper))
    }

    /// Bounds the distance of two triangles from above; zero where they certainly cross.
    pub(crate) fn most_distance(&self, corners: &[[IntervalVec3; 3]; 2]) -> f64 {
        if cross(&corners[0], &corners[1].map(|q| self.seen(q))) {
            return 0.0;
        }
        let seen = corners[1].map(|q| self.guess(q.mid()));
        let near = closest(&corners[0].map(IntervalVec3::mid), &seen).weights;
        let [p, q] = [0, 1].map(|k| {
            // Not negative, and no more than one together or divided by their sum: parts of a point between the corners.
            let ([a, b, c], [u, v, w]) = (corners[k], near[k].abs().to_array().map(Interval::point));
            let sum = u + v + w;
            let [v, w] = if (v + w).hi() <= 1.0 { [v, w] } else { [v / sum, w / sum] };
            self.placed(k, a + (b - a) * v + (c - a) * w)
        });
        ((q.middle - p.middle).norm() + p.off + q.off).hi()
    }

    /// A point of one of the bodies in the world. What the enclosures of the poses leave open is a ball about the middles, which is
    /// less than what is left of it in three products of boxes by up to 3√3.
    fn placed(&self, body: usize, p: IntervalVec3) -> Placed {
        let state = &self.states[body];
        let middle = IntervalMat3::point(state.rotation) * p + state.position;
        Placed { middle, off: p.norm() * known(state.rotation_radius) + known(state.position_radius) }
    }
}

/// A point is within `off` of one of these.
#[derive(Clone, Copy)]
struct Placed {
    middle: IntervalVec3,
    off: Interval,
}

/// Does a side of one triangle certainly pass through the other one? Five signs of volumes.
fn cross(a: &[IntervalVec3; 3], b: &[IntervalVec3; 3]) -> bool {
    let volume = |[u, v, w, x]: [IntervalVec3; 4]| (v - u).triple_product(w - u, x - u).certain_sign();
    let passes = |p: IntervalVec3, q: IntervalVec3, [a, b, c]: [IntervalVec3; 3]| {
        let turns = [(a, b), (b, c), (c, a)].map(|(u, v)| volume([p, q, u, v]));
        volume([a, b, c, p]) * volume([a, b, c, q]) < 0 && turns[0] != 0 && turns == [turns[0]; 3]
    };
    (0..3).any(|k| passes(a[k], a[(k + 1) % 3], *b) || passes(b[k], b[(k + 1) % 3], *a))
}
