//! Two triangles in motion: until when does a fixed direction keep them apart by more than the level?

use super::closest::closest;
use super::refined_directions::refined_directions;
use crate::search::motion::frame::Frame;
use crate::tree::margin::{DOWN, UNIT_F64, UP};
use d2m_lanes::{Doubles, Elementwise, Quad, QuadVec, Two};
use glam::DVec3;

/// Distances and bounds of one search, in the units of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairScale {
    /// Distance that is to be reached: wanted separation plus δ.
    pub(crate) level: f64,
    /// Bound on the error of a projected gap, for a unit direction.
    pub(crate) error: f64,
    /// Contact when the distance is at most this: level + δ + error.
    pub(crate) stop: f64,
    /// Pairs are followed to this much above the level, so that others that meet at the same features can be seen
    /// apart at the time of the contact.
    pub(crate) spare: f64,
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f64,
    /// From the followed point to the centre of the tree, body axes.
    pub(crate) arms: [DVec3; 2],
    /// |ω|²ρ of each body, ρ the largest distance from the followed point, rounded up.
    pub(crate) swings: [f64; 2],
}

impl PairScale {
    /// What is there before the first one.
    pub(crate) const NONE: Self = Self {
        level: 0.0,
        error: 0.0,
        stop: 0.0,
        spare: 0.0,
        acceleration: 0.0,
        arms: [DVec3::ZERO; 2],
        swings: [0.0; 2],
    };

    /// The distance down to which pairs are followed.
    #[inline(always)]
    fn aim(&self) -> f64 {
        self.level + self.spare
    }
}

/// How much one look does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Care {
    /// One direction and a bound on the acceleration: enough for most queries.
    Quick,
    /// Also the normals, and the corners' own accelerations: for pairs that stay close for long.
    Thorough,
}

/// What one look at a pair gives.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Look {
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

/// The triangles of a pair in the frame of B's tree, and how they move.
struct Placed {
    a: [DVec3; 3],
    b: [DVec3; 3],
    /// Velocity of A's tree centre against B's.
    velocity: DVec3,
    offset: DVec3,
    omega_a: DVec3,
    omega_b: DVec3,
    /// From the followed points to the centres of the trees.
    arm_a: DVec3,
    arm_b: DVec3,
    /// No later time matters, counted from the frame.
    enough: f64,
    care: Care,
}

/// Corners of A's triangle (tree-centred, body axes) moved into B's frame.
#[inline(always)]
pub(crate) fn place_a<D: Doubles>(frame: &Frame, corners: &[DVec3; 3]) -> [DVec3; 3] {
    let (r, apart) = (&frame.rotation, D::load(&frame.apart));
    [
        (r.times::<D>(corners[0]) + apart).store().to_vec(),
        (r.times::<D>(corners[1]) + apart).store().to_vec(),
        (r.times::<D>(corners[2]) + apart).store().to_vec(),
    ]
}

/// Looks at a pair at the time of the frame. `a`, `b`: corners relative to the trees' centres, body axes. `enough`:
/// a longer clear time is of no use.
#[inline(always)]
pub(crate) fn look<D: Doubles>(
    frame: &Frame,
    (a, b): (&[DVec3; 3], &[DVec3; 3]),
    scale: &PairScale,
    enough: f64,
    care: Care,
) -> Look {
    let placed = Placed::new::<D>(frame, (a, b), scale, (enough, care));
    let (mut direction, gap) = placed.widest_gap::<D>();
    let (apart, far) = (gap.exceeds(scale.level + scale.error), gap.exceeds(FAR_STOPS * scale.stop));
    let (mut best, mut touching) = (0.0, false);
    // One piece of code for the three directions: the widest; a normal, which lasts longer than the line to a corner
    // that comes closer when faces slide along each other; near the end that of the closest features, which attains
    // the distance.
    for attempt in if apart { 0 } else { 2 }..3 {
        if attempt == 1 {
            direction = widest_normal(&placed.a, &placed.b);
        } else if attempt == 2 {
            let near = closest::<D>(&placed.a, &placed.b);
            direction = near.direction;
            touching = near.square <= scale.stop * scale.stop;
        }
        best = placed.clear_for::<D>(direction, scale, scale.aim(), best);
        let enough_of_it = best >= enough || far && (attempt == 1 || care == Care::Quick);
        if attempt < 2 && enough_of_it {
            return Look::ClearFor(best);
        }
    }
    if !touching && best == 0.0 {
        best = placed.clear_along_refined::<D>(scale);
    }
    // One of the two ends applies up to rounding.
    if touching || best == 0.0 { Look::Near { crossing: !touching, direction } } else { Look::ClearFor(best) }
}

