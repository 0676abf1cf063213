//! A number that no text format changes.

use core::fmt;
use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An `f64` that arrives bit for bit: in formats for people a string of its shortest decimal form, since many libraries change
/// the last place of JSON numbers; elsewhere the number. Plain numbers are read too, as the library reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ExactNumber(pub(crate) f64);

impl Serialize for ExactNumber {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            serializer.collect_str(&format_args!("{:?}", self.0))
        } else {
            serializer.serialize_f64(self.0)
        }
    }
}

impl<'de> Deserialize<'de> for ExactNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(NumberOrText)
        } else {
            f64::deserialize(deserializer).map(Self)
        }
    }
}

struct NumberOrText;

impl Visitor<'_> for NumberOrText {
    type Value = ExactNumber;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a string that holds one")
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<ExactNumber, E> {
        Ok(ExactNumber(number))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<ExactNumber, E> {
        Ok(ExactNumber(number as f64))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<ExactNumber, E> {
        Ok(ExactNumber(number as f64))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<ExactNumber, E> {
        text.parse().map(ExactNumber).map_err(|_| E::invalid_value(de::Unexpected::Str(text), &self))
    }
}
