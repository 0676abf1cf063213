//! What single pairs of a scene have of their own.

use crate::scene_fault::{check_not_negative, fault, keys_of};
use crate::{IoError, UniqueKeys};
use d2m_bvh::Start;
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// An entry of the list `pairs` of a scene file: two bodies, and what they have instead of what the scene says.
///
/// ```
/// use d2m_bvh::Start;
/// use d2m_io::SceneFile;
/// let scene = SceneFile::parse(br#"{"bodies": [{"name": "table", "mesh": "shape:box"}, {"name": "cup", "mesh": "shape:box"}],
///     "pairs": [{"a": "cup", "b": "table", "start": "leave"}]}"#)?;
/// let pair = &scene.pairs[0];
/// assert_eq!((pair.a.as_str(), pair.start, pair.min_separation), ("cup", Some(Start::Leave), None));
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ScenePair {
    /// The name of a body.
    pub a: String,
    /// That of another one.
    pub b: String,
    /// What counts of the two if they are in contact at the start.
    pub start: Option<Start>,
    /// The distance at which these two count as in contact, at least zero.
    pub min_separation: Option<f64>,
    /// Coefficient of restitution of the two, for simulations; from 0 to 1.
    pub restitution: Option<f64>,
    /// Coulomb's coefficient of friction of the two, for simulations; at least zero.
    pub friction: Option<f64>,
}

/// The keys of an entry.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PairForm {
    a: String,
    b: String,
    #[serde(default)]
    start: Option<Value>,
    #[serde(default)]
    min_separation: Option<f64>,
    #[serde(default)]
    restitution: Option<f64>,
    #[serde(default)]
    friction: Option<f64>,
}

impl ScenePair {
    /// Reads the list `pairs` of a scene with bodies of these names.
    ///
    /// # Errors
    /// [`IoError::Content`] with the number of the entry, key and value: a name that is no body's, a body with itself, a pair twice, a
    /// word that is no start, a number out of its range.
    pub fn parse_all(list: Vec<UniqueKeys>, names: &BTreeSet<&str>) -> Result<Vec<Self>, IoError> {
        let mut pairs = Vec::with_capacity(list.len());
        let mut seen: BTreeMap<[String; 2], usize> = BTreeMap::new();
        for (index, UniqueKeys(value)) in list.into_iter().enumerate() {
            let place = format!("pairs, entry {index}");
            let pair = Self::parse(value, &place, names)?;
            let mut key = [pair.a.clone(), pair.b.clone()];
            key.sort();
            if let Some(earlier) = seen.insert(key, index) {
                let reason = format!("{:?} and {:?} are the pair of entry {earlier} too", pair.a, pair.b);
                return Err(fault(place, reason));
            }
            pairs.push(pair);
        }
        Ok(pairs)
    }

    fn parse(value: Value, place: &str, names: &BTreeSet<&str>) -> Result<Self, IoError> {
        let form: PairForm = keys_of(place, value)?;
        for (key, name) in [("a", &form.a), ("b", &form.b)] {
            if !names.contains(name.as_str()) {
                return Err(fault(format!("{place}, {key}"), format!("{name:?} is the name of no body")));
            }
        }
        if form.a == form.b {
            return Err(fault(place, format!("{:?} is no pair with itself", form.a)));
        }
        let key = |key: &str| format!("{place}, {key}");
        let start = parse_start(form.start.as_ref()).map_err(|reason| fault(key("start"), reason))?;
        for (name, what, value) in
            [("min_separation", "distance", form.min_separation), ("friction", "coefficient", form.friction)]
        {
            value.map_or(Ok(()), |value| check_not_negative(&key(name), what, value))?;
        }
        if let Some(value) = form.restitution.filter(|value| !(0.0..=1.0).contains(value)) {
            return Err(fault(key("restitution"), format!("{value:?} is not from 0 to 1")));
        }
        let PairForm { a, b, min_separation, restitution, friction, .. } = form;
        Ok(Self { a, b, start, min_separation, restitution, friction })
    }
}

/// The value of a key `start`: `"report"` or `"leave"`; `None` without a value. An error is a sentence with the value.
pub(crate) fn parse_start(value: Option<&Value>) -> Result<Option<Start>, String> {
    match value {
        None => Ok(None),
        Some(Value::String(word)) if word == "report" => Ok(Some(Start::Report)),
        Some(Value::String(word)) if word == "leave" => Ok(Some(Start::Leave)),
        Some(other) => Err(format!("{other} is neither \"report\" nor \"leave\"")),
    }
}
