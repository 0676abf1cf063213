//! The pairs of a scene that are ignored, by names of bodies or groups.

use super::SceneBody;
use crate::failure::Failure;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// One entry of `ignore`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Ignored {
    /// Two bodies by number.
    Pair(usize, usize),
    /// All pairs of bodies of two groups, which may be the same.
    Groups(String, String),
    /// A body and all bodies of a group.
    BodyAndGroup(usize, String),
}

/// What names stand for.
pub(crate) struct Names<'a> {
    bodies: BTreeMap<&'a str, usize>,
    groups: BTreeSet<&'a str>,
}

impl<'a> Names<'a> {
    pub(crate) fn new(bodies: &'a [SceneBody]) -> Self {
        Self {
            bodies: bodies.iter().enumerate().map(|(index, body)| (body.name.as_str(), index)).collect(),
            groups: bodies.iter().filter_map(|body| body.group.as_deref()).collect(),
        }
    }

    /// Reads one entry; a name that a body and a group share is the body's.
    pub(crate) fn ignored(&self, place: &str, value: &Value) -> Result<Ignored, Failure> {
        let words = value.as_array().map(|list| list.iter().map(Value::as_str).collect::<Vec<_>>());
        let Some([Some(a), Some(b)]) = words.as_deref() else {
            return Err(Failure::at(place, format!("{value} is not a pair of names")));
        };
        for name in [a, b] {
            if !self.bodies.contains_key(name) && !self.groups.contains(name) {
                return Err(Failure::at(place, format!("{name:?} is the name of no body and of no group")));
            }
        }
        self.pair(place, a, b)
    }

    /// What two names of the scene stand for; one body twice is no pair.
    pub(crate) fn pair(&self, place: &str, a: &str, b: &str) -> Result<Ignored, Failure> {
        Ok(match (self.bodies.get(a), self.bodies.get(b)) {
            (Some(a_body), Some(b_body)) if a_body == b_body => {
                return Err(Failure::at(place, format!("{a:?} twice is one body, and no pair")));
            }
            (Some(&a), Some(&b)) => Ignored::Pair(a, b),
            (Some(&body), None) => Ignored::BodyAndGroup(body, b.to_owned()),
            (None, Some(&body)) => Ignored::BodyAndGroup(body, a.to_owned()),
            (None, None) => Ignored::Groups(a.to_owned(), b.to_owned()),
        })
    }
}
