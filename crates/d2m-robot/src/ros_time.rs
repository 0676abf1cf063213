//! Times as the messages of ROS have them: seconds and nanoseconds.

use core::fmt;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

/// A number of seconds, or `{"sec", "nanosec"}` (`{"secs", "nsecs"}` in ROS 1): the double next to their sum.
pub(crate) fn seconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    deserializer.deserialize_any(Seconds)
}

/// In one second.
const NANOSECONDS: i64 = 1_000_000_000;

struct Seconds;

impl<'de> Visitor<'de> for Seconds {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("seconds, or an object with sec and nanosec")
    }

    fn visit_f64<E: Error>(self, seconds: f64) -> Result<f64, E> {
        Ok(seconds)
    }

    fn visit_i64<E: Error>(self, seconds: i64) -> Result<f64, E> {
        Ok(seconds as f64)
    }

    fn visit_u64<E: Error>(self, seconds: u64) -> Result<f64, E> {
        Ok(seconds as f64)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<f64, A::Error> {
        let (mut sec, mut nanosec) = (None, None);
        while let Some(key) = entries.next_key::<String>()? {
            let part = match key.as_str() {
                "sec" | "secs" => &mut sec,
                "nanosec" | "nsecs" => &mut nanosec,
                _ => return Err(Error::unknown_field(&key, &["sec", "nanosec"])),
            };
            if part.replace(i64::from(entries.next_value::<i32>()?)).is_some() {
                return Err(Error::custom(format!("{key} is given twice")));
            }
        }
        let (Some(sec), Some(nanosec)) = (sec, nanosec) else {
            return Err(Error::custom("a time has sec and nanosec"));
        };
        // The sum is exact, and nearly always a double: only the quotient rounds.
        Ok((sec * NANOSECONDS + nanosec) as f64 / NANOSECONDS as f64)
    }
}
