//! Truth to about 70 digits, short enough to be trusted by reading: fixed-point numbers n·2⁻²⁵⁶ over big integers, and
//! the rotation as the plain power series of exp(\[ω\]t).
use crate::Draw;
use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use dashu_int::IBig;
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

const BITS: usize = 256;

/// The number n·2⁻²⁵⁶; products are rounded down.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fix(pub IBig);

impl Fix {
    /// Exact for |x| ≥ 2⁻²⁰⁰ or 0.
    pub fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i64;
        let mantissa = (bits & ((1 << 52) - 1)) | if exponent > 0 { 1 << 52 } else { 0 };
        let shift = exponent.max(1) - 1075 + BITS as i64;
        let n = IBig::from(mantissa);
        let n = if shift >= 0 { n << shift as usize } else { n >> (-shift) as usize };
        Self(if x < 0.0 { -n } else { n })
    }

    /// The quotient, rounded toward zero.
    pub fn divide(&self, o: &Self) -> Self {
        Self((self.0.clone() << BITS) / &o.0)
    }

    /// About the nearest double.
    pub fn to_f64(&self) -> f64 {
        let n: IBig = self.0.clone() >> (BITS - 160);
        n.to_f64().value() * 2f64.powi(-160)
    }

    /// Whether it lies in an interval.
    pub fn is_in(&self, i: Interval) -> bool {
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

/// A vector.
pub type V = [Fix; 3];
/// A matrix of rows.
pub type M = [V; 3];

/// A vector of doubles.
pub fn vec(p: DVec3) -> V {
    [Fix::new(p.x), Fix::new(p.y), Fix::new(p.z)]
}
/// a + b.
pub fn add(a: &V, b: &V) -> V {
    core::array::from_fn(|i| &a[i] + &b[i])
}
/// a − b.
pub fn sub(a: &V, b: &V) -> V {
    core::array::from_fn(|i| &a[i] - &b[i])
}
/// s·a.
pub fn scale(a: &V, s: &Fix) -> V {
    core::array::from_fn(|i| &a[i] * s)
}
/// a·b.
pub fn dot(a: &V, b: &V) -> Fix {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}
/// a × b.
pub fn cross(a: &V, b: &V) -> V {
    core::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &(&a[j] * &b[k]) - &(&a[k] * &b[j])
    })
}
/// M v.
pub fn apply(m: &M, v: &V) -> V {
    core::array::from_fn(|i| dot(&m[i], v))
}
/// Mᵀ.
pub fn transpose(m: &M) -> M {
    core::array::from_fn(|i| core::array::from_fn(|j| m[j][i].clone()))
}
fn multiply(a: &M, b: &M) -> M {
    let b = transpose(b);
    core::array::from_fn(|i| core::array::from_fn(|j| dot(&a[i], &b[j])))
}

/// R(t) = exp(\[ω\](t − t_ref))·R(q/|q|).
pub fn rotation(m: &ConstantTwist, t: &Fix) -> M {
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
pub fn arm_and_position(m: &ConstantTwist, p: DVec3, t: &Fix) -> (V, V) {
    let arm = apply(&rotation(m, t), &sub(&vec(p), &vec(m.at())));
    let s = t - &Fix::new(m.reference_time());
    (arm, add(&vec(m.position()), &scale(&vec(m.linear_velocity()), &s)))
}

/// World position of the body point.
pub fn world(m: &ConstantTwist, p: DVec3, t: &Fix) -> V {
    let (arm, x) = arm_and_position(m, p, t);
    add(&arm, &x)
}

/// Position, velocity and acceleration of a mover's point in the observer's frame.
pub fn relative(mover: &ConstantTwist, observer: &ConstantTwist, p: DVec3, t: &Fix) -> [V; 3] {
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

/// A motion with speeds up to about `v` and `w`.
///
/// # Panics
/// Never: all numbers drawn are finite.
pub fn random_motion(random: &mut impl Draw, v: f64, w: f64) -> ConstantTwist {
    let q = random.quaternion();
    ConstantTwist::try_new(random.vector(), q, random.vector() * v, random.vector() * w).expect("finite")
}
