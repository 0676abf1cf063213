//! `d2m clearance`: how near do two moving meshes come?

use super::scene_question::{SceneQuestion, is_scene, sizes_line_of};
use super::toc::{MovingPair, prove, read, with_proof};
use crate::arguments::ClearanceArguments;
use crate::engine::{ClearanceAnswer, MIN_SEPARATION, Pair, number};
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::{print_answer, printable, short};
use crate::report::{body_lines, clearance_words, duration, feature_sentence, microseconds, vector};
use crate::scene::{Scene, SceneBody};
use crate::sizes::sizes_line;
use crate::verification::{Bodies, Promise, Proof, joined};
use d2m::bvh::{Clearance, ClearanceOptions, ClearanceStatus, Window};
use d2m::{BodyId, PairClearance, WorldError};
use d2m_io::clearance_fields;
use serde_json::json;
use std::fmt::Write;

/// Runs the command.
pub(crate) fn run(arguments: &ClearanceArguments) -> Result<Outcome, Failure> {
    let accuracy = number("--accuracy", &arguments.accuracy, "a positive finite number", |r| r > 0.0)?;
    let asked = &arguments.pair;
    if asked.query.min_separation.is_some() {
        return Err(Failure::at(
            "--min-separation",
            "d2m clearance has no such option: compare the distance that it answers",
        ));
    }
    if is_scene(asked) {
        return run_scene(arguments, accuracy);
    }
    if arguments.below.is_some() {
        return Err(Failure::at("--below", "it is for scenes: two meshes are one pair"));
    }
    let MovingPair { pair, motion_a, motion_b, window, travels } = read(asked)?;
    let answer = pair.clearance([&motion_a, &motion_b], window, Some(accuracy))?;
    let promise = Promise::Clearance { found: answer.found, accuracy: Some(accuracy) };
    let proof = prove(asked, &pair, [&motion_a, &motion_b], window, &[promise])?;
    print_answer(&if asked.json {
        with_proof(asked, to_json(&pair, window, &answer), proof)?
    } else {
        with_proof(asked, to_text(&pair, window, &answer), proof)? + &sizes_line(pair.sizes(), Some(travels))
    })?;
    Ok(Outcome::from(answer.found.status).reported(asked.exit_status))
}

/// The nearest pair of a scene, and all that are near.
fn run_scene(arguments: &ClearanceArguments, accuracy: f64) -> Result<Outcome, Failure> {
    let asked = &arguments.pair;
    let below = arguments.below.as_ref().map(|text| number("--below", text, MIN_SEPARATION, |d| d >= 0.0));
    let below = below.transpose()?;
    let SceneQuestion { scene, world, options } = SceneQuestion::read(asked)?;
    let named = |error: WorldError| Failure::at(&asked.a, scene.describe(error));
    let mut wanted = ClearanceOptions::default().with_accuracy(accuracy).with_budget(options.budget);
    wanted.tolerance = options.tolerance;
    let nearest = world.nearest_pair(scene.window, &wanted).map_err(named)?;
    let near = below.map(|limit| world.clearances_below(limit, scene.window, &wanted).map_err(named));
    let near = near.transpose()?;
    let name = |id: BodyId| scene.bodies[id.index()].name.as_str();
    let object = |found: &PairClearance| {
        let mut object = clearance_fields(&found.clearance);
        (object["a"], object["b"]) = (json!(name(found.a)), json!(name(found.b)));
        object
    };
    let proof = if asked.verify {
        Some(prove_scene(&scene, &wanted, nearest.as_ref(), below.zip(near.as_deref()))?)
    } else {
        None
    };
    let status = nearest.as_ref().map_or(ClearanceStatus::Clear, |found| found.clearance.status);
    print_answer(&if asked.json {
        // Of a scene without pairs nothing comes near.
        let none = json!({ "status": "clear", "clearance": null, "a": null, "b": null });
        let mut answer = nearest.as_ref().map_or(none, object);
        answer["window"] = json!([scene.window.start(), scene.window.end()]);
        if let (Some(limit), Some(near)) = (below, &near) {
            answer["below"] = json!(limit);
            answer["pairs"] = near.iter().map(object).collect();
        }
        if let Some(proof) = proof {
            proof.put(&mut answer);
        }
        format!("{answer}\n")
    } else {
        let line = |found: &PairClearance| {
            let Clearance { lower, upper, time, status, .. } = found.clearance;
            let (enclosure, time) = (clearance_words([lower, upper], status), short(time));
            let [a, b] = [found.a, found.b].map(|id| printable(name(id)));
            format!("{a} \u{2013} {b}: {enclosure} at t = {time}\n")
        };
        let mut text = match &nearest {
            None => "CLEARANCE: no pair is of interest\n".to_owned(),
            Some(found) => {
                let word = match status {
                    ClearanceStatus::Clear => "CLEARANCE",
                    ClearanceStatus::Contact => "CONTACT",
                    ClearanceStatus::Undecided => "UNDECIDED",
                };
                format!("{word} {}", line(found))
            }
        };
        if let (Some(limit), Some(near)) = (below, &near) {
            let sure = near.iter().filter(|found| found.clearance.upper <= limit).count();
            let open = match near.len() - sure {
                0 => String::new(),
                open => format!(", {open} more may"),
            };
            let _ = writeln!(text, "  {sure} of all pairs come within {}{open}", short(limit));
            text.extend(near.iter().map(|found| format!("  {}", line(found))));
        }
        if let Some(proof) = proof {
            let _ = writeln!(text, "  verified    {}", proof.sentence());
        }
        text + &sizes_line_of(&scene)
    })?;
    Ok(Outcome::from(status).reported(asked.exit_status))
}

