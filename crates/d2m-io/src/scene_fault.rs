//! Faults of scene files.

use crate::{IoError, Place, short_value};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A fault at an item of a scene.
pub(crate) fn fault(item: impl Into<String>, reason: impl std::fmt::Display) -> IoError {
    let place = Place { item: Some(item.into()), ..Place::default() };
    IoError::Content { place, reason: reason.to_string() }
}

/// Distances are finite and not negative.
pub(crate) fn check_distance(item: &str, distance: f64) -> Result<(), IoError> {
    check_not_negative(item, "distance", distance)
}

/// Finite, and not negative; `what` the number is.
pub(crate) fn check_not_negative(item: &str, what: &str, number: f64) -> Result<(), IoError> {
    if number >= 0.0 && number.is_finite() {
        return Ok(());
    }
    Err(fault(item, format!("{number:?} is not a finite {what} that is not negative")))
}

/// The keys of an object at a place of a scene. A list is none: serde would take its values in the order of the keys.
pub(crate) fn keys_of<T: DeserializeOwned>(place: &str, value: Value) -> Result<T, IoError> {
    if !value.is_object() {
        return Err(fault(place, format!("{} is not an object with keys", short_value(&value))));
    }
    serde_json::from_value(value).map_err(|error| fault(place, error))
}
