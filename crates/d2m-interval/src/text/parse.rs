//! Text to interval, by the grammar of IEEE 1788: the result is the narrowest interval that holds what is written.
use core::{cmp::Ordering, str::FromStr};

use super::big::Big;
use crate::{Interval, ParseIntervalError};

/// A real number, exactly: `±numerator·10^decimal·2^binary/denominator`.
#[derive(Clone)]
struct Number {
    negative: bool,
    numerator: Big,
    denominator: Big,
    decimal: i32,
    binary: i32,
}

/// An end point as written.
enum End {
    Number(Number),
    Infinite { negative: bool },
}

/// Exponents beyond are no different from this.
const HUGE_EXPONENT: i32 = 1_000_000;

fn syntax<T>() -> Result<T, ParseIntervalError> {
    Err(ParseIntervalError::Syntax)
}

fn exponent(text: &str) -> Result<i32, ParseIntervalError> {
    let (negative, digits) = sign(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return syntax();
    }
    let size = digits.bytes().fold(0i32, |n, b| (n * 10 + i32::from(b - b'0')).min(HUGE_EXPONENT));
    Ok(if negative { -size } else { size })
}

fn sign(text: &str) -> (bool, &str) {
    match text.as_bytes().first() {
        Some(b'-') => (true, &text[1..]),
        Some(b'+') => (false, &text[1..]),
        _ => (false, text),
    }
}

/// Digits with at most one point: (digits as an integer, digits after the point).
fn mantissa(text: &str, base: u32) -> Result<(Big, i32), ParseIntervalError> {
    let (mut value, mut after, mut point, mut any) = (Big::default(), 0i32, false, false);
    for c in text.chars() {
        if c == '.' && !point {
            point = true;
        } else if let Some(digit) = c.to_digit(base) {
            value.push_digit(base, digit);
            after += i32::from(point);
            any = true;
        } else {
            return syntax();
        }
    }
    if any { Ok((value, after)) } else { syntax() }
}

fn end(text: &str) -> Result<End, ParseIntervalError> {
    let (negative, size) = sign(text);
    if size == "inf" || size == "infinity" {
        return Ok(End::Infinite { negative });
    }
    number(text).map(End::Number)
}

/// A decimal, hexadecimal or rational literal (in lower case).
fn number(text: &str) -> Result<Number, ParseIntervalError> {
    let (negative, size) = sign(text);
    let one = Big::from_u64(1);
    let mut result = Number { negative, numerator: Big::default(), denominator: one, decimal: 0, binary: 0 };
    if let Some((p, q)) = size.split_once('/') {
        let (q, after) = mantissa(q, 10)?;
        let (p, before) = mantissa(p, 10)?;
        if after != 0 || before != 0 || q.is_zero() {
            return syntax();
        }
        (result.numerator, result.denominator) = (p, q);
    } else if let Some(hexadecimal) = size.strip_prefix("0x") {
        let (digits, power) = hexadecimal.split_once('p').unwrap_or((hexadecimal, "0"));
        let (value, after) = mantissa(digits, 16)?;
        (result.numerator, result.binary) = (value, exponent(power)?.saturating_sub(after.saturating_mul(4)));
    } else {
        let (digits, power) = size.split_once('e').unwrap_or((size, "0"));
        let (value, after) = mantissa(digits, 10)?;
        (result.numerator, result.decimal) = (value, exponent(power)?.saturating_sub(after));
    }
    Ok(result)
}

/// `|x|` compared with a double `y ≥ 0`, both over the same denominator.
fn compare(y: f64, numerator: &Big, denominator: &Big) -> Ordering {
    let field = (y.to_bits() >> 52) as i32;
    let bits = y.to_bits() & ((1 << 52) - 1);
    let (m, q) = if field == 0 { (bits, -1074) } else { (bits | 1 << 52, field - 1075) };
    let scaled = Big::from_u64(m).times(denominator);
    if q >= 0 { scaled.shifted(q as u32).cmp(numerator) } else { scaled.cmp(&numerator.shifted(-q as u32)) }
}

