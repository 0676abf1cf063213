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

/// What is wrong with one line of JSON: for the parser every line is the first, and where it lost the thread is the end of what
/// is wrong.
pub(crate) fn json_fault(error: &serde_json::Error) -> String {
    let (text, column) = (error.to_string(), error.column());
    let what = text.split(" at line 1 column ").next().unwrap_or_default();
    if column == 0 { what.to_owned() } else { format!("{what} (before column {column})") }
}
