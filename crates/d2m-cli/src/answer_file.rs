//! An answer as `d2m toc --json`, `d2m clearance --json` or `d2m spans --json` printed it, read again. What contradicts itself, or is about other bodies, is refused by name: the
//! verifier judges what an answer promises, so everything else that it says is compared here.

use crate::arguments::StartChoice;
use crate::engine::Pair;
use crate::failure::{Failure, parse_json};
use crate::verification::{PairVerifier, Promise};
use d2m::bvh::{ContactSpan, Solid, StartState, TimeOfContact, Window};
use d2m::feature::FeaturePair;
use d2m::motion::RigidMotion;
use d2m::motion::serde_object::Object;
use d2m_io::{clearance_fields, contact_fields, start_in_json};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// What an answer says besides its verdict.
#[derive(Deserialize)]
struct About {
    status: String,
    window: [f64; 2],
    min_separation: f64,
    triangles: [usize; 2],
    solid: Option<bool>,
    solids: [bool; 2],
    toc: Option<f64>,
    toc_hi: Option<f64>,
    time: Option<[f64; 2]>,
    point: Option<[f64; 3]>,
    start: Option<StartState>,
    start_proven: Option<bool>,
    left: Option<[f64; 2]>,
    clearance: Option<[f64; 2]>,
    clearance_status: Option<String>,
    clearance_time: Option<f64>,
}

/// What any answer may say of its proof.
const OF_PROOFS: [&str; 4] = ["verified", "proof_steps", "why", "counterexample"];

/// What answers say besides the verdict, the least distance or the spans.
const BESIDES_CONTACT: [&str; 10] = [
    "microseconds",
    "window",
    "min_separation",
    "triangles",
    "solid",
    "solids",
    "left",
    "clearance",
    "clearance_status",
    "clearance_time",
];
const BESIDES_CLEARANCE: [&str; 3] = ["microseconds", "window", "triangles"];
const BESIDES_SPANS: [&str; 3] = ["window", "resolution", "spans"];

impl About {
    /// How the bodies are said to stand at the start: where that is not proven, a word stands for what is not decided.
    fn start(&self) -> Option<StartState> {
        if self.start_proven == Some(false) { Some(StartState::Undecided) } else { self.start }
    }
}

/// What the answer has to be about.
pub(crate) struct Question<'a> {
    pub(crate) motions: [&'a dyn RigidMotion; 2],
    pub(crate) window: Window,
    /// None: as the answer says.
    pub(crate) start: Option<StartChoice>,
}

/// Reads an answer of `d2m toc`, `d2m clearance` or `d2m spans` and holds it against the bodies and the window: all that it promises.
pub(crate) fn read_answer(
    place: &str,
    bytes: &[u8],
    verifier: &PairVerifier<'_>,
    question: &Question<'_>,
) -> Result<Vec<Promise>, Failure> {
    let Question { motions, window, start } = *question;
    let mut object: Value = parse_json(place, bytes)?;
    if !object.is_object() {
        let expected =
            "expected an object with keys, as d2m toc, d2m clearance and d2m spans print it with --json";
        return Err(Failure::at(place, expected));
    }
    let is_leaving = object.get("left").is_some();
    if start.is_some_and(|start| is_leaving != (start == StartChoice::Leave)) {
        let found = if is_leaving { "leave" } else { "report" };
        return Err(Failure::at(place, format!("start: it is an answer to --start {found}")));
    }
    let file = AnswerFile { place, verifier, pair: verifier.pair, window };
    if let Some(text) = object.get("feature").and_then(Value::as_str) {
        let feature = parse_feature(text).ok_or_else(|| Failure::at(place, format!("feature: {text:?}")))?;
        object["feature"] = serde_json::to_value(feature).map_err(|error| Failure::at(place, error))?;
    }
    if object.get("spans").is_some() {
        file.spans(&object)
    } else if object.get("clearance").is_some() && object.get("min_separation").is_none() {
        file.clearance(object)
    } else {
        let about: About = parse_json(place, bytes)?;
        file.time_of_contact(object, &about, motions)
    }
}

