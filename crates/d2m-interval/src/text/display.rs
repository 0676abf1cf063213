//! Interval to text. Decimal forms are rounded outwards: what is printed holds the interval.
use core::fmt::{self, Write};

use super::Side;
use crate::Interval;

/// All decimal digits of a double (767 at most) and the exponent, as `{:.766e}` prints them.
struct Digits {
    bytes: [u8; 800],
    length: usize,
}

impl Write for Digits {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length + text.len();
        self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

/// Digits of one end after rounding: `0.d₁d₂… · 10^point`.
struct Rounded {
    digits: [u8; 800],
    count: usize,
    point: i32,
}

/// Where digits that do not fit round to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Towards {
    Zero,
    Infinity,
}

/// Decimal digits of `size ≥ 0`; `keep` counts digits from the first one on, given the exponent of that digit.
fn rounded(size: f64, towards: Towards, keep: impl Fn(i32) -> i32) -> Result<Rounded, fmt::Error> {
    let mut text = Digits { bytes: [0; 800], length: 0 };
    write!(text, "{size:.766e}")?;
    let text = core::str::from_utf8(&text.bytes[..text.length]).map_err(|_| fmt::Error)?;
    let (mantissa, exponent) = text.split_once('e').ok_or(fmt::Error)?;
    let exponent: i32 = exponent.parse().map_err(|_| fmt::Error)?;
    let mut result = Rounded { digits: [0; 800], count: 0, point: exponent + 1 };
    if size == 0.0 {
        return Ok(result);
    }
    let keep = keep(exponent);
    if keep <= 0 {
        // Not even the first digit: zero, or one unit of the last place that is printed.
        if towards == Towards::Infinity {
            result.digits[0] = 1;
            result.count = 1;
            result.point = exponent + 2 - keep;
        }
        return Ok(result);
    }
    let mut lost = false;
    for digit in mantissa.bytes().filter(u8::is_ascii_digit) {
        if (result.count as i32) < keep {
            result.digits[result.count] = digit - b'0';
            result.count += 1;
        } else {
            lost |= digit != b'0';
        }
    }
    if lost && towards == Towards::Infinity {
        let mut i = result.count;
        loop {
            if i == 0 {
                // 99…9 became 100…0.
                result.digits[0] = 1;
                result.point += 1;
                break;
            }
            i -= 1;
            if result.digits[i] < 9 {
                result.digits[i] += 1;
                break;
            }
            result.digits[i] = 0;
        }
    }
    while result.count > 0 && result.digits[result.count - 1] == 0 {
        result.count -= 1;
    }
    Ok(result)
}

fn digit(r: &Rounded, i: i32) -> char {
    let value = usize::try_from(i).ok().filter(|&i| i < r.count).map_or(0, |i| r.digits[i]);
    char::from(b'0' + value)
}

/// Writes one end, rounded outwards.
fn write_end(f: &mut fmt::Formatter<'_>, x: f64, side: Side) -> fmt::Result {
    if x.is_infinite() {
        return f.write_str(if x > 0.0 { "inf" } else { "-inf" });
    }
    let towards = match (side, x > 0.0) {
        (Side::Upper, true) | (Side::Lower, false) => Towards::Infinity,
        (Side::Upper, false) | (Side::Lower, true) => Towards::Zero,
    };
    let precision = f.precision().map(|p| i32::try_from(p).unwrap_or(i32::MAX / 2));
    let r = match precision {
        Some(p) => rounded(x.abs(), towards, |exponent| (exponent + 1).saturating_add(p))?,
        None => rounded(x.abs(), towards, |_| 17)?,
    };
    if x < 0.0 && r.count > 0 {
        f.write_char('-')?;
    }
    let plain = precision.is_some() || (r.point > -5 && r.point < 18);
    let (first, last) = if plain { (r.point.max(1), r.count as i32) } else { (1, r.count as i32) };
    if plain {
        // Digits before the point, from place `r.point − first`.
        for i in 0..first {
            f.write_char(digit(&r, r.point - first + i))?;
        }
        let after = precision.unwrap_or((last - r.point).max(0));
        if after > 0 {
            f.write_char('.')?;
        }
        for i in 0..after {
            f.write_char(digit(&r, r.point + i))?;
        }
        return Ok(());
    }
    f.write_char(digit(&r, 0))?;
    if last > 1 {
        f.write_char('.')?;
    }
    for i in 1..last {
        f.write_char(digit(&r, i))?;
    }
    write!(f, "e{}", r.point - 1)
}

impl fmt::Display for Interval {
    /// `[lo, hi]` in decimal, rounded outwards: to 17 significant digits, or to the given number of places.
    /// Reading it back gives an interval that holds the original.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(Interval::new(0.1, 0.75).to_string(), "[0.1, 0.75]");
    /// assert_eq!(format!("{:.2}", Interval::new(-1.0 / 3.0, 2.0 / 3.0)), "[-0.34, 0.67]");
    /// assert_eq!(Interval::EMPTY.to_string(), "[empty]");
    /// ```
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("[empty]");
        }
        f.write_char('[')?;
        write_end(f, self.lo(), Side::Lower)?;
        f.write_str(", ")?;
        write_end(f, self.hi(), Side::Upper)?;
        f.write_char(']')
    }
}

impl fmt::Debug for Interval {
    /// The exact end points, as `f64` prints them; zero without a sign, because an interval has none.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(format!("{:?}", Interval::new(-0.0, 2.0)), "[0.0, 2.0]");
    /// ```
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("[empty]");
        }
        // Adding zero takes the sign off −0 only.
        write!(f, "[{:?}, {:?}]", self.lo() + 0.0, self.hi() + 0.0)
    }
}

fn write_hexadecimal(f: &mut fmt::Formatter<'_>, x: f64) -> fmt::Result {
    if x.is_infinite() {
        return f.write_str(if x > 0.0 { "inf" } else { "-inf" });
    }
    let bits = x.to_bits();
    if x < 0.0 {
        f.write_char('-')?;
    }
    let (field, fraction) = ((bits >> 52 & 2047) as i32, bits & ((1 << 52) - 1));
    let (lead, exponent) = match (field, fraction) {
        (0, 0) => return f.write_str("0x0p+0"),
        (0, _) => (0, -1022),
        _ => (1, field - 1023),
    };
    write!(f, "0x{lead}")?;
    if fraction != 0 {
        let zeros = fraction.trailing_zeros() / 4;
        write!(f, ".{:0width$x}", fraction >> (4 * zeros), width = 13 - zeros as usize)?;
    }
    write!(f, "p{exponent:+}")
}

impl fmt::LowerHex for Interval {
    /// The exact end points in hexadecimal: reading it back gives the same interval.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let x = Interval::new(0.1, 2.5);
    /// assert_eq!(format!("{x:x}"), "[0x1.999999999999ap-4, 0x1.4p+1]");
    /// assert_eq!(format!("{x:x}").parse(), Ok(x));
    /// ```
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("[empty]");
        }
        f.write_char('[')?;
        write_hexadecimal(f, self.lo())?;
        f.write_str(", ")?;
        write_hexadecimal(f, self.hi())?;
        f.write_char(']')
    }
}
