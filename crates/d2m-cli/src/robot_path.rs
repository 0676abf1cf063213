//! Files of paths: what is no number in them is named by point and joint, not by its column.

use crate::failure::{Failure, parse_json};
use crate::load::{named, read};
use crate::simulation::short;
use d2m::motion::serde_object::Object;
use d2m_robot::Trajectory;
use serde_json::{Value, json};
use std::path::Path;

/// Reads a path, which makes sense by itself: what joints a robot has is not known here.
pub(crate) fn read_path(file: &Path) -> Result<Trajectory, Failure> {
    let place = named(file);
    let bytes = read(file)?;
    let Object(path) = parse_json::<Object<Trajectory>>(&place, &bytes).map_err(|failure| {
        number_fault(&String::from_utf8_lossy(&bytes)).map_or(failure, |reason| Failure::at(&place, reason))
    })?;
    path.joint_values().map_err(|error| Failure::at(&place, error))?;
    Ok(path)
}

/// The first of the numbers of a path that is none, with point and joint.
fn number_fault(text: &str) -> Option<String> {
    let value: Value = serde_json::from_str(&with_words_quoted(text)).ok()?;
    let points = value.get("points")?.as_array()?;
    points.iter().enumerate().find_map(|(index, point)| {
        let lists = ["positions", "velocities", "accelerations"].iter().find_map(|key| {
            let list = point.get(key)?.as_array()?;
            let at = list.iter().position(|number| !number.is_number())?;
            let joint = value.get("joint_names").and_then(|names| names.get(at)?.as_str());
            let joint = joint.map_or(String::new(), |name| format!(" (joint {name:?})"));
            Some(format!("points[{index}], {key}[{at}]: {} is not a finite number{joint}", shown(&list[at])))
        });
        lists.or_else(|| {
            let time = point.get("time_from_start").filter(|time| !is_time(time))?;
            let what = match time {
                Value::Object(parts) if !parts.contains_key(WORD) => {
                    "not {\"sec\", \"nanosec\"} with numbers"
                }
                _ => "not a finite number",
            };
            Some(format!("points[{index}], time_from_start: {} is {what}", shown(time)))
        })
    })
}

/// Seconds, or seconds and nanoseconds in the keys of ROS.
fn is_time(time: &Value) -> bool {
    let has = |keys: [&str; 2]| keys.iter().all(|key| time.get(key).is_some_and(Value::is_number));
    let is_of_two = time.as_object().is_some_and(|parts| parts.len() == 2);
    time.is_number() || (is_of_two && (has(["sec", "nanosec"]) || has(["secs", "nsecs"])))
}

/// The key of an object that stands for a word which JSON does not have.
const WORD: &str = "word";

fn shown(value: &Value) -> String {
    let mut value = value.clone();
    if let Some(word) = value.get(WORD).and_then(Value::as_str) {
        return word.to_owned();
    }
    for part in value.as_object_mut().into_iter().flat_map(serde_json::Map::values_mut) {
        if let Some(word) = part.get(WORD).cloned() {
            *part = word;
        }
    }
    short(&value)
}

/// The same text with `NaN`, `inf`, `1e999` and their like as objects, so that it can be parsed.
fn with_words_quoted(text: &str) -> String {
    let ends = |c: char| c.is_whitespace() || ",:[]{}\"".contains(c);
    let (mut quoted, mut rest) = (String::new(), text.trim_start_matches('\u{feff}'));
    while let Some(first) = rest.chars().next() {
        let length = if first == '"' {
            let mut is_escaped = false;
            let end = rest.char_indices().skip(1).find(|&(_, c)| {
                let is_end = c == '"' && !is_escaped;
                is_escaped = c == '\\' && !is_escaped;
                is_end
            });
            end.map_or(rest.len(), |(at, _)| at + 1)
        } else if ends(first) {
            first.len_utf8()
        } else {
            rest.find(ends).unwrap_or(rest.len())
        };
        let (word, after) = rest.split_at(length);
        rest = after;
        if ends(first) || serde_json::from_str::<Value>(word).is_ok() {
            quoted.push_str(word);
        } else {
            quoted.push_str(&json!({ WORD: word }).to_string());
        }
    }
    quoted
}
