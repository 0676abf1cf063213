//! Faults of scene files.

use crate::{IoError, Place};

/// A fault at an item of a scene.
pub(crate) fn fault(item: impl Into<String>, reason: impl std::fmt::Display) -> IoError {
    let place = Place { item: Some(item.into()), ..Place::default() };
    IoError::Content { place, reason: reason.to_string() }
}

/// Distances are finite and not negative.
pub(crate) fn check_distance(item: &str, distance: f64) -> Result<(), IoError> {
    if distance >= 0.0 && distance.is_finite() {
        return Ok(());
    }
    Err(fault(item, format!("{distance:?} is not a finite distance that is not negative")))
}
