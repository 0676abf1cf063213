//! Two triangles in motion: until when does a fixed direction keep them apart by more than the level?

use super::closest::closest;
use super::frame::Frame;
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

#[inline(always)]
fn moved(r: &[DVec3; 3], p: DVec3) -> DVec3 {
    r[0] * p.x + r[1] * p.y + r[2] * p.z
}

/// Corners of A's triangle (tree-centred, body axes) moved into B's frame.
#[inline(always)]
pub(crate) fn place_a(frame: &Frame, corners: &[DVec3; 3]) -> [DVec3; 3] {
    let side = &frame.sides[1];
    let r = &side.rotation;
    [
        moved(r, corners[0]) + side.offset,
        moved(r, corners[1]) + side.offset,
        moved(r, corners[2]) + side.offset,
    ]
}

/// Looks at a pair at the time of the frame. `a`, `b`: corners relative to the trees' centres, body axes. Stops
/// looking for a better direction once the pair is clear for `enough`.
pub(crate) fn look(frame: &Frame, a: &[DVec3; 3], b: &[DVec3; 3], scale: &PairScale, enough: f64) -> Look {
    let side = &frame.sides[1];
    let placed = Placed {
        a: place_a(frame, a),
        b: *b,
        velocity: side.velocity,
        offset: side.offset,
        omega_a: side.omega_single,
        omega_b: side.omega_wide,
    };
    let edges = |t: &[DVec3; 3]| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (ea, eb) = (edges(&placed.a), edges(&placed.b));
    let mut best = 0.0;
    for normal in [eb[0].cross(eb[1]), ea[0].cross(ea[1])] {
        best = placed.clear_for(normal, scale, best);
        if best >= enough {
            return Look::ClearFor(best);
        }
    }
    for e in &ea {
        for d in &eb {
            best = placed.clear_for(e.cross(*d), scale, best);
            if best >= enough {
                return Look::ClearFor(best);
            }
        }
    }
    let near = closest(&placed.a, &placed.b);
    best = placed.clear_for(near.direction, scale, best);
    // The features' own directions attain the distance, so one of the two ends applies up to rounding.
    let touching = near.square <= scale.stop * scale.stop;
    if touching || best == 0.0 { Look::Near { crossing: !touching } } else { Look::ClearFor(best) }
}

impl Placed {
    /// The larger of `known` and the time for which the direction keeps the pair apart.
    #[inline(always)]
    fn clear_for(&self, n: DVec3, scale: &PairScale, known: f64) -> f64 {
        let pa = [n.dot(self.a[0]), n.dot(self.a[1]), n.dot(self.a[2])];
        let pb = [n.dot(self.b[0]), n.dot(self.b[1]), n.dot(self.b[2])];
        let forward = least(&pb) - greatest(&pa);
        let backward = least(&pa) - greatest(&pb);
        let length = n.length();
        let need = (scale.level + scale.error) * length;
        // Also when n is zero or not a number.
        let separated = forward.max(backward) > need;
        if !separated {
            return known;
        }
        let (turn_a, turn_b) = (n.cross(self.omega_a), n.cross(self.omega_b));
        let drift = n.dot(self.velocity);
        let drift = drift - turn_a.dot(self.offset);
        let ra =
            [drift + turn_a.dot(self.a[0]), drift + turn_a.dot(self.a[1]), drift + turn_a.dot(self.a[2])];
        let rb = [turn_b.dot(self.b[0]), turn_b.dot(self.b[1]), turn_b.dot(self.b[2])];
        let m = scale.acceleration * length;
        let s = if forward > backward {
            first_time((&pa, &ra), (&pb, &rb), need, m)
        } else {
            first_time((&pb, &rb), (&pa, &ra), need, m)
        };
        known.max(s)
    }
}

fn least(values: &[f64; 3]) -> f64 {
    values[0].min(values[1]).min(values[2])
}

fn greatest(values: &[f64; 3]) -> f64 {
    values[0].max(values[1]).max(values[2])
}

/// First s ≥ 0 at which min(high + s·rate) − max(low + s·rate) − m s²/2 can be `need`. At s = 0 it is larger.
#[inline(always)]
fn first_time(low: (&[f64; 3], &[f64; 3]), high: (&[f64; 3], &[f64; 3]), need: f64, m: f64) -> f64 {
    let pick = |at: f64| {
        let (mut i, mut j) = (0, 0);
        let value_low = |k: usize| low.0[k] + low.1[k] * at;
        let value_high = |k: usize| high.0[k] + high.1[k] * at;
        for k in 1..3 {
            if value_low(k) > value_low(i) {
                i = k;
            }
            if value_high(k) < value_high(j) {
                j = k;
            }
        }
        (i, j)
    };
    let mut s = f64::INFINITY;
    let mut pair = pick(0.0);
    // Each round takes the pair of corners that is lowest at the present s; its root can only be earlier.
    for _ in 0..9 {
        let (i, j) = pair;
        let gap = high.0[j] - low.0[i] - need;
        s = s.min(root(gap, high.1[j] - low.1[i], m));
        if s > 1e300 {
            // No motion that closes this pair: look at the rates alone.
            s = 1e300;
        }
        let next = pick(s);
        if next == pair {
            break;
        }
        pair = next;
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
        f64::INFINITY
    }
}
