//! How the bodies may move relative to each other over a span of time, and what that does to a gap.
//!
//! Seen from the base, a point Q of the other body (from its center) is at x. With d from center to center, s from the other's center to
//! the point, v, a the velocities and accelerations of the centers and ω, α those of the turns (index A: the base), in axes that turn
//! with the base:
//!
//! ```text
//! x′ = u + Ω × s                  u  = v_B − v_A − ω_A × d                      Ω  = ω_B − ω_A
//! x″ = u′ + Ω′ × s + Ω × (Ω × s)  u′ = a_B − a_A − α_A × d − 2ω_A × (v_B − v_A) + ω_A × (ω_A × d)
//!                                 Ω′ = α_B − α_A − ω_A × ω_B
//! ```
use crate::directions::Direction;
use crate::instant::{Part, Separation, around, kinematics, rotations};
use crate::{Body, TimeSpan};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::Ball;

/// Enclosures over a span, world axes; a unit of time is as long as the span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rates {
    turn: [IntervalMat3; 2],
    d: IntervalVec3,
    u: IntervalVec3,
    u_rate: IntervalVec3,
    spin: IntervalVec3,
    spin_rate: IntervalVec3,
}

impl Rates {
    pub(crate) fn new(bodies: &[Body<'_>; 2], span: TimeSpan) -> Self {
        let [a, b] = bodies.each_ref().map(|body| kinematics(body, span));
        let known = |ball: Ball| around(ball.center, ball.radius);
        let tails = IntervalVec3::point(b.position_tail) - IntervalVec3::point(a.position_tail);
        let d = known(b.position) - known(a.position) + tails;
        let v = known(b.linear) - known(a.linear);
        let (wa, wb) = (known(a.angular), known(b.angular));
        let (ra, rb) = (known(a.angular_rate), known(b.angular_rate));
        let inertial = ra.cross(d) + wa.cross(v) * 2.0 - wa.cross(wa.cross(d));
        Self {
            turn: [a, b].map(|k| rotations(k.rotation, k.rotation_radius)),
            d,
            u: v - wa.cross(d),
            u_rate: known(b.linear_rate) - known(a.linear_rate) - inertial,
            spin: wb - wa,
            spin_rate: rb - ra - wa.cross(wb),
        }
    }

    /// About the fastest that a point of the other body moves that is so far from its center.
    pub(crate) fn guess_speed(&self, reach: f64) -> f64 {
        (self.u.norm() + self.spin.norm() * reach).hi()
    }

    /// About the most that it accelerates.
    pub(crate) fn guess_acceleration(&self, reach: f64) -> f64 {
        (self.u_rate.norm() + (self.spin_rate.norm() + self.spin.norm().sqr()) * reach).hi()
    }

    /// An upper bound of g″ over the span for all points of the parts, g = N·(x − p) − D(N² + c²)/(2c), by its own terms:
    /// N″·y + 2N′·y′ + N·y″ with y = x − p. Not below zero.
    pub(crate) fn curvature(&self, separation: &Separation, parts: [Part<'_>; 2]) -> f64 {
        let hull = |part: Part<'_>| part.iter().copied().reduce(IntervalVec3::hull);
        let [base, other] = parts.map(|part| hull(part).unwrap_or(IntervalVec3::ENTIRE));
        let s = self.turn[1] * other;
        let first = |v: IntervalVec3| self.spin.cross(v);
        let second = |v: IntervalVec3| self.spin_rate.cross(v) + first(first(v));
        let y2 = self.u_rate + second(s);
        let sum = |[n, n1, n2]: [IntervalVec3; 3]| {
            let y = self.d + s - self.turn[0] * base;
            n2.dot(y) + n1.dot(self.u + first(s)) * 2.0 + n.dot(y2)
        };
        let (bend, level) = match separation.direction {
            Direction::Base(n) => ((self.turn[0] * n).dot(y2), Interval::ZERO),
            Direction::Other(n) => {
                let n = self.turn[1] * n;
                (sum([n, first(n), second(n)]), Interval::ZERO)
            }
            Direction::Across(e, f) => {
                let (e, f) = (self.turn[0] * e, self.turn[1] * f);
                let [n, n1, n2] = [f, first(f), second(f)].map(|f| e.cross(f));
                (sum([n, n1, n2]), (n1.norm_squared() + n.dot(n2)) * separation.per_square() * 2.0)
            }
        };
        (bend * separation.sign - level).hi().max(0.0)
    }
}

/// A lower bound of g on [0, L] from g(0) ≥ `start`, g(L) ≥ `end` and g″ ≤ K, with `bend` ≥ K L²/2 (of rates in the span: K/2).
///
/// At τL the chord is at most bend·τ(1 − τ) above g: with m the lesser end and D how much greater the other one is, that leaves m where
/// D ≥ bend, and m − (bend − D)²/(4 bend) otherwise (with D = 0: m − K L²/8).
///
/// ```text
///  end ●                 g, with g″ as large as it may be
///      │╲╲    chord      ╱● start
///      │   ╲ ╲_________╱
///      │     ╲________╱  ← lower bound
/// ```
pub(crate) fn lowest(ends: [f64; 2], bend: f64) -> f64 {
    let ([start, end], bend) = (ends.map(Interval::point), Interval::point(bend));
    let (less, more) = (start.min(end), start.max(end));
    let rise = (more - less).lo().max(0.0);
    if rise >= bend.hi() {
        return less.lo();
    }
    let short = bend - Interval::point(rise);
    // Where squares underflow the second bound is the sharper one.
    let drop = (short.sqr() / (bend * 4.0)).hi().min((bend * 0.25).hi());
    (less - Interval::point(drop)).lo()
}
