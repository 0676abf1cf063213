//! Where the bodies are at one time, and the gap between two parts of them along a direction.
use crate::closest::closest;
use crate::directions::{BoxAxis, Direction, between, faces_and_sides};
use crate::mesh::finite;
use crate::{Body, TimeSpan};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::CertifiedState;
use glam::{DMat3, DVec2, DVec3};

/// A part of a body is all that is between these points (or boxes), from its mesh's center in body axes.
pub(crate) type Part<'p> = &'p [IntervalVec3];

/// A direction along which two parts may be further apart than a distance D.
///
/// Where |N| is fixed, N·(x − p) > D|N| says so. Where it changes, D|N| ≤ D(N² + c²)/(2c), which is smooth; c is about |N|.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Separation {
    pub(crate) direction: Direction,
    pub(crate) distance: f64,
    pub(crate) about: f64,
}

impl Separation {
    /// D/(2c).
    pub(crate) fn per_square(&self) -> Interval {
        if self.distance == 0.0 {
            return Interval::ZERO;
        }
        Interval::point(self.distance) / (Interval::point(self.about) * 2.0)
    }

    /// What N·(x − p) has to be above of where N is this.
    fn needed(&self, n: IntervalVec3) -> Interval {
        match self.direction {
            Direction::Across(..) => {
                (n.norm_squared() + Interval::point(self.about).sqr()) * self.per_square()
            }
            fixed => fixed.size() * self.distance,
        }
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
    pub(crate) axes: [BoxAxis; 15],
    /// Where the bodies are in the world, seen from a point near both.
    states: [CertifiedState; 2],
}

impl Instant {
    /// `None` where an enclosure says nothing: what is empty, unbounded or no number proves nothing.
    pub(crate) fn new(bodies: &[Body<'_>; 2], time: f64) -> Option<Self> {
        // Near the bodies, so that their positions lose nothing far from the world's origin.
        let near = bodies[0].motion.pose_and_twist(time).0.translation;
        let origin = if near.is_finite() { near } else { DVec3::ZERO };
        let [a, b] =
            bodies.map(|body| body.motion.enclose_state_about(time, origin).following(body.mesh.center));
        Self::of_states(time, &a, &b)
    }

    /// What holds at all times of a span; as wide as the bodies move in it.
    pub(crate) fn over(bodies: &[Body<'_>; 2], span: TimeSpan) -> Option<Self> {
        let times = Interval::try_new(span.from, span.to).ok()?;
        let [a, b] = bodies.map(|body| body.motion.enclose_kinematics(times).following(body.mesh.center));
        let origin = a.position.center;
        Self::of_states(span.from, &a.state_about(origin), &b.state_about(origin))
    }

    fn of_states(time: f64, a: &CertifiedState, b: &CertifiedState) -> Option<Self> {
        let boxes = [a, b].map(|state| {
            let at = around(state.position, state.position_radius);
            around_matrix(state.rotation, state.rotation_radius).zip(at)
        });
        let [(turn_a, at_a), (turn_b, at_b)] = [boxes[0]?, boxes[1]?];
        let back_a = turn_a.transpose();
        let turn = back_a.mul_mat(turn_b);
        let offset = finite(back_a.mul_vec(at_b - at_a))?;
        let [x, y, z] = turn.cols().map(finite);
        let turn_guess = DMat3::from_cols(x?.mid(), y?.mid(), z?.mid());
        let (back, offset_guess, axes) = (turn.transpose(), offset.mid(), BoxAxis::all(&turn_guess));
        Some(Self { time, turn, back, offset, turn_guess, offset_guess, axes, states: [*a, *b] })
    }

    /// A point of the other body, seen from the base.
    pub(crate) fn seen(&self, q: IntervalVec3) -> IntervalVec3 {
        self.turn.mul_vec(q) + self.offset
    }

    /// A point of the base, seen from the other body.
    pub(crate) fn seen_back(&self, p: IntervalVec3) -> IntervalVec3 {
        self.back.mul_vec(p - self.offset)
    }

    pub(crate) fn guess(&self, q: DVec3) -> DVec3 {
        self.turn_guess * q + self.offset_guess
    }

    /// N, and N·(x − p) over all points p of the base's part and x of the other's.
    fn gap(&self, direction: Direction, [base, other]: [Part<'_>; 2]) -> (IntervalVec3, Interval) {
        let [n, n_other] = direction.at(&self.turn, &self.back);
        let along = |n: IntervalVec3, part: Part<'_>| part.iter().map(|&p| n.dot(p)).reduce(Interval::hull);
        let [base, other] = [along(n, base), along(n_other, other)].map(|x| x.unwrap_or(Interval::ENTIRE));
        (n, n.dot(self.offset) + other - base)
    }

    /// By how much the gap is certainly above what is needed: what is proven of this time.
    pub(crate) fn above(&self, separation: &Separation, parts: [Part<'_>; 2]) -> f64 {
        let (n, gap) = self.gap(separation.direction, parts);
        (gap - separation.needed(n)).lo()
    }

    /// Encloses the distance of two triangles: it is at least a gap along a direction, and at most that of two of their points.
    pub(crate) fn distance(&self, corners: &[[IntervalVec3; 3]; 2]) -> Interval {
        let upper = self.most_distance(corners);
        if upper == 0.0 {
            return Interval::ZERO;
        }
        let guess = corners.map(|t| t.map(IntervalVec3::mid));
        let directions = faces_and_sides(&guess).into_iter();
        let directions = directions.chain(between(&guess, &self.turn_guess, self.offset_guess));
        let placed = [0, 1].map(|k| corners[k].map(|p| self.placed(k, p)));
        let lower = directions.map(|direction| {
            // Any vector is a direction, along it or against it.
            let n = IntervalVec3::point(self.states[0].rotation * direction.guess(&self.turn_guess));
            let gap = placed[1].map(|b| placed[0].map(|a| n.dot(b.middle - a.middle)));
            let gap = gap.into_iter().flatten().reduce(Interval::hull).unwrap_or(Interval::ENTIRE);
            let gap = gap.lo().max(-gap.hi());
            // By the length of a direction that may be zero nothing is divided.
            if gap > 0.0 { (Interval::point(gap) / Interval::point(n.norm().hi())).lo() } else { 0.0 }
        });
        let off = placed.map(|t| t.into_iter().fold(Interval::ZERO, |most, p| most.max(p.off)));
        let lower = (Interval::point(lower.fold(0.0, f64::max)) - off[0] - off[1]).lo();
        Interval::try_new(lower.max(0.0).min(upper), upper).unwrap_or(Interval::ENTIRE)
    }

    /// Bounds the distance of two triangles from above; zero where they certainly cross.
    pub(crate) fn most_distance(&self, corners: &[[IntervalVec3; 3]; 2]) -> f64 {
        let [a, b] = corners;
        if cross(a, &b.map(|q| self.seen(q))) {
            return 0.0;
        }
        let seen = b.map(|q| self.guess(q.mid()));
        match closest(&a.map(IntervalVec3::mid), &seen).weights.map(on_triangle) {
            [Some(s), Some(t)] => {
                let [a, b] = [self.placed(0, point(a, s)), self.placed(1, point(b, t))];
                ((b.middle - a.middle).norm() + a.off + b.off).hi()
            }
            _ => f64::INFINITY,
        }
    }

    /// A point of one of the bodies in the world. What the enclosures of the poses leave open is a ball about the middles, which is
    /// less than what is left of it in three products of boxes by up to 3√3.
    fn placed(&self, body: usize, p: IntervalVec3) -> Placed {
        let state = &self.states[body];
        let middle = IntervalMat3::point(state.rotation).mul_vec(p) + IntervalVec3::point(state.position);
        let off = p.norm() * state.rotation_radius + Interval::point(state.position_radius);
        Placed { middle, off }
    }
}

/// A point is within `off` of one of these.
#[derive(Clone, Copy)]
struct Placed {
    middle: IntervalVec3,
    off: Interval,
}

/// The vectors within `radius` of `center`.
fn around(center: DVec3, radius: f64) -> Option<IntervalVec3> {
    let [x, y, z] = center.to_array().map(|x| Interval::around(x, radius));
    if radius >= 0.0 { finite(IntervalVec3::new(x, y, z)) } else { None }
}

/// The matrices within `radius` (operator norm) of `m`: no entry is further off than that.
pub(crate) fn around_matrix(m: DMat3, radius: f64) -> Option<IntervalMat3> {
    let [x, y, z] = m.to_cols_array_2d().map(|column| around(column.into(), radius));
    Some(IntervalMat3::from_cols([x?, y?, z?]))
}

/// Weights of a point that is certainly on the triangle: moved by a few units in the last place if need be.
fn on_triangle(weights: DVec2) -> Option<DVec2> {
    let is_on =
        |w: &DVec2| w.min_element() >= 0.0 && (Interval::point(w.x) + Interval::point(w.y)).hi() <= 1.0;
    [weights, weights.max(DVec2::ZERO) * (1.0 - 8.0 * f64::EPSILON)].into_iter().find(is_on)
}

fn point([a, b, c]: &[IntervalVec3; 3], weights: DVec2) -> IntervalVec3 {
    *a + (*b - *a) * weights.x + (*c - *a) * weights.y
}

/// Does a side of one triangle certainly pass through the other one? Five signs of volumes.
fn cross(a: &[IntervalVec3; 3], b: &[IntervalVec3; 3]) -> bool {
    let volume = |[u, v, w, x]: [IntervalVec3; 4]| sign((v - u).triple_product(w - u, x - u));
    let passes = |[p, q]: [IntervalVec3; 2], [a, b, c]: [IntervalVec3; 3]| {
        let turns = [(a, b), (b, c), (c, a)].map(|(u, v)| volume([p, q, u, v]));
        volume([a, b, c, p]) * volume([a, b, c, q]) < 0
            && turns[0] != 0
            && turns.iter().all(|&t| t == turns[0])
    };
    (0..3).any(|k| passes([a[k], a[(k + 1) % 3]], *b) || passes([b[k], b[(k + 1) % 3]], *a))
}

/// The proven sign; 0: none.
pub(crate) fn sign(x: Interval) -> i32 {
    i32::from(x.certainly_positive()) - i32::from(x.certainly_negative())
}