impl Number {
    /// The doubles around the number, equal when it is one.
    fn enclose(&self) -> (f64, f64) {
        let (lo, hi) = self.enclose_size();
        if self.negative { (-hi, -lo) } else { (lo, hi) }
    }

    fn enclose_size(&self) -> (f64, f64) {
        if self.numerator.is_zero() {
            return (0.0, 0.0);
        }
        // log₂ of the size, roughly: settle what is out of range without large powers.
        let log = (self.numerator.bits() - self.denominator.bits()) as f64
            + f64::from(self.decimal) * core::f64::consts::LOG2_10
            + f64::from(self.binary);
        if log > 1100.0 {
            return (f64::MAX, f64::INFINITY);
        }
        if log < -1200.0 {
            return (0.0, 5e-324);
        }
        let ten = |k: i32| k.max(0).unsigned_abs();
        let numerator = self.numerator.clone().times_power(10, ten(self.decimal)).shifted(ten(self.binary));
        let denominator =
            self.denominator.clone().times_power(10, ten(-self.decimal)).shifted(ten(-self.binary));
        // A first guess from 64 digits of each, then single steps, judged exactly.
        let ratio = numerator.leading() as f64 / denominator.leading() as f64;
        let exponent =
            (numerator.bits() - numerator.bits().min(64)) - (denominator.bits() - denominator.bits().min(64));
        let mut y = ratio;
        for _ in 0..exponent.unsigned_abs() {
            y *= if exponent > 0 { 2.0 } else { 0.5 };
        }
        if y > f64::MAX {
            y = f64::MAX;
        }
        while compare(y, &numerator, &denominator) == Ordering::Greater {
            y = y.next_down();
        }
        loop {
            match compare(y, &numerator, &denominator) {
                Ordering::Equal => return (y, y),
                _ if y == f64::MAX => return (y, f64::INFINITY),
                _ => {}
            }
            let next = y.next_up();
            if compare(next, &numerator, &denominator) == Ordering::Greater {
                return (y, next);
            }
            y = next;
        }
    }

    /// Sum with `steps/2` units of the last digit.
    fn moved(&self, steps: &Big, negative: bool) -> Self {
        let two = Big::from_u64(2);
        let twice = self.numerator.times(&two);
        let (numerator, sign) = if self.negative == negative {
            (twice.plus(steps), negative)
        } else if twice >= *steps {
            (twice.minus(steps), self.negative)
        } else {
            (steps.minus(&twice), negative)
        };
        Self { negative: sign, numerator, denominator: two, decimal: self.decimal, binary: 0 }
    }
}

/// `m ? r [u|d] [e exponent]`: the decimal m, give or take r units of its last digit (half a unit without r, any
/// amount with a second question mark), upwards or downwards only with `u` or `d`.
fn uncertain(centre: &str, rest: &str) -> Result<Interval, ParseIntervalError> {
    let (rest, power) = match rest.split_once('e') {
        Some((rest, power)) => (rest, exponent(power)?),
        None => (rest, 0),
    };
    let (rest, direction) = match rest.as_bytes().last() {
        Some(b'u') => (&rest[..rest.len() - 1], Some(false)),
        Some(b'd') => (&rest[..rest.len() - 1], Some(true)),
        _ => (rest, None),
    };
    if centre.contains(['e', 'x', 'p', '/']) {
        return syntax();
    }
    let mut centre = number(centre)?;
    centre.decimal = centre.decimal.saturating_add(power);
    let (mut lo, mut hi) = centre.enclose();
    if rest == "?" {
        lo = f64::NEG_INFINITY;
        hi = f64::INFINITY;
        match direction {
            Some(false) => lo = centre.enclose().0,
            Some(true) => hi = centre.enclose().1,
            None => {}
        }
        return Ok(Interval::raw(lo, hi));
    }
    let steps = if rest.is_empty() {
        Big::from_u64(1)
    } else {
        if !rest.bytes().all(|b| b.is_ascii_digit()) {
            return syntax();
        }
        mantissa(rest, 10)?.0.times(&Big::from_u64(2))
    };
    if direction != Some(false) {
        lo = centre.moved(&steps, true).enclose().0;
    }
    if direction != Some(true) {
        hi = centre.moved(&steps, false).enclose().1;
    }
    Ok(Interval::raw(lo, hi))
}

