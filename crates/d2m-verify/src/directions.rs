//! Directions that are worth a try, guessed in plain floating point. A bad guess proves nothing, and nothing false.
use crate::instant::{Direction, Instant, Part};
use crate::nearest::{Place, nearest};
use glam::DVec3;

const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];

/// From center to center, and the fifteen of two boxes.
pub(crate) fn across_boxes(now: &Instant, parts: [&Part; 2]) -> impl Iterator<Item = Direction> {
    let [[a, ..], [b, ..]] = parts.map(Part::guess);
    let centers = (now.turn_guess * b + now.offset_guess - a).normalize_or(DVec3::X);
    (0..16).map(move |k| match k {
        0 => Direction::Base(centers),
        1..4 => Direction::Base(AXES[k - 1]),
        4..7 => Direction::Other(AXES[k - 4]),
        _ => Direction::Across(AXES[(k - 7) / 3], AXES[(k - 7) % 3]),
    })
}

/// The normals of two triangles and across each two of their sides.
pub(crate) fn faces_and_sides(parts: [&Part; 2]) -> [Direction; 11] {
    let [a, b] = parts.map(Part::guess);
    let side = |t: &[DVec3; 3], k: usize| (t[(k + 1) % 3] - t[k]).normalize_or(DVec3::X);
    let normal = |t: &[DVec3; 3]| side(t, 0).cross(side(t, 1)).normalize_or(DVec3::X);
    core::array::from_fn(|k| match k {
        0 => Direction::Base(normal(&a)),
        1 => Direction::Other(normal(&b)),
        _ => Direction::Across(side(&a, (k - 2) / 3), side(&b, (k - 2) % 3)),
    })
}

/// The direction between the closest points of two triangles, fixed in either body. At 1e-10 it is noise but for the part across a side
/// that a closest point is on, where the other end of the side must not reach beyond.
pub(crate) fn between(now: &Instant, parts: [&Part; 2]) -> [Direction; 2] {
    let [a, b] = parts.map(Part::guess);
    let near = nearest(&a, &b.map(|p| now.turn_guess * p + now.offset_guess));
    let across = |t: &[DVec3; 3], place: Place, n: DVec3| match place {
        Place::Edge(k) => {
            let side = (t[(k + 1) % 3] - t[k]).normalize_or_zero();
            (n - side * side.dot(n)).normalize_or_zero()
        }
        _ => n,
    };
    let n = near.gap.normalize_or_zero();
    [
        Direction::Base(across(&a, near.places[0], n)),
        Direction::Other(across(&b, near.places[1], now.back_guess * n)),
    ]
}
