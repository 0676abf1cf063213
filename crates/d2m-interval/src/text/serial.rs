//! Serde: a checked pair `[lo, hi]`.
use alloc::string::String;
use core::fmt;

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, SeqAccess, Unexpected, Visitor},
    ser::SerializeTuple,
};

use crate::Interval;

impl Serialize for Interval {
    /// `[lo, hi]`; in human-readable formats, which often lack infinities, an unbounded or empty interval is the
    /// string of its exact hexadecimal form.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() && (self.is_empty() || !self.is_bounded()) {
            return serializer.collect_str(&format_args!("{self:x}"));
        }
        let mut pair = serializer.serialize_tuple(2)?;
        pair.serialize_element(&self.lo())?;
        pair.serialize_element(&self.hi())?;
        pair.end()
    }
}

struct Checked;

impl<'de> Visitor<'de> for Checked {
    type Value = Interval;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[lo, hi] with lo <= hi, or an interval as text")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut pair: A) -> Result<Interval, A::Error> {
        let lo: f64 = pair.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let hi: f64 = pair.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
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
    /// Refuses NaN and ends in the wrong order.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(Checked)
        } else {
            deserializer.deserialize_tuple(2, Checked)
        }
    }
}
