//! The serde form of an interval: its two ends, checked on the way in.

use crate::Interval;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// Writes the pair (lo, hi).
impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.lo(), self.hi()).serialize(serializer)
    }
}

/// Reads the pair (lo, hi); refused unless [`Interval::try_new`] accepts it.
impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (lo, hi) = <(f64, f64)>::deserialize(deserializer)?;
        Self::try_new(lo, hi).map_err(D::Error::custom)
    }
}
