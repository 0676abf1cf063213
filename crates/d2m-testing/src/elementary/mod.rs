//! Slow exact reference: fixed-point numbers with 1400 binary places, on big integers. Every double, and every
//! sum of doubles, is exact; anything else is off by less than `2⁻¹³⁵⁰` (relative 2⁻²⁷⁵ at the smallest double).
//! Only integer arithmetic: nothing here shares code or roundings with the crate.
use std::sync::OnceLock;

use dashu_int::{IBig, UBig, ops::Abs, ops::BitTest};

pub mod families;

/// Binary places.
const P: usize = 1400;

/// Value · 2¹⁴⁰⁰.
pub type Fixed = IBig;

/// The exact value of a finite double.
///
/// # Panics
/// If `x` is not finite.
pub fn fixed(x: f64) -> Fixed {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let field = (bits >> 52 & 2047) as usize;
    let mantissa = bits & ((1 << 52) - 1) | u64::from(field != 0) << 52;
    let value = IBig::from(mantissa) << (P - 1075 + field.max(1));
    if x < 0.0 { -value } else { value }
}

pub(crate) fn one() -> Fixed {
    IBig::from(1) << P
}

pub(crate) fn mul(a: &Fixed, b: &Fixed) -> Fixed {
    (a * b) >> P
}

/// The quotient, rounded to a multiple of 2⁻¹⁴⁰⁰.
pub fn div(a: &Fixed, b: &Fixed) -> Fixed {
    (a << P) / b
}

pub(crate) fn sqrt(a: &Fixed) -> Fixed {
    let square: UBig = (a << P).try_into().expect("not negative");
    dashu_int::ops::SquareRoot::sqrt(&square).into()
}

/// The largest double not above the value, and the least one not below it.
///
/// # Panics
/// Never: what is rounded has at most 53 bits.
pub fn to_doubles(value: &Fixed) -> [f64; 2] {
    let negative = *value < IBig::from(0);
    let size: UBig = value.clone().abs().try_into().expect("absolute value");
    let length = size.bit_len();
    let shift = if length < P - 1074 + 53 { P - 1074 } else { length - 53 };
    let kept = &size >> shift;
    let q = u64::try_from(&kept).expect("53 bits");
    let is_exact = (kept << shift) == size;
    let k = shift as i32 - P as i32;
    let double = |q: u64, too_large: f64| {
        let power = |p: i32| f64::from_bits(((1023 + p) as u64) << 52);
        if k == -1074 {
            f64::from_bits(q)
        } else if k > 971 || (k == 971 && q == 1 << 53) {
            too_large
        } else {
            q as f64 * power(k / 2) * power(k - k / 2)
        }
    };
    let (near, far) = (double(q, f64::MAX), double(q + u64::from(!is_exact), f64::INFINITY));
    if negative { [-far, -near] } else { [near, far] }
}

/// Σ over a Taylor series: `term_{n+1} = term_n · x / d(n)`, until the terms vanish.
fn series(first: Fixed, factor: &Fixed, divisor: impl Fn(u32) -> u32) -> Fixed {
    let (mut term, mut sum, mut n) = (first.clone(), first, 1);
    while term != IBig::from(0) && term != IBig::from(-1) {
        term = mul(&term, factor) / IBig::from(divisor(n));
        sum += &term;
        n += 1;
    }
    sum
}

/// π by Machin's formula, 16 atan(1/5) − 4 atan(1/239), in units of 1/`one`.
fn machin(one: &IBig) -> IBig {
    let inverse = |k: u32| {
        let (mut power, mut sum, mut n) = (one / IBig::from(k), IBig::from(0), 1u32);
        while power != IBig::from(0) {
            let term = &power / IBig::from(n);
            if n % 4 == 1 {
                sum += term;
            } else {
                sum -= term;
            }
            power /= IBig::from(k * k);
            n += 2;
        }
        sum
    };
    inverse(5) * IBig::from(16) - inverse(239) * IBig::from(4)
}

pub(crate) fn pi() -> &'static Fixed {
    static PI: OnceLock<Fixed> = OnceLock::new();
    PI.get_or_init(|| machin(&one()))
}

