//! A real number as it is written, exactly, and the doubles around it.
//!
//! All of it is linear in the digits: decimal digits are words to the base 10⁹, a comparison with a double multiplies by a
//! power of ten (a shift of words) and by a power of two of at most 1100 bits.
use alloc::{format, vec::Vec};
use core::cmp::Ordering;

use super::Side;
use super::big::Big;
use crate::{Interval, ParseIntervalError};

/// `±numerator·10^decimal·2^binary/denominator`, exactly; or, if digits were cut off, above that in size, by less than
/// one unit of the numerator.
#[derive(Clone)]
pub(super) struct Number {
    negative: bool,
    numerator: Big,
    denominator: Big,
    pub(super) decimal: i64,
    binary: i64,
    cut_off: bool,
}

/// Exponents beyond are no different from this: a text has fewer digits to make up for it.
const HUGE_EXPONENT: i64 = 1_000_000_000_000_000;

/// Hexadecimal digits from the first that is not 0 that are kept. A double that is not below a number of 200 digits is at
/// least one unit of the last of them above it, or equal: it has 53 binary digits, of 800 from the same place on. So
/// what is cut off decides no comparison, but makes "equal" into "below". (16²⁰⁰ < 2¹⁰²⁴, too.)
const HEXADECIMAL_DIGITS: usize = 200;

/// Above 10³²⁰ every number lies between the largest double and infinity, below 10⁻³⁴⁰ between 0 and the smallest.
const LARGEST_MAGNITUDE: f64 = 320.0;
const SMALLEST_MAGNITUDE: f64 = -340.0;

/// [`Number::magnitude`] is right to 1 for each number and a little for its own rounding (below 1 for exponents up to
/// 10¹⁶): numbers that differ by more in it are in that order.
const CERTAIN_ORDER: f64 = 4.0;

/// Exact comparisons of two numbers between the same doubles are given up beyond this many products of words, or bits.
const MOST_PRODUCTS: usize = 10_000_000;
const MOST_BITS: u64 = 20_000;

fn syntax<T>() -> Result<T, ParseIntervalError> {
    Err(ParseIntervalError::Syntax)
}

/// The exponent behind an `e` or `p`.
pub(super) fn exponent(text: &str) -> Result<i64, ParseIntervalError> {
    let Signed { negative, size: digits } = sign(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return syntax();
    }
    let size = digits.bytes().fold(0i64, |n, b| (n * 10 + i64::from(b - b'0')).min(HUGE_EXPONENT));
    Ok(if negative { -size } else { size })
}

/// A text without its sign.
pub(super) struct Signed<'t> {
    pub(super) negative: bool,
    /// What follows the sign.
    pub(super) size: &'t str,
}

/// Takes the sign off.
pub(super) fn sign(text: &str) -> Signed<'_> {
    match text.as_bytes().first() {
        Some(b'-') => Signed { negative: true, size: &text[1..] },
        Some(b'+') => Signed { negative: false, size: &text[1..] },
        _ => Signed { negative: false, size: text },
    }
}

/// Digits with at most one point.
struct Mantissa {
    /// The digits as an integer.
    digits: Big,
    /// How many of them are behind the point (negative: how many are missing before it).
    after: i64,
    /// Digits that are not 0 are missing.
    cut_off: bool,
}

fn decimal_mantissa(text: &str) -> Result<Mantissa, ParseIntervalError> {
    let (before, after) = text.split_once('.').unwrap_or((text, ""));
    let mut digits = Vec::with_capacity(text.len());
    digits.extend_from_slice(before.as_bytes());
    digits.extend_from_slice(after.as_bytes());
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return syntax();
    }
    Ok(Mantissa { digits: Big::from_decimal(&digits), after: after.len() as i64, cut_off: false })
}

