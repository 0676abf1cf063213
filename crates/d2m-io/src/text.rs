//! Words and numbers of texts.

use d2m_bvh::MAX_COORDINATE;

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

/// Words of a file in quotes, as messages show them: at most 60 characters, because damaged files have long ones.
///
/// ```
/// assert_eq!(d2m_io::excerpt("1.5e"), "\"1.5e\"");
/// assert_eq!(d2m_io::excerpt(&"x".repeat(100)).chars().count(), 63);
/// ```
pub fn excerpt(text: &str) -> String {
    const MOST_CHARACTERS: usize = 60;
    match text.char_indices().nth(MOST_CHARACTERS) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}…", &text[..end]),
    }
}
