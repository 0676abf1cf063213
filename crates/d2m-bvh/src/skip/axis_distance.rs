//! How near does a triangle come to an axis?

use glam::{DVec2, DVec3};

/// The square of the distance of the origin from a triangle in the plane. `squares`: those of the corners' distances.
pub(super) fn distance_squared_in_plane(flat: &[DVec2; 3], squares: &[f64; 3]) -> f64 {
    // With the edge, not with its end: a short edge does not magnify the rounding.
    let edges = [0, 1, 2].map(|k| flat[(k + 1) % 3] - flat[k]);
    let sides = [0, 1, 2].map(|k| flat[k].perp_dot(edges[k]));
    if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
        return 0.0;
    }
    let mut least = squares[0].min(squares[1]).min(squares[2]);
    for k in 0..3 {
        let (along, length) = (-flat[k].dot(edges[k]), edges[k].length_squared());
        if along > 0.0 && along < length {
            least = least.min(sides[k] * sides[k] / length);
        }
    }
    least
}

/// The distance of the origin from a triangle in a plane through it with normal `axis`.
pub(super) fn distance_in_plane(flat: &[DVec3; 3], axis: DVec3) -> f64 {
    let sides = [0, 1, 2].map(|k| flat[k].cross(flat[(k + 1) % 3]).dot(axis));
    if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
        return 0.0;
    }
    let mut least = f64::INFINITY;
    for k in 0..3 {
        let (p, e) = (flat[k], flat[(k + 1) % 3] - flat[k]);
        let along = (-p.dot(e) / e.length_squared()).clamp(0.0, 1.0);
        // An edge of one point gives 0/0.
        let foot = if along.is_nan() { p } else { p + e * along };
        least = least.min(foot.length());
    }
    least
}
