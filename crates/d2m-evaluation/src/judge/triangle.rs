//! Two triangles, by the definition: the least of fifteen feature distances, zero when an edge pierces a face.
//! Slow and plain on purpose; errors are those of f64 on coordinates of the scene's size.
use glam::DVec3;

/// Three corners in a common frame.
pub(crate) type Corners = [DVec3; 3];

/// The distance of the closed triangles; it is 0 when [`cross`] says so.
pub(crate) fn distance(a: &Corners, b: &Corners) -> f64 {
    if cross(a, b) { 0.0 } else { feature_distance(a, b) }
}

/// Are they at least `limit` apart along a coordinate axis or along the normal of one of them? Most pairs are, and need
/// no more than that.
pub(crate) fn are_apart(a: &Corners, b: &Corners, limit: f64) -> bool {
    let normal = |t: &Corners| (t[1] - t[0]).cross(t[2] - t[0]);
    [DVec3::X, DVec3::Y, DVec3::Z, normal(a), normal(b)].iter().any(|n| {
        let (a, b) = (a.map(|p| n.dot(p)), b.map(|p| n.dot(p)));
        let least = |v: [f64; 3]| v[0].min(v[1]).min(v[2]);
        let most = |v: [f64; 3]| v[0].max(v[1]).max(v[2]);
        let gap = (least(b) - most(a)).max(least(a) - most(b));
        gap > limit * n.length()
    })
}

/// The least distance over six vertex/face and nine edge/edge pairs.
fn feature_distance(a: &Corners, b: &Corners) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..3 {
        least = least.min(point_triangle(a[i], b)).min(point_triangle(b[i], a));
        for j in 0..3 {
            least = least.min(segment_segment([a[i], a[(i + 1) % 3]], [b[j], b[(j + 1) % 3]]));
        }
    }
    least
}

/// Does an edge of one pierce the other? Touching within rounding may be answered either way.
pub(crate) fn cross(a: &Corners, b: &Corners) -> bool {
    (0..3).any(|i| pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a))
}

fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    (b - a).cross(c - a).dot(d - a)
}

/// Does the open segment cross the triangle?
pub(crate) fn pierces(p: DVec3, q: DVec3, t: &Corners) -> bool {
    let (above, below) = (volume(t[0], t[1], t[2], p), volume(t[0], t[1], t[2], q));
    if !(above > 0.0 && below < 0.0 || above < 0.0 && below > 0.0) {
        return false;
    }
    let s = [0, 1, 2].map(|i| volume(p, q, t[i], t[(i + 1) % 3]));
    s.iter().all(|&v| v >= 0.0) || s.iter().all(|&v| v <= 0.0)
}

fn point_segment(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    // A segment of one point gives 0/0; its end is then the answer.
    p.distance(if t.is_nan() { a } else { a + d * t })
}

fn point_triangle(p: DVec3, t: &Corners) -> f64 {
    let n = (t[1] - t[0]).cross(t[2] - t[0]);
    let inside = (0..3).all(|i| n.cross(t[(i + 1) % 3] - t[i]).dot(p - t[i]) >= 0.0);
    let edges = (0..3).map(|i| point_segment(p, [t[i], t[(i + 1) % 3]])).fold(f64::INFINITY, f64::min);
    let plane = (p - t[0]).dot(n).abs() / n.length();
    if inside && plane.is_finite() { edges.min(plane) } else { edges }
}

/// The distance of two segments.
pub(super) fn segment_segment(s: [DVec3; 2], t: [DVec3; 2]) -> f64 {
    let ends = point_segment(s[0], t)
        .min(point_segment(s[1], t))
        .min(point_segment(t[0], s))
        .min(point_segment(t[1], s));
    let (d, e, r) = (s[1] - s[0], t[1] - t[0], t[0] - s[0]);
    let n = d.cross(e);
    let (along, across) = (r.cross(e).dot(n) / n.length_squared(), r.cross(d).dot(n) / n.length_squared());
    let inside = |x: f64| (0.0..=1.0).contains(&x);
    // The distance of two points of the segments: with nearly parallel lines their direction is noise, and a
    // distance measured along it could come out too small. Both places on the lines err on their own then, so each is compared with what
    // is closest to it on the other.
    if inside(along) && inside(across) {
        ends.min(point_segment(s[0] + d * along, t)).min(point_segment(t[0] + e * across, s))
    } else {
        ends
    }
}
