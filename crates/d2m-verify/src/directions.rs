//! Directions along which two parts may be apart. Whatever is a `DVec3` or an `f64` here is a guess: it proves nothing.
use crate::closest::closest;
use d2m_interval::{IntervalMat3, IntervalVec3};
use glam::{DMat3, DVec3};

/// A direction that goes with the bodies; it need not be of length one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Direction {
    /// Fixed in the base.
    Base(DVec3),
    /// Fixed in the other body.
    Other(DVec3),
    /// e × (turn·f): across a direction of either.
    Across(DVec3, DVec3),
}

impl Direction {
    /// In the axes of the base and in those of the other body, which is turned so.
    pub(crate) fn at(self, turn: &IntervalMat3, back: &IntervalMat3) -> [IntervalVec3; 2] {
        match self {
            Self::Base(n) => [IntervalVec3::point(n), back.mul_point(n)],
            Self::Other(n) => [turn.mul_point(n), IntervalVec3::point(n)],
            Self::Across(e, f) => [-turn.mul_point(f).cross_point(e), back.mul_point(e).cross_point(f)],
        }
    }
}

/// About a direction at one time: in the axes of the base and in those of the other body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) direction: Direction,
    pub(crate) n: [DVec3; 2],
    pub(crate) length: f64,
}

impl Axis {
    pub(crate) fn new(direction: Direction, turn: &DMat3) -> Self {
        let n = match direction {
            Direction::Base(n) => n,
            Direction::Other(n) => *turn * n,
            Direction::Across(e, f) => e.cross(*turn * f),
        };
        Self { direction, n: [n, turn.transpose() * n], length: n.length() }
    }

    /// The fifteen directions of boxes whose sides are along the axes of their bodies.
    pub(crate) fn of_boxes(turn: &DMat3) -> [Self; 15] {
        core::array::from_fn(|k| match k {
            0..3 => Self::new(Direction::Base(DVec3::AXES[k]), turn),
            3..6 => Self::new(Direction::Other(DVec3::AXES[k - 3]), turn),
            _ => Self::new(Direction::Across(DVec3::AXES[k / 3 - 2], DVec3::AXES[k % 3]), turn),
        })
    }
}

/// The normals of two triangles and across each two of their sides.
pub(crate) fn faces_and_sides([a, b]: &[[DVec3; 3]; 2]) -> [Direction; 11] {
    let side = |t: &[DVec3; 3], k: usize| (t[(k + 1) % 3] - t[k]).normalize_or(DVec3::X);
    let normal = |t: &[DVec3; 3]| side(t, 0).cross(side(t, 1)).normalize_or(DVec3::X);
    core::array::from_fn(|k| match k {
        0 => Direction::Base(normal(a)),
        1 => Direction::Other(normal(b)),
        _ => Direction::Across(side(a, (k - 2) / 3), side(b, (k - 2) % 3)),
    })
}

/// The direction between the closest points of two triangles, fixed in either body. At 1e-10 it is noise but for the part across a side
/// that a closest point is on, where the other end of the side must not reach beyond.
pub(crate) fn between([a, b]: &[[DVec3; 3]; 2], turn: &DMat3, offset: DVec3) -> [Direction; 2] {
    let near = closest(a, &b.map(|p| *turn * p + offset));
    let across = |[p, q, r]: &[DVec3; 3], weights: DVec3, n: DVec3| {
        // Of a point on a side one weight is zero, of a corner two.
        let side = match weights.cmpeq(DVec3::ZERO).bitmask() {
            1 => *r - *q,
            2 => *p - *r,
            4 => *q - *p,
            _ => return n,
        };
        n.reject_from_normalized(side.normalize_or_zero()).normalize_or_zero()
    };
    let n = near.gap.normalize_or_zero();
    let of_other = across(b, near.weights[1], turn.transpose() * n);
    [Direction::Base(across(a, near.weights[0], n)), Direction::Other(of_other)]
}

/// Steps of Gilbert's algorithm: more seldom find what these have not.
const STEPS: usize = 12;

/// About the direction of the shortest way from what is between some points to what is between others: Gilbert's algorithm.
pub(crate) fn between_hulls(a: &[DVec3], b: &[DVec3]) -> Direction {
    let furthest = |points: &[DVec3], n: DVec3| {
        let further = |p: DVec3, q: DVec3| if n.dot(q) > n.dot(p) { q } else { p };
        points.iter().copied().reduce(further).unwrap_or_default()
    };
    let mut way = b[0] - a[0];
    for _ in 0..STEPS {
        let next = furthest(b, -way) - furthest(a, way) - way;
        let part = -next.dot(way) / next.length_squared();
        if part.is_nan() || part <= 0.0 {
            break;
        }
        way += next * part.min(1.0);
    }
    Direction::Base(way.normalize_or(DVec3::X))
}
