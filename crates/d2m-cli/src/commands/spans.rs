//! `d2m spans`: which times of a window are proven clear?

use super::scene_question::{SceneQuestion, is_scene, sizes_line_of};
use super::toc::{MovingPair, prove, read, with_proof};
use crate::arguments::{PairArguments, SpansArguments};
use crate::engine::number;
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::{print_answer, printable, short};
use crate::scene::{Scene, SceneBody};
use crate::sizes::sizes_line;
use crate::verification::{Bodies, Promise, Proof, joined};
use d2m::bvh::{ContactSpan, QueryOptions, SpanStatus, Start, TimeOfContact};
use d2m::{BodyId, PairSpans, join_spans};
use serde_json::{Value, json};
use std::fmt::Write;

/// Runs the command.
pub(crate) fn run(arguments: &SpansArguments) -> Result<Outcome, Failure> {
    let asked = &arguments.pair;
    let given = arguments.resolution.as_deref();
    let resolution = given.map(|text| number("--resolution", text, "a positive finite time", |t| t > 0.0));
    let resolution = resolution.transpose()?;
    if is_scene(asked) {
        return run_scene(asked, resolution);
    }
    let MovingPair { pair, motion_a, motion_b, window, travels } = read(asked)?;
    let spans = pair.spans([&motion_a, &motion_b], window, resolution)?;
    let resolution = resolution.unwrap_or(window.default_resolution());
    let ends = [window.start(), window.end()];
    let (text, json) = (to_text(&spans), spans.iter().map(to_json).collect::<Vec<Value>>());
    let promise = Promise::Spans { spans: spans.clone(), resolution };
    let proof = prove(asked, &pair, [&motion_a, &motion_b], window, &[promise])?;
    print_answer(&if asked.json {
        let json = json!({ "window": ends, "resolution": resolution, "spans": json });
        with_proof(asked, format!("{json}\n"), proof)?
    } else {
        with_proof(asked, text, proof)? + &sizes_line(pair.sizes(), Some(travels))
    })?;
    Ok(outcome_of(&spans).reported(asked.exit_status))
}

fn outcome_of(spans: &[ContactSpan]) -> Outcome {
    let has = |status: SpanStatus| spans.iter().any(|span| span.status == status);
    match (has(SpanStatus::Contact), has(SpanStatus::Undecided)) {
        (true, _) => Outcome::Contact,
        (false, true) => Outcome::Undecided,
        (false, false) => Outcome::Separated,
    }
}

/// The spans of all pairs of a scene together, and of each that is not clear all the time.
fn run_scene(asked: &PairArguments, resolution: Option<f64>) -> Result<Outcome, Failure> {
    let SceneQuestion { scene, world, options } = SceneQuestion::read(asked)?;
    let pairs = world.contact_spans(scene.window, resolution);
    let pairs = pairs.map_err(|error| Failure::at(&asked.a, scene.describe(error)))?;
    let resolution = resolution.unwrap_or(scene.window.default_resolution());
    let all = join_spans(scene.window, &pairs);
    let name = |id: BodyId| scene.bodies[id.index()].name.as_str();
    let list = |spans: &[ContactSpan]| spans.iter().map(to_json).collect::<Vec<Value>>();
    let proof = if asked.verify { Some(prove_scene(&scene, options, resolution, &pairs)?) } else { None };
    print_answer(&if asked.json {
        let of_pairs: Vec<Value> = pairs
            .iter()
            .map(|pair| json!({ "a": name(pair.a), "b": name(pair.b), "spans": list(&pair.spans) }))
            .collect();
        let ends = [scene.window.start(), scene.window.end()];
        let mut object =
            json!({ "window": ends, "resolution": resolution, "spans": list(&all), "pairs": of_pairs });
        if let Some(proof) = proof {
            proof.put(&mut object);
        }
        format!("{object}\n")
    } else {
        let mut text = to_text(&all);
        let shown = |id: BodyId| printable(name(id));
        for pair in &pairs {
            let _ = write!(text, "{} \u{2013} {}: {}", shown(pair.a), shown(pair.b), to_text(&pair.spans));
        }
        if let Some(proof) = proof {
            let _ = writeln!(text, "  verified    {}", proof.sentence());
        }
        text + &sizes_line_of(&scene)
    })?;
    Ok(outcome_of(&all).reported(asked.exit_status))
}

/// Proves the spans of all pairs again: those of the answer as they are, and that no other pair ever meets.
fn prove_scene(
    scene: &Scene,
    options: QueryOptions,
    resolution: f64,
    found: &[PairSpans],
) -> Result<Proof, Failure> {
    let bodies = Bodies::new(scene.bodies.iter().map(SceneBody::moving).collect())?;
    let of = |pair: &PairSpans| [pair.a.index(), pair.b.index()];
    let proofs = scene.pairs().into_iter().map(|[a, b]| {
        let options = scene.pair_options([a, b], options).with_start(Start::Report);
        match found.iter().find(|pair| of(pair) == [a, b] || of(pair) == [b, a]) {
            Some(pair) => bodies.prove_spans(of(pair), scene.window, &options, (&pair.spans, resolution)),
            None => bodies.prove([a, b], scene.window, &options, &TimeOfContact::Separated),
        }
    });
    Ok(joined(proofs))
}

fn word(status: SpanStatus) -> &'static str {
    match status {
        SpanStatus::Clear => "clear",
        SpanStatus::Contact => "contact",
        SpanStatus::Undecided => "undecided",
    }
}

fn to_json(span: &ContactSpan) -> Value {
    let mut object = json!({ "from": span.from, "to": span.to, "status": word(span.status) });
    if span.status == SpanStatus::Contact {
        object["tolerance"] = json!(span.tolerance);
    }
    object
}

fn to_text(spans: &[ContactSpan]) -> String {
    let mut text = format!("SPANS: {}\n", spans.len());
    for span in spans {
        // Writing to a string cannot fail.
        let _ =
            writeln!(text, "  {:<10} from {:<22} to {}", word(span.status), short(span.from), short(span.to));
    }
    text
}