/// The time of a contact, looked back from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Behind {
    /// Its frame with all velocities reversed ([`Frame::reversed`]): what has a bound on its acceleration is followed
    /// backwards as well as forwards.
    pub(crate) reversed: Frame,
    /// The direction of the contact, not normalised, or zero: most pairs that are near it are apart along it too.
    pub(crate) direction: DVec3,
}

/// Are the triangles further apart than the level all the time from `span` before the contact up to its time? True
/// only if that is proven.
#[inline(always)]
pub(crate) fn apart_since<D: Doubles>(
    behind: &Behind,
    triangles: (&[DVec3; 3], &[DVec3; 3]),
    scale: &PairScale,
    span: f64,
) -> bool {
    let placed = Placed::new::<D>(&behind.reversed, triangles, scale, (span, Care::Quick));
    let mut direction = behind.direction;
    for attempt in 0..2 {
        if attempt == 1 {
            (direction, _) = placed.widest_gap::<D>();
        }
        if placed.clear_for::<D>(direction, scale, scale.level, 0.0) >= span {
            return true;
        }
    }
    false
}

impl Placed {
    #[inline(always)]
    fn new<D: Doubles>(
        frame: &Frame,
        (a, b): (&[DVec3; 3], &[DVec3; 3]),
        scale: &PairScale,
        (enough, care): (f64, Care),
    ) -> Self {
        Self {
            a: place_a::<D>(frame, a),
            b: *b,
            velocity: frame.velocity.to_vec(),
            offset: frame.apart.to_vec(),
            omega_a: frame.omega_a.to_vec(),
            omega_b: frame.omega_b.to_vec(),
            arm_a: frame.rotation.times::<D>(scale.arms[0]).store().to_vec(),
            arm_b: scale.arms[1],
            enough,
            care,
        }
    }

