//! Orientation predicates with exact signs for every finite input.
//!
//! A floating-point evaluation with an error bound decides nearly always. What it cannot decide is summed exactly: the
//! determinant of *coordinates* (not of differences) is a sum of 6 or 24 products of up to three numbers of 53 bits, and
//! one fixed-point accumulator that spans all exponents holds such a sum without any rounding, underflow or overflow
//! (U. Kulisch's long accumulator). So there is no hypothesis on the range of the input.

use d2m_lanes::power_of_two;
use glam::{DVec2, DVec3};
use std::cmp::Ordering;

/// Below this magnitude a determinant is not trusted to the filter, because products may have underflowed.
const FILTER_MINIMUM: f64 = power_of_two(-700);
/// Above this magnitude of the differences the filter is not used, because products may overflow.
const FILTER_MAXIMUM: f64 = power_of_two(200);

/// The exact sign of (b − a) × (c − a): `Greater` if a, b, c turn counter-clockwise, `Equal` if they lie on a line.
///
/// ```
/// use d2m_feature::orient2d;
/// use glam::dvec2;
/// use std::cmp::Ordering;
///
/// assert_eq!(orient2d(dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)), Ordering::Greater);
/// assert_eq!(orient2d(dvec2(0.0, 0.0), dvec2(1e-300, 0.0), dvec2(0.0, 1e-300)), Ordering::Greater);
/// assert_eq!(orient2d(dvec2(0.1, 0.1), dvec2(0.2, 0.2), dvec2(0.7, 0.7)), Ordering::Equal);
/// ```
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let (ab, ac) = (b - a, c - a);
    let (left, right) = (ab.x * ac.y, ab.y * ac.x);
    let determinant = left - right;
    // Differences carry a relative error u, products 3u, their difference one more u of itself: 4u, with second-order
    // terms below 5u = 2.5 EPSILON of the permanent; twice that is taken.
    let bound = 5.0 * f64::EPSILON * (left.abs() + right.abs());
    let size = ab.abs().max_element().max(ac.abs().max_element());
    if determinant.abs() > bound && determinant.abs() > FILTER_MINIMUM && size < FILTER_MAXIMUM {
        return sign(determinant);
    }
    let mut sum = ExactSum::new();
    for (p, q) in [(a, b), (b, c), (c, a)] {
        sum.add([p.x, q.y, 1.0]);
        sum.add([-p.y, q.x, 1.0]);
    }
    sum.sign()
}

/// The exact sign of ((b − a) × (c − a)) · (d − a): `Greater` if d lies on the side of the plane a, b, c from which they
/// turn counter-clockwise, `Equal` if the four points lie in a plane.
///
/// ```
/// use d2m_feature::orient3d;
/// use glam::DVec3;
/// use std::cmp::Ordering;
///
/// assert_eq!(orient3d(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z), Ordering::Greater);
/// assert_eq!(orient3d(DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.5, 0.25, 0.25)), Ordering::Equal);
/// assert_eq!(orient3d(DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(1.0 / 3.0)), Ordering::Less); // fl(1/3) < 1/3
/// ```
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    let (yz, zy) = (ab.y * ac.z, ab.z * ac.y);
    let (zx, xz) = (ab.z * ac.x, ab.x * ac.z);
    let (xy, yx) = (ab.x * ac.y, ab.y * ac.x);
    let determinant = (yz - zy) * ad.x + (zx - xz) * ad.y + (xy - yx) * ad.z;
    let permanent = (yz.abs() + zy.abs()) * ad.x.abs()
        + (zx.abs() + xz.abs()) * ad.y.abs()
        + (xy.abs() + yx.abs()) * ad.z.abs();
    // Three differences (u each), two products, one subtraction and two additions: at most 8u on every term, with
    // second-order terms below 9u; 16u = 8 EPSILON is taken, which also covers the rounding of the permanent.
    let bound = 8.0 * f64::EPSILON * permanent;
    let size = ab.abs().max(ac.abs()).max(ad.abs()).max_element();
    if determinant.abs() > bound && determinant.abs() > FILTER_MINIMUM && size < FILTER_MAXIMUM {
        return sign(determinant);
    }
    let mut sum = ExactSum::new();
    for (p, q, r) in [(b, c, d), (a, d, c), (a, b, d), (a, c, b)] {
        sum.add_determinant(p, q, r);
    }
    sum.sign()
}