fn hexadecimal_mantissa(text: &str) -> Result<Mantissa, ParseIntervalError> {
    let mut result = Mantissa { digits: Big::default(), after: 0, cut_off: false };
    let (mut kept, mut any, mut point) = (0, false, false);
    for c in text.chars() {
        if c == '.' && !point {
            point = true;
            continue;
        }
        let Some(digit) = c.to_digit(16) else { return syntax() };
        any = true;
        if kept < HEXADECIMAL_DIGITS {
            result.digits.multiply_add(16, u64::from(digit));
            kept += usize::from(!result.digits.is_zero());
            result.after += i64::from(point);
        } else {
            result.cut_off |= digit != 0;
            result.after -= i64::from(!point);
        }
    }
    if any { Ok(result) } else { syntax() }
}

impl Number {
    /// Reads a decimal, hexadecimal or rational literal (in lower case).
    pub(super) fn read(text: &str) -> Result<Self, ParseIntervalError> {
        let Signed { negative, size } = sign(text);
        let (mut decimal, mut binary, mut denominator) = (0, 0, Big::from_u64(1));
        let mantissa = if let Some((p, q)) = size.split_once('/') {
            let (p, q) = (decimal_mantissa(p)?, decimal_mantissa(q)?);
            if size.contains('.') || q.digits.is_zero() {
                return syntax();
            }
            denominator = q.digits;
            p
        } else if let Some(hexadecimal) = size.strip_prefix("0x") {
            let (digits, power) = hexadecimal.split_once('p').unwrap_or((hexadecimal, "0"));
            let mantissa = hexadecimal_mantissa(digits)?;
            binary = exponent(power)? - 4 * mantissa.after;
            mantissa
        } else {
            let (digits, power) = size.split_once('e').unwrap_or((size, "0"));
            let mantissa = decimal_mantissa(digits)?;
            decimal = exponent(power)? - mantissa.after;
            mantissa
        };
        let Mantissa { digits: numerator, cut_off, .. } = mantissa;
        Ok(Self { negative, numerator, denominator, decimal, binary, cut_off })
    }

    /// The interval between the doubles around the number; a point when it is one.
    pub(super) fn enclose(&self) -> Interval {
        let size = self.enclose_size();
        if self.negative { -size } else { size }
    }

    /// log₁₀ of the size, to within 1 and the rounding of this sum; the number is not zero.
    fn magnitude(&self) -> f64 {
        let digits = self.numerator.digits() as i64 - self.denominator.digits() as i64;
        (digits + self.decimal) as f64 + self.binary as f64 * core::f64::consts::LOG10_2
    }

    fn enclose_size(&self) -> Interval {
        if self.numerator.is_zero() {
            return Interval::ZERO;
        }
        let magnitude = self.magnitude();
        if magnitude > LARGEST_MAGNITUDE {
            return Interval::raw(f64::MAX, f64::INFINITY);
        }
        if magnitude < SMALLEST_MAGNITUDE {
            return Interval::raw(0.0, f64::from_bits(1));
        }
        // A guess that is next to the number or next but one, then single steps, judged exactly.
        let mut y = self.guess();
        while self.compare(y) == Ordering::Greater {
            y = y.next_down();
        }
        loop {
            match self.compare(y) {
                Ordering::Equal => return Interval::point(y),
                _ if y == f64::MAX => return Interval::raw(y, f64::INFINITY),
                _ => {}
            }
            let next = y.next_up();
            if self.compare(next) == Ordering::Greater {
                return Interval::raw(y, next);
            }
            y = next;
        }
    }

    /// A double near the size, by the first 18 digits of numerator and denominator.
    fn guess(&self) -> f64 {
        let (n, d) = (self.numerator.leading(), self.denominator.leading());
        let quotient = u128::from(n) * 1_000_000_000_000_000_000 / u128::from(d);
        let digits = self.numerator.digits() as i64 - self.denominator.digits() as i64;
        // The library reads a short decimal correctly rounded.
        let mut y: f64 = format!("{quotient}e{}", digits + self.decimal - 18).parse().unwrap_or(f64::MAX);
        let mut binary = self.binary;
        while binary != 0 {
            let step = binary.clamp(-1000, 1000);
            y *= d2m_lanes::power_of_two(step as i32);
            binary -= step;
        }
        if y > f64::MAX { f64::MAX } else { y }
    }

