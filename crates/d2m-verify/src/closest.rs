//! Closest points of two triangles, in plain floating point: guesses of directions and of witnesses. Nothing here is trusted.
use glam::DVec3;

/// A point of either triangle, as parts of its corners, and the way from the first to the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(crate) weights: [DVec3; 2],
    pub(crate) gap: DVec3,
}

/// The nearest of what each two sides and each corner above a face give.
pub(crate) fn closest(a: &[DVec3; 3], b: &[DVec3; 3]) -> Closest {
    let corners = (0..3).flat_map(|i| {
        let on_b = above(b, a[i]).map(|weights| [DVec3::AXES[i], weights]);
        [on_b, above(a, b[i]).map(|weights| [weights, DVec3::AXES[i]])]
    });
    let sides = (0..9).map(|k| sides(a, b, k / 3, k % 3));
    let point = |[p, q, r]: &[DVec3; 3], weights: DVec3| *p * weights.x + *q * weights.y + *r * weights.z;
    let found = corners.flatten().chain(sides);
    let found = found.map(|weights| Closest { weights, gap: point(b, weights[1]) - point(a, weights[0]) });
    let nearer = |s: Closest, t: Closest| if t.gap.length() < s.gap.length() { t } else { s };
    found.reduce(nearer).expect("nine pairs of sides")
}

/// The foot of a point on a triangle's plane, if it is in the triangle.
fn above([a, b, c]: &[DVec3; 3], p: DVec3) -> Option<DVec3> {
    let (u, v, w) = (*b - *a, *c - *a, p - *a);
    let n = u.cross(v);
    let (s, t) = (w.cross(v).dot(n) / n.length_squared(), u.cross(w).dot(n) / n.length_squared());
    (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| DVec3::new(1.0 - (s + t), s, t))
}

/// Closest points of side i of the one and side j of the other: clamped on one, then on the other.
fn sides(a: &[DVec3; 3], b: &[DVec3; 3], i: usize, j: usize) -> [DVec3; 2] {
    let (u, v, r) = (a[(i + 1) % 3] - a[i], b[(j + 1) % 3] - b[j], a[i] - b[j]);
    let (uu, vv, uv, ur, vr) = (u.dot(u), v.dot(v), u.dot(v), u.dot(r), v.dot(r));
    let part = |x: f64| if x >= 0.0 { x.min(1.0) } else { 0.0 };
    let t = part((uv * part((uv * vr - ur * vv) / (uu * vv - uv * uv)) + vr) / vv);
    let s = part((uv * t - ur) / uu);
    [(i, s), (j, t)].map(|(k, x)| DVec3::AXES[k] * (1.0 - x) + DVec3::AXES[(k + 1) % 3] * x)
}
