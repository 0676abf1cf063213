//! Two triangles in motion: until when does a fixed direction keep them apart by more than the level?

use super::closest::closest;
use super::frame::Frame;
use super::quad::{Quad, QuadVec};
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
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f64,
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
}

/// Corners of A's triangle (tree-centred, body axes) moved into B's frame.
#[inline(always)]
pub(crate) fn place_a(frame: &Frame, corners: &[DVec3; 3]) -> [DVec3; 3] {
    let r = &frame.rotation;
    [
        (r.times(corners[0]) + frame.apart).to_vec(),
        (r.times(corners[1]) + frame.apart).to_vec(),
        (r.times(corners[2]) + frame.apart).to_vec(),
    ]
}

/// Looks at a pair at the time of the frame. `a`, `b`: corners relative to the trees' centres, body axes. `enough`:
/// a longer clear time is of no use.
#[inline(always)]
pub(crate) fn look(frame: &Frame, a: &[DVec3; 3], b: &[DVec3; 3], scale: &PairScale, enough: f64) -> Look {
    let placed = Placed {
        a: place_a(frame, a),
        b: *b,
        velocity: frame.velocity.to_vec(),
        offset: frame.apart.to_vec(),
        omega_a: frame.omega_a.to_vec(),
        omega_b: frame.omega_b.to_vec(),
    };
    let (direction, gap) = placed.widest_gap();
    let mut best = 0.0;
    if gap > scale.level + scale.error {
        best = placed.clear_for(direction, scale, best);
        if best >= enough || gap > 16.0 * scale.stop {
            return Look::ClearFor(best);
        }
    }
    placed.look_closely(scale, best)
}

