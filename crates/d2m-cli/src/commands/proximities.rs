//! `d2m proximities`: where are two bodies at rest locally closest?

use crate::arguments::ProximitiesArguments;
use crate::engine::number;
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::{print, short};
use crate::posed::PosedBodies;
use crate::report::{duration, feature_field, feature_sentence, microseconds, vector};
use d2m::bvh::{Proximity, ProximityOptions, QueryError, proximities_with, reduce_proximities};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// A person is shown so many.
const MOST_SHOWN: usize = 40;

/// What was found of surfaces that are apart.
struct Found {
    /// How many there were before they were reduced.
    count: usize,
    kept: Vec<Proximity>,
}

/// Runs the command.
pub(crate) fn run(arguments: &ProximitiesArguments) -> Result<Outcome, Failure> {
    let positive = |value: f64| value >= 0.0;
    let margin = number("--margin", &arguments.margin, "a distance that is not negative", positive)?;
    let slack = match &arguments.cone_slack {
        Some(text) => number("--cone-slack", text, "the sine of an angle, not negative", positive)?,
        None => 0.0,
    };
    let reduce = match &arguments.reduce {
        Some(text) => Some(number("--reduce", text, "an angle that is not negative", positive)?),
        None => None,
    };
    let bodies = PosedBodies::new(&arguments.posed)?;
    let [a, b] = &bodies.both;
    // Rounded bodies are nearer than their meshes.
    let [radius_a, radius_b] = bodies.radii;
    let options = ProximityOptions::new((margin + (radius_a + radius_b)).next_up()).with_cone_slack(slack);
    let start = Instant::now();
    let found = match proximities_with(a.posed(), b.posed(), &options) {
        Ok(all) => {
            let rounded = all.iter().map(|near| near.with_radii(bodies.radii));
            let all: Vec<Proximity> = rounded.filter(|near| near.distance <= margin).collect();
            let count = all.len();
            let kept = match reduce {
                Some(angle) => reduce_proximities(&all, angle),
                None => all,
            };
            Some(Found { count, kept })
        }
        Err(QueryError::NotApart { .. }) => None,
        Err(error) => return Err(bodies.failure(error)),
    };
    let took = start.elapsed();
    print(&if arguments.posed.json {
        to_json(&bodies, margin, found.as_ref(), took)
    } else {
        to_text(&bodies, margin, found.as_ref(), took)
    })?;
    let outcome = if found.is_some() { Outcome::Separated } else { Outcome::Contact };
    Ok(outcome.reported(arguments.posed.exit_status))
}

fn to_text(bodies: &PosedBodies, margin: f64, found: Option<&Found>, took: Duration) -> String {
    let within = format!("within {}", short(margin));
    let (mut text, shown) = match found {
        None => {
            ("CONTACT: the surfaces are not apart, so there are no closest features\n".to_owned(), &[][..])
        }
        Some(Found { count: 0, .. }) => (format!("NONE {within}\n"), &[][..]),
        Some(Found { count, kept }) if kept.len() == *count => {
            (format!("{count} {within}\n"), &kept[..kept.len().min(MOST_SHOWN)])
        }
        Some(Found { count, kept }) => {
            (format!("{} of {count} {within}\n", kept.len()), &kept[..kept.len().min(MOST_SHOWN)])
        }
    };
    // Writing to a string cannot fail.
    for proximity in shown {
        let [a, b, n] = [proximity.point_a, proximity.point_b, proximity.normal].map(vector);
        let _ = writeln!(text, "  {}: {}", short(proximity.distance), feature_sentence(proximity.feature));
        let _ = writeln!(text, "    from {a} to {b}, normal {n}");
    }
    if let Some(more) = found.map(|found| found.kept.len() - shown.len()).filter(|more| *more > 0) {
        let _ = writeln!(text, "  and {more} more, all of them with --json");
    }
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}");
    };
    bodies.lines(&mut line);
    line("took", duration(took));
    text + &bodies.sizes_line()
}

fn to_json(bodies: &PosedBodies, margin: f64, found: Option<&Found>, took: Duration) -> String {
    let kept = found.map_or(&[][..], |found| &found.kept);
    let list: Vec<Value> = kept
        .iter()
        .map(|proximity| {
            json!({
                "distance": proximity.distance,
                "normal": proximity.normal.to_array(),
                "point_a": proximity.point_a.to_array(),
                "point_b": proximity.point_b.to_array(),
                "feature": feature_field(proximity.feature),
                "triangle_a": proximity.triangle_a,
                "triangle_b": proximity.triangle_b,
                "tilt": proximity.tilt,
            })
        })
        .collect();
    let object = json!({
        "status": if found.is_some() { "separated" } else { "contact" },
        "margin": margin,
        "found": found.map(|found| found.count),
        "proximities": list,
        "triangles": bodies.both.each_ref().map(|body| body.tree.mesh().triangle_count()),
        "microseconds": microseconds(took),
    });
    format!("{object}\n")
}
