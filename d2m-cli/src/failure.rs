//! Why a command stopped.

use crate::commands::features::FeaturesError;
use std::fmt::Display;
use thiserror::Error;

/// Ends a command; all but the closed pipe with exit code 3.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// Input that cannot be used, with where and what.
    #[error("{0}")]
    Input(String),
    /// Nobody reads standard output any more.
    #[error("standard output was closed")]
    ClosedPipe,
}

impl Failure {
    /// Bad input at a place (a file, an option) with its reason.
    pub(crate) fn at(place: impl Display, reason: impl Display) -> Self {
        Self::Input(format!("{place}: {reason}"))
    }
}

impl From<FeaturesError> for Failure {
    fn from(error: FeaturesError) -> Self {
        match error {
            FeaturesError::Output(failure) => failure,
            other => Self::Input(other.to_string()),
        }
    }
}
