//! Directions along which two parts may be apart. Whatever is a `DVec3` or an `f64` here is a guess: it proves nothing.
use crate::closest::{Place, closest};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
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
    /// An upper bound of its length.
    pub(crate) fn size(self) -> Interval {
        let length = |v: DVec3| IntervalVec3::point(v).norm();
        match self {
            Self::Base(n) | Self::Other(n) => length(n),
            Self::Across(e, f) => length(e) * length(f),
        }
    }

    /// In the axes of the base and in those of the other body, which is turned so.
    pub(crate) fn at(self, turn: &IntervalMat3, back: &IntervalMat3) -> [IntervalVec3; 2] {
        match self {
            Self::Base(n) => [IntervalVec3::point(n), back.mul_point(n)],
            Self::Other(n) => [turn.mul_point(n), IntervalVec3::point(n)],
            Self::Across(e, f) => [-turn.mul_point(f).cross_point(e), back.mul_point(e).cross_point(f)],
        }
    }

    /// About the same in the axes of the base.
    pub(crate) fn guess(self, turn: &DMat3) -> DVec3 {
        match self {
            Self::Base(n) => n,
            Self::Other(n) => *turn * n,
            Self::Across(e, f) => e.cross(*turn * f),
        }
    }

    pub(crate) fn reversed(self) -> Self {
        match self {
            Self::Base(n) => Self::Base(-n),
            Self::Other(n) => Self::Other(-n),
            Self::Across(e, f) => Self::Across(-e, f),
        }
    }
}

/// One of the fifteen directions of two boxes whose sides are along the axes of their bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxAxis {
    pub(crate) direction: Direction,
    pub(crate) length: f64,
    n: DVec3,
    /// What half the sides of either box are multiplied by.
    spread: [DVec3; 2],
}

const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];

impl BoxAxis {
    /// All of them, of bodies that are turned so.
    pub(crate) fn all(turn: &DMat3) -> [Self; 15] {
        core::array::from_fn(|k| {
            let direction = match k {
                0..3 => Direction::Base(AXES[k]),
                3..6 => Direction::Other(AXES[k - 3]),
                _ => Direction::Across(AXES[(k - 6) / 3], AXES[(k - 6) % 3]),
            };
            let n = direction.guess(turn);
            Self { direction, n, spread: [n.abs(), (turn.transpose() * n).abs()], length: n.length() }
        })
    }

    /// About the gaps along it and along its opposite of boxes whose middles are so far apart.
    pub(crate) fn gaps(&self, between: DVec3, half: &[DVec3; 2]) -> [f64; 2] {
        let spread = self.spread[0].dot(half[0]) + self.spread[1].dot(half[1]);
        [self.n.dot(between) - spread, -self.n.dot(between) - spread]
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
    let across = |t: &[DVec3; 3], place: Place, n: DVec3| {
        let Place::Edge(k) = place else { return n };
        let side = (t[(k + 1) % 3] - t[k]).normalize_or_zero();
        (n - side * side.dot(n)).normalize_or_zero()
    };
    let n = near.gap.normalize_or_zero();
    let [of_a, of_b] = near.places;
    [Direction::Base(across(a, of_a, n)), Direction::Other(across(b, of_b, turn.transpose() * n))]
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
