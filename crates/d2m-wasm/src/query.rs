//! The queries, from texts to JSON: everything but the boundary to JavaScript.

use crate::clock::timed;
use crate::options::Options;
use crate::pose::{read_motion, read_pose};
use d2m::bvh::{self, ClearanceOptions, MeshTree, Moving, Posed, Solid, TimeOfContact, Window};
use d2m::motion::{AnyMotion, RigidMotion};
use d2m_io::{answer_lines, clearance_fields, contact_fields, distance_fields, proven_spans, query_fault};
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
        let mut wanted = ClearanceOptions::default().with_budget(options.budget());
        wanted.tolerance = options.query().tolerance;
        wanted.accuracy = options.accuracy.unwrap_or(wanted.accuracy);
        let [a, b] = self.moving();
        bvh::clearance(a, b, self.window, &wanted)
            .map_err(|error| query_fault(&error, self.motions(), self.window))
    }

    fn triangles(&self) -> Value {
        json!(self.trees.map(|tree| tree.mesh().triangle_count()))
    }
}

/// As `d2m toc --json` answers, with the words of `d2m view`.
pub(crate) fn time_of_contact(bodies: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse("timeOfContact", &["accuracy"])?;
    let pair = Pair::new(bodies, &options)?;
    let query = options.query();
    let [a, b] = pair.moving();
    let (found, microseconds) = timed(|| bvh::time_of_contact(a, b, pair.window, &query));
    let verdict = found.map_err(|error| query_fault(&error, pair.motions(), pair.window))?;
    let clearance = match verdict {
        TimeOfContact::Separated if options.clearance => Some(pair.clearance(&options)?),
        _ => None,
    };
    let mut answer = contact_fields(&verdict);
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
    let words = answer_lines(&verdict, pair.window, &query, clearance.as_ref());
    put("headline", json!(words.headline));
    put("facts", json!(words.lines));
    let spans = proven_spans(&verdict, pair.window);
    put("spans", spans.iter().map(d2m_io::ProvenSpan::to_json).collect());
    Ok(Value::Object(answer))
}

/// As `d2m clearance --json` answers.
pub(crate) fn clearance(bodies: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    options.refuse("clearance", &["min_separation", "clearance"])?;
    let pair = Pair::new(bodies, &options)?;
    let (found, microseconds) = timed(|| pair.clearance(&options));
    let mut answer = clearance_fields(&found?);
    answer["window"] = json!([pair.window.start(), pair.window.end()]);
    answer["triangles"] = pair.triangles();
    answer["microseconds"] = json!(microseconds);
    Ok(answer)
}

/// As `d2m distance --json` answers.
pub(crate) fn distance([a, b]: [Given<'_>; 2], options: &str) -> Result<Value, String> {
    let options = Options::parse(options)?;
    let of_motions = ["window", "tolerance", "min_separation", "budget", "clearance", "accuracy"];
    options.refuse("distance", &of_motions)?;
    let poses = [read_pose("pose of A", a.motion)?, read_pose("pose of B", b.motion)?];
    let solids = [options.solid("A", a.tree)?, options.solid("B", b.tree)?];
    let solid = if solids == [Solid::Filled; 2] { Solid::Filled } else { Solid::Surface };
    let (found, microseconds) =
        timed(|| bvh::distance(Posed::new(a.tree, poses[0]), Posed::new(b.tree, poses[1]), solid));
    let mut answer = distance_fields(&found.map_err(|error| error.to_string())?);
    answer["solid"] = json!(solid == Solid::Filled);
    answer["triangles"] = json!([a.tree.mesh().triangle_count(), b.tree.mesh().triangle_count()]);
    answer["microseconds"] = json!(microseconds);
    Ok(answer)
}
