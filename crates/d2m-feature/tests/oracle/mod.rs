//! Truth to about 70 digits, short enough to be trusted by reading: fixed-point numbers n·2⁻²⁵⁶ over big integers, and
//! the rotation as the plain power series of exp(\[ω\]t).
#![allow(dead_code, reason = "each test binary uses a part of it")]

use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use dashu_int::IBig;
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

const BITS: usize = 256;

/// The number n·2⁻²⁵⁶; products are rounded down.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Fix(pub(crate) IBig);

impl Fix {
    /// Exact for |x| ≥ 2⁻²⁰⁰ or 0.
    pub(crate) fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i64;
        let mantissa = (bits & ((1 << 52) - 1)) | if exponent > 0 { 1 << 52 } else { 0 };
        let shift = exponent.max(1) - 1075 + BITS as i64;
        let n = IBig::from(mantissa);
        let n = if shift >= 0 { n << shift as usize } else { n >> (-shift) as usize };
        Self(if x < 0.0 { -n } else { n })
    }

    pub(crate) fn divide(&self, o: &Self) -> Self {
        Self((self.0.clone() << BITS) / &o.0)
    }

    /// About the nearest double.
    pub(crate) fn to_f64(&self) -> f64 {
        let n: IBig = self.0.clone() >> (BITS - 160);
        n.to_f64().value() * 2f64.powi(-160)
    }

    pub(crate) fn is_in(&self, i: Interval) -> bool {
        (i.lo() == f64::NEG_INFINITY || Self::new(i.lo()) <= *self)
            && (i.hi() == f64::INFINITY || *self <= Self::new(i.hi()))
    }
}

impl Add for &Fix {
    type Output = Fix;
    fn add(self, o: Self) -> Fix {
        Fix(&self.0 + &o.0)
    }
}
impl Sub for &Fix {
    type Output = Fix;
    fn sub(self, o: Self) -> Fix {
        Fix(&self.0 - &o.0)
    }
}
impl Mul for &Fix {
    type Output = Fix;
    fn mul(self, o: Self) -> Fix {
        Fix((&self.0 * &o.0) >> BITS)
    }
}
impl Neg for &Fix {
    type Output = Fix;
    fn neg(self) -> Fix {
        Fix(-self.0.clone())
    }
}

pub(crate) type V = [Fix; 3];
pub(crate) type M = [V; 3];

pub(crate) fn vec(p: DVec3) -> V {
    [Fix::new(p.x), Fix::new(p.y), Fix::new(p.z)]
}
pub(crate) fn add(a: &V, b: &V) -> V {
    core::array::from_fn(|i| &a[i] + &b[i])
}
pub(crate) fn sub(a: &V, b: &V) -> V {
    core::array::from_fn(|i| &a[i] - &b[i])
}
pub(crate) fn scale(a: &V, s: &Fix) -> V {
    core::array::from_fn(|i| &a[i] * s)
}
pub(crate) fn dot(a: &V, b: &V) -> Fix {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}
pub(crate) fn cross(a: &V, b: &V) -> V {
    core::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &(&a[j] * &b[k]) - &(&a[k] * &b[j])
    })
}
pub(crate) fn apply(m: &M, v: &V) -> V {
    core::array::from_fn(|i| dot(&m[i], v))
}
pub(crate) fn transpose(m: &M) -> M {
    core::array::from_fn(|i| core::array::from_fn(|j| m[j][i].clone()))
}
fn multiply(a: &M, b: &M) -> M {
    let b = transpose(b);
    core::array::from_fn(|i| core::array::from_fn(|j| dot(&a[i], &b[j])))
}

/// R(t) = exp(\[ω\](t − t_ref))·R(q/|q|).
pub(crate) fn rotation(m: &ConstantTwist, t: &Fix) -> M {
    let s = t - &Fix::new(m.reference_time());
    let w = scale(&vec(m.angular_velocity()), &s);
    let zero = Fix::new(0.0);
    let k: M = [
        [zero.clone(), -&w[2], w[1].clone()],
        [w[2].clone(), zero.clone(), -&w[0]],
        [-&w[1], w[0].clone(), zero.clone()],
    ];
    let one = |i: usize, j: usize| Fix::new(if i == j { 1.0 } else { 0.0 });
    let mut term: M = core::array::from_fn(|i| core::array::from_fn(|j| one(i, j)));
    let mut sum = term.clone();
    for n in 1..400 {
        term = multiply(&term, &k).map(|r| r.map(|x| Fix(x.0 / n)));
        if term.iter().flatten().all(|x| x.0.clone() * 4 == IBig::ZERO) {
            break;
        }
        sum = core::array::from_fn(|i| add(&sum[i], &term[i]));
    }
    let q = m.orientation();
    let v = vec(DVec3::new(q.x, q.y, q.z));
    let c = Fix::new(q.w);
    let norm = &dot(&v, &v) + &(&c * &c);
    // Columns: (c² − |v|²) e + 2 (v·e) v + 2 c v × e, over the norm.
    let columns: M = core::array::from_fn(|j| {
        let e: V = core::array::from_fn(|i| one(i, j));
        let first = scale(&e, &(&(&c * &c) - &dot(&v, &v)));
        let rest = add(&scale(&v, &dot(&v, &e)), &scale(&cross(&v, &e), &c));
        add(&first, &add(&rest, &rest)).map(|x| x.divide(&norm))
    });
    multiply(&sum, &transpose(&columns))
}

/// R(t)(p − at), and x(t).
pub(crate) fn arm_and_position(m: &ConstantTwist, p: DVec3, t: &Fix) -> (V, V) {
    let arm = apply(&rotation(m, t), &sub(&vec(p), &vec(m.at())));
    let s = t - &Fix::new(m.reference_time());
    (arm, add(&vec(m.position()), &scale(&vec(m.linear_velocity()), &s)))
}

/// World position of the body point.
pub(crate) fn world(m: &ConstantTwist, p: DVec3, t: &Fix) -> V {
    let (arm, x) = arm_and_position(m, p, t);
    add(&arm, &x)
}

/// Position, velocity and acceleration of a mover's point in the observer's frame.
pub(crate) fn relative(mover: &ConstantTwist, observer: &ConstantTwist, p: DVec3, t: &Fix) -> [V; 3] {
    let (z, x) = arm_and_position(mover, p, t);
    let (_, xo) = arm_and_position(observer, observer.at(), t);
    let (wm, wo) = (vec(mover.angular_velocity()), vec(observer.angular_velocity()));
    let x0 = add(&sub(&x, &xo), &z);
    let u = sub(&vec(mover.linear_velocity()), &vec(observer.linear_velocity()));
    let d1 = add(&u, &cross(&wm, &z));
    let d2 = cross(&wm, &cross(&wm, &z));
    let x1 = sub(&d1, &cross(&wo, &x0));
    let x2 = sub(&sub(&d2, &cross(&wo, &d1)), &cross(&wo, &x1));
    let back = transpose(&rotation(observer, t));
    [add(&apply(&back, &x0), &vec(observer.at())), apply(&back, &x1), apply(&back, &x2)]
}

/// Numbers from a seed, in \[−1, 1), multiples of 2⁻⁵².
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = self.0 ^ (self.0 >> 29);
        (x.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub(crate) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }
    /// A motion with speeds up to about `v` and `w`.
    pub(crate) fn motion(&mut self, v: f64, w: f64) -> ConstantTwist {
        let q = glam::DQuat::from_xyzw(self.number(), self.number(), self.number(), self.number());
        ConstantTwist::try_new(self.vector(), q, self.vector() * v, self.vector() * w).expect("finite")
    }
}
