//! Until when do two sets of vertices stay apart along a direction? First roots of concave bounds, never late.

use core::ops::Add;
use d2m_lanes::Doubles;
use d2m_mesh::margin::{DOWN, UNIT_F64, UP};

/// What rates are lowered by, so that none is zero and the square of none underflows: a gap that grows less is never late, and the
/// unit of time is short against what this rate takes.
const LEAST_RATE: f64 = 1e-140;
/// The discriminant v² − 2ag errs by at most 2·2⁻⁵³(v² + |2ag|); twice that and some room.
const DISCRIMINANT_ERROR: f64 = 8.0 * UNIT_F64;

/// Positions and rates of vertices along a direction.
#[derive(Clone, Copy)]
pub(crate) struct Lines<D> {
    pub(crate) at: D,
    pub(crate) rate: D,
}

/// Positions, rates and accelerations of three vertices along a direction.
pub(crate) struct Jets {
    pub(crate) at: [f64; 3],
    pub(crate) rate: [f64; 3],
    pub(crate) bend: [f64; 3],
}

/// First s ≥ 0 at which min(high + s·rate) − max(low + s·rate) − m s²/2 can be `need`. At s = 0 it is larger. No time beyond `enough`
/// matters: what never closes is proven for a little longer.
#[inline(always)]
pub(crate) fn first_time<D: Doubles>(low: Lines<D>, high: Lines<D>, need: f64, m: f64, enough: f64) -> f64 {
    // Lowest vertex now with the fastest closing rate: never late; exact when one vertex is both.
    let gap = high.at.min_element() - low.at.max_element() - need;
    let s = root(gap, high.rate.min_element() - low.rate.max_element(), m).unwrap_or(enough);
    // Concave in s: the chord from a proven time to a later one with a positive value is proven too.
    let later = 2.0 * s;
    let (l, h) = (low.at + low.rate * D::splat(later), high.at + high.rate * D::splat(later));
    let value = h.min_element() - l.max_element() - need;
    let s = if value - 0.5 * m * later * later > 0.0 { later } else { s };
    s * DOWN
}

/// Root of g + v s − m s²/2 for g > 0, if there is one: sums of terms of one sign only.
#[inline(always)]
fn root(g: f64, v: f64, m: f64) -> Option<f64> {
    let v = v - LEAST_RATE;
    let root = (v * v + 2.0 * m * g).sqrt();
    if v < 0.0 { Some(2.0 * g / (root - v)) } else { (m > 0.0).then(|| (v + root) / m) }
}

/// A time until which every pair of vertices stays further apart than `need`, of which none beyond `enough` matters.
#[inline(never)]
pub(crate) fn first_time_of_jets(low: &Jets, high: &Jets, need: f64, jerk: f64, enough: f64) -> f64 {
    let pair = |k: usize| {
        let (i, j) = (k / 3, k % 3);
        let gap = high.at[j] - (low.at[i] + need);
        PathAlong { gap, rate: high.rate[j] - low.rate[i], bend: high.bend[j] - low.bend[i], jerk }
    };
    let pairs: [PathAlong; 9] = core::array::from_fn(pair);
    first_time_of_paths(&pairs, enough)
}

/// A gap f ≥ 0 along a direction: its value, rate and second derivative now, and a bound on its third derivative always.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathAlong {
    pub(crate) gap: f64,
    pub(crate) rate: f64,
    pub(crate) bend: f64,
    pub(crate) jerk: f64,
}

impl Add for PathAlong {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            gap: self.gap + other.gap,
            rate: self.rate + other.rate,
            bend: self.bend + other.bend,
            jerk: self.jerk + other.jerk,
        }
    }
}

/// A time until which all gaps stay positive, of which none beyond `enough` matters.
///
/// Each f(s) ≥ g + v s + a s²/2 − J s³/6, and for s ≤ S the last two terms are at least (a − J S/3) s²/2: a
/// parabola, whose first root holds up to S. S starts where J would not matter, and moves towards the root.
#[inline(always)]
pub(crate) fn first_time_of_paths<const N: usize>(paths: &[PathAlong; N], enough: f64) -> f64 {
    let size = |path: &PathAlong| path.rate.abs() + path.bend.abs() + path.jerk;
    if !paths.iter().map(size).sum::<f64>().is_finite() {
        return 0.0;
    }
    // Up to `most`.
    let first_root = |span: f64, most: f64| {
        let mut first = most;
        for path in paths {
            let loss = path.jerk * span * (1.0 / 3.0 * UP);
            let bound = Parabola { gap: path.gap, rate: path.rate, bend: path.bend - loss };
            match bound.first_root() {
                Some(s) if s < first => first = s,
                _ => {}
            }
        }
        first
    };
    let mut span = first_root(0.0, enough * (UP * UP));
    let mut proven = 0.0;
    for _ in 0..3 {
        let s = first_root(span, span);
        proven = s.max(proven);
        if s >= 0.8 * span {
            break;
        }
        span = (span * s).sqrt();
    }
    proven * DOWN
}

/// g + v s + a s²/2.
#[derive(Clone, Copy)]
struct Parabola {
    /// g.
    gap: f64,
    /// v.
    rate: f64,
    /// a.
    bend: f64,
}

impl Parabola {
    /// The first root for g > 0, never late; none only if there is none.
    #[inline(always)]
    fn first_root(&self) -> Option<f64> {
        let (g, a) = (self.gap, self.bend);
        let (v, bent) = (self.rate - LEAST_RATE, 2.0 * a * g);
        // Too large by more than its rounding: the root of a closing pair is early.
        let square = (v * v - bent) + DISCRIMINANT_ERROR * (v * v + bent.abs());
        let root = square.max(0.0).sqrt();
        let closing = v < 0.0;
        let (above, below) = (if closing { 2.0 * g } else { v + root }, if closing { root - v } else { -a });
        let is_free = square < 0.0 || !closing && a >= 0.0;
        (!is_free).then(|| above / below)
    }
}