    /// A double `y ≥ 0` compared with the size of the number.
    fn compare(&self, y: f64) -> Ordering {
        let field = (y.to_bits() >> 52) as i64;
        let bits = y.to_bits() & ((1 << 52) - 1);
        let (mantissa, exponent) = if field == 0 { (bits, -1074) } else { (bits | 1 << 52, field - 1075) };
        let twos = exponent - self.binary;
        let power = |x: i64| usize::try_from(x).unwrap_or(0);
        let left = &self.denominator * &Big::from_u64(mantissa);
        let left = left.times_power_of_two(power(twos)).times_power_of_ten(power(-self.decimal));
        let right = self.numerator.clone().times_power_of_two(power(-twos));
        let right = right.times_power_of_ten(power(self.decimal));
        // What was cut off is above an equal double.
        left.cmp(&right).then(if self.cut_off { Ordering::Less } else { Ordering::Equal })
    }

    /// So many halves of a unit of the last digit to this side.
    pub(super) fn moved(&self, steps: &Big, side: Side) -> Self {
        let negative = side == Side::Lower;
        let twice = &self.numerator + &self.numerator;
        let (numerator, sign) = if self.negative == negative {
            (&twice + steps, negative)
        } else if twice >= *steps {
            (&twice - steps, self.negative)
        } else {
            (steps - &twice, negative)
        };
        Self { negative: sign, numerator, denominator: Big::from_u64(2), ..self.clone() }
    }

    /// Whether this is certainly greater than `o`: exact, where rounding might hide that they are in the wrong order.
    ///
    /// Two numbers between the same doubles are not ordered where only digits that were cut off differ, or where it
    /// takes more than [`MOST_PRODUCTS`] or [`MOST_BITS`].
    pub(super) fn is_greater(&self, o: &Self) -> bool {
        match (self.negative, o.negative) {
            (true, false) => false,
            (false, true) => !(self.numerator.is_zero() && o.numerator.is_zero()),
            (false, false) => self.compare_sizes(o) == Some(Ordering::Greater),
            (true, true) => self.compare_sizes(o) == Some(Ordering::Less),
        }
    }

    fn compare_sizes(&self, o: &Self) -> Option<Ordering> {
        let (mine, other) = (self.enclose_size(), o.enclose_size());
        if mine != other || mine.lo() == mine.hi() {
            // A number that is no double lies strictly between its two: other doubles, other order.
            let lower = mine.lo().partial_cmp(&other.lo())?;
            return Some(lower.then(mine.hi().partial_cmp(&other.hi())?));
        }
        // Neither is zero.
        let apart = self.magnitude() - o.magnitude();
        if apart.abs() > CERTAIN_ORDER {
            return apart.partial_cmp(&0.0);
        }
        let products = (self.numerator.words() * o.denominator.words())
            .max(o.numerator.words() * self.denominator.words());
        if self.cut_off || o.cut_off || products > MOST_PRODUCTS || self.binary.abs_diff(o.binary) > MOST_BITS
        {
            return None;
        }
        // a.n·10^i·2^j·b.d against b.n·10^k·2^l·a.d, with all exponents made non-negative.
        let (ten, two) = (self.decimal.min(o.decimal), self.binary.min(o.binary));
        let side = |x: &Self, other: &Self| {
            (&x.numerator * &other.denominator)
                .times_power_of_ten((x.decimal - ten) as usize)
                .times_power_of_two((x.binary - two) as usize)
        };
        Some(side(self, o).cmp(&side(o, self)))
    }
}