    /// Of the 2 normals, the 9 products of edges, 3 edge normals and the line of centres: the direction with the
    /// widest gap, and the gap.
    #[inline(always)]
    fn widest_gap<D: Doubles>(&self) -> (DVec3, Gap) {
        let (a, b) = (&self.a, &self.b);
        let ea = [a[1] - a[0], a[2] - a[1], a[0] - a[2]];
        let eb = [b[1] - b[0], b[2] - b[1], b[0] - b[2]];
        let (normal_a, normal_b) = (ea[0].cross(ea[1]), eb[0].cross(eb[1]));
        let center = (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]);
        let first = QuadVec::<D>::new([normal_a, normal_b, center, b[0] - a[0]]);
        let across = QuadVec::<D>::new([eb[0], eb[1], eb[2], normal_a]);
        let ends = QuadVec::<D>::splat(ea[1]).beside(&QuadVec::splat(ea[2]));
        let best = Widest::of(&first.beside(&across.crossed_by(ea[0])), a, b).or(&Widest::of(
            &ends.crossed(&across.beside(&across)),
            a,
            b,
        ));
        best.halves::<D>().of_all()
    }

    /// The larger of `known` and the time for which the direction keeps the pair further apart than `level`.
    #[inline(always)]
    fn clear_for<D: Doubles>(&self, n: DVec3, scale: &PairScale, level: f64, known: f64) -> f64 {
        let n = lengthened(n);
        let a = QuadVec::<D>::new([self.a[0], self.a[1], self.a[2], self.a[2]]);
        let b = QuadVec::<D>::new([self.b[0], self.b[1], self.b[2], self.b[2]]);
        let (pa, pb) = (a.dot(n), b.dot(n));
        let (forward, backward) = (pb.least() - pa.greatest(), pa.least() - pb.greatest());
        let a_is_low = forward > backward;
        let gap = if a_is_low { forward } else { backward };
        let length = n.length();
        let need = (level + scale.error) * length;
        // Not when n is zero or not a number either, nor so short that its square is lost to underflow.
        let separated = gap > need && length > SHORTEST;
        if !separated {
            return known;
        }
        let (turn_a, turn_b) = (n.cross(self.omega_a), n.cross(self.omega_b));
        let drift = n.dot(self.velocity) - turn_a.dot(self.offset);
        let (ra, rb) = (a.dot(turn_a) + D::splat(drift), b.dot(turn_b));
        let s = if self.care == Care::Quick {
            let (low, high) = if a_is_low { ((pa, ra), (pb, rb)) } else { ((pb, rb), (pa, ra)) };
            first_time(low, high, need, scale.acceleration * length)
        } else {
            let of = [(three(pa), three(ra)), (three(pb), three(rb))];
            self.clear_for_jets(n, scale, (a_is_low, need), of)
        };
        if s > known { s } else { known }
    }

    /// The largest time along directions that are made accurate for slivers and for edges that are nearly parallel: needed
    /// only where the others separate nothing although the features are apart, or where triangles cross.
    #[cold]
    #[inline(never)]
    fn clear_along_refined<D: Doubles>(&self, scale: &PairScale) -> f64 {
        let mut best = 0.0;
        for direction in refined_directions(&self.a, &self.b) {
            best = self.clear_for::<D>(direction, scale, scale.aim(), best);
        }
        best
    }

    /// The same with the corners' own accelerations; positions and rates along `n` are given.
    #[inline(never)]
    fn clear_for_jets(
        &self,
        n: DVec3,
        scale: &PairScale,
        (a_is_low, need): (bool, f64),
        [(pa, ra), (pb, rb)]: [([f64; 3], [f64; 3]); 2],
    ) -> f64 {
        let (a, b, length) = (&self.a, &self.b, n.length());
        let (turn_a, turn_b) = (n.cross(self.omega_a), n.cross(self.omega_b));
        // |n·(ω × (ω × e))| = |(n × ω)·(ω × e)| ≤ |n × ω||ω||e|, and the same times |ω| for the next derivative.
        let [swing_a, swing_b] = self.swings(scale, turn_a, turn_b);
        let m = (swing_a + swing_b).min(scale.acceleration * length) * UP;
        let quad = |v: &[f64; 3]| Quad([v[0], v[1], v[2], v[2]]);
        let ((qa, ua), (qb, ub)) = ((quad(&pa), quad(&ra)), (quad(&pb), quad(&rb)));
        let s = if a_is_low {
            first_time((qa, ua), (qb, ub), need, m)
        } else {
            first_time((qb, ub), (qa, ua), need, m)
        };
        let speed = if a_is_low { least(&rb) - greatest(&ra) } else { least(&ra) - greatest(&rb) };
        if s >= self.enough || m * s <= PATIENCE * speed.abs() {
            return s;
        }
        let jerk = (swing_a * self.omega_a.length() + swing_b * self.omega_b.length()) * UP;
        let bend_a = self.omega_a * self.omega_a.dot(n) - n * self.omega_a.length_squared();
        let bend_b = self.omega_b * self.omega_b.dot(n) - n * self.omega_b.length_squared();
        let (arm_a, arm_b) = (self.arm_a - self.offset, self.arm_b);
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
    fn swings(&self, scale: &PairScale, turn_a: DVec3, turn_b: DVec3) -> [f64; 2] {
        let one = |swing: f64, turn: DVec3, omega: DVec3| {
            let square = omega.length_squared();
            if square > 0.0 { swing * (turn.length_squared() / square).sqrt() } else { 0.0 }
        };
        [one(scale.swings[0], turn_a, self.omega_a), one(scale.swings[1], turn_b, self.omega_b)]
    }
}

/// Of the two normals the one along which the gap is wider (not normalised).
#[inline(always)]
pub(crate) fn widest_normal(a: &[DVec3; 3], b: &[DVec3; 3]) -> DVec3 {
    let along = |n: DVec3| {
        let (pa, pb) = (a.map(|p| n.dot(p)), b.map(|p| n.dot(p)));
        let gap = (least(&pb) - greatest(&pa)).max(least(&pa) - greatest(&pb));
        (gap * gap.abs(), n.length_squared())
    };
    let (na, nb) = ((a[1] - a[0]).cross(a[2] - a[0]), (b[1] - b[0]).cross(b[2] - b[0]));
    let ((ga, la), (gb, lb)) = (along(na), along(nb));
    if ga * lb > gb * la { na } else { nb }
}

