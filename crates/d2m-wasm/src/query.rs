//! The queries, from texts to JSON: everything but the boundary to JavaScript.

use crate::clock::timed;
use crate::options::{Options, StartChoice};
use crate::pose::{read_motion, read_pose};
use d2m::bvh::{self, MeshTree, Moving, Posed, Solid, StartState, TimeOfContact, Window};
use d2m::motion::{AnyMotion, RigidMotion};
use d2m::verify::{DEFAULT_STEPS, Verdict, Verifier};
use d2m_io::{
    answer_lines, clearance_fields, contact_fields, distance_fields, joined_verdict, proven_spans,
    put_verdict, query_fault, start_in_json,
};
use serde_json::{Value, json};

/// A body as JavaScript gives it: its tree, and its motion or pose as text.
#[derive(Clone, Copy)]
pub(crate) struct Given<'s> {
    pub(crate) tree: &'s MeshTree,
    pub(crate) motion: &'s str,
}

/// Two moving bodies, checked.
struct Pair<'s> {
    trees: [&'s MeshTree; 2],
    motions: [AnyMotion; 2],
    solids: [Solid; 2],
    window: Window,
}

impl<'s> Pair<'s> {
    fn new([a, b]: [Given<'s>; 2], options: &Options) -> Result<Self, String> {
        let window = options.window()?;
        let motions = [
            read_motion("motion of A", a.motion, window, a.tree)?,
            read_motion("motion of B", b.motion, window, b.tree)?,
        ];
        let solids = [options.solid("A", a.tree)?, options.solid("B", b.tree)?];
        Ok(Self { trees: [a.tree, b.tree], motions, solids, window })
    }

    fn motions(&self) -> [&dyn RigidMotion; 2] {
        self.motions.each_ref().map(|motion| motion as &dyn RigidMotion)
    }

    fn moving(&self) -> [Moving<'_>; 2] {
        let [a, b] = self.motions();
        [
            Moving::new(self.trees[0], a).with_solid(self.solids[0]),
            Moving::new(self.trees[1], b).with_solid(self.solids[1]),
        ]
    }

    fn clearance(&self, options: &Options) -> Result<bvh::Clearance, String> {
        let [a, b] = self.moving();
        bvh::clearance(a, b, self.window, &options.of_clearance())
            .map_err(|error| query_fault(&error, self.motions(), self.window))
    }

    /// Adds to an answer whether the verifier proves it again, if that is wanted.
    fn put_proof(
        &self,
        options: &Options,
        answer: &mut Value,
        prove: impl FnOnce(&Verifier, &[Moving<'_>; 2]) -> Verdict,
    ) -> Result<(), String> {
        if options.verify {
            let [a, b] = self.trees.map(MeshTree::mesh);
            let verifier = Verifier::try_new(a, b).map_err(|error| format!("verify: {error}"))?;
            put_verdict(&prove(&verifier, &self.moving()), answer);
        }
        Ok(())
    }

    fn triangles(&self) -> Value {
        json!(self.trees.map(|tree| tree.mesh().triangle_count()))
    }
}

/// As `d2m toc --json` answers, with the words of `d2m view`.
pub(crate) fn time_of_contact(bodies: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse("timeOfContact", &["accuracy", "resolution"])?;
    let pair = Pair::new(bodies, &options)?;
    let query = options.query();
    let [a, b] = pair.moving();
    let is_leaving = options.start == Some(StartChoice::Leave);
    let (found, microseconds) = timed(|| {
        if is_leaving {
            bvh::departure(a, b, pair.window, &query).map(|found| (found.answer, Some(found)))
        } else {
            bvh::time_of_contact(a, b, pair.window, &query).map(|answer| (answer, None))
        }
    });
    let (verdict, departure) = found.map_err(|error| query_fault(&error, pair.motions(), pair.window))?;
    let clearance = match verdict {
        TimeOfContact::Separated if options.clearance => Some(pair.clearance(&options)?),
        _ => None,
    };
    let mut answer = contact_fields(&verdict, pair.window);
    let mut put = |key: &str, value: Value| answer.insert(key.to_owned(), value);
    put("microseconds", json!(microseconds));
    put("window", json!([pair.window.start(), pair.window.end()]));
    put("solid", json!(pair.solids == [Solid::Filled; 2]));
    put("solids", json!(pair.solids.map(|solid| solid == Solid::Filled)));
    put("min_separation", json!(query.min_separation));
    put("triangles", pair.triangles());
    if let Some(found) = &clearance {
        put("clearance", json!([found.lower, found.upper]));
    }
    if let Some(found) = &departure {
        put("left", json!(found.left));
        put("start", json!(start_in_json(found.start)));
        put("start_proven", json!(found.start != StartState::Undecided));
    }
    let words = answer_lines(&verdict, pair.window, &query, clearance.as_ref());
    put("headline", json!(words.headline));
    put("facts", json!(words.lines));
    // What is let go is in contact for some time, which these words do not know.
    if departure.is_none() {
        let spans = proven_spans(&verdict, pair.window);
        put("spans", spans.iter().map(d2m_io::ProvenSpan::to_json).collect());
    }
    let mut answer = Value::Object(answer);
    pair.put_proof(&options, &mut answer, |verifier, bodies| {
        let window = pair.window;
        let first = match &departure {
            Some(found) => verifier.departure(bodies, window, &query, found, DEFAULT_STEPS),
            None => verifier.time_of_contact(bodies, window, &query, &verdict, DEFAULT_STEPS),
        };
        let wanted = options.of_clearance();
        let nearest =
            clearance.map(|found| verifier.clearance(bodies, window, &wanted, &found, DEFAULT_STEPS));
        joined_verdict(std::iter::once(first).chain(nearest))
    })?;
    Ok(answer)
}

/// As `d2m spans --json` answers.
pub(crate) fn contact_spans(bodies: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse("contactSpans", &["clearance", "accuracy", "start"])?;
    let pair = Pair::new(bodies, &options)?;
    let [a, b] = pair.moving();
    let resolution = options.resolution.unwrap_or(pair.window.default_resolution());
    let (found, microseconds) =
        timed(|| bvh::contact_spans(a, b, pair.window, &options.query(), Some(resolution)));
    let spans = found.map_err(|error| query_fault(&error, pair.motions(), pair.window))?;
    let mut answer = json!({
        "window": [pair.window.start(), pair.window.end()],
        "resolution": resolution,
        "spans": spans,
        "triangles": pair.triangles(),
        "microseconds": microseconds,
    });
    pair.put_proof(&options, &mut answer, |verifier, bodies| {
        verifier.contact_spans(bodies, pair.window, &options.query(), Some(resolution), &spans, DEFAULT_STEPS)
    })?;
    Ok(answer)
}

/// As `d2m clearance --json` answers.
pub(crate) fn clearance(bodies: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse("clearance", &["min_separation", "clearance", "start", "resolution"])?;
    let pair = Pair::new(bodies, &options)?;
    let (found, microseconds) = timed(|| pair.clearance(&options));
    let found = found?;
    let mut answer = clearance_fields(&found);
    answer["window"] = json!([pair.window.start(), pair.window.end()]);
    answer["triangles"] = pair.triangles();
    answer["microseconds"] = json!(microseconds);
    pair.put_proof(&options, &mut answer, |verifier, bodies| {
        verifier.clearance(bodies, pair.window, &options.of_clearance(), &found, DEFAULT_STEPS)
    })?;
    Ok(answer)
}

/// As `d2m distance --json` answers.
pub(crate) fn distance([a, b]: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse_all_but_solid("distance")?;
    let poses = [read_pose("pose of A", a.motion)?, read_pose("pose of B", b.motion)?];
    let solids = [options.solid("A", a.tree)?, options.solid("B", b.tree)?];
    let (found, microseconds) =
        timed(|| bvh::distance(Posed::new(a.tree, poses[0]), Posed::new(b.tree, poses[1]), solids));
    let mut answer = distance_fields(&found.map_err(|error| error.to_string())?);
    answer["solid"] = json!(solids == [Solid::Filled; 2]);
    answer["solids"] = json!(solids.map(|solid| solid == Solid::Filled));
    answer["triangles"] = json!([a.tree.mesh().triangle_count(), b.tree.mesh().triangle_count()]);
    answer["microseconds"] = json!(microseconds);
    Ok(answer)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each question with and without a proof: the same answer, and what became of it.
    #[test]
    fn answers_are_proven_again_where_that_is_wanted() {
        let tree = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1").unwrap());
        let given = |motion| Given { tree: &tree, motion };
        let through = [given(r#"{"x": [-4, 0, 0], "v": [8, 0, 0]}"#), given("{}")];
        let past = [given(r#"{"x": [-4, 3, 0], "v": [8, 0, 0], "w": [0, 0, 1]}"#), given("{}")];
        let lifted = [given(r#"{"x": [0, 2, 0], "v": [0, 1, 0]}"#), given("{}")];
        type Ask = fn([Given<'_>; 2], &str) -> Result<Value, String>;
        let asked: [(Ask, [Given<'_>; 2], &str); 6] = [
            (time_of_contact, through, ""),
            (time_of_contact, past, r#""clearance": true"#),
            (time_of_contact, lifted, r#""start": "leave""#),
            (contact_spans, through, r#""resolution": 0.01"#),
            (clearance, past, ""),
            (clearance, through, ""),
        ];
        for (ask, bodies, options) in asked {
            let comma = if options.is_empty() { "" } else { ", " };
            let mut plain = ask(bodies, &format!("{{{options}}}")).unwrap();
            let mut proven = ask(bodies, &format!(r#"{{{options}{comma}"verify": true}}"#)).unwrap();
            assert_eq!(proven["verified"], json!(true), "{options}: {proven}");
            assert!(proven["proof_steps"].as_u64().unwrap() > 0);
            for (answer, keys) in [
                (&mut plain, &["microseconds"][..]),
                (&mut proven, &["microseconds", "verified", "proof_steps"]),
            ] {
                for key in keys {
                    assert!(answer.as_object_mut().unwrap().remove(*key).is_some(), "{key}");
                }
            }
            assert_eq!(plain, proven);
        }
    }

    /// A cube that lies on another one and is lifted, and one that flies through it, by what a page would write.
    #[test]
    fn what_touches_is_let_go_and_spans_are_told() {
        let tree = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1").unwrap());
        let bodies = |motion| [Given { tree: &tree, motion }, Given { tree: &tree, motion: "{}" }];
        let lifted = bodies(r#"{"x": [0, 2, 0], "v": [0, 1, 0]}"#);
        let plain = time_of_contact(lifted, "{}").unwrap();
        assert_eq!((&plain["status"], &plain["toc"]), (&json!("contact"), &json!(0.0)));
        let leaving = time_of_contact(lifted, r#"{"start": "leave"}"#).unwrap();
        assert_eq!((&leaving["status"], &leaving["start"]), (&json!("separated"), &json!("touching")));
        assert!(leaving["left"][1].as_f64().unwrap() < 1e-3 && leaving.get("spans").is_none(), "{leaving}");

        let through = bodies(r#"{"x": [-4, 0, 0], "v": [8, 0, 0]}"#);
        let spans = contact_spans(through, "{}").unwrap();
        let status: Vec<&Value> = spans["spans"].as_array().unwrap().iter().map(|s| &s["status"]).collect();
        assert_eq!(status, ["clear", "contact", "clear"]);
        assert_eq!(spans["resolution"], json!(1e-6));
        assert!((spans["spans"][1]["from"].as_f64().unwrap() - 0.25).abs() < 1e-5);
        for options in [r#"{"start": "leave"}"#, r#"{"resolution": 0}"#] {
            assert!(contact_spans(through, options).is_err(), "{options}");
        }
        assert!(time_of_contact(through, r#"{"start": "go"}"#).is_err());
        assert!(distance(through, r#"{"verify": true}"#).unwrap_err().contains("verify"));
        assert!(time_of_contact(through, r#"{"resolution": 1e-3}"#).is_err());
    }
}