impl Placed {
    /// Of the 2 normals, the 9 products of edges, 3 edge normals and the line of centres: the direction with the
    /// widest gap, and the gap for a unit direction (not positive when none separates).
    #[inline(always)]
    fn widest_gap(&self) -> (DVec3, f64) {
        let (a, b) = (&self.a, &self.b);
        let ea = [a[1] - a[0], a[2] - a[1], a[0] - a[2]];
        let eb = [b[1] - b[0], b[2] - b[1], b[0] - b[2]];
        let (normal_a, normal_b) = (ea[0].cross(ea[1]), eb[0].cross(eb[1]));
        let across = QuadVec::new([eb[0], eb[1], eb[2], normal_a]);
        let center = (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]);
        let first = QuadVec::new([normal_a, normal_b, center, b[0] - a[0]]);
        // gap·|gap|/|n|², compared without dividing.
        let mut best = Quad::splat(0.0);
        let mut best_length = Quad::splat(1.0);
        let mut best_axis = first;
        for axis in [first, across.crossed_by(ea[0]), across.crossed_by(ea[1]), across.crossed_by(ea[2])] {
            let (pa, pb) = (a, b);
            let low_a = axis.dot(pa[0]).min(axis.dot(pa[1])).min(axis.dot(pa[2]));
            let high_a = axis.dot(pa[0]).max(axis.dot(pa[1])).max(axis.dot(pa[2]));
            let low_b = axis.dot(pb[0]).min(axis.dot(pb[1])).min(axis.dot(pb[2]));
            let high_b = axis.dot(pb[0]).max(axis.dot(pb[1])).max(axis.dot(pb[2]));
            let gap = (low_b - high_a).max(low_a - high_b).max(Quad::splat(0.0));
            let square = gap * gap;
            let length = axis.length_squared();
            let (left, right) = (square * best_length, best * length);
            best = Quad::if_greater(left, right, square, best);
            best_length = Quad::if_greater(left, right, length, best_length);
            for k in 0..3 {
                best_axis.0[k] = Quad::if_greater(left, right, axis.0[k], best_axis.0[k]);
            }
        }
        let mut lane = 0;
        for other in 1..4 {
            if best.0[other] * best_length.0[lane] > best.0[lane] * best_length.0[other] {
                lane = other;
            }
        }
        let axis = DVec3::new(best_axis.0[0].0[lane], best_axis.0[1].0[lane], best_axis.0[2].0[lane]);
        (axis, (best.0[lane] / best_length.0[lane]).sqrt())
    }

    /// Near the end: the direction of the closest features too, and the distance itself.
    #[cold]
    #[inline(never)]
    fn look_closely(&self, scale: &PairScale, known: f64) -> Look {
        let near = closest(&self.a, &self.b);
        let best = self.clear_for(near.direction, scale, known);
        // The features' own directions attain the distance, so one of the two ends applies up to rounding.
        let touching = near.square <= scale.stop * scale.stop;
        if touching || best == 0.0 { Look::Near { crossing: !touching } } else { Look::ClearFor(best) }
    }

    /// The larger of `known` and the time for which the direction keeps the pair apart.
    #[inline(always)]
    fn clear_for(&self, n: DVec3, scale: &PairScale, known: f64) -> f64 {
        let (a, b) = (&self.a, &self.b);
        let pa = [n.dot(a[0]), n.dot(a[1]), n.dot(a[2])];
        let pb = [n.dot(b[0]), n.dot(b[1]), n.dot(b[2])];
        let forward = least(&pb) - greatest(&pa);
        let backward = least(&pa) - greatest(&pb);
        let length = n.length();
        let need = (scale.level + scale.error) * length;
        // Also when n is zero or not a number.
        let separated = forward > need || backward > need;
        if !separated {
            return known;
        }
        let (turn_a, turn_b) = (n.cross(self.omega_a), n.cross(self.omega_b));
        let drift = n.dot(self.velocity) - turn_a.dot(self.offset);
        let ra = [drift + turn_a.dot(a[0]), drift + turn_a.dot(a[1]), drift + turn_a.dot(a[2])];
        let rb = [turn_b.dot(b[0]), turn_b.dot(b[1]), turn_b.dot(b[2])];
        let m = scale.acceleration * length;
        let s = if forward > backward {
            first_time((&pa, &ra), (&pb, &rb), need, m)
        } else {
            first_time((&pb, &rb), (&pa, &ra), need, m)
        };
        if s > known { s } else { known }
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

/// First s ≥ 0 at which min(high + s·rate) − max(low + s·rate) − m s²/2 can be `need`. At s = 0 it is larger.
#[inline(always)]
fn first_time(low: (&[f64; 3], &[f64; 3]), high: (&[f64; 3], &[f64; 3]), need: f64, m: f64) -> f64 {
    // Lowest corner now with the fastest closing rate: never late; exact when one corner is both.
    let gap = least(high.0) - greatest(low.0) - need;
    let mut s = root(gap, least(high.1) - greatest(low.1), m);
    // Then from the other end: at the root of the pair that is lowest now, who is lowest? Each round can only raise
    // the proven time.
    let value = |at: f64| {
        let l = [low.0[0] + low.1[0] * at, low.0[1] + low.1[1] * at, low.0[2] + low.1[2] * at];
        let h = [high.0[0] + high.1[0] * at, high.0[1] + high.1[1] * at, high.0[2] + high.1[2] * at];
        least(&h) - greatest(&l) - need
    };
    // Concave in s: the chord from a proven time to a later one with a positive value is proven too.
    let later = 2.0 * s;
    if value(later) - 0.5 * m * later * later > 0.0 {
        s = later;
    }
    s * (1.0 - 1e-12)
}

/// Root of g + v s − m s²/2 for g > 0: sums of terms of one sign only.
#[inline(always)]
fn root(g: f64, v: f64, m: f64) -> f64 {
    let root = (v * v + 2.0 * m * g).sqrt();
    if v < 0.0 {
        2.0 * g / (root - v)
    } else if m > 0.0 {
        (v + root) / m
    } else {
        1e300
    }
}
