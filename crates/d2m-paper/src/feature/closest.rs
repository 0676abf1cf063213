//! Closest points in plain floating point: they propose separating directions and prove nothing.

use glam::DVec3;

/// About the closest point to `p` on the segment a + s·e, s in \[0, 1\]; returns s.
pub(crate) fn estimate_on_segment(p: DVec3, a: DVec3, e: DVec3) -> f64 {
    let length = e.length_squared();
    if length > 0.0 { ((p - a).dot(e) / length).clamp(0.0, 1.0) } else { 0.0 }
}

/// About the closest point to `p` on a convex polygon, and what it lies on.
pub(crate) fn estimate_on_polygon(p: DVec3, vertices: &[DVec3], normal: DVec3) -> DVec3 {
    let n = vertices.len();
    let mut best = (f64::INFINITY, vertices[0]);
    for i in 0..n {
        let (a, e) = (vertices[i], vertices[(i + 1) % n] - vertices[i]);
        let c = a + e * estimate_on_segment(p, a, e);
        let d = (p - c).length_squared();
        if d < best.0 {
            best = (d, c);
        }
    }
    // Inside all sides: the foot on the plane is closer than any side.
    let turn = |i: usize| normal.cross(vertices[(i + 1) % n] - vertices[i]).dot(p - vertices[i]);
    if (0..n).all(|i| turn(i) > 0.0) || (0..n).all(|i| turn(i) < 0.0) {
        return p - normal * (p - vertices[0]).dot(normal);
    }
    best.1
}

/// About the closest points of the segments a + s·e and b + t·d; returns (s, t), both in \[0, 1\].
pub(crate) fn estimate_between_segments(a: DVec3, e: DVec3, b: DVec3, d: DVec3) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let mut offer = |s: f64, t: f64| {
        let gap = (a + e * s - b - d * t).length_squared();
        if gap < best.0 {
            best = (gap, s, t);
        }
    };
    offer(0.0, estimate_on_segment(a, b, d));
    offer(1.0, estimate_on_segment(a + e, b, d));
    offer(estimate_on_segment(b, a, e), 0.0);
    offer(estimate_on_segment(b + d, a, e), 1.0);
    let k = e.cross(d);
    let kk = k.length_squared();
    if kk > 0.0 {
        let w = b - a;
        let (s, t) = (w.cross(d).dot(k) / kk, w.cross(e).dot(k) / kk);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            offer(s, t);
        }
    }
    (best.1, best.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossing_parallel_and_collapsed_segments() {
        let (s, t) =
            estimate_between_segments(-DVec3::X, 2.0 * DVec3::X, DVec3::new(0.0, -1.0, 1.0), 2.0 * DVec3::Y);
        assert!((s - 0.5).abs() < 1e-15 && (t - 0.5).abs() < 1e-15);
        let (s, t) = estimate_between_segments(DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::X);
        assert_eq!((s, t), (1.0, 0.0));
        let (s, t) = estimate_between_segments(DVec3::ZERO, DVec3::ZERO, DVec3::new(2.0, 1.0, 0.0), DVec3::X);
        assert_eq!((s, t), (0.0, 0.0));
    }

    #[test]
    fn polygon_inside_and_outside() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let c = estimate_on_polygon(DVec3::new(0.25, 0.5, 3.0), &square, DVec3::Z);
        assert_eq!(c, DVec3::new(0.25, 0.5, 0.0));
        let c = estimate_on_polygon(DVec3::new(2.0, 0.5, 3.0), &square, -DVec3::Z);
        assert_eq!(c, DVec3::new(1.0, 0.5, 0.0));
    }
}
