//! Serde: text that every library keeps exactly, or a checked pair of doubles.
use alloc::string::String;
use core::fmt;

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, SeqAccess, Unexpected, Visitor},
    ser::SerializeTuple,
};

use crate::Interval;

impl Serialize for Interval {
    /// In human-readable formats the string of the exact hexadecimal form, `"[0x1.8p+0, 0x1p+1]"`: decimal numbers are
    /// rounded by some libraries (plain `serde_json` reads one in four to a neighbour), strings are not, and infinities
    /// and the empty set need nothing special. In binary formats the pair of doubles.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            return serializer.collect_str(&format_args!("{self:x}"));
        }
        let mut pair = serializer.serialize_tuple(2)?;
        pair.serialize_element(&self.lo())?;
        pair.serialize_element(&self.hi())?;
        pair.end()
    }
}

/// How far the number that a library hands over may be from the double that was written, in neighbours: fast readers round
/// the digits, a power of ten, and their product (3·2⁻⁵³ of the number, at most three neighbours), and once more if it
/// is subnormal.
const READ_NEIGHBOURS: u32 = 4;

fn lowered(x: f64) -> f64 {
    (0..READ_NEIGHBOURS).fold(x, |x, _| x.next_down())
}

/// An end point in a human-readable format: what it may have been before it was read.
struct End(Interval);

impl<'de> Deserialize<'de> for End {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EndVisitor)
    }
}

struct EndVisitor;

impl Visitor<'_> for EndVisitor {
    type Value = End;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an end point")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<End, E> {
        let (lo, hi) = (lowered(x), -lowered(-x));
        if x.is_nan() {
            Err(E::invalid_value(Unexpected::Float(x), &self))
        } else {
            Ok(End(Interval::raw(lo, hi)))
        }
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<End, E> {
        self.visit_i128(i128::from(x))
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<End, E> {
        self.visit_i128(i128::from(x))
    }

    fn visit_i128<E: Error>(self, x: i128) -> Result<End, E> {
        // Integers are kept; beyond 2⁵³ the double next to one need not be equal.
        let near = x as f64;
        Ok(End(if near as i128 == x {
            Interval::point(near)
        } else {
            Interval::raw(near.next_down(), near.next_up())
        }))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<End, E> {
        // An infinity alone is an end, but no interval.
        match text {
            "inf" => Ok(End(Interval::raw(f64::MAX, f64::INFINITY))),
            "-inf" => Ok(End(Interval::raw(f64::NEG_INFINITY, -f64::MAX))),
            _ => text.parse().map(End).map_err(|_| E::invalid_value(Unexpected::Str(text), &self)),
        }
    }
}

/// What is read, from a human-readable format or not.
struct Checked {
    readable: bool,
}

impl<'de> Visitor<'de> for Checked {
    type Value = Interval;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[lo, hi] with lo <= hi, or an interval as text")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut pair: A) -> Result<Interval, A::Error> {
        let missing = |n: usize| A::Error::invalid_length(n, &"a pair of end points");
        if self.readable {
            let lo: End = pair.next_element()?.ok_or_else(|| missing(0))?;
            let hi: End = pair.next_element()?.ok_or_else(|| missing(1))?;
            return Interval::try_new(lo.0.lo(), hi.0.hi()).map_err(A::Error::custom);
        }
        let lo: f64 = pair.next_element()?.ok_or_else(|| missing(0))?;
        let hi: f64 = pair.next_element()?.ok_or_else(|| missing(1))?;
        if (lo, hi) == (f64::INFINITY, f64::NEG_INFINITY) {
            return Ok(Interval::EMPTY);
        }
        Interval::try_new(lo, hi).map_err(A::Error::custom)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Interval, E> {
        text.parse().map_err(|_| E::invalid_value(Unexpected::Str(text), &self))
    }

    fn visit_string<E: Error>(self, text: String) -> Result<Interval, E> {
        self.visit_str(&text)
    }
}

impl<'de> Deserialize<'de> for Interval {
    /// Any text that `from_str` reads, or a pair. The pair of numbers that versions up to 0.1.0 wrote is read outward in
    /// human-readable formats: integers as they are, other numbers with their four neighbours, because a library may have
    /// rounded them. NaN and ends in the wrong order are refused.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(Checked { readable: true })
        } else {
            deserializer.deserialize_tuple(2, Checked { readable: false })
        }
    }
}
