//! Why a command stopped.

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
