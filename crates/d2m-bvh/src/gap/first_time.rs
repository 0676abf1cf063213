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
    let rate = high.rate.min_element() - low.rate.max_element();
    let s = Parabola::new(gap, rate, -m).first_root_bent_down().unwrap_or(enough);
    // Concave in s: the chord from a proven time to a later one with a positive value is proven too.
    let later = 2.0 * s;
    let s = if is_open_at(later, low, high, need, m) { later } else { s };
    s * DOWN
}

/// Is min(high + s·rate) − max(low + s·rate) − m s²/2 above `need` at a time? Where it is so at s = 0, too, it is so until this time
/// less its roundings (times [`DOWN`]), for it is concave.
#[inline(always)]
pub(crate) fn is_open_at<D: Doubles>(s: f64, low: Lines<D>, high: Lines<D>, need: f64, m: f64) -> bool {
    let (l, h) = (low.at + low.rate * D::splat(s), high.at + high.rate * D::splat(s));
    let value = h.min_element() - l.max_element() - need;
    value - 0.5 * m * s * s > 0.0
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
            match Parabola::new(path.gap, path.rate, path.bend - loss).first_root() {
                Some(s) if s < first => first = s,
                Some(s) if s.is_nan() => return 0.0,
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

/// The lemma of this file: a gap that is g > 0 now, changes by v and bends by a at least stays open for as long as g + v s + a s²/2 does.
#[derive(Clone, Copy)]
struct Parabola {
    /// g.
    gap: f64,
    /// v, less the least rate.
    rate: f64,
    /// a.
    bend: f64,
}

impl Parabola {
    #[inline(always)]
    fn new(gap: f64, rate: f64, bend: f64) -> Self {
        Self { gap, rate: rate - LEAST_RATE, bend }
    }

    /// The first root, never late; none only if there is none.
    #[inline(always)]
    fn first_root(&self) -> Option<f64> {
        let (square, bent) = (self.rate * self.rate, 2.0 * self.bend * self.gap);
        // Too large by more than its rounding: the root of a closing pair is early.
        self.root_of((square - bent) + DISCRIMINANT_ERROR * (square + bent.abs()))
    }

    /// The same where a ≤ 0: sums of terms of one sign only.
    #[inline(always)]
    fn first_root_bent_down(&self) -> Option<f64> {
        self.root_of(self.rate * self.rate - 2.0 * self.bend * self.gap)
    }

    /// The root with this discriminant; not a number where something is none.
    #[inline(always)]
    fn root_of(&self, discriminant: f64) -> Option<f64> {
        let Self { gap: g, rate: v, bend: a } = *self;
        let root = discriminant.sqrt();
        let closing = v < 0.0;
        let (above, below) = (if closing { 2.0 * g } else { v + root }, if closing { root - v } else { -a });
        let is_free = discriminant < 0.0 || v >= 0.0 && a >= 0.0;
        (!is_free).then(|| above / below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::{F64x4, Quad};

    /// One pair of vertices, by both ways.
    fn proven([gap, rate, bend, jerk]: [f64; 4]) -> [f64; 2] {
        let [low, high] = [[0.0; 2], [gap, rate]]
            .map(|[at, rate]| Lines { at: F64x4::splat(at), rate: F64x4::splat(rate) });
        let path = PathAlong { gap, rate, bend, jerk };
        [first_time(low, high, 0.0, -bend, 1.0), first_time_of_paths(&[path], 1.0)]
    }

    /// A tip that is near and stays, beside a rim that is far and comes: a root pairs the place of the one with the rate of the other.
    #[test]
    fn what_is_near_and_what_closes_may_be_two_vertices() {
        let low = Lines { at: F64x4::splat(0.0), rate: F64x4::splat(0.0) };
        let high = Lines {
            at: F64x4::load(&Quad([0.1, 1.1, 1.1, 1.1])),
            rate: F64x4::load(&Quad([0.0, -3.0, -3.0, -3.0])),
        };
        assert!(first_time(low, high, 0.0, 3.2, 1.0) < 0.067);
        // 0.1 = 3.2·0.25²/2 for the tip; for the rim 1.1 = 3·0.31 + 3.2·0.31²/2.
        assert!(is_open_at(0.2499, low, high, 0.0, 3.2) && !is_open_at(0.2501, low, high, 0.0, 3.2));
        assert!(is_open_at(0.2, low, high, 0.0, 4.9) && !is_open_at(0.35, low, high, 0.0, 0.9));
    }

    #[test]
    fn what_never_closes_is_proven_for_all_that_matters_and_what_is_no_number_for_no_time() {
        for opening in [[1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0], [1.0, 1.0, -0.25, 0.0]] {
            assert!(proven(opening).iter().all(|&time| time >= 1.0), "{opening:?}");
        }
        let times = proven([1.0, -1.0, -4.0, 0.0]);
        assert!(times.iter().all(|&time| time > 0.499 && time <= 0.5), "{times:?}");
        for place in 1..3 {
            for (rate, bend) in [(-1.0, -1.0), (-1.0, 0.0), (1.0, -1.0), (1.0, 0.0)] {
                let mut jet = [1.0, rate, bend, 0.0];
                jet[place] = f64::NAN;
                assert!(!proven(jet).iter().any(|&time| time > 0.0), "{jet:?}");
            }
        }
    }
}