/// The exact sign of (Σu × Σv) · Σw, each vector given as a sum of at most sixteen exact parts: a difference of two points that are
/// themselves sums of doubles – a vertex and a translation, say – loses nothing.
///
/// ```
/// use d2m_feature::triple_product_sign;
/// use glam::DVec3;
/// use std::cmp::Ordering;
///
/// let tiny = DVec3::Z * 1e-30;
/// assert_eq!(triple_product_sign(&[DVec3::X], &[DVec3::Y], &[DVec3::Z, tiny, -DVec3::Z]), Ordering::Greater);
/// assert_eq!(triple_product_sign(&[DVec3::X], &[DVec3::Y], &[DVec3::X, DVec3::Y]), Ordering::Equal);
/// ```
///
/// # Panics
/// With more than sixteen parts, in debug builds.
pub fn triple_product_sign(u: &[DVec3], v: &[DVec3], w: &[DVec3]) -> Ordering {
    let parts = [u, v, w];
    debug_assert!(parts.iter().all(|list| list.len() <= MOST_PARTS), "at most sixteen parts");
    let sum = |list: &[DVec3]| list.iter().fold(DVec3::ZERO, |sum, part| sum + *part);
    let magnitude = |list: &[DVec3]| list.iter().fold(DVec3::ZERO, |sum, part| sum + part.abs());
    let [a, b, c] = parts.map(sum);
    let determinant =
        (a.y * b.z - a.z * b.y) * c.x + (a.z * b.x - a.x * b.z) * c.y + (a.x * b.y - a.y * b.x) * c.z;
    let [a, b, c] = parts.map(magnitude);
    let permanent =
        (a.y * b.z + a.z * b.y) * c.x + (a.z * b.x + a.x * b.z) * c.y + (a.x * b.y + a.y * b.x) * c.z;
    // A sum of n parts is off by (n − 1)u of the sum of their magnitudes to first order, n ≤ 16; the determinant of the three sums
    // by 5u of the permanent of their magnitudes, as in `orient3d`, of which the differences are left out: 50u. 64u = 32 EPSILON
    // covers second-order terms and the rounding of the permanent.
    let bound = 32.0 * f64::EPSILON * permanent;
    let size = a.max(b).max(c).max_element();
    if determinant.abs() > bound && determinant.abs() > FILTER_MINIMUM && size < FILTER_MAXIMUM {
        return sign(determinant);
    }
    let mut exact = ExactSum::new();
    for p in u {
        for q in v {
            for r in w {
                exact.add_determinant(*p, *q, *r);
            }
        }
    }
    exact.sign()
}

/// Parts of a vector in [`triple_product_sign`].
const MOST_PARTS: usize = 16;

