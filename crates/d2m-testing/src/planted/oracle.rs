//! The independent oracle: 192-bit arithmetic, its own rotation by Taylor series, bisection. Slow and simple.
//!
//! It shares nothing with the library but the definition of the motion.
use super::families::{Kind, Planted};
use crate::big::{self, Big, Big3, add, cross, dot, scale, sub};
use glam::DVec3;

const BITS: usize = 192;

/// A double, exactly.
pub fn big(x: f64) -> Big {
    big::number::<BITS>(x)
}

fn big3(v: DVec3) -> Big3 {
    big::vector::<BITS>(v)
}

/// Where the four vertices are at a time: point and triangle, or edge and edge.
pub type Vertices<'a> = dyn Fn(&Big) -> [Big3; 4] + 'a;

/// The vertices of a rigid query.
pub fn rigid(query: &Planted) -> impl Fn(&Big) -> [Big3; 4] + '_ {
    move |t| {
        let a = big::place::<BITS>(&query.motion_a, query.a, t);
        let b = big::place::<BITS>(&query.motion_b, query.b, t);
        let (a, b) = (|i: usize| a[i].clone(), |i: usize| b[i].clone());
        match query.kind {
            Kind::PointTriangle => [a(0), b(0), b(1), b(2)],
            Kind::EdgeEdge => [a(0), a(1), b(0), b(1)],
        }
    }
}

/// The vertices of straight paths.
pub fn straight(start: [DVec3; 4], end: [DVec3; 4]) -> impl Fn(&Big) -> [Big3; 4] {
    move |t| {
        [0, 1, 2, 3].map(|i| {
            let (p0, p1) = (big3(start[i]), big3(end[i]));
            add(&p0, &scale(&sub(&p1, &p0), t))
        })
    }
}

/// The volume that vanishes when point and plane, or the two lines, meet.
fn volume(kind: Kind, v: &[Big3; 4]) -> Big {
    match kind {
        Kind::PointTriangle => dot(&sub(&v[0], &v[1]), &cross(&sub(&v[2], &v[1]), &sub(&v[3], &v[1]))),
        Kind::EdgeEdge => dot(&sub(&v[0], &v[2]), &cross(&sub(&v[1], &v[0]), &sub(&v[3], &v[2]))),
    }
}

/// Whether features whose volume vanishes share a point (degenerate ones: never said).
fn meets(kind: Kind, v: &[Big3; 4]) -> bool {
    let within = |x: &Big, of: &Big| *x >= big(0.0) && x <= of;
    match kind {
        Kind::PointTriangle => {
            let (e, f, w) = (sub(&v[2], &v[1]), sub(&v[3], &v[1]), sub(&v[0], &v[1]));
            let n = cross(&e, &f);
            let area = dot(&n, &n);
            let (s, t) = (dot(&cross(&w, &f), &n), dot(&cross(&e, &w), &n));
            area > big(0.0) && within(&s, &area) && within(&t, &area) && within(&(s + t), &area)
        }
        Kind::EdgeEdge => {
            let (e, d, w) = (sub(&v[1], &v[0]), sub(&v[3], &v[2]), sub(&v[2], &v[0]));
            let n = cross(&e, &d);
            let area = dot(&n, &n);
            let (s, t) = (dot(&cross(&w, &d), &n), dot(&cross(&w, &e), &n));
            area > big(0.0) && within(&s, &area) && within(&t, &area)
        }
    }
}

/// A true contact near the planted time, to 10⁻³⁸: a change of sign of the volume between two times, where the
/// features meet. `None` says nothing.
pub fn true_contact(kind: Kind, vertices: &Vertices, time: f64, window: (f64, f64)) -> Option<Big> {
    let (first, last) = (big(window.0), big(window.1));
    let planted = big(time);
    let f_planted = volume(kind, &vertices(&planted));
    let zero = big(0.0);
    for width in [1e-13, 1e-11, 1e-8, 1e-6, 1e-4, 1e-3] {
        for (mut lo, mut hi) in [
            ((&planted - big(width)).max(first.clone()), planted.clone()),
            (planted.clone(), (&planted + big(width)).min(last.clone())),
        ] {
            if lo >= hi {
                continue;
            }
            let value = |t: &Big| if *t == planted { f_planted.clone() } else { volume(kind, &vertices(t)) };
            let (mut f_lo, mut f_hi) = (value(&lo), value(&hi));
            if (f_lo > zero) == (f_hi > zero) {
                continue;
            }
            // Secant steps kept inside the bracket, with a bisection whenever they stall.
            for round in 0..200 {
                if &hi - &lo < big(1e-39) {
                    break;
                }
                let share = &f_lo / (&f_lo - &f_hi);
                let step = &hi - &lo;
                let mut mid = &lo + &step * share;
                if round % 3 == 2 {
                    mid = &lo + step * big(0.5);
                }
                let f = volume(kind, &vertices(&mid));
                if (f > zero) == (f_lo > zero) {
                    (lo, f_lo) = (mid, f);
                } else {
                    (hi, f_hi) = (mid, f);
                }
            }
            let here = vertices(&hi);
            return (meets(kind, &here)).then_some(hi);
        }
    }
    None
}

/// Distance of the features at a time, to about 1e-30 (as f64).
///
/// # Panics
/// If `time` is not finite.
pub fn distance(kind: Kind, vertices: &Vertices, time: f64) -> f64 {
    let v = vertices(&big(time));
    let zero = big(0.0);
    let clamp = |x: Big| x.max(zero.clone()).min(big(1.0));
    // Squared distance of a point to a segment.
    let to_segment = |p: &Big3, a: &Big3, b: &Big3| {
        let (e, w) = (sub(b, a), sub(p, a));
        let length = dot(&e, &e);
        let s = if length > zero { clamp(dot(&w, &e) / length) } else { zero.clone() };
        let d = sub(&w, &scale(&e, &s));
        dot(&d, &d)
    };
    let mut squares = match kind {
        Kind::PointTriangle => vec![
            to_segment(&v[0], &v[1], &v[2]),
            to_segment(&v[0], &v[2], &v[3]),
            to_segment(&v[0], &v[3], &v[1]),
        ],
        Kind::EdgeEdge => vec![
            to_segment(&v[0], &v[2], &v[3]),
            to_segment(&v[1], &v[2], &v[3]),
            to_segment(&v[2], &v[0], &v[1]),
            to_segment(&v[3], &v[0], &v[1]),
        ],
    };
    if meets(kind, &v) {
        // The foot is inside: distance to the plane, or of the lines.
        let n = match kind {
            Kind::PointTriangle => cross(&sub(&v[2], &v[1]), &sub(&v[3], &v[1])),
            Kind::EdgeEdge => cross(&sub(&v[1], &v[0]), &sub(&v[3], &v[2])),
        };
        let f = volume(kind, &v);
        squares.push(&f * &f / dot(&n, &n));
    }
    let least = squares.into_iter().min().expect("not empty");
    least.to_f64().value().sqrt()
}
