//! How the bodies may move relative to each other over a span of time.
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
use crate::instant::{Direction, Part, around_matrix};
use crate::mesh::finite;
use crate::{Body, TimeSpan};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};

/// Enclosures over a span, world axes.
pub(crate) struct Turning {
    turn: [IntervalMat3; 2],
    d: IntervalVec3,
    u: IntervalVec3,
    u_rate: IntervalVec3,
    spin: IntervalVec3,
    spin_rate: IntervalVec3,
}

impl Turning {
    /// `None` where an enclosure says nothing.
    pub(crate) fn new(bodies: &[Body<'_>; 2], span: TimeSpan) -> Option<Self> {
        let time = Interval::try_new(span.from, span.to).ok()?;
        let [a, b] = bodies.map(|body| body.motion.enclose_kinematics(time).following(body.mesh.center));
        let tails = IntervalVec3::point(b.position_tail) - IntervalVec3::point(a.position_tail);
        let ball = |v: d2m_motion::Ball| (v.radius >= 0.0).then(|| v.to_box()).and_then(finite);
        let d = finite(ball(b.position)? - ball(a.position)? + tails)?;
        let v = ball(b.linear)? - ball(a.linear)?;
        let (wa, wb) = (ball(a.angular)?, ball(b.angular)?);
        let (ra, rb) = (ball(a.angular_rate)?, ball(b.angular_rate)?);
        let coriolis = wa.cross(v) * 2.0;
        let centripetal = wa.cross(wa.cross(d));
        let turn = [&a, &b].map(|k| around_matrix(k.rotation, k.rotation_radius));
        Some(Self {
            turn: [turn[0]?, turn[1]?],
            d,
            u: finite(v - wa.cross(d))?,
            u_rate: finite(
                ball(b.linear_rate)? - ball(a.linear_rate)? - ra.cross(d) - coriolis + centripetal,
            )?,
            spin: finite(wb - wa)?,
            spin_rate: finite(rb - ra - wa.cross(wb))?,
        })
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let [w1, turn_rate] = [self.spin, self.spin_rate].map(IntervalVec3::norm);
        let [speed, rate] = [self.u, self.u_rate].map(IntervalVec3::norm);
        Bounds { speed, rate, w1, w2: turn_rate + w1.sqr() }
    }

    /// An upper bound of g″ over the span for all points of the parts, g = N·(x − p) − D(N² + c²)/(2c), by its own terms:
    /// N″·y + 2N′·y′ + N·y″ with y = x − p. Not below zero.
    pub(crate) fn curvature(&self, direction: Direction, [base, other]: [&Part; 2], level: &Level) -> f64 {
        let s = self.turn[1].mul_vec(other.bounds());
        let y = self.d + s - self.turn[0].mul_vec(base.bounds());
        let swing = |v: IntervalVec3| self.spin.cross(v);
        let second = |v: IntervalVec3| self.spin_rate.cross(v) + swing(swing(v));
        let (y1, y2) = (self.u + swing(s), self.u_rate + second(s));
        let sum =
            |n: IntervalVec3, n1: IntervalVec3, n2: IntervalVec3| n2.dot(y) + n1.dot(y1) * 2.0 + n.dot(y2);
        let value = match direction {
            Direction::Base(n) => self.turn[0].mul_point(n).dot(y2),
            Direction::Other(n) => {
                let n = self.turn[1].mul_point(n);
                sum(n, swing(n), second(n))
            }
            Direction::Across(e, f) => {
                let (e, f) = (self.turn[0].mul_point(e), self.turn[1].mul_point(f));
                let [n, n1, n2] = [f, swing(f), second(f)].map(|f| e.cross(f));
                sum(n, n1, n2) - (n1.norm_squared() + n.dot(n2)) * level.per_square() * 2.0
            }
        };
        value.hi().max(0.0)
    }
}

/// Lengths of the same, upper bounds as intervals, so that sums and products of them round upwards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    speed: Interval,
    rate: Interval,
    w1: Interval,
    w2: Interval,
}

impl Bounds {
    /// Nothing is known.
    pub(crate) const NONE: Self =
        Self { speed: Interval::ENTIRE, rate: Interval::ENTIRE, w1: Interval::ENTIRE, w2: Interval::ENTIRE };

    /// |x′| of points within `reach` of the other body's center.
    pub(crate) fn speed(&self, reach: f64) -> Interval {
        self.speed + self.w1 * reach
    }

    /// Upper bounds of f″ for |N| = 1 that is fixed in the base, and for one that turns.
    pub(crate) fn curvatures(&self, reach: f64, far: Interval) -> [Interval; 2] {
        let fixed = self.rate + self.w2 * reach;
        [fixed, fixed + self.w1 * self.speed(reach) * 2.0 + self.w2 * far]
    }

    /// An upper bound of g″ by lengths: |N|(Y₂ + 2w₁Y₁ + w₂Y₀), and for a length that changes D|N|²w₂/c. `far` bounds |x − p|.
    pub(crate) fn curvature(&self, direction: Direction, reach: f64, far: Interval, level: &Level) -> f64 {
        let (size, [fixed, turning]) = (direction.size(), self.curvatures(reach, far));
        let value = match direction {
            Direction::Base(_) => size * fixed,
            Direction::Other(_) => size * turning,
            Direction::Across(..) => size * turning + size.sqr() * self.w2 * level.per_square() * 2.0,
        };
        value.hi()
    }
}

/// The distance D that is to be proven, and the length c that a direction across two edges has about.
///
/// Where |N| is fixed, f > D|N| says that the parts are further apart than D. Where it changes, D|N| ≤ D(N² + c²)/(2c), which is
/// smooth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub(crate) distance: f64,
    pub(crate) about: f64,
}

impl Level {
    /// D/(2c).
    fn per_square(&self) -> Interval {
        if self.distance == 0.0 {
            Interval::ZERO
        } else {
            Interval::point(self.distance) / (Interval::point(self.about) * 2.0)
        }
    }

    /// What f has to be above of, for this direction with these values.
    pub(crate) fn needed(&self, direction: Direction, n: IntervalVec3) -> Interval {
        match direction {
            Direction::Across(..) => {
                (n.norm_squared() + Interval::point(self.about).sqr()) * self.per_square()
            }
            fixed => fixed.size() * self.distance,
        }
    }
}

/// A lower bound of g on [0, L] from g(0) ≥ `start`, g(L) ≥ `end` and g″ ≤ K, with `bend` ≥ K L²/2.
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
pub(crate) fn lowest(start: f64, end: f64, bend: f64) -> f64 {
    let (less, more) = (Interval::point(start.min(end)), Interval::point(start.max(end)));
    let (bend, rise) = (Interval::point(bend), (more - less).lo().max(0.0));
    if rise >= bend.hi() {
        return less.lo();
    }
    let short = bend - Interval::point(rise);
    // Where squares underflow the second bound is the sharper one.
    let drop = (short.sqr() / (bend * 4.0)).hi().min((bend * 0.25).hi());
    (less - Interval::point(drop)).lo()
}