/// Compares two numbers exactly, where rounding might hide that they are in the wrong order.
fn greater(a: &Number, b: &Number) -> bool {
    if a.negative != b.negative {
        return b.negative && !(a.numerator.is_zero() && b.numerator.is_zero());
    }
    let apart = |x: &Number| x.decimal.abs().max(x.binary.abs()) > 5000;
    if apart(a) || apart(b) {
        return a.enclose().0 > b.enclose().1;
    }
    // a.n·10^i·2^j·b.d against b.n·10^k·2^l·a.d, with all exponents made non-negative.
    let (ten, two) = (a.decimal.min(b.decimal), a.binary.min(b.binary));
    let side = |x: &Number, other: &Number| {
        x.numerator
            .clone()
            .times_power(10, (x.decimal - ten).unsigned_abs())
            .shifted((x.binary - two).unsigned_abs())
            .times(&other.denominator)
    };
    let order = side(a, b).cmp(&side(b, a));
    if a.negative { order == Ordering::Less } else { order == Ordering::Greater }
}

impl FromStr for Interval {
    type Err = ParseIntervalError;

    /// Reads the forms of IEEE 1788, upper or lower case, and bare numbers:
    /// `[0.1, 2/3]`, `[0x1.8p-3]`, `[-inf, 5]`, `[,5]`, `[entire]`, `[empty]`, `3.14?2` (give or take two units of
    /// the last digit), `0.1`. The result holds every number that is written, however many digits it has.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let x: Interval = "0.1".parse()?;
    /// assert!(x.lo() < 0.1 + 1e-18 && x.lo() < x.hi()); // 0.1 is not a double: its two neighbours
    /// assert_eq!("[1, 1.5]".parse::<Interval>()?, Interval::new(1.0, 1.5)); // these are doubles
    /// assert!("[2, 1]".parse::<Interval>().is_err());
    /// # Ok::<(), d2m_interval::ParseIntervalError>(())
    /// ```
    fn from_str(text: &str) -> Result<Self, ParseIntervalError> {
        let text = text.trim().to_ascii_lowercase();
        let Some(inner) = text.strip_prefix('[') else {
            if let Some((centre, rest)) = text.split_once('?') {
                return uncertain(centre, rest);
            }
            let (lo, hi) = number(&text)?.enclose();
            return Ok(Self::raw(lo, hi));
        };
        let Some(inner) = inner.strip_suffix(']') else { return syntax() };
        match inner.trim() {
            "" | "empty" => return Ok(Self::EMPTY),
            "entire" => return Ok(Self::ENTIRE),
            _ => {}
        }
        let Some((first, second)) = inner.split_once(',') else {
            return match end(inner.trim())? {
                End::Number(x) => {
                    let (lo, hi) = x.enclose();
                    Ok(Self::raw(lo, hi))
                }
                End::Infinite { .. } => Err(ParseIntervalError::Order),
            };
        };
        let side = |text: &str, negative: bool| match text.trim() {
            "" => Ok(End::Infinite { negative }),
            text => end(text),
        };
        match (side(first, true)?, side(second, false)?) {
            (End::Infinite { negative: false }, _) | (_, End::Infinite { negative: true }) => {
                Err(ParseIntervalError::Order)
            }
            (End::Infinite { .. }, End::Infinite { .. }) => Ok(Self::ENTIRE),
            (End::Infinite { .. }, End::Number(hi)) => Ok(Self::raw(f64::NEG_INFINITY, hi.enclose().1)),
            (End::Number(lo), End::Infinite { .. }) => Ok(Self::raw(lo.enclose().0, f64::INFINITY)),
            (End::Number(lo), End::Number(hi)) => {
                if greater(&lo, &hi) {
                    return Err(ParseIntervalError::Order);
                }
                Ok(Self::raw(lo.enclose().0, hi.enclose().1))
            }
        }
    }
}
