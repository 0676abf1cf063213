//! Correctly rounded square root in integer arithmetic, for targets without a vector unit and without std.
use crate::power_of_two;

/// `√x`, rounded to nearest.
pub(crate) fn sqrt(x: f64) -> f64 {
    let bits = x.to_bits();
    if x.is_nan() || x <= 0.0 || x == f64::INFINITY {
        return if x < 0.0 { f64::NAN } else { x };
    }
    let mut exponent = (bits >> 52) as i32 - 1075;
    let mut mantissa = bits & ((1 << 52) - 1);
    if exponent == -1075 {
        exponent = -1074;
    } else {
        mantissa |= 1 << 52;
    }
    // x = mantissa · 2^exponent; scale so that the integer root has at least 54 bits.
    let mut shift = mantissa.leading_zeros() as i32 + 44;
    if (exponent - shift) % 2 != 0 {
        shift -= 1;
    }
    let radicand = u128::from(mantissa) << shift;
    let half = (exponent - shift) / 2;
    let root = radicand.isqrt();
    // The root has 54 bits; round to 53, to nearest (a root cannot be half way without a remainder).
    let exact = root * root == radicand;
    let length = 128 - root.leading_zeros() as i32;
    let drop = length - 53;
    let kept = (root >> drop) as u64;
    let rest = root & ((1 << drop) - 1);
    let middle = 1u128 << (drop - 1);
    let round_up = rest > middle || (rest == middle && (!exact || kept & 1 == 1));
    let rounded = kept + u64::from(round_up);
    rounded as f64 * power_of_two(half + drop)
}
