//! Objects of a scene file, read strictly: what is unknown or unusable is named with its place.

use crate::failure::Failure;
use d2m_io::SceneTerms;
pub(crate) use d2m_io::short_value as short;
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Map, Value};

/// An object of a file and its place in messages, such as `scene.json, body floor (index 0)`.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'v> {
    place: String,
    object: &'v Map<String, Value>,
}

impl<'v> Fields<'v> {
    pub(crate) fn new(place: String, value: &'v Value, known: &[&str]) -> Result<Self, Failure> {
        let Some(object) = value.as_object() else {
            return Err(Failure::at(place, format!("should be an object, not {}", short(value))));
        };
        if let Some(key) = object.keys().find(|key| !known.contains(&key.as_str())) {
            return Err(Failure::at(place, format!("unknown key {key:?}; known are {}", known.join(", "))));
        }
        Ok(Self { place, object })
    }

    /// The object without these keys.
    pub(crate) fn without(&self, keys: &[&str]) -> Value {
        let others = self.object.iter().filter(|(key, _)| !keys.contains(&key.as_str()));
        Value::Object(others.map(|(key, value)| (key.clone(), value.clone())).collect())
    }

    /// The object with these keys only.
    pub(crate) fn only(&self, keys: &[&str]) -> Value {
        let some = self.object.iter().filter(|(key, _)| keys.contains(&key.as_str()));
        Value::Object(some.map(|(key, value)| (key.clone(), value.clone())).collect())
    }

    /// What a scene says of all its pairs.
    pub(crate) fn terms(&self) -> Result<SceneTerms, Failure> {
        let terms = SceneTerms::parse(self.only(&["window", "min_separation", "tolerance", "start"]));
        terms.map_err(|error| error.in_file(&self.place).into())
    }

    pub(crate) fn place(&self) -> &str {
        &self.place
    }

    pub(crate) fn get(&self, key: &str) -> Option<&'v Value> {
        self.object.get(key)
    }

    pub(crate) fn fault(&self, key: &str, reason: impl core::fmt::Display) -> Failure {
        Failure::at(&self.place, format!("{key}: {reason}"))
    }

    pub(crate) fn required(&self, key: &str) -> Result<&'v Value, Failure> {
        self.get(key).ok_or_else(|| Failure::at(&self.place, format!("key {key:?} is missing")))
    }

    pub(crate) fn list(&self, key: &str) -> Result<Option<&'v Vec<Value>>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value
            .as_array()
            .map(Some)
            .ok_or_else(|| self.fault(key, format!("{} should be a list", short(value))))
    }

    /// The object under a key, with these keys of its own.
    pub(crate) fn object(&self, key: &str, known: &[&str]) -> Result<Option<Self>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        Self::new(format!("{}, {key}", self.place), value, known).map(Some)
    }

    pub(crate) fn flag(&self, key: &str) -> Result<Option<bool>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let fault = || self.fault(key, format!("{} should be true or false", short(value)));
        value.as_bool().map(Some).ok_or_else(fault)
    }

    pub(crate) fn text(&self, key: &str) -> Result<Option<&'v str>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value.as_str().map(Some).ok_or_else(|| self.fault(key, format!("{} should be a text", short(value))))
    }

    pub(crate) fn number(&self, key: &str) -> Result<Option<f64>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        number(value)
            .map(Some)
            .ok_or_else(|| self.fault(key, format!("{} should be a finite number", short(value))))
    }

    pub(crate) fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let list = value.as_array().filter(|list| list.len() == N);
        let parsed: Option<Vec<f64>> = list.and_then(|list| list.iter().map(number).collect());
        match parsed.and_then(|numbers| numbers.try_into().ok()) {
            Some(numbers) => Ok(Some(numbers)),
            None => Err(self.fault(key, format!("{} should be {N} finite numbers", short(value)))),
        }
    }

    pub(crate) fn vector(&self, key: &str) -> Result<Option<DVec3>, Failure> {
        Ok(self.numbers::<3>(key)?.map(DVec3::from_array))
    }

    /// `[w, x, y, z]`; zero is refused.
    pub(crate) fn quaternion(&self, key: &str) -> Result<Option<DQuat>, Failure> {
        let Some([w, x, y, z]) = self.numbers::<4>(key)? else { return Ok(None) };
        if [w, x, y, z] == [0.0; 4] {
            return Err(self.fault(key, "[0, 0, 0, 0] has no direction"));
        }
        Ok(Some(DQuat::from_xyzw(x, y, z, w)))
    }

    /// Three rows.
    pub(crate) fn matrix(&self, key: &str) -> Result<Option<DMat3>, Failure> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let row = |row: &Value| -> Option<DVec3> {
            let numbers: Option<Vec<f64>> = row.as_array()?.iter().map(number).collect();
            numbers?.try_into().ok().map(DVec3::from_array)
        };
        let rows: Option<Vec<DVec3>> = value.as_array().and_then(|rows| rows.iter().map(row).collect());
        match rows.as_deref() {
            Some([x, y, z]) => Ok(Some(DMat3::from_cols(*x, *y, *z).transpose())),
            _ => {
                Err(self.fault(key, format!("{} should be three rows of three finite numbers", short(value))))
            }
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64().filter(|number| number.is_finite())
}
