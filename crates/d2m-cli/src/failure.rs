//! Why a command stopped.

use d2m_io::{IoError, excerpt};
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
    serde_json::from_slice(bytes).map_err(|error| {
        let line = bytes.split(|&byte| byte == b'\n').nth(error.line().saturating_sub(1)).unwrap_or_default();
        let word = word_at(&String::from_utf8_lossy(line), error.column());
        Failure::at(place, format!("{error}{word}"))
    })
}

/// What is wrong with one line of JSON: for the parser every line is the first, and the column at which it stops is the end of what
/// is wrong.
pub(crate) fn json_fault(error: &serde_json::Error, line: &str) -> String {
    let (text, column) = (error.to_string(), error.column());
    let what = text.split(" at line 1 column ").next().unwrap_or_default();
    if column == 0 {
        what.to_owned()
    } else {
        format!("{what} (before column {column}){}", word_at(line, column))
    }
}

/// The word of a line that a column (from 1, in bytes) is in, for numbers that are none in JSON (NaN) or too large.
fn word_at(line: &str, column: usize) -> String {
    let is_delimiter = |c: char| c.is_whitespace() || ",:[]{}\"".contains(c);
    let mut start = 0;
    for word in line.split(is_delimiter) {
        if (start..=start + word.len()).contains(&column.saturating_sub(1)) && !word.is_empty() {
            return format!(": {}", excerpt(word));
        }
        start += word.len() + 1;
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_json_name_the_word() {
        let fault = |text: &str| parse_json::<Vec<f64>>("f.json", text.as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("[1, NaN]"), "f.json: expected value at line 1 column 5: \"NaN\"");
        assert_eq!(fault("[1,\n 1e999]"), "f.json: number out of range at line 2 column 6: \"1e999\"");
        let line = "[1, -Infinity]";
        let error = serde_json::from_str::<Vec<f64>>(line).unwrap_err();
        assert_eq!(json_fault(&error, line), "invalid number (before column 6): \"-Infinity\"");
        assert!(fault("").contains("EOF"), "{}", fault(""));
        assert!(fault("[\u{e9}\u{e9}").contains("column"), "{}", fault("[\u{e9}\u{e9}"));
    }
}