/// Where an answer stands, and what it has to be about.
struct AnswerFile<'a> {
    place: &'a str,
    verifier: &'a PairVerifier<'a>,
    pair: &'a Pair,
    window: Window,
}

impl AnswerFile<'_> {
    fn fault(&self, what: &str, why: impl std::fmt::Display) -> Failure {
        Failure::at(self.place, format!("{what}: {why}"))
    }

    fn check(&self, what: &str, holds: bool) -> Result<(), Failure> {
        if holds { Ok(()) } else { Err(self.fault(what, "not an answer to this question")) }
    }

    /// Nothing is said that no answer of its kind says: nobody would have compared it.
    fn check_keys(&self, object: &Value, known: &Value, besides: &[&str]) -> Result<(), Failure> {
        let is_known =
            |key: &str| known.get(key).is_some() || besides.contains(&key) || OF_PROOFS.contains(&key);
        let mut keys = object.as_object().into_iter().flat_map(serde_json::Map::keys);
        let other = keys.find(|key| !is_known(key));
        other.map_or(Ok(()), |key| Err(self.fault(key, "no answer of this kind says this")))
    }

    /// A field, by its name.
    fn field<T: DeserializeOwned>(&self, object: &Value, name: &str) -> Result<T, Failure> {
        let value = object.get(name).cloned().unwrap_or(Value::Null);
        serde_json::from_value(value).map_err(|error| self.fault(name, error))
    }

    fn spans(&self, object: &Value) -> Result<Vec<Promise>, Failure> {
        self.check_keys(object, &Value::Null, &BESIDES_SPANS)?;
        let window: [f64; 2] = self.field(object, "window")?;
        self.check("window", window == [self.window.start(), self.window.end()])?;
        let spans: Vec<Object<ContactSpan>> = self.field(object, "spans")?;
        let spans = spans.into_iter().map(|Object(span)| span).collect();
        Ok(vec![Promise::Spans { spans, resolution: self.field(object, "resolution")? }])
    }

    fn clearance(&self, mut object: Value) -> Result<Vec<Promise>, Failure> {
        let [lower, upper]: [f64; 2] = self.field(&object, "clearance")?;
        let window: [f64; 2] = self.field(&object, "window")?;
        self.check("window", window == [self.window.start(), self.window.end()])?;
        let triangles: [usize; 2] = self.field(&object, "triangles")?;
        let counts = [&self.pair.a, &self.pair.b].map(|body| body.mesh().triangle_count());
        self.check("triangles", triangles == counts)?;
        let said = object.clone();
        (object["lower"], object["upper"]) = (json!(lower), json!(upper));
        let found = serde_json::from_value(object).map_err(|error| self.fault("clearance", error))?;
        self.check_keys(&said, &clearance_fields(&found), &BESIDES_CLEARANCE)?;
        Ok(vec![Promise::Clearance { found, accuracy: None }])
    }

    fn time_of_contact(
        &self,
        mut object: Value,
        about: &About,
        motions: [&dyn RigidMotion; 2],
    ) -> Result<Vec<Promise>, Failure> {
        let (pair, window) = (self.pair, self.window);
        self.check("window", about.window == [window.start(), window.end()])?;
        self.check("min_separation", about.min_separation == pair.min_separation)?;
        let counts = [&pair.a, &pair.b].map(|body| body.mesh().triangle_count());
        self.check("triangles", about.triangles == counts)?;
        let solids = pair.solids.map(|solid| solid == Solid::Filled);
        self.check("solids", about.solids == solids)?;
        self.check("solid", about.solid.is_none_or(|said| said == (solids == [true; 2])))?;
        if !["contact", "separated", "undecided"].contains(&about.status.as_str()) {
            return Err(self.fault("status", format!("{:?} is none of an answer", about.status)));
        }
        // Bodies that never part have left at no time.
        let is_leaving = object.get("left").is_some();
        let left = about.left.map(|[lo, hi]| json!([lo, hi]));
        let start = about.start().unwrap_or(StartState::Apart);
        let is_word = about.start.is_none_or(|word| start_in_json(word) == start_in_json(start));
        self.check("start", is_word)?;
        // After bodies have parted they are apart; what is said of the start is said of the window.
        if left.is_some() {
            object["start"] = json!(StartState::Apart);
        } else if about.start.is_some() {
            object["start"] = json!(start);
        }
        let said = object.clone();
        let answer: TimeOfContact =
            serde_json::from_value(object).map_err(|error| self.fault(&about.status, error))?;
        self.check_keys(&said, &Value::Object(contact_fields(&answer, window)), &BESIDES_CONTACT)?;
        // Of a contact it is a part of what is promised.
        if !is_leaving && answer.contact().is_none() {
            let known = contact_fields(&answer, window);
            self.check("start", about.start.is_none_or(|said| known["start"] == start_in_json(said)))?;
            self.check("start_proven", about.start_proven.is_none_or(|said| known["start_proven"] == said))?;
        }
        match &answer {
            TimeOfContact::Separated => self.check("toc", about.toc.is_none() && about.time.is_none())?,
            TimeOfContact::Undecided { clear_until } => self.check("toc", about.toc == Some(*clear_until))?,
            TimeOfContact::Contact(contact) => {
                self.check("toc", about.toc == Some(contact.time_lo))?;
                self.check("toc_hi", about.toc_hi == Some(contact.time_hi))?;
                self.check("time", about.time == Some([contact.time_lo, contact.time_hi]))?;
                self.check("point", about.point == Some(contact.point_a.to_array()))?;
                if let Some(field) = self.verifier.witness_fault(motions, window, contact) {
                    return Err(self.fault(field, "it is not that of these triangles at that time"));
                }
            }
        }
        let mut promises = vec![if is_leaving {
            let departure = json!({ "start": start, "left": left, "answer": answer });
            let departure = serde_json::from_value(departure).map_err(|error| self.fault("left", error))?;
            Promise::Departure(departure)
        } else {
            Promise::Contact(answer)
        }];
        if let Some([lower, upper]) = about.clearance {
            self.check("clearance", answer.is_separated())?;
            let in_window = |time: f64| window.start() <= time && time <= window.end();
            self.check("clearance_time", about.clearance_time.is_none_or(in_window))?;
            promises.push(Promise::Apart { lower, upper, time: about.clearance_time });
        }
        let word = about.clearance_status.as_deref();
        let is_apart =
            word.is_none_or(|word| about.clearance.is_some() && ["clear", "undecided"].contains(&word));
        self.check("clearance_status", is_apart)?;
        Ok(promises)
    }
}

