//! The first tier of the judge: the oracle's questions in double-double (106 bits), a hundred times as fast.
//!
//! It only ever says "this answer is right, clearly": every sign that it uses differs from zero by 10⁴ times the error of
//! its arithmetic or more, and whatever is closer goes to the 192 bits. So it never accuses and never excuses. It shares
//! nothing with the library, whose own double-double is another one.
use super::families::{Kind, Planted};
use d2m_feature::FirstContact;
use d2m_motion::ConstantTwist;
use glam::DVec3;
use std::ops::{Add, Div, Mul, Sub};

/// An unevaluated sum of two doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Double2 {
    hi: f64,
    lo: f64,
}

type V = [Double2; 3];

fn two_sum(a: f64, b: f64) -> Double2 {
    let s = a + b;
    let c = s - a;
    Double2 { hi: s, lo: (a - (s - c)) + (b - c) }
}

fn two_product(a: f64, b: f64) -> Double2 {
    let split = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let ((a1, a0), (b1, b0), p) = (split(a), split(b), a * b);
    Double2 { hi: p, lo: ((a1 * b1 - p) + a1 * b0 + a0 * b1) + a0 * b0 }
}

impl From<f64> for Double2 {
    fn from(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
}
impl Add for Double2 {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (s, t) = (two_sum(self.hi, o.hi), two_sum(self.lo, o.lo));
        let s = two_sum(s.hi, s.lo + t.hi);
        two_sum(s.hi, s.lo + t.lo)
    }
}
impl Sub for Double2 {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + Self { hi: -o.hi, lo: -o.lo }
    }
}
impl Mul for Double2 {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = two_product(self.hi, o.hi);
        two_sum(p.hi, p.lo + (self.hi * o.lo + self.lo * o.hi))
    }
}
impl Div for Double2 {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let first = Self::from(self.hi / o.hi);
        let rest = self - first * o;
        let second = Self::from(rest.hi / o.hi);
        let rest = rest - second * o;
        first + second + Self::from(rest.hi / o.hi)
    }
}

fn vector(v: DVec3) -> V {
    [v.x.into(), v.y.into(), v.z.into()]
}
fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn scale(a: V, s: Double2) -> V {
    a.map(|x| x * s)
}
fn dot(a: V, b: V) -> Double2 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `p` turned by the quaternion (s, u), divided by its norm.
fn turned((s, u): (Double2, V), p: V) -> V {
    let (ss, uu, two) = (s * s, dot(u, u), Double2::from(2.0));
    let sum = add(add(scale(p, ss - uu), scale(u, two * dot(u, p))), scale(cross(u, p), two * s));
    let norm = ss + uu;
    sum.map(|x| x / norm)
}

/// The quaternion of exp(\[w\]t): series of a small turn, then squared.
fn exponential(w: DVec3, t: Double2) -> (Double2, V) {
    let mut half = scale(vector(w), t * 0.5.into());
    let mut doublings = 0;
    while dot(half, half).hi > 0.01 {
        half = scale(half, 0.5.into());
        doublings += 1;
    }
    let square = dot(half, half);
    let (mut cos, mut sinc, mut term) = (Double2::from(1.0), Double2::from(1.0), Double2::from(1.0));
    // φ ≤ 0.1: ten terms leave less than 10⁻³⁷.
    for k in 1..10_u32 {
        let next = term * square / f64::from((2 * k - 1) * (2 * k)).into();
        term = Double2 { hi: -next.hi, lo: -next.lo };
        cos = cos + term;
        sinc = sinc + term / f64::from(2 * k + 1).into();
    }
    let mut q = (cos, scale(half, sinc));
    for _ in 0..doublings {
        let (s, u) = q;
        q = (s * s - dot(u, u), scale(u, s * 2.0.into()));
    }
    q
}

fn place<const N: usize>(motion: &ConstantTwist, points: [DVec3; N], t: Double2) -> [V; N] {
    let s = t - motion.reference_time().into();
    let q = motion.orientation();
    let start = (q.w.into(), [q.x.into(), q.y.into(), q.z.into()]);
    let turn = exponential(motion.angular_velocity(), s);
    let center = add(vector(motion.position()), scale(vector(motion.linear_velocity()), s));
    points.map(|p| add(center, turned(turn, turned(start, sub(vector(p), vector(motion.at()))))))
}

/// Where the four vertices are at a time.
pub type QuickVertices<'a> = dyn Fn(Double2) -> [V; 4] + 'a;

