//! Why a command stopped.

use d2m_io::IoError;
pub(crate) use d2m_io::json_fault;
use serde::de::DeserializeOwned;
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

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self::Input(error.to_string())
    }
}

/// Reads a JSON file; a fault names line, column and the word that is there.
pub(crate) fn parse_json<T: DeserializeOwned>(place: &str, bytes: &[u8]) -> Result<T, Failure> {
    d2m_io::parse_json(bytes).map_err(|error| Failure::at(place, error))
}
