//! Words and numbers of texts.

use d2m_bvh::MAX_COORDINATE;
use serde_json::Value;

/// Characters of a file in a message, at most.
const MOST_CHARACTERS: usize = 60;

/// A coordinate of a text, correctly rounded whatever its number of digits.
pub(crate) fn coordinate(axis: &str, word: Option<&str>) -> Result<f64, String> {
    let word = word.ok_or_else(|| format!("{axis} is missing"))?;
    let value: f64 = word.parse().map_err(|_| format!("{axis} is {}, not a number", excerpt(word)))?;
    // In the words of the file: 1e999 and not infinity.
    if value.is_finite() {
        check_coordinate(axis, value)?;
        Ok(value)
    } else {
        Err(format!("{axis} is {}, not a finite number", excerpt(word).trim_matches('"')))
    }
}

pub(crate) fn check_coordinate(axis: &str, value: f64) -> Result<(), String> {
    if !value.is_finite() {
        return Err(format!("{axis} is {value}, not a finite number"));
    }
    if value.abs() > MAX_COORDINATE {
        return Err(format!("{axis} is {value:e}, larger than the limit of {MAX_COORDINATE:e}"));
    }
    Ok(())
}

/// The start of a JSON value, as messages show it.
///
/// ```
/// assert_eq!(d2m_io::short_value(&serde_json::json!(["a", 1])), "[\"a\",1]");
/// assert_eq!(d2m_io::short_value(&vec![7; 100].into()).chars().count(), 61);
/// ```
pub fn short_value(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(MOST_CHARACTERS) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Words of a file in quotes, as messages show them: at most 60 characters, because damaged files have long ones.
///
/// ```
/// assert_eq!(d2m_io::excerpt("1.5e"), "\"1.5e\"");
/// assert_eq!(d2m_io::excerpt(&"x".repeat(100)).chars().count(), 63);
/// ```
pub fn excerpt(text: &str) -> String {
    match text.char_indices().nth(MOST_CHARACTERS) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}…", &text[..end]),
    }
}