/// Proves the answer about a scene again: the clearances that it states, and that all other pairs stay at least as far apart as the
/// nearest one does, and as the limit where one was given.
fn prove_scene(
    scene: &Scene,
    options: &ClearanceOptions,
    nearest: Option<&PairClearance>,
    near: Option<(f64, &[PairClearance])>,
) -> Result<Proof, Failure> {
    let bodies = Bodies::new(scene.bodies.iter().map(SceneBody::moving).collect())?;
    let (limit, listed) = near.unwrap_or((0.0, &[]));
    let least = nearest.map_or(limit, |found| found.clearance.lower);
    let stated: Vec<&PairClearance> = nearest.into_iter().chain(listed).collect();
    let of = |found: &PairClearance| [found.a.index(), found.b.index()];
    let of_stated = stated
        .iter()
        .map(|&found| bodies.prove_clearance(of(found), scene.window, options, &found.clearance));
    let is = |found: &PairClearance, [a, b]: [usize; 2]| of(found) == [a, b] || of(found) == [b, a];
    let others = scene.pairs().into_iter().filter(|&pair| !listed.iter().any(|found| is(found, pair)));
    let others = others.filter(|&pair| !nearest.is_some_and(|found| is(found, pair)));
    // Of bodies that meet nothing follows for the others.
    let distance = least.max(limit);
    let others = others.filter(|_| distance > 0.0);
    let apart = others.map(|pair| bodies.prove_apart(pair, scene.window, distance));
    Ok(joined(of_stated.chain(apart)))
}

fn to_json(pair: &Pair, window: Window, ClearanceAnswer { found, took }: &ClearanceAnswer) -> String {
    let mut object = clearance_fields(found);
    object["window"] = json!([window.start(), window.end()]);
    object["triangles"] = json!([pair.a.mesh().triangle_count(), pair.b.mesh().triangle_count()]);
    object["microseconds"] = json!(microseconds(*took));
    format!("{object}\n")
}

fn to_text(pair: &Pair, window: Window, ClearanceAnswer { found, took }: &ClearanceAnswer) -> String {
    let [lower, upper, time] = [found.lower, found.upper, found.time].map(short);
    let mut text = match found.status {
        ClearanceStatus::Clear => format!("CLEARANCE {upper} at t = {time}\n"),
        ClearanceStatus::Contact => format!("CONTACT at t = {time}\n"),
        ClearanceStatus::Undecided => format!("UNDECIDED: at most {upper}, at t = {time}\n"),
    };
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
    };
    line("certified", format!("least distance in [{lower}, {upper}]"));
    line("point on A", format!("{} · triangle {}", vector(found.point_a), found.triangle_a));
    line("point on B", format!("{} · triangle {}", vector(found.point_b), found.triangle_b));
    line("normal", format!("{} from A to B", vector(found.normal)));
    line("features", feature_sentence(found.feature));
    body_lines(&mut line, pair);
    let [start, end] = [window.start(), window.end()].map(short);
    line("query", format!("window [{start}, {end}]"));
    line("took", duration(*took));
    text
}
