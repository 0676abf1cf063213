//! Distances of posed triangles in rational arithmetic: slow, and to be trusted by reading.

use d2m_motion::Pose;
use dashu_ratio::RBig;
use glam::DVec3;

pub(crate) type Vector = [RBig; 3];

pub(crate) fn exact(p: DVec3) -> Vector {
    p.to_array().map(|c| RBig::try_from(c).unwrap())
}

fn sub(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn along(p: &Vector, d: &Vector, t: &RBig) -> Vector {
    [&p[0] + &d[0] * t, &p[1] + &d[1] * t, &p[2] + &d[2] * t]
}

fn square(a: &Vector) -> RBig {
    dot(a, a)
}

/// The body point in the world: q p q̄ / |q|² without any root.
pub(crate) fn pose_point(pose: &Pose, point: DVec3) -> Vector {
    let [x, y, z, w] = pose.rotation.to_array().map(|c| RBig::try_from(c).unwrap());
    let p = sub(&exact(point), &exact(pose.at));
    let u = [x, y, z];
    let norm = square(&u) + &w * &w;
    // q p q̄ = (w² − u·u) p + 2 (u·p) u + 2 w u × p.
    let (first, second, third) = (&w * &w - square(&u), dot(&u, &p) * RBig::from(2), cross(&u, &p));
    let two_w = &w * RBig::from(2);
    let x = exact(pose.translation);
    [0, 1, 2].map(|k| (&first * &p[k] + &second * &u[k] + &two_w * &third[k]) / &norm + &x[k])
}

/// Squared distance of a point from a segment.
fn point_segment(p: &Vector, q: &[&Vector; 2]) -> RBig {
    let d = sub(q[1], q[0]);
    let (length, part) = (square(&d), dot(&sub(p, q[0]), &d));
    if length == RBig::ZERO || part <= RBig::ZERO {
        return square(&sub(p, q[0]));
    }
    if part >= length { square(&sub(p, q[1])) } else { square(&sub(p, &along(q[0], &d, &(part / length)))) }
}

fn segment_segment(p: &[&Vector; 2], q: &[&Vector; 2]) -> RBig {
    let (d, e) = (sub(p[1], p[0]), sub(q[1], q[0]));
    let n = cross(&d, &e);
    let nn = square(&n);
    let w = sub(q[0], p[0]);
    let ends =
        [point_segment(p[0], q), point_segment(p[1], q), point_segment(q[0], p), point_segment(q[1], p)];
    let least = ends.into_iter().min().unwrap();
    if nn == RBig::ZERO {
        return least;
    }
    let (s, t) = (dot(&cross(&w, &e), &n), dot(&cross(&w, &d), &n));
    let inside = |x: &RBig| *x >= RBig::ZERO && *x <= nn;
    if inside(&s) && inside(&t) {
        let height = dot(&w, &n);
        return least.min(&height * &height / nn);
    }
    least
}

/// Squared distance from the inside of a triangle to a point above it; None when the foot is outside.
fn point_face(p: &Vector, t: &[Vector; 3]) -> Option<RBig> {
    let n = cross(&sub(&t[1], &t[0]), &sub(&t[2], &t[0]));
    let nn = square(&n);
    let over = |i: usize| dot(&cross(&sub(&t[(i + 1) % 3], &t[i]), &sub(p, &t[i])), &n) >= RBig::ZERO;
    if nn == RBig::ZERO || !(0..3).all(over) {
        return None;
    }
    let height = dot(&sub(p, &t[0]), &n);
    Some(&height * &height / nn)
}

fn pierces(p: &[&Vector; 2], t: &[Vector; 3]) -> bool {
    let n = cross(&sub(&t[1], &t[0]), &sub(&t[2], &t[0]));
    let (h0, h1) = (dot(&sub(p[0], &t[0]), &n), dot(&sub(p[1], &t[0]), &n));
    if &h0 * &h1 > RBig::ZERO || h0 == h1 {
        return false;
    }
    point_face(&along(p[0], &sub(p[1], p[0]), &(&h0 / (&h0 - &h1))), t).is_some()
}

/// Squared distance of two closed triangles.
pub(crate) fn triangle_triangle(a: &[Vector; 3], b: &[Vector; 3]) -> RBig {
    let edge = |t: usize, i: usize| {
        let t = if t == 0 { a } else { b };
        [&t[i], &t[(i + 1) % 3]]
    };
    if (0..3).any(|i| pierces(&edge(0, i), b) || pierces(&edge(1, i), a)) {
        return RBig::ZERO;
    }
    let edges = (0..9).map(|k| segment_segment(&edge(0, k / 3), &edge(1, k % 3)));
    let faces = (0..3).flat_map(|i| [point_face(&a[i], b), point_face(&b[i], a)]).flatten();
    edges.chain(faces).min().unwrap()
}