/// A feature pair as it is printed.
fn parse_feature(text: &str) -> Option<FeaturePair> {
    let parts: Vec<&str> = text.split(':').collect();
    let [kind, first, last] = parts.as_slice() else { return None };
    let edge = |text: &str| {
        let (p, q) = text.split_once('-')?;
        Some([p.parse().ok()?, q.parse().ok()?])
    };
    Some(match *kind {
        "vertex_face" => FeaturePair::VertexFace { vertex: first.parse().ok()?, face: last.parse().ok()? },
        "face_vertex" => FeaturePair::FaceVertex { face: first.parse().ok()?, vertex: last.parse().ok()? },
        "edge_edge" => FeaturePair::EdgeEdge { edge_a: edge(first)?, edge_b: edge(last)? },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::feature_field;

    #[test]
    fn features_are_read_as_they_are_written() {
        for feature in [
            FeaturePair::VertexFace { vertex: 3, face: 40 },
            FeaturePair::FaceVertex { face: 7, vertex: 0 },
            FeaturePair::EdgeEdge { edge_a: [1, 2], edge_b: [30, 4] },
        ] {
            assert_eq!(parse_feature(&feature_field(feature)), Some(feature));
        }
        for text in
            ["", "vertex_face:1", "edge_edge:1:2", "face:1:2", "vertex_face:-1:2", "edge_edge:1-2:3-4:5"]
        {
            assert_eq!(parse_feature(text), None, "{text}");
        }
    }
}
