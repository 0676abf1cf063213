//! Two placed triangles: cheap proofs that they are apart.

use d2m_feature::{triangle_distance, triangles_intersect};
use glam::DVec3;

/// 1 + 2⁻⁴⁶: sixteen times the eight roundings of the compared squares.
const SQUARES_ROUNDING: f64 = 1.0 + 64.0 * f64::EPSILON;

/// Is the gap of the projections onto `n` or `−n` proven to be more than `need` times |n|? Not for n = 0.
///
/// `need` holds the wanted distance and the rounding of the projections. The comparison is of squares, whose own
/// roundings (at most 8·2⁻⁵³) [`SQUARES_ROUNDING`] covers; when squares underflow, n and the gap are too small to be judged
/// and the answer is no.
#[inline(always)]
pub(crate) fn gap_exceeds(n: DVec3, a: &[DVec3; 3], b: &[DVec3; 3], need: f64) -> bool {
    let (low_a, high_a) = range(n.dot(a[0]), n.dot(a[1]), n.dot(a[2]));
    let (low_b, high_b) = range(n.dot(b[0]), n.dot(b[1]), n.dot(b[2]));
    let gap = larger(low_b - high_a, low_a - high_b);
    let square = n.length_squared();
    gap > 0.0 && square > f64::MIN_POSITIVE && gap * gap > need * need * square * SQUARES_ROUNDING
}

#[inline(always)]
fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

#[inline(always)]
fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

#[inline(always)]
fn range(x: f64, y: f64, z: f64) -> (f64, f64) {
    (smaller(smaller(x, y), z), larger(larger(x, y), z))
}

/// Are the two placed triangles proven to be more than `error` apart? `need` is `error` with the rounding of
/// projections. Complete up to rounding: no only if the distance is `error` within a few roundings, or less.
#[inline(always)]
pub(crate) fn proven_apart(a: &[DVec3; 3], b: &[DVec3; 3], error: f64, need: f64) -> bool {
    let edges = |t: &[DVec3; 3]| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (ea, eb) = (edges(a), edges(b));
    if gap_exceeds(eb[0].cross(eb[1]), a, b, need) || gap_exceeds(ea[0].cross(ea[1]), a, b, need) {
        return true;
    }
    for e in &ea {
        for d in &eb {
            if gap_exceeds(e.cross(*d), a, b, need) {
                return true;
            }
        }
    }
    // Those that share a point are decided by a few signs. Flat and nearly degenerate cases: the certified distance tries every
    // direction.
    !triangles_intersect(a, b) && triangle_distance(a, b).lower > error
}
