//! Bodies that are proven to be within a distance of each other at one time.
use crate::Body;
use crate::directions::{between, faces_and_sides};
use crate::instant::{Instant, Part};
use crate::nearest::nearest;
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec2;

/// Encloses the distance of two triangles: it is at most that of two of their points, and at least a gap along a direction.
pub(crate) fn distance(now: &Instant, [a, b]: [&Part; 2]) -> Interval {
    let (Some(p), Some(q)) = (a.corners(), b.corners()) else { return Interval::ENTIRE };
    if cross(now, p, q) {
        return Interval::ZERO;
    }
    let near = nearest(&a.guess(), &b.guess().map(|p| now.turn_guess * p + now.offset_guess));
    let upper = match near.weights.map(on_triangle) {
        [Some(s), Some(t)] => (now.turn.mul_vec(point(q, t)) + now.offset - point(p, s)).norm().hi(),
        _ => f64::INFINITY,
    };
    let directions = faces_and_sides([a, b]).into_iter().chain(between(now, [a, b]));
    let gaps = directions.flat_map(|direction| [direction, direction.reversed()]).map(|direction| {
        let n = direction.at(now);
        let gap = now.gap(n, [a, b]);
        // By the length of a direction that may be zero nothing is divided.
        if gap.lo() > 0.0 {
            (Interval::point(gap.lo()) / Interval::point(n[0].norm().hi())).lo()
        } else {
            0.0
        }
    });
    Interval::try_new(gaps.fold(0.0, f64::max).min(upper), upper).unwrap_or(Interval::ENTIRE)
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
fn cross(now: &Instant, a: &[IntervalVec3; 3], b: &[IntervalVec3; 3]) -> bool {
    let b = b.map(|p| now.turn.mul_vec(p) + now.offset);
    let pierces = |sides: &[IntervalVec3; 3], face: &[IntervalVec3; 3]| {
        (0..3).any(|k| passes([sides[k], sides[(k + 1) % 3]], face))
    };
    pierces(a, &b) || pierces(&b, a)
}

fn passes([p, q]: [IntervalVec3; 2], [a, b, c]: &[IntervalVec3; 3]) -> bool {
    let volume = |[u, v, w, x]: [IntervalVec3; 4]| sign((v - u).triple_product(w - u, x - u));
    if volume([*a, *b, *c, p]) * volume([*a, *b, *c, q]) >= 0 {
        return false;
    }
    let turn = volume([p, q, *a, *b]);
    turn != 0 && turn == volume([p, q, *b, *c]) && turn == volume([p, q, *c, *a])
}

/// The proven sign; 0: none.
pub(crate) fn sign(x: Interval) -> i32 {
    i32::from(x.certainly_positive()) - i32::from(x.certainly_negative())
}

/// Two triangles as parts.
pub(crate) fn triangles(bodies: &[Body<'_>; 2], pair: [u32; 2]) -> [Part; 2] {
    [0, 1].map(|k| Part::triangle(bodies[k].mesh.corners(pair[k])))
}
