//! `d2m collide`: do two bodies at rest share a point?

use crate::arguments::CollideArguments;
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::print_answer;
use crate::posed::PosedBodies;
use crate::report::{duration, microseconds, solids_words, start_in_json, start_word, vector};
use d2m::bvh::{Solid, StartState, collide, distance, try_colliding_pair};
use serde_json::json;
use std::fmt::Write;
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(arguments: &CollideArguments) -> Result<Outcome, Failure> {
    let bodies = PosedBodies::new(&arguments.posed)?;
    let solids = bodies.solids(arguments.solid)?;
    let [a, b] = &bodies.both;
    let start = Instant::now();
    let rounded = bodies.radii != [0.0; 2];
    let is_near = rounded || collide(a.posed(), b.posed(), solids).map_err(|error| bodies.failure(error))?;
    let took = start.elapsed();
    // How bodies that are not apart meet: decided by the distance, which finds the normal of those that touch. It decides everything of
    // bodies with radii.
    let met = if is_near {
        let found = distance(a.posed(), b.posed(), solids).map_err(|error| bodies.failure(error))?;
        Some(found.with_radii(bodies.radii)).filter(|met| !rounded || met.state != StartState::Apart)
    } else {
        None
    };
    let is_contact = met.is_some();
    let triangles = match &met {
        Some(met) if rounded => {
            (met.state != StartState::Contained).then_some([met.triangle_a, met.triangle_b])
        }
        Some(_) => try_colliding_pair(a.posed(), b.posed()).map_err(|error| bodies.failure(error))?,
        None => None,
    };
    let state = met.as_ref().map_or(StartState::Apart, |met| met.state);
    let normal = met.as_ref().filter(|met| met.state == StartState::Touching).map(|met| met.normal);
    print_answer(&if arguments.posed.json {
        let object = json!({
            "start": start_in_json(state),
            "start_proven": state != StartState::Undecided,
            "normal": normal.map(|normal| normal.to_array()),
            "status": if is_contact { "contact" } else { "separated" },
            "triangle_a": triangles.map(|[a, _]| a),
            "triangle_b": triangles.map(|[_, b]| b),
            "contained": is_contact && triangles.is_none(),
            "solid": solids == [Solid::Filled; 2],
            "solids": solids.map(|solid| solid == Solid::Filled),
            "triangles": bodies.both.each_ref().map(|body| body.tree.mesh().triangle_count()),
            "microseconds": microseconds(took),
        });
        format!("{object}\n")
    } else {
        let mut text = if is_contact { "CONTACT\n" } else { "SEPARATED\n" }.to_owned();
        let mut line = |label: &str, value: String| {
            let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
        };
        match (is_contact, triangles) {
            (false, _) => line("certified", "no point in common".to_owned()),
            (true, Some([a, b])) => {
                line("triangles", format!("{a} of A and {b} of B are not proven apart"));
            }
            (true, None) => {
                line("contained", "the surfaces are apart and one body is inside the other".to_owned());
            }
        }
        if is_contact {
            line("state", start_word(state).to_owned());
        }
        if let Some(normal) = normal {
            line("normal", format!("{} from A to B", vector(normal)));
        }
        bodies.lines(&mut line);
        line("query", solids_words(solids).to_owned());
        line("took", duration(took));
        text + &bodies.sizes_line()
    })?;
    let outcome = if is_contact { Outcome::Contact } else { Outcome::Separated };
    Ok(outcome.reported(arguments.posed.exit_status))
}