/// Directions that are used are longer than this: lengths and times are about one, and the products of up to four of them and of
/// gaps of at least 2⁻⁵³ are not lost to underflow.
const SHORTEST: f64 = 1e-30;
/// What rates are lowered by, so that none is zero and the square of none underflows: a gap that grows less is never late, and the
/// unit of time is short against what this rate takes.
const LEAST_RATE: f64 = 1e-140;
/// Stands for "at no time": longer than every window, and finite, so that no product with a rate of zero is undefined.
const NEVER: f64 = 1e300;
/// Features closer than so many stopping distances are tested themselves.
const FAR_STOPS: f64 = 16.0;
/// The discriminant v² − 2ag errs by at most 2·2⁻⁵³(v² + |2ag|); twice that and some room.
const DISCRIMINANT_ERROR: f64 = 8.0 * UNIT_F64;

/// The direction, made longer when it is very short; zero stays zero.
#[inline(always)]
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

/// The first bound is good enough when the acceleration changes speeds by less than this part of them.
const PATIENCE: f64 = 0.1;

/// Positions, rates and accelerations of three corners along a direction.
struct Jets {
    at: [f64; 3],
    rate: [f64; 3],
    bend: [f64; 3],
}

/// Directions side by side, the square of the gap along each (not normalised, zero when there is none) and of its length.
struct Widest<D> {
    axis: QuadVec<D>,
    square: D,
    length: D,
}

/// The widest gap that was found along a direction.
#[derive(Clone, Copy)]
pub(crate) struct Gap {
    /// Square of the gap along a direction that is not normalised, zero when there is none.
    square: f64,
    /// Square of the direction's length.
    length: f64,
}

impl Gap {
    #[inline(always)]
    fn exceeds(&self, limit: f64) -> bool {
        self.square > limit * limit * self.length
    }
}

impl<D: Elementwise<Scalar = f64>> Widest<D> {
    #[inline(always)]
    fn of(axis: &QuadVec<D>, a: &[DVec3; 3], b: &[DVec3; 3]) -> Self {
        // From corner 0 of A: its own projection is zero.
        let zero = D::splat(0.0);
        let (a1, a2) = (axis.dot(a[1] - a[0]), axis.dot(a[2] - a[0]));
        let (b0, b1, b2) = (axis.dot(b[0] - a[0]), axis.dot(b[1] - a[0]), axis.dot(b[2] - a[0]));
        let (low_a, high_a) = (a1.min(a2).min(zero), a1.max(a2).max(zero));
        let (low_b, high_b) = (b0.min(b1).min(b2), b0.max(b1).max(b2));
        let gap = (low_b - high_a).max(low_a - high_b).max(zero);
        let length = axis.length_squared();
        // No direction at all has a gap of zero.
        let length = D::if_greater(length, zero, length, D::splat(1.0));
        Self { axis: *axis, square: gap * gap, length }
    }

    /// In each lane the direction with the wider gap: gap²/|n|², compared without dividing.
    #[inline(always)]
    fn or(self, other: &Self) -> Self {
        let (left, right) = (other.square * self.length, self.square * other.length);
        let ([x, y, z], [u, v, w]) = (other.axis.0, self.axis.0);
        Self {
            axis: QuadVec([
                D::if_greater(left, right, x, u),
                D::if_greater(left, right, y, v),
                D::if_greater(left, right, z, w),
            ]),
            square: D::if_greater(left, right, other.square, self.square),
            length: D::if_greater(left, right, other.length, self.length),
        }
    }

    /// In each lane the wider one of both halves.
    #[inline(always)]
    fn halves<H: Doubles<Two = D>>(self) -> Widest<H>
    where
        D: Two<H>,
    {
        let [x, y, z] = self.axis.0;
        let first = Widest {
            axis: QuadVec([x.first(), y.first(), z.first()]),
            square: self.square.first(),
            length: self.length.first(),
        };
        first.or(&Widest {
            axis: QuadVec([x.second(), y.second(), z.second()]),
            square: self.square.second(),
            length: self.length.second(),
        })
    }
}

impl<D: Doubles> Widest<D> {
    /// The widest of all lanes. Without a branch: which one it is cannot be predicted.
    #[inline(always)]
    fn of_all(self) -> (DVec3, Gap) {
        let (square, length) = (self.square.store().0, self.length.store().0);
        let i = wider(&square, &length, 0, 1);
        let j = wider(&square, &length, 2, 3);
        let lane = wider(&square, &length, i, j);
        let [x, y, z] = self.axis.0;
        let axis = DVec3::new(x.store().0[lane], y.store().0[lane], z.store().0[lane]);
        (axis, Gap { square: square[lane], length: length[lane] })
    }
}

