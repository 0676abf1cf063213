//! The first zero of a quadratic, bounded from below over the whole range of doubles.
//!
//! ```text
//! q(x) = gap + slope·x + ½ curvature·x²,  gap > 0,   Δ = slope² − 2 gap·curvature
//! falling (slope < 0)                    σ = 2 gap/(√Δ − slope)          Δ < 0: q > 0 for good
//! rising, bent down (curvature < 0)      σ = (slope + √Δ)/(−curvature)
//! else                                   q > 0 for good
//! ```
//! The proof of the constants is in `docs/theory/isolator.md`, section 1.
use d2m_lanes::{Binary, UNIT, power_of_two, scaled};

/// Added to the discriminant, in parts of slope² + |2 gap·curvature|. Needed are 7: two products and their difference
/// (2), the gap's own relative error (4), and this addition (1).
const DISCRIMINANT: f64 = 8.0 * UNIT;

/// Makes a computed zero early. Needed are 8 units: root, sum, quotient (4 with the product's half), the gap's own error
/// (at most 4), less what the inflated discriminant leaves; the rest makes the bound strict.
const EARLY: f64 = 1.0 - 16.0 * UNIT;

/// 2⁻⁹⁰⁰: beyond it, what underflows in a discriminant (2⁻¹⁰⁷⁵ a product) is below 2⁻¹⁷⁰ of it.
const LEAST_DISCRIMINANT: f64 = power_of_two(-900);
/// 2⁻¹⁰⁰⁰: above it, `EARLY` times a zero is not subnormal, and the discriminant of a falling start has not overflowed: an
/// infinite one makes the zero 0 or not a number. (That of a rising start makes it infinite.)
const LEAST_ZERO: f64 = power_of_two(-1000);
/// Coefficients below 2⁻⁹⁰⁰ times the largest are lowered to −2⁻⁹⁰⁰ times it: a smaller coefficient is an earlier zero.
const NEGLIGIBLE: i32 = -900;

/// A gap between them, with a discriminant beyond `LEAST_DISCRIMINANT`, has no zero above 2⁸⁵¹.
pub(super) const USUAL_GAPS: (f64, f64) = (power_of_two(-400), power_of_two(400));

/// See [`Quadratic::bound_first_zero`](super::Quadratic::bound_first_zero); for a positive gap, and coefficients that have
/// not overflowed. A zero beyond 2¹⁰²³ may come out as infinite.
#[inline(always)]
pub(super) fn bound_first_zero(gap: f64, slope: f64, curvature: f64) -> f64 {
    let square = slope * slope;
    let product = 2.0 * gap * curvature;
    // Whatever is not a number, too small or too large for the comparisons is bounded with other exponents.
    if slope < 0.0 {
        // Its terms may cancel: inflated by more than its error.
        let discriminant = (square - product) + DISCRIMINANT * (square + product.abs());
        if discriminant > LEAST_DISCRIMINANT {
            let zero = 2.0 * gap / (discriminant.sqrt() - slope);
            if zero > LEAST_ZERO {
                return zero * EARLY;
            }
        } else if discriminant < -LEAST_DISCRIMINANT {
            return f64::INFINITY;
        }
    } else if curvature < 0.0 {
        let discriminant = square - product;
        let zero = (discriminant.sqrt() + slope) / -curvature;
        if discriminant > LEAST_DISCRIMINANT && zero > LEAST_ZERO && zero < f64::INFINITY {
            return zero * EARLY;
        }
    } else if slope >= 0.0 && curvature >= 0.0 {
        return f64::INFINITY;
    }
    bound_scaled(gap, slope, curvature)
}

/// The first zero by the formulas above, for a discriminant that is not negative.
#[inline(always)]
fn zero_of(gap: f64, slope: f64, curvature: f64, discriminant: f64) -> f64 {
    if slope < 0.0 {
        2.0 * gap / (discriminant.sqrt() - slope)
    } else {
        (discriminant.sqrt() + slope) / -curvature
    }
}

/// The same with the gap in [1, 2) and the larger of slope and curvature just below 1, by powers of two.
#[cold]
#[inline(never)]
pub(super) fn bound_scaled(gap: f64, slope: f64, curvature: f64) -> f64 {
    // Not finite: nothing is known.
    if !(gap > 0.0 && gap < f64::INFINITY && slope.is_finite() && curvature.is_finite()) {
        return 0.0;
    }
    let Binary { mantissa: gap, exponent: value_exponent } = Binary::from_f64(gap);
    let Binary { mantissa: b, exponent: slope_exponent } = Binary::from_f64(slope);
    let Binary { mantissa: k, exponent: curvature_exponent } = Binary::from_f64(curvature);
    // x = 2ᵗ·y: slope and curvature become b·2^(its exponent + t − e), k·2^(its exponent + 2t − e).
    let by_slope = value_exponent - slope_exponent;
    let by_curvature = (value_exponent - curvature_exponent).div_euclid(2);
    if slope >= 0.0 && curvature >= 0.0 {
        return f64::INFINITY;
    }
    let time_exponent = match (b == 0.0, k == 0.0) {
        (true, true) => return f64::INFINITY,
        (true, false) => by_curvature,
        (false, true) => by_slope,
        (false, false) => by_slope.min(by_curvature),
    };
    let coefficient = |mantissa: f64, exponent: i32| {
        if mantissa == 0.0 {
            0.0
        } else if exponent < NEGLIGIBLE {
            -power_of_two(NEGLIGIBLE)
        } else {
            mantissa * power_of_two(exponent)
        }
    };
    let bent_by = curvature_exponent + 2 * time_exponent - value_exponent;
    if slope > 0.0 && bent_by < NEGLIGIBLE {
        // Rising for long: the gap no longer matters, and leaving it out is early.
        return scaled_down(2.0 * b / -k * EARLY, slope_exponent - curvature_exponent);
    }
    let slope = coefficient(b, slope_exponent + time_exponent - value_exponent);
    let curvature = coefficient(k, bent_by);
    if slope >= 0.0 && curvature >= 0.0 {
        return f64::INFINITY;
    }
    let (square, product) = (slope * slope, 2.0 * gap * curvature);
    let inflation = if slope < 0.0 { DISCRIMINANT * (square + product.abs()) } else { 0.0 };
    let discriminant = (square - product) + inflation;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    scaled_down(zero_of(gap, slope, curvature, discriminant) * EARLY, time_exponent)
}

/// A double below `x·2ⁿ` when that is subnormal, else that; at most the largest double, at least 0.
fn scaled_down(x: f64, n: i32) -> f64 {
    let x = scaled(x, n);
    if x > f64::MAX {
        f64::MAX
    } else if x >= 2.0 * f64::MIN_POSITIVE {
        x
    } else if x > 0.0 {
        x.next_down()
    } else {
        0.0
    }
}