fn sign(value: f64) -> Ordering {
    if value > 0.0 {
        Ordering::Greater
    } else if value < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// Exact sum of products of three finite numbers.
///
/// Limb i weighs 2^(32 i − 3222), where −3222 = 3·(−1074) is the smallest exponent of a product. Limbs are signed and
/// collect pieces below 2³² without carrying, so up to 2³⁰ pieces fit.
struct ExactSum {
    limbs: [i64; 204],
    lowest: usize,
    highest: usize,
}

impl ExactSum {
    fn new() -> Self {
        Self { limbs: [0; 204], lowest: 204, highest: 0 }
    }

    /// Adds (p × q) · r.
    fn add_determinant(&mut self, p: DVec3, q: DVec3, r: DVec3) {
        self.add([p.x, q.y, r.z]);
        self.add([-p.x, q.z, r.y]);
        self.add([p.y, q.z, r.x]);
        self.add([-p.y, q.x, r.z]);
        self.add([p.z, q.x, r.y]);
        self.add([-p.z, q.y, r.x]);
    }

    /// Adds the product of the three factors.
    fn add(&mut self, factors: [f64; 3]) {
        let (mut weight, mut negative) = (3222, false);
        let mut mantissas = [0_u64; 3];
        for (mantissa, factor) in mantissas.iter_mut().zip(factors) {
            let bits = factor.to_bits();
            let exponent = (bits >> 52 & 0x7ff) as i32;
            let fraction = bits & ((1 << 52) - 1);
            *mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
            weight += exponent.max(1) - 1075;
            negative ^= factor.is_sign_negative();
        }
        let [first, second, third] = mantissas.map(u128::from);
        if first == 0 || second == 0 || third == 0 {
            return;
        }
        let pair = first * second; // below 2^106
        let low = (pair & u128::from(u64::MAX)) * third; // below 2^117
        let high = (pair >> 64) * third; // below 2^95
        let weight = weight as usize;
        for (word, offset) in
            [(low as u64, 0), ((low >> 64) as u64, 64), (high as u64, 64), ((high >> 64) as u64, 128)]
        {
            let position = weight + offset;
            let shifted = u128::from(word) << (position % 32);
            for piece in 0..3 {
                let digit = (shifted >> (32 * piece)) as u32;
                let limb = &mut self.limbs[position / 32 + piece];
                *limb += if negative { -i64::from(digit) } else { i64::from(digit) };
            }
            self.lowest = self.lowest.min(position / 32);
            self.highest = self.highest.max(position / 32 + 2);
        }
    }

    /// The sign of the sum: carry upwards, leaving digits in [0, 2³²); a negative final carry outweighs all of them.
    fn sign(&self) -> Ordering {
        let mut carry = 0_i64;
        let mut has_digits = false;
        for limb in self.limbs.iter().take(self.highest + 1).skip(self.lowest) {
            let value = limb + carry;
            carry = value >> 32;
            has_digits |= value & 0xffff_ffff != 0;
        }
        match carry.cmp(&0) {
            Ordering::Equal if has_digits => Ordering::Greater,
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_ratio::RBig;
    use proptest::prelude::*;

    fn exact(value: f64) -> RBig {
        RBig::try_from(value).unwrap()
    }

    fn exact_orient3d(points: [DVec3; 4]) -> Ordering {
        let [a, b, c, d] = points.map(|point| point.to_array().map(exact));
        let [b, c, d] = [b, c, d].map(|p| [&p[0] - &a[0], &p[1] - &a[1], &p[2] - &a[2]]);
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        (minor(1, 2) * &d[0] + minor(2, 0) * &d[1] + minor(0, 1) * &d[2]).cmp(&RBig::ZERO)
    }

    fn exact_orient2d([a, b, c]: [DVec2; 3]) -> Ordering {
        let [a, b, c] = [a, b, c].map(|p| p.to_array().map(exact));
        ((&b[0] - &a[0]) * (&c[1] - &a[1])).cmp(&((&b[1] - &a[1]) * (&c[0] - &a[0])))
    }

    /// Any finite number, most of them of similar size, some huge, subnormal or zero.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => -1.0..1.0,
            2 => (-4_i32..5).prop_map(f64::from),
            2 => (-40_i32..41).prop_map(|k| 1.0 + f64::from(k) * f64::EPSILON),
            1 => any::<f64>().prop_map(|x| if x.is_finite() { x } else { f64::MAX }),
            1 => prop::sample::select(vec![0.0, -0.0, 5e-324, -5e-324, f64::MIN_POSITIVE, f64::MAX, f64::MIN, 1e-200]),
        ]
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]
        #[test]
        fn signs_are_exact(points in prop::array::uniform4(point())) {
            prop_assert_eq!(orient3d(points[0], points[1], points[2], points[3]), exact_orient3d(points));
            let flat = [points[0], points[1], points[2]].map(DVec3::truncate);
            prop_assert_eq!(orient2d(flat[0], flat[1], flat[2]), exact_orient2d(flat));
        }

        #[test]
        fn signs_of_sums_are_exact(points in prop::array::uniform6(point()), zero in 0_usize..3) {
            let [u, v, w, x, y, z] = points;
            let total = |parts: &[DVec3]| -> [RBig; 3] {
                let sum = |k: usize| parts.iter().map(|p| exact(p[k])).fold(RBig::ZERO, |s, x| s + x);
                [sum(0), sum(1), sum(2)]
            };
            // Sums that cancel are the hard ones.
            let third = [w, z, [-w, -z, -u][zero]];
            let [a, b, c] = [total(&[u, x]), total(&[v, y]), total(&third)];
            let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
            let expected = (minor(1, 2) * &c[0] + minor(2, 0) * &c[1] + minor(0, 1) * &c[2]).cmp(&RBig::ZERO);
            prop_assert_eq!(triple_product_sign(&[u, x], &[v, y], &third), expected);
        }

        #[test]
        fn signs_are_exact_near_the_plane(a in point(), b in point(), c in point(), s in -1.0..2.0, t in -1.0..2.0, step in -2_i32..3) {
            let [a, b, c] = [a, b, c].map(|p| p.clamp(DVec3::splat(-1e150), DVec3::splat(1e150)));
            let mut d: DVec3 = a + (b - a) * s + (c - a) * t;
            d.z *= 1.0 + f64::from(step) * f64::EPSILON;
            prop_assert_eq!(orient3d(a, b, c, d), exact_orient3d([a, b, c, d]));
            let d: DVec3 = a + (b - a) * s;
            prop_assert_eq!(orient2d(a.truncate(), b.truncate(), d.truncate()), exact_orient2d([a, b, d].map(DVec3::truncate)));
        }
    }

    #[test]
    fn permutations_flip_the_sign() {
        let points =
            [DVec3::new(0.1, 0.2, 0.3), DVec3::X * 1e-310, DVec3::Y * 1e200, DVec3::new(-3.0, 0.7, 1e-9)];
        let sign = orient3d(points[0], points[1], points[2], points[3]);
        assert_ne!(sign, Ordering::Equal);
        assert_eq!(orient3d(points[1], points[0], points[2], points[3]), sign.reverse());
        assert_eq!(orient3d(points[0], points[1], points[3], points[2]), sign.reverse());
    }
}
