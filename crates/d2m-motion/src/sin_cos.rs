//! The project's own sine and cosine of a double, for frames: the same bits on every platform, a counted error.
//!
//! Three-part Cody–Waite reduction by π/2 and polynomials of its own (Chebyshev interpolants; the remainder carried as a
//! pair). |computed − true| ≤ 2·2⁻⁵³ for each of both, |x| ≤ 8e5, and in double-double up to 1e9; docs/theory/features.md has the count.
use crate::double_double_trig::sin_cos_double;
use d2m_lanes::{DoubleDouble, F64x2};

const PIO2_1: f64 = 1.570_796_326_734_125_614_17; // first 33 bits of π/2
const PIO2_2: f64 = 6.077_100_506_303_965_98e-11; // second 33 bits
const PIO2_2T: f64 = 2.022_266_248_795_950_63e-21; // π/2 − PIO2_1 − PIO2_2
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²: adding it rounds to an integer

/// The largest argument that the three parts of π/2 reduce.
const FEW_TURNS: f64 = 8e5;
/// The largest argument with a promised error; from [`FEW_TURNS`] on in double-double, some fifty times slower.
pub(crate) const LARGEST_ANGLE: f64 = 1e9;

/// (sin x, cos x), each within 2·2⁻⁵³ absolutely for |x| ≤ [`LARGEST_ANGLE`]; NaN beyond it.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= core::f64::consts::FRAC_PI_4 {
        return (kernel_sin(x, 0.0), kernel_cos(x, 0.0));
    }
    // Also NaN goes this way: a caller must get NaN, never a plausible number.
    if x.is_nan() || x.abs() > LARGEST_ANGLE {
        return (f64::NAN, f64::NAN);
    }
    if x.abs() > FEW_TURNS {
        let (sin, cos) = sin_cos_double(DoubleDouble::from_f64(x));
        return (sin.hi, cos.hi);
    }
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUND;
    let n = shifted - ROUND;
    // n·PIO2_1 and n·PIO2_2 are exact (33 + 20 bits).
    let r = x - n * PIO2_1;
    let t = n * PIO2_2;
    let first = r - t;
    // What the second subtraction lost, plus the third part.
    let lost = n * PIO2_2T - ((r - first) - t);
    let high = first - lost;
    let low = (first - high) - lost;
    let (sin, cos) = (kernel_sin(high, low), kernel_cos(high, low));
    match shifted.to_bits() & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// [`sin_cos`] of two angles, side by side: the same numbers.
///
/// A small angle needs no reduction, and gets none: n = 0 leaves it as it is.
#[inline(always)]
pub(crate) fn sin_cos_two(x: F64x2) -> (F64x2, F64x2) {
    let [x0, x1] = x.to_array();
    let few = x0.abs() <= FEW_TURNS && x1.abs() <= FEW_TURNS;
    // Also NaN goes this way.
    if !few {
        let ((s0, c0), (s1, c1)) = (sin_cos(x0), sin_cos(x1));
        return (F64x2::pack(s0, s1), F64x2::pack(c0, c1));
    }
    let (round, one, half) = (F64x2::splat(ROUND), F64x2::splat(1.0), F64x2::splat(0.5));
    let turns = x * F64x2::splat(core::f64::consts::FRAC_2_PI);
    let shifted = turns + round;
    let n = shifted - round;
    let r = x - n * F64x2::splat(PIO2_1);
    let t = n * F64x2::splat(PIO2_2);
    let first = r - t;
    let lost = n * F64x2::splat(PIO2_2T) - (r - first - t);
    let high = first - lost;
    let low = first - high - lost;
    // The kernels below, term by term.
    let z = high * high;
    let half_z = half * z;
    let w = one - half_z;
    let r = polynomial(&SIN, z);
    let cubic = high * z * (z * r - F64x2::splat(1.0 / 6.0));
    let sin = high + (low * w + cubic);
    let r = polynomial(&COS, z);
    let tail = z * z * r - high * low;
    let cos = w + (one - w - half_z + tail);
    // n mod 4: (s, c), (c, −s), (−s, −c), (−c, s). The second bit of n is the first of ⌊n/2⌋.
    let odd = shifted.lowest_bit();
    let upper = (n * half - F64x2::splat(0.25) + round).lowest_bit();
    let minus = F64x2::splat(-0.0);
    (odd.select(cos, sin).xor(upper.and(minus)), odd.select(sin, cos).xor(upper.xor(odd).and(minus)))
}

#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], z: F64x2) -> F64x2 {
    let mut sum = F64x2::splat(coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = F64x2::splat(coefficient) + z * sum;
    }
    sum
}

/// Coefficients of S and C below, lowest first.
const SIN: [f64; 5] = [
    0.008_333_333_333_330_948,
    -0.000_198_412_698_367_585_74,
    2.755_731_610_255_243e-6,
    -2.505_113_184_500_181e-8,
    1.591_812_929_473_593e-10,
];
const COS: [f64; 6] = [
    0.041_666_666_666_666_664,
    -0.001_388_888_888_888_739_8,
    2.480_158_729_876_569e-5,
    -2.755_731_727_172_979e-7,
    2.087_614_626_840_206e-9,
    -1.138_263_242_543_996_5e-11,
];

/// sin(x + y), |x| ≤ π/4 (1 + 2⁻³⁰), |y| ≤ ulp(x): x + x³·S(x²), S the Chebyshev interpolant of degree 5.
#[inline(always)]
fn kernel_sin(x: f64, y: f64) -> f64 {
    let z = x * x;
    let r = SIN[0] + z * (SIN[1] + z * (SIN[2] + z * (SIN[3] + z * SIN[4])));
    // sin(x + y) = x + (y·cos x + x³·(−1/6 + z·r)), with cos x = 1 − z/2 up to what |y| leaves of it.
    x + (y * (1.0 - 0.5 * z) + x * z * (z * r - 1.0 / 6.0))
}

/// cos(x + y), |x| ≤ π/4 (1 + 2⁻³⁰), |y| ≤ ulp(x): 1 − x²/2 + x⁴·C(x²), C the Chebyshev interpolant of degree 5.
#[inline(always)]
fn kernel_cos(x: f64, y: f64) -> f64 {
    let z = x * x;
    let r = COS[0] + z * (COS[1] + z * (COS[2] + z * (COS[3] + z * (COS[4] + z * COS[5]))));
    let half = 0.5 * z;
    let w = 1.0 - half;
    // w + ((1 − w) − half) is 1 − half exactly; −x·y is the pair's second part.
    w + (((1.0 - w) - half) + (z * z * r - x * y))
}