/// The vertices of a rigid query.
pub fn rigid(query: &Planted) -> impl Fn(Double2) -> [V; 4] + '_ {
    move |t| {
        let [a0, a1] = place(&query.motion_a, query.a, t);
        let [b0, b1, b2] = place(&query.motion_b, query.b, t);
        match query.kind {
            Kind::PointTriangle => [a0, b0, b1, b2],
            Kind::EdgeEdge => [a0, a1, b0, b1],
        }
    }
}

/// The vertices of straight paths.
pub fn straight(start: [DVec3; 4], end: [DVec3; 4]) -> impl Fn(Double2) -> [V; 4] {
    move |t| {
        [0, 1, 2, 3].map(|i| {
            let (p0, p1) = (vector(start[i]), vector(end[i]));
            add(p0, scale(sub(p1, p0), t))
        })
    }
}

/// Largest coordinate from the origin, and largest difference.
fn sizes(v: &[V; 4]) -> (f64, f64) {
    let (mut world, mut size) = (0.0_f64, 0.0_f64);
    for p in v {
        for i in 0..3 {
            world = world.max(p[i].hi.abs());
            size = size.max((p[i].hi - v[0][i].hi).abs());
        }
    }
    (world, 2.0 * size)
}

/// Volume and a bound of its error: vertices are off by less than 10⁻²⁷ of the farthest coordinate (106 bits lose 10⁻³²;
/// squaring a quaternion 13 times and 3000 radians of angle take four digits of the five that are left).
pub fn volume(kind: Kind, v: &[V; 4]) -> (Double2, f64) {
    let value = match kind {
        Kind::PointTriangle => dot(sub(v[0], v[1]), cross(sub(v[2], v[1]), sub(v[3], v[1]))),
        Kind::EdgeEdge => dot(sub(v[0], v[2]), cross(sub(v[1], v[0]), sub(v[3], v[2]))),
    };
    let (world, size) = sizes(v);
    (value, 1e-26 * (1.0 + world) * (1.0 + size * size))
}

/// Whether features whose volume vanishes within `off` of these places share a point; `None`: too close to say.
fn meets(kind: Kind, v: &[V; 4], off: f64) -> Option<bool> {
    let (n, numbers) = match kind {
        Kind::PointTriangle => {
            let (e, f, w) = (sub(v[2], v[1]), sub(v[3], v[1]), sub(v[0], v[1]));
            let n = cross(e, f);
            let (s, t) = (dot(cross(w, f), n), dot(cross(e, w), n));
            (n, [s.hi, t.hi, (s + t).hi])
        }
        Kind::EdgeEdge => {
            let (e, d, w) = (sub(v[1], v[0]), sub(v[3], v[2]), sub(v[2], v[0]));
            let n = cross(e, d);
            let (s, t) = (dot(cross(w, d), n).hi, dot(cross(w, e), n).hi);
            (n, [s, t, t])
        }
    };
    let area = dot(n, n).hi;
    let (world, size) = sizes(v);
    let margin = 1e-9 * area + (off + 1e-24 * (1.0 + world)) * 100.0 * (1.0 + size).powi(4);
    if numbers.iter().all(|x| *x > margin && *x < area - margin) {
        return Some(true);
    }
    if numbers.iter().any(|x| *x < -margin || *x > area + margin) { Some(false) } else { None }
}

/// Distance at a time, good to 10⁻¹².
fn distance(kind: Kind, v: &[V; 4]) -> f64 {
    let to_segment = |p: V, a: V, b: V| {
        let (e, w) = (sub(b, a), sub(p, a));
        let length = dot(e, e);
        let s = if length.hi > 0.0 { dot(w, e) / length } else { 0.0.into() };
        let s = if s.hi <= 0.0 {
            0.0.into()
        } else if s.hi >= 1.0 {
            1.0.into()
        } else {
            s
        };
        let d = sub(w, scale(e, s));
        dot(d, d).hi
    };
    let mut least = match kind {
        Kind::PointTriangle => {
            to_segment(v[0], v[1], v[2]).min(to_segment(v[0], v[2], v[3])).min(to_segment(v[0], v[3], v[1]))
        }
        Kind::EdgeEdge => to_segment(v[0], v[2], v[3])
            .min(to_segment(v[1], v[2], v[3]))
            .min(to_segment(v[2], v[0], v[1]))
            .min(to_segment(v[3], v[0], v[1])),
    };
    if meets(kind, v, 0.0) == Some(true) {
        let n = match kind {
            Kind::PointTriangle => cross(sub(v[2], v[1]), sub(v[3], v[1])),
            Kind::EdgeEdge => cross(sub(v[1], v[0]), sub(v[3], v[2])),
        };
        let f = volume(kind, v).0;
        least = least.min((f * f / dot(n, n)).hi);
    }
    least.max(0.0).sqrt()
}

