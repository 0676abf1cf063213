//! `d2m clearance`: how near do two moving meshes come?

use super::toc::{MovingPair, prove, read, refuse, with_proof};
use crate::arguments::ClearanceArguments;
use crate::engine::{ClearanceAnswer, Pair, number};
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::print_answer;
use crate::output::short;
use crate::report::{body_lines, duration, feature_field, feature_sentence, microseconds, vector};
use crate::sizes::sizes_line;
use crate::verification::Promise;
use d2m::bvh::{ClearanceStatus, Window};
use serde_json::json;
use std::fmt::Write;

/// Runs the command.
pub(crate) fn run(arguments: &ClearanceArguments) -> Result<Outcome, Failure> {
    let accuracy = number("--accuracy", &arguments.accuracy, "a positive finite number", |r| r > 0.0)?;
    let toc = &arguments.toc;
    refuse(toc, "clearance")?;
    if toc.query.min_separation.is_some() {
        return Err(Failure::at("--min-separation", "d2m clearance has no such option"));
    }
    let MovingPair { pair, motion_a, motion_b, window, travels, .. } = read(toc)?;
    let answer = pair.clearance([&motion_a, &motion_b], window, Some(accuracy))?;
    let promise = Promise::Clearance { found: answer.found, accuracy: Some(accuracy) };
    let proof = prove(toc, &pair, [&motion_a, &motion_b], window, &[promise])?;
    print_answer(&if toc.json {
        with_proof(toc, to_json(&pair, window, &answer), proof)?
    } else {
        with_proof(toc, to_text(&pair, window, &answer), proof)? + &sizes_line(pair.sizes(), Some(travels))
    })?;
    Ok(Outcome::from(answer.found.status).reported(toc.exit_status))
}

fn to_json(pair: &Pair, window: Window, ClearanceAnswer { found, took }: &ClearanceAnswer) -> String {
    let status = match found.status {
        ClearanceStatus::Clear => "clear",
        ClearanceStatus::Contact => "contact",
        ClearanceStatus::Undecided => "undecided",
    };
    let object = json!({
        "status": status,
        "clearance": [found.lower, found.upper],
        "time": found.time,
        "point_a": found.point_a.to_array(),
        "point_b": found.point_b.to_array(),
        "normal": found.normal.to_array(),
        "feature": feature_field(found.feature),
        "triangle_a": found.triangle_a,
        "triangle_b": found.triangle_b,
        "tolerance": found.tolerance,
        "window": [window.start(), window.end()],
        "triangles": [pair.a.mesh().triangle_count(), pair.b.mesh().triangle_count()],
        "microseconds": microseconds(*took),
    });
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
