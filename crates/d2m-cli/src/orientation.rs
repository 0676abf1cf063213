//! Warnings of orientations that people mistype.

use crate::output::note;
use serde_json::Value;
use std::f64::consts::TAU;

/// Lengths of quaternions differ from one by this much when their numbers were written with seven digits.
pub(crate) const WRITTEN: f64 = 1e-6;

/// What is doubtful of quaternions `[w, x, y, z]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Doubt {
    /// The w was probably written last.
    Order,
    Length,
}

impl Doubt {
    fn of(q: [f64; 4]) -> Option<Self> {
        let length = length(q);
        match q {
            [0.0, 0.0, 0.0, 1.0] => Some(Self::Order),
            _ => ((length - 1.0).abs() > WRITTEN && length > 0.0).then_some(Self::Length),
        }
    }
}

fn length(q: [f64; 4]) -> f64 {
    q.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// One warning of each kind, of the first quaternion and of how many more there are.
fn warn(place: &str, quaternions: &[[f64; 4]]) {
    for doubt in [Doubt::Order, Doubt::Length] {
        let mut doubtful = quaternions.iter().filter(|&&q| Doubt::of(q) == Some(doubt));
        let Some(&q) = doubtful.next() else { continue };
        let text = match doubt {
            Doubt::Order => {
                "q = 0,0,0,1 is half a turn about z: w comes first, and no turn is q = 1,0,0,0".to_owned()
            }
            Doubt::Length => format!("q = {q:?} has the length {}, not 1; it is normalized", length(q)),
        };
        let more = match doubtful.count() {
            0 => String::new(),
            more => format!(" ({more} more like it)"),
        };
        note(&format!("d2m: warning: {place}: {text}{more}"));
    }
}

/// Warns of the `q` of a motion's text, and of an `rpy` that was probably meant in degrees.
pub(crate) fn warn_of_text(place: &str, text: &str) {
    let parts = text.split(';').filter_map(|part| part.split_once('='));
    let quaternion = |value: &str| {
        let numbers: Vec<f64> = value.split(',').filter_map(|word| word.trim().parse().ok()).collect();
        numbers.try_into().ok()
    };
    for (_, value) in parts.clone().filter(|(key, _)| key.trim() == "rpy") {
        let most = value.split(',').filter_map(|word| word.trim().parse::<f64>().ok()).map(f64::abs);
        if most.fold(0.0, f64::max) > TAU {
            note(&format!(
                "d2m: warning: {place}: rpy = {value} is in radians, and more than a whole turn; degrees have deg behind the number"
            ));
        }
    }
    let of_turns = parts.filter(|(key, _)| key.trim() == "q");
    warn(place, &of_turns.filter_map(|(_, value)| quaternion(value)).collect::<Vec<_>>());
}

/// Warns of the doubtful `q` of a JSON form.
pub(crate) fn warn_of_json(place: &str, value: &Value) {
    let mut found = Vec::new();
    collect(value, &mut found);
    warn(place, &found);
}

/// Every `q` of four numbers, in their order.
fn collect(value: &Value, found: &mut Vec<[f64; 4]>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                let numbers = value.as_array().filter(|_| key == "q");
                let numbers = numbers.map(|list| list.iter().filter_map(Value::as_f64).collect::<Vec<_>>());
                match numbers.and_then(|numbers| <[f64; 4]>::try_from(numbers).ok()) {
                    Some(q) => found.push(q),
                    None => collect(value, found),
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|value| collect(value, found)),
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
