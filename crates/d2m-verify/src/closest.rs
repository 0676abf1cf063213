//! Closest points of two triangles, in plain floating point: guesses of directions and of witnesses. Nothing here is trusted.
use glam::{DVec2, DVec3};

/// Where on a triangle a closest point is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    Vertex,
    /// The side from this corner to the next.
    Edge(usize),
    Face,
}

/// Points of two triangles, as v₀ + s(v₁ − v₀) + t(v₂ − v₀).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(crate) weights: [DVec2; 2],
    pub(crate) places: [Place; 2],
    /// From the first to the second.
    pub(crate) gap: DVec3,
}

pub(crate) fn closest(a: &[DVec3; 3], b: &[DVec3; 3]) -> Closest {
    let of_corners = (0..3).flat_map(|i| {
        let on_b = above(b, a[i]).map(|(w, p)| ([corner(i), w], [Place::Vertex, Place::Face], p - a[i]));
        let on_a = above(a, b[i]).map(|(w, p)| ([w, corner(i)], [Place::Face, Place::Vertex], b[i] - p));
        [on_b, on_a].into_iter().flatten()
    });
    let of_sides = (0..9).map(|k| sides(a, b, k / 3, k % 3));
    let found = of_corners.map(|(weights, places, gap)| Closest { weights, places, gap }).chain(of_sides);
    let none = Closest { weights: [DVec2::ZERO; 2], places: [Place::Vertex; 2], gap: b[0] - a[0] };
    found.fold(none, |s, t| if t.gap.length_squared() < s.gap.length_squared() { t } else { s })
}

fn corner(i: usize) -> DVec2 {
    [DVec2::ZERO, DVec2::X, DVec2::Y][i]
}

/// The foot of a point on a triangle's plane, if it is in the triangle.
fn above(t: &[DVec3; 3], p: DVec3) -> Option<(DVec2, DVec3)> {
    let (u, v, w) = (t[1] - t[0], t[2] - t[0], p - t[0]);
    let n = u.cross(v);
    let weights = DVec2::new(w.cross(v).dot(n), u.cross(w).dot(n)) / n.length_squared();
    let inside = weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0;
    inside.then(|| (weights, t[0] + u * weights.x + v * weights.y))
}

/// Closest points of two sides: clamped on one, then on the other.
fn sides(a: &[DVec3; 3], b: &[DVec3; 3], i: usize, j: usize) -> Closest {
    let (p, q) = (a[i], b[j]);
    let (u, v, r) = (a[(i + 1) % 3] - p, b[(j + 1) % 3] - q, a[i] - b[j]);
    let (uu, vv, uv, ur, vr) = (u.dot(u), v.dot(v), u.dot(v), u.dot(r), v.dot(r));
    let part = |x: f64| if x >= 0.0 { x.min(1.0) } else { 0.0 };
    let t = part((uv * part((uv * vr - ur * vv) / (uu * vv - uv * uv)) + vr) / vv);
    let s = part((uv * t - ur) / uu);
    let along = |from: usize, x: f64| corner(from) * (1.0 - x) + corner((from + 1) % 3) * x;
    let place = |from: usize, x: f64| if x > 0.0 && x < 1.0 { Place::Edge(from) } else { Place::Vertex };
    Closest {
        weights: [along(i, s), along(j, t)],
        places: [place(i, s), place(j, t)],
        gap: q + v * t - p - u * s,
    }
}