#[inline(always)]
fn least(v: &[f64; 3]) -> f64 {
    let m = if v[0] < v[1] { v[0] } else { v[1] };
    if m < v[2] { m } else { v[2] }
}

#[inline(always)]
fn greatest(v: &[f64; 3]) -> f64 {
    let m = if v[0] > v[1] { v[0] } else { v[1] };
    if m > v[2] { m } else { v[2] }
}

/// Of two lanes the one with the wider gap.
#[inline(always)]
fn wider(square: &[f64; 4], length: &[f64; 4], i: usize, j: usize) -> usize {
    [i, j][usize::from(square[j & 3] * length[i & 3] > square[i & 3] * length[j & 3])]
}

/// First s ≥ 0 at which min(high + s·rate) − max(low + s·rate) − m s²/2 can be `need`. At s = 0 it is larger.
#[inline(always)]
fn first_time<D: Doubles>(low: (D, D), high: (D, D), need: f64, m: f64) -> f64 {
    // Lowest corner now with the fastest closing rate: never late; exact when one corner is both.
    let gap = high.0.least() - low.0.greatest() - need;
    let s = root(gap, high.1.least() - low.1.greatest(), m);
    // Concave in s: the chord from a proven time to a later one with a positive value is proven too.
    let later = 2.0 * s;
    let (l, h) = (low.0 + low.1 * D::splat(later), high.0 + high.1 * D::splat(later));
    let value = h.least() - l.greatest() - need;
    let s = if value - 0.5 * m * later * later > 0.0 { later } else { s };
    s * DOWN
}

/// Root of g + v s − m s²/2 for g > 0: sums of terms of one sign only.
#[inline(always)]
fn root(g: f64, v: f64, m: f64) -> f64 {
    let v = v - LEAST_RATE;
    let root = (v * v + 2.0 * m * g).sqrt();
    if v < 0.0 {
        2.0 * g / (root - v)
    } else if m > 0.0 {
        (v + root) / m
    } else {
        NEVER
    }
}

/// A time until which every pair of corners stays further apart than `need`, of which none beyond `enough` matters.
///
/// For each pair f(s) ≥ g + v s + a s²/2 − J s³/6, and for s ≤ S the last two terms are at least (a − J S/3) s²/2: a
/// parabola, whose first root holds up to S. S starts where J would not matter, and moves towards the root.
#[inline(never)]
fn first_time_of_jets(low: &Jets, high: &Jets, need: f64, jerk: f64, enough: f64) -> f64 {
    let pair = |k: usize| {
        let (i, j) = (k / 3, k % 3);
        let gap = high.at[j] - (low.at[i] + need);
        (gap, high.rate[j] - low.rate[i], high.bend[j] - low.bend[i])
    };
    let pairs: [(f64, f64, f64); 9] = core::array::from_fn(pair);
    let finite =
        low.rate.iter().chain(&high.rate).chain(&low.bend).chain(&high.bend).map(|x| x.abs()).sum::<f64>()
            + jerk;
    if !finite.is_finite() {
        return 0.0;
    }
    let first_root = |loss: f64| {
        let mut first = f64::INFINITY;
        for &(g, v, a) in &pairs {
            let s = parabola_root(g, v, a - loss);
            first = if s < first { s } else { first };
        }
        first
    };
    let mut span = first_root(0.0).min(enough * (UP * UP));
    let mut proven = 0.0;
    for _ in 0..3 {
        let s = first_root(jerk * span * (1.0 / 3.0 * UP));
        proven = s.min(span).max(proven);
        if s >= 0.8 * span {
            break;
        }
        span = (span * s).sqrt();
    }
    proven * DOWN
}

/// First root of g + v s + a s²/2, g > 0, never late; infinite when there is none.
#[inline(always)]
fn parabola_root(g: f64, v: f64, a: f64) -> f64 {
    let (v, bent) = (v - LEAST_RATE, 2.0 * a * g);
    // Too large by more than its rounding: the root of a closing pair is early.
    let square = (v * v - bent) + DISCRIMINANT_ERROR * (v * v + bent.abs());
    let root = square.max(0.0).sqrt();
    let closing = v < 0.0;
    let (above, below) = (if closing { 2.0 * g } else { v + root }, if closing { root - v } else { -a });
    if square < 0.0 || !closing && a >= 0.0 { f64::INFINITY } else { above / below }
}
