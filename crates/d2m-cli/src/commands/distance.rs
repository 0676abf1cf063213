//! `d2m distance`: how far apart are two bodies at rest?

use crate::arguments::DistanceArguments;
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::{print_answer, short};
use crate::posed::PosedBodies;
use crate::report::{duration, microseconds, solids_words, start_word, vector};
use d2m::bvh::{Distance, Solid, StartState, distance};
use d2m_io::distance_fields;
use serde_json::json;
use std::fmt::Write;
use std::time::{Duration, Instant};

/// Runs the command.
pub(crate) fn run(arguments: &DistanceArguments) -> Result<Outcome, Failure> {
    let bodies = PosedBodies::new(&arguments.posed)?;
    let solids = bodies.solids(arguments.solid)?;
    let [a, b] = &bodies.both;
    let start = Instant::now();
    let found = distance(a.posed(), b.posed(), solids);
    let took = start.elapsed();
    let found = found.map_err(|error| bodies.failure(error))?.with_radii(bodies.radii);
    print_answer(&if arguments.posed.json {
        to_json(&bodies, solids, &found, took)
    } else {
        to_text(&bodies, solids, &found, took)
    })?;
    let outcome = if found.state == StartState::Apart { Outcome::Separated } else { Outcome::Contact };
    Ok(outcome.reported(arguments.posed.exit_status))
}

fn to_text(bodies: &PosedBodies, solids: [Solid; 2], found: &Distance, took: Duration) -> String {
    let mut text = match found.state {
        StartState::Apart => format!("DISTANCE {}\n", short(found.value)),
        state => format!("DISTANCE 0: {}\n", start_word(state)),
    };
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
    };
    let surfaces = if found.state == StartState::Contained { " (of the surfaces)" } else { "" };
    line("certified", format!("[{}, {}]{surfaces}", short(found.lower), short(found.upper)));
    line("point on A", format!("{} · triangle {}", vector(found.point_a), found.triangle_a));
    line("point on B", format!("{} · triangle {}", vector(found.point_b), found.triangle_b));
    if matches!(found.state, StartState::Apart | StartState::Touching) {
        line("normal", format!("{} from A to B", vector(found.normal)));
    }
    bodies.lines(&mut line);
    line("query", solids_words(solids).to_owned());
    line("took", duration(took));
    text + &bodies.sizes_line()
}

fn to_json(bodies: &PosedBodies, solids: [Solid; 2], found: &Distance, took: Duration) -> String {
    let mut object = distance_fields(found);
    object["solid"] = json!(solids == [Solid::Filled; 2]);
    object["solids"] = json!(solids.map(|solid| solid == Solid::Filled));
    object["triangles"] = json!(bodies.both.each_ref().map(|body| body.tree.mesh().triangle_count()));
    object["microseconds"] = json!(microseconds(took));
    format!("{object}\n")
}
