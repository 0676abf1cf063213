//! Sums and products of two doubles as the rounded result and what the rounding left.

/// `a + b = s + e` exactly (Knuth's two-sum), barring overflow.
///
/// ```
/// assert_eq!(d2m_lanes::two_sum(1.0, 1e-20), (1.0, 1e-20));
/// ```
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let c = s - a;
    (s, (a - (s - c)) + (b - c))
}

/// `a + b = s + e` exactly when `|a| ≥ |b|` or `a = 0` (Dekker's fast two-sum).
///
/// ```
/// assert_eq!(d2m_lanes::fast_two_sum(1.0, 1e-20), (1.0, 1e-20));
/// ```
#[inline(always)]
pub fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `a·b = p + e` exactly (Veltkamp, Dekker) for `|a|, |b| ≤ 2⁹⁹⁵`, `|a·b| ≤ 2¹⁰²¹`, and, `e` being a
/// multiple of the product of the last places, when no part of it underflows (`|a·b| ≥ 2⁻⁹⁶⁰` suffices).
///
/// ```
/// let a = 1.0 + f64::EPSILON;
/// assert_eq!(d2m_lanes::two_product(a, a), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
/// ```
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let (a1, a0) = halves(a);
    let (b1, b0) = halves(b);
    let p = a * b;
    (p, ((a1 * b1 - p) + a1 * b0 + a0 * b1) + a0 * b0)
}

#[inline(always)]
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a; // 2²⁷ + 1
    let high = c - (c - a);
    (high, a - high)
}
