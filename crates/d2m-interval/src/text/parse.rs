//! Text to interval, by the grammar of IEEE 1788: the result is the narrowest interval that holds what is written.
use core::str::FromStr;

use super::Side;
use super::big::Big;
use super::number::{Number, Signed, exponent, sign};
use crate::{Interval, ParseIntervalError};

/// An end point as written.
enum End {
    Number(Number),
    Infinite { negative: bool },
}

fn syntax<T>() -> Result<T, ParseIntervalError> {
    Err(ParseIntervalError::Syntax)
}

fn end(text: &str) -> Result<End, ParseIntervalError> {
    let Signed { negative, size } = sign(text);
    if size == "inf" || size == "infinity" {
        return Ok(End::Infinite { negative });
    }
    Number::read(text).map(End::Number)
}

/// `m ? r [u|d] [e exponent]`: the decimal m, give or take r units of its last digit (half a unit without r, any
/// amount with a second question mark), upwards or downwards only with `u` or `d`.
fn uncertain(center: &str, rest: &str) -> Result<Interval, ParseIntervalError> {
    let (rest, power) = match rest.split_once('e') {
        Some((rest, power)) => (rest, exponent(power)?),
        None => (rest, 0),
    };
    let (rest, only) = match rest.as_bytes().last() {
        Some(b'u') => (&rest[..rest.len() - 1], Some(Side::Upper)),
        Some(b'd') => (&rest[..rest.len() - 1], Some(Side::Lower)),
        _ => (rest, None),
    };
    if center.contains(['e', 'x', 'p', '/']) {
        return syntax();
    }
    let mut center = Number::read(center)?;
    center.decimal += power;
    if rest == "?" {
        let known = center.enclose();
        return Ok(match only {
            Some(Side::Upper) => Interval::raw(known.lo(), f64::INFINITY),
            Some(Side::Lower) => Interval::raw(f64::NEG_INFINITY, known.hi()),
            None => Interval::ENTIRE,
        });
    }
    let steps = if rest.is_empty() {
        Big::from_u64(1)
    } else {
        if !rest.bytes().all(|b| b.is_ascii_digit()) {
            return syntax();
        }
        Big::from_decimal(rest.as_bytes()).times_power_of_two(1)
    };
    let end = |side: Side| match only {
        Some(other) if other != side => center.enclose(),
        _ => center.moved(&steps, side).enclose(),
    };
    Ok(Interval::raw(end(Side::Lower).lo(), end(Side::Upper).hi()))
}

impl FromStr for Interval {
    type Err = ParseIntervalError;

    /// Reads the forms of IEEE 1788, upper or lower case, and bare numbers:
    /// `[0.1, 2/3]`, `[0x1.8p-3]`, `[-inf, 5]`, `[,5]`, `[entire]`, `[empty]`, `3.14?2` (give or take two units of
    /// the last digit), `0.1`. The result is the narrowest interval that holds every number that is written, however many
    /// digits it has; the time is linear in them.
    ///
    /// Ends in the wrong order are an error. (Where both lie between the same two doubles and only hexadecimal digits
    /// behind the 200th, or a comparison of fractions of tens of thousands of digits, could decide it, the result is the
    /// interval between these doubles.)
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
            if let Some((center, rest)) = text.split_once('?') {
                return uncertain(center, rest);
            }
            return Ok(Number::read(&text)?.enclose());
        };
        let Some(inner) = inner.strip_suffix(']') else { return syntax() };
        match inner.trim() {
            "" | "empty" => return Ok(Self::EMPTY),
            "entire" => return Ok(Self::ENTIRE),
            _ => {}
        }
        let Some((first, second)) = inner.split_once(',') else {
            return match end(inner.trim())? {
                End::Number(x) => Ok(x.enclose()),
                End::Infinite { .. } => Err(ParseIntervalError::Order),
            };
        };
        let end_or = |text: &str, missing: End| match text.trim() {
            "" => Ok(missing),
            text => end(text),
        };
        let (lowest, highest) = (End::Infinite { negative: true }, End::Infinite { negative: false });
        match (end_or(first, lowest)?, end_or(second, highest)?) {
            (End::Infinite { negative: false }, _) | (_, End::Infinite { negative: true }) => {
                Err(ParseIntervalError::Order)
            }
            (End::Infinite { .. }, End::Infinite { .. }) => Ok(Self::ENTIRE),
            (End::Infinite { .. }, End::Number(hi)) => Ok(Self::raw(f64::NEG_INFINITY, hi.enclose().hi())),
            (End::Number(lo), End::Infinite { .. }) => Ok(Self::raw(lo.enclose().lo(), f64::INFINITY)),
            (End::Number(lo), End::Number(hi)) => {
                if lo.is_greater(&hi) {
                    return Err(ParseIntervalError::Order);
                }
                Ok(Self::raw(lo.enclose().lo(), hi.enclose().hi()))
            }
        }
    }
}