/// π/2 with 1400 places more, for arguments up to the largest double.
fn long_half_pi() -> &'static Fixed {
    static HALF_PI: OnceLock<Fixed> = OnceLock::new();
    HALF_PI.get_or_init(|| machin(&(IBig::from(1) << (2 * P))) >> 1usize)
}

pub(crate) fn ln_2() -> &'static Fixed {
    static LN_2: OnceLock<Fixed> = OnceLock::new();
    LN_2.get_or_init(|| atanh_series(&(one() / IBig::from(3))) * IBig::from(2))
}

/// Σ x·squareⁿ/(2n + 1), n from 0 on: atanh x for the square of x, atan x for its negative.
fn odd_series(x: &Fixed, square: &Fixed) -> Fixed {
    let (mut power, mut sum, mut n) = (x.clone(), IBig::from(0), 1u32);
    while power != IBig::from(0) && power != IBig::from(-1) {
        sum += &power / IBig::from(n);
        power = mul(&power, square);
        n += 2;
    }
    sum
}

fn atanh_series(s: &Fixed) -> Fixed {
    odd_series(s, &mul(s, s))
}

pub(crate) fn exp(x: &Fixed) -> Fixed {
    let k = floor_div(x, ln_2());
    let r = (x - ln_2() * &k) >> 16usize;
    let mut value = series(one(), &r, |n| n);
    for _ in 0..16 {
        value = mul(&value, &value);
    }
    let k = i64::try_from(k).expect("moderate");
    if k >= 0 { value << k as usize } else { value >> (-k) as usize }
}

pub(crate) fn ln(x: &Fixed) -> Fixed {
    let size: UBig = x.clone().try_into().expect("positive");
    let e = size.bit_len() as i64 - P as i64;
    let m = if e >= 0 { x >> e as usize } else { x << (-e) as usize };
    // ½ ≤ m < 1; three square roots bring it near 1.
    let root = sqrt(&sqrt(&sqrt(&m)));
    let s = div(&(&root - one()), &(&root + one()));
    atanh_series(&s) * IBig::from(16) + ln_2() * IBig::from(e)
}

fn floor_div(a: &Fixed, b: &Fixed) -> IBig {
    let q = a / b;
    if &q * b > *a { q - IBig::from(1) } else { q }
}

/// (⌊x/(π/2)⌋, rest).
pub(crate) fn quadrant(x: &Fixed) -> (IBig, Fixed) {
    let wide = x << P;
    let k = floor_div(&wide, long_half_pi());
    let rest = wide - long_half_pi() * &k;
    (k, rest >> P)
}

/// Sine and cosine.
///
/// # Panics
/// Never: a quadrant is 0, 1, 2 or 3.
pub fn sin_cos(x: &Fixed) -> (Fixed, Fixed) {
    let (k, r) = quadrant(x);
    let square = -mul(&r, &r);
    let s = series(r, &square, |n| 2 * n * (2 * n + 1));
    let c = series(one(), &square, |n| 2 * n * (2 * n - 1));
    let residue: i64 = i64::try_from(((&k % IBig::from(4)) + IBig::from(4)) % IBig::from(4)).expect("0..4");
    match residue {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

pub(crate) fn atan(x: &Fixed) -> Fixed {
    let mut t = x.clone();
    // atan t = 2 atan(t/(1 + √(1 + t²)))
    for _ in 0..10 {
        let root = sqrt(&(one() + mul(&t, &t)));
        t = div(&t, &(root + one()));
    }
    odd_series(&t, &-mul(&t, &t)) * IBig::from(1024)
}

/// Angle of (x, y) ≠ (0, 0).
pub(crate) fn atan2(y: &Fixed, x: &Fixed) -> Fixed {
    let zero = IBig::from(0);
    let (a, b): (Fixed, Fixed) = (x.clone().abs(), y.clone().abs());
    let first = if a >= b { atan(&div(&b, &a)) } else { (pi() >> 1usize) - atan(&div(&a, &b)) };
    let upper = if *x < zero { pi() - first } else { first };
    if *y < zero { -upper } else { upper }
}
