//! JSON files: faults name line, column and the word that is there; no key stands twice.

use crate::{IoError, Place, excerpt, short_value};
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

/// Reads the bytes of a JSON file; a fault names line, column and the word that is there. A byte order mark is no part of it.
///
/// ```
/// let fault = d2m_io::parse_json::<Vec<f64>>(b"[1,\n 1e999]").unwrap_err();
/// assert_eq!(fault.to_string(), "number out of range at line 2 column 6: \"1e999\"");
/// ```
///
/// # Errors
/// [`IoError::Content`].
pub fn parse_json<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, IoError> {
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    serde_json::from_slice(bytes).map_err(|error| {
        let line = bytes.split(|&byte| byte == b'\n').nth(error.line().saturating_sub(1)).unwrap_or_default();
        let word = word_at(&String::from_utf8_lossy(line), error.column());
        IoError::Content { place: Place::default(), reason: format!("{}{word}", short(&error.to_string())) }
    })
}

/// The same of a file that holds an object with keys. A list is none: serde would take its values in the order of the keys.
pub(crate) fn parse_object<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, IoError> {
    let UniqueKeys(value) = parse_json(bytes)?;
    if value.is_object() {
        return parse_json(bytes);
    }
    let reason = format!("{} is not an object with keys", short_value(&value));
    Err(IoError::Content { place: Place::default(), reason })
}

/// What is wrong with one line of a file of JSON lines: for the parser every line is the first, and the column at which it stops is the
/// end of what is wrong.
///
/// ```
/// let line = r#"{"x": NaN}"#;
/// let error = serde_json::from_str::<serde_json::Value>(line).unwrap_err();
/// let fault = d2m_io::json_fault(&error, line);
/// assert!(fault.contains("column") && fault.contains("NaN"));
/// ```
pub fn json_fault(error: &serde_json::Error, line: &str) -> String {
    let (text, column) = (error.to_string(), error.column());
    let what = text.split(" at line 1 column ").next().unwrap_or_default();
    if column == 0 {
        short(what)
    } else {
        format!("{} (before column {column}){}", short(what), word_at(line, column))
    }
}

/// Characters at the start and at the end of what the parser says that are kept: it quotes a whole string.
const KEPT: usize = 200;

/// What the parser says of text that is no JSON, and what that means to those who do not know it.
const WORDS: [(&str, &str); 3] = [
    ("expected value", "expected a JSON value"),
    ("expected ident", "expected a JSON value"),
    ("EOF while parsing", "the text ends within"),
];

/// What the parser says, in words that say what is missing and without the middle of what is long.
fn short(text: &str) -> String {
    let known = WORDS.iter().find_map(|(said, meant)| Some(format!("{meant}{}", text.strip_prefix(said)?)));
    let text = known.as_deref().unwrap_or(text);
    let (start, end) = (text.char_indices().nth(KEPT), text.char_indices().nth_back(KEPT));
    match (start, end) {
        (Some((start, _)), Some((end, _))) if start < end => format!("{} … {}", &text[..start], &text[end..]),
        _ => text.to_owned(),
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

/// Any JSON value. An object that names a key twice is refused, with the key; the reader adds line and column. (A plain
/// [`Value`] keeps the last one and says nothing.)
///
/// ```
/// use d2m_io::UniqueKeys;
/// let UniqueKeys(value) = serde_json::from_str(r#"{"x": 1, "y": 2}"#)?;
/// assert_eq!(value["y"], 2);
/// assert!(serde_json::from_str::<UniqueKeys>(r#"{"x": 1, "x": 2}"#).is_err());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug)]
pub struct UniqueKeys(
    /// The value.
    pub Value,
);

impl<'de> Deserialize<'de> for UniqueKeys {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        reader.deserialize_any(AnyValue).map(Self)
    }
}

struct AnyValue;

impl<'de> Visitor<'de> for AnyValue {
    type Value = Value;

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Value, E> {
        Ok(Value::String(value.to_owned()))
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(UniqueKeys(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format_args!("duplicate field `{key}`")));
            }
            let UniqueKeys(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_json_name_the_word() {
        let fault = |text: &str| parse_json::<Vec<f64>>(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("[1, NaN]"), "expected a JSON value at line 1 column 5: \"NaN\"");
        let line = "[1, -Infinity]";
        let error = serde_json::from_str::<Vec<f64>>(line).unwrap_err();
        assert_eq!(json_fault(&error, line), "invalid number (before column 6): \"-Infinity\"");
        assert!(fault("").contains("the text ends within a value"), "{}", fault(""));
        let long = fault(&format!("[\"{}\"]", "\u{e9}".repeat(100_000)));
        assert!(long.starts_with("invalid type: string") && long.contains(" at line 1 column "), "{long}");
        assert!(long.chars().count() < 480, "{long}");
        assert!(fault("[\u{e9}\u{e9}").contains("column"), "{}", fault("[\u{e9}\u{e9}"));
    }
}
