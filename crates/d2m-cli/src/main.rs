//! The d2m command: certified time of contact of two meshes from the command line.
//!
//! Exit codes: 0 answered, 2 bad usage, 3 bad input (with file, line, index and value on stderr); where `--exit-status` asks
//! for it 10 contact, 11 separated, 12 undecided.
#![forbid(unsafe_code)]

mod answer_file;
mod arguments;
mod commands;
mod engine;
mod failure;
mod inputs;
mod joint_turns;
mod let_go;
mod load;
mod mesh_library;
mod motion;
mod orientation;
mod outcome;
mod output;
mod partial;
mod posed;
mod report;
mod robot_path;
mod robot_scene;
mod scene;
mod simulation;
mod sizes;
mod travel;
mod trials;
mod unlike_sizes;
mod verification;
mod view;

use arguments::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use outcome::Outcome;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::try_parse().unwrap_or_else(|error| {
        for hint in window_hint(std::env::args()).into_iter().chain(pose_hint(std::env::args())) {
            output::note(&hint);
        }
        error.exit()
    });
    let outcome = match &arguments.command {
        Command::Toc(arguments) => commands::toc::run(arguments),
        Command::Spans(arguments) => commands::spans::run(arguments),
        Command::Clearance(arguments) => commands::clearance::run(arguments),
        Command::Verify(arguments) => commands::verify::run(arguments),
        Command::Batch(arguments) => commands::batch::run(arguments),
        Command::Features(arguments) => commands::features::run(arguments).map(Outcome::from),
        Command::Distance(arguments) => commands::distance::run(arguments),
        Command::Collide(arguments) => commands::collide::run(arguments),
        Command::Proximities(arguments) => commands::proximities::run(arguments),
        Command::Simulate(arguments) => commands::simulate::run(arguments).map(Outcome::from),
        Command::Scene(arguments) => commands::scene::run(arguments),
        Command::Robot(arguments) => commands::robot::run(arguments),
        Command::Info(arguments) => commands::info::run(arguments).map(Outcome::from),
        Command::Tree(arguments) => commands::tree::run(arguments).map(Outcome::from),
        Command::View(arguments) => commands::view::run(arguments).map(Outcome::from),
        Command::Demo => commands::demo::run().map(Outcome::from),
        Command::Completions(arguments) => commands::manual::completions(arguments).map(Outcome::from),
        Command::Man(arguments) => commands::manual::page(arguments).map(Outcome::from),
    };
    match outcome {
        Ok(outcome) => ExitCode::from(outcome.code()),
        // A reader that closed the pipe has what it wanted.
        Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Err(failure) => {
            output::note(&format!("d2m: {failure}"));
            ExitCode::from(3)
        }
    }
}

/// What someone means who writes `--window 0 1`.
fn window_hint(words: impl Iterator<Item = String>) -> Option<String> {
    let words: Vec<String> = words.collect();
    let two = words.windows(3).find(|three| {
        three[0] == "--window"
            && three[1..].iter().all(|word| word.trim_end_matches(',').parse::<f64>().is_ok())
    })?;
    let [start, end] = [&two[1], &two[2]].map(|word| word.trim_end_matches(','));
    Some(format!("d2m: --window takes both times in one word: --window {start},{end}"))
}

/// What someone means who gives a motion to a command of bodies at rest, or a pose to one of moving bodies.
fn pose_hint(words: impl Iterator<Item = String>) -> Option<String> {
    const AT_REST: [&str; 3] = ["distance", "collide", "proximities"];
    const MOVING: [&str; 5] = ["toc", "view", "clearance", "spans", "verify"];
    let words: Vec<String> = words.collect();
    let command = words.get(1)?.as_str();
    let (given, taken) = match command {
        _ if AT_REST.contains(&command) => ("--motion-", "--pose-"),
        _ if MOVING.contains(&command) => ("--pose-", "--motion-"),
        _ => return None,
    };
    let word = words.iter().find(|word| word.starts_with(given))?;
    let option = word.split('=').next().unwrap_or_default();
    let wanted = option.replacen(given, taken, 1);
    Some(format!("d2m: {command} takes {wanted}, not {option}"))
}
