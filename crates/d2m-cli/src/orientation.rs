//! Warnings of orientations that people mistype.

use crate::output::note;
use serde_json::Value;

/// Lengths of quaternions differ from one by this much when their numbers were written with seven digits.
pub(crate) const WRITTEN: f64 = 1e-6;

/// Warns of a quaternion `[w, x, y, z]` that is probably not what was meant.
fn warn(place: &str, q: [f64; 4]) {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    if q == [0.0, 0.0, 0.0, 1.0] {
        note(&format!(
            "d2m: warning: {place}: q = 0,0,0,1 is half a turn about z: w comes first, and no turn is q = 1,0,0,0"
        ));
    } else if (length - 1.0).abs() > WRITTEN && length > 0.0 {
        note(&format!("d2m: warning: {place}: q = {q:?} has the length {length}, not 1; it is normalized"));
    }
}

/// Warns of the `q` of a motion's text.
pub(crate) fn warn_of_text(place: &str, text: &str) {
    let parts = text.split(';').filter_map(|part| part.split_once('='));
    for (_, value) in parts.filter(|(key, _)| key.trim() == "q") {
        let numbers: Vec<f64> = value.split(',').filter_map(|word| word.trim().parse().ok()).collect();
        if let Ok(q) = numbers.try_into() {
            warn(place, q);
        }
    }
}

/// Warns of every doubtful `q` of a JSON form.
pub(crate) fn warn_of_json(place: &str, value: &Value) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                let numbers = value.as_array().filter(|_| key == "q");
                let numbers = numbers.map(|list| list.iter().filter_map(Value::as_f64).collect::<Vec<_>>());
                match numbers.and_then(|numbers| <[f64; 4]>::try_from(numbers).ok()) {
                    Some(q) => warn(place, q),
                    None => warn_of_json(place, value),
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|value| warn_of_json(place, value)),
        _ => {}
    }
}

/// Is there a `q` in a JSON form whose length is not one?
pub(crate) fn has_odd_length(value: &Value) -> bool {
    let is_odd = |q: &Value| {
        let squares =
            q.as_array().map(|list| list.iter().filter_map(Value::as_f64).map(|x| x * x).sum::<f64>());
        squares.is_some_and(|squares| (squares.sqrt() - 1.0).abs() > WRITTEN)
    };
    match value {
        Value::Object(object) => {
            object.iter().any(|(key, value)| if key == "q" { is_odd(value) } else { has_odd_length(value) })
        }
        Value::Array(list) => list.iter().any(has_odd_length),
        _ => false,
    }
}