/// A change of sign of the volume near the planted time, as the oracle searches for it: `Err` where a sign is in doubt,
/// `Ok(None)` where there is none.
fn crossing(
    kind: Kind,
    vertices: &QuickVertices,
    time: f64,
    window: (f64, f64),
) -> Result<Option<(Double2, Double2)>, ()> {
    let signed = |t: Double2| {
        let (f, error) = volume(kind, &vertices(t));
        if f.hi.abs() > 2.0 * error { Ok(f) } else { Err(()) }
    };
    let above = |f: Double2| f.hi > 0.0;
    let planted = Double2::from(time);
    let f_planted = signed(planted)?;
    for width in [1e-13, 1e-11, 1e-8, 1e-6, 1e-4, 1e-3] {
        let (first, last) = (two_sum(time, -width), two_sum(time, width));
        let first = if first.hi < window.0 { window.0.into() } else { first };
        let last = if last.hi > window.1 { window.1.into() } else { last };
        for (mut lo, mut hi) in [(first, planted), (planted, last)] {
            if (hi - lo).hi <= 0.0 {
                continue;
            }
            let (mut f_lo, mut f_hi) =
                if hi == planted { (signed(lo)?, f_planted) } else { (f_planted, signed(hi)?) };
            if above(f_lo) == above(f_hi) {
                continue;
            }
            // Regula falsi (Illinois): an end that stays twice counts half, so that both ends converge.
            let mut stayed = 0;
            for _ in 0..80 {
                let step = hi - lo;
                if step.hi < 1e-20 * (1.0 + time.abs()) {
                    break;
                }
                let mid = lo + step * (f_lo / (f_lo - f_hi));
                let Ok(f) = signed(mid) else {
                    // As good as on the root: take the nearest times on either side where their signs are certain.
                    for part in [1e-9, 1e-6, 1e-3] {
                        let reach = step * part.into();
                        if let (Ok(before), Ok(after)) = (signed(mid - reach), signed(mid + reach))
                            && above(before) == above(f_lo)
                            && above(after) == above(f_hi)
                        {
                            (lo, hi) = (mid - reach, mid + reach);
                            break;
                        }
                    }
                    break;
                };
                if above(f) == above(f_lo) {
                    (lo, f_lo) = (mid, f);
                    if stayed > 0 {
                        f_hi = f_hi * 0.5.into();
                    }
                    stayed = 1;
                } else {
                    (hi, f_hi) = (mid, f);
                    if stayed < 0 {
                        f_lo = f_lo * 0.5.into();
                    }
                    stayed = -1;
                }
            }
            return Ok(Some((lo, hi)));
        }
    }
    Ok(None)
}

/// Whether an answer is clearly right: `Some(true)` with a proven contact, `Some(false)` without; `None`: in doubt.
pub fn clearly_right(
    kind: Kind,
    vertices: &QuickVertices,
    answer: &FirstContact,
    time: f64,
    window: (f64, f64),
) -> Option<bool> {
    let crossing = crossing(kind, vertices, time, window).ok()?;
    let met = match crossing {
        None => Some(false),
        Some((lo, hi)) => meets(kind, &vertices(hi), (hi - lo).hi * 1e4),
    };
    match answer {
        FirstContact::Clear => (met == Some(false)).then_some(false),
        FirstContact::Contact(contact) => {
            let inside = window.0 <= contact.lo && contact.lo <= contact.hi && contact.hi <= window.1;
            // Not late: the sign at the bracket's lower end is that of before the crossing.
            let early =
                met == Some(false) || crossing.is_some_and(|(lo, _)| (lo - contact.lo.into()).hi >= 0.0);
            let close = |t: f64| distance(kind, &vertices(t.into())) < 0.9e-9;
            // At the border of a feature the answer is right whether they meet or not.
            (inside && early && (close(contact.lo) || close(contact.hi))).then_some(met == Some(true))
        }
        FirstContact::Undecided { .. } => None,
    }
}
