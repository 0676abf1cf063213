//! Vectors and rotations of numbers with hundreds of bits, by their definitions. Slow and simple.
//!
//! The precision of a result is that of its operands, so the number of bits is chosen where a double is turned into one:
//! `number::<192>(x)`.
use d2m_motion::ConstantTwist;
use dashu_float::{FBig, round::mode::HalfEven};
use glam::DVec3;

/// A number of many bits.
pub type Big = FBig<HalfEven, 2>;
/// A vector of them.
pub type Big3 = [Big; 3];

/// A unit quaternion up to its length.
#[derive(Debug, Clone)]
pub struct BigQuaternion {
    /// The real part.
    pub scalar: Big,
    /// The other three.
    pub vector: Big3,
}

/// A double, exactly, with which results have `BITS` bits.
///
/// # Panics
/// If `x` is not finite.
pub fn number<const BITS: usize>(x: f64) -> Big {
    Big::try_from(x).expect("finite").with_precision(BITS).value()
}

/// A vector of doubles, exactly.
///
/// # Panics
/// If it is not finite.
pub fn vector<const BITS: usize>(v: DVec3) -> Big3 {
    [number::<BITS>(v.x), number::<BITS>(v.y), number::<BITS>(v.z)]
}

/// a + b.
pub fn add(a: &Big3, b: &Big3) -> Big3 {
    [&a[0] + &b[0], &a[1] + &b[1], &a[2] + &b[2]]
}

/// a − b.
pub fn sub(a: &Big3, b: &Big3) -> Big3 {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// s·a.
pub fn scale(a: &Big3, s: &Big) -> Big3 {
    [&a[0] * s, &a[1] * s, &a[2] * s]
}

/// a·b.
pub fn dot(a: &Big3, b: &Big3) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a × b.
pub fn cross(a: &Big3, b: &Big3) -> Big3 {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

/// |x|.
pub fn abs(x: &Big) -> Big {
    if *x < Big::ZERO { -x } else { x.clone() }
}

impl BigQuaternion {
    /// exp(\[w\]s): Taylor of a small turn, then repeated squaring.
    pub fn exponential<const BITS: usize>(w: &Big3, s: &Big) -> Self {
        let one = || number::<BITS>(1.0);
        let mut half = scale(w, &(s * number::<BITS>(0.5)));
        let mut doublings = 0;
        // 2⁻¹⁰.
        while dot(&half, &half) > number::<BITS>(0.000_976_562_5) {
            half = scale(&half, &number::<BITS>(0.5));
            doublings += 1;
        }
        let square = dot(&half, &half);
        // Half angle at most 2⁻⁵: 26 terms leave less than 2⁻²⁶⁰/52!, below 2⁻⁴⁸⁰.
        let (mut cos, mut sinc, mut term) = (one(), one(), one());
        for k in 1..26_u32 {
            term = -term * &square / number::<BITS>(f64::from((2 * k - 1) * (2 * k)));
            cos += &term;
            sinc += &term / number::<BITS>(f64::from(2 * k + 1));
        }
        let mut q = Self { scalar: cos, vector: scale(&half, &sinc) };
        for _ in 0..doublings {
            let Self { scalar: c, vector: u } = &q;
            q = Self { scalar: c * c - dot(u, u), vector: scale(u, &(number::<BITS>(2.0) * c)) };
        }
        q
    }

    /// `p` turned: ((c² − u·u)p + 2(u·p)u + 2c u × p)/(c² + u·u).
    pub fn turned<const BITS: usize>(&self, p: &Big3) -> Big3 {
        let Self { scalar: c, vector: u } = self;
        let (cc, uu, two) = (c * c, dot(u, u), number::<BITS>(2.0));
        let sum = add(
            &add(&scale(p, &(&cc - &uu)), &scale(u, &(&two * dot(u, p)))),
            &scale(&cross(u, p), &(&two * c)),
        );
        let norm = cc + uu;
        sum.map(|x| x / &norm)
    }
}

/// World positions of body points at a time: `x(t) + exp([ω](t − t_ref)) R(q/|q|)(p − at)`.
///
/// # Panics
/// If a point is not finite.
pub fn place<const BITS: usize>(
    motion: &ConstantTwist,
    points: impl IntoIterator<Item = DVec3>,
    t: &Big,
) -> Vec<Big3> {
    let s = t - number::<BITS>(motion.reference_time());
    let q = motion.orientation();
    let start =
        BigQuaternion { scalar: number::<BITS>(q.w), vector: vector::<BITS>(DVec3::new(q.x, q.y, q.z)) };
    let turn = BigQuaternion::exponential::<BITS>(&vector::<BITS>(motion.angular_velocity()), &s);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| turn.turned::<BITS>(&start.turned::<BITS>(&vector::<BITS>(axis))));
    let at = vector::<BITS>(motion.at());
    let origin =
        add(&vector::<BITS>(motion.position()), &scale(&vector::<BITS>(motion.linear_velocity()), &s));
    let world = |p: DVec3| {
        let e = sub(&vector::<BITS>(p), &at);
        let arm = add(&add(&scale(&axes[0], &e[0]), &scale(&axes[1], &e[1])), &scale(&axes[2], &e[2]));
        add(&origin, &arm)
    };
    points.into_iter().map(world).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Draw, Random};

    #[test]
    fn places_are_those_of_the_motion() {
        let mut random = Random::new(3);
        for _ in 0..50 {
            let motion = ConstantTwist::try_new(
                random.vector(),
                random.quaternion(),
                random.vector(),
                random.vector() * 3.0,
            )
            .expect("finite")
            .with_at(random.vector());
            let (p, t) = (random.vector(), random.between(-2.0, 2.0));
            let exact = &place::<192>(&motion, [p], &number::<192>(t))[0];
            let rounded = DVec3::from_array(exact.clone().map(|x| x.to_f64().value()));
            let other = d2m_motion::RigidMotion::pose_and_twist(&motion, t).0.transform_point(p);
            assert!((rounded - other).length() < 1e-14, "{rounded} {other}");
        }
    }
}
