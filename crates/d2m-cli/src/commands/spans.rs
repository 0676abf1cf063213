//! `d2m spans`: which times of a window are proven clear?

use super::toc::{MovingPair, prove, read, refuse, with_proof};
use crate::arguments::SpansArguments;
use crate::engine::number;
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::print_answer;
use crate::output::short;
use crate::sizes::sizes_line;
use crate::verification::Promise;
use d2m::bvh::{ContactSpan, SpanStatus};
use serde_json::{Value, json};
use std::fmt::Write;

/// The resolution as a part of the window.
const RESOLUTION: f64 = 1e-6;

/// Runs the command.
pub(crate) fn run(arguments: &SpansArguments) -> Result<Outcome, Failure> {
    let toc = &arguments.toc;
    refuse(toc, "spans")?;
    let given = arguments.resolution.as_deref();
    let resolution = given.map(|text| number("--resolution", text, "a positive finite time", |t| t > 0.0));
    let resolution = resolution.transpose()?;
    let MovingPair { pair, motion_a, motion_b, window, travels, .. } = read(toc)?;
    let resolution = resolution.unwrap_or(RESOLUTION * window.length());
    let spans = pair.spans([&motion_a, &motion_b], window, resolution)?;
    let ends = [window.start(), window.end()];
    let (text, json) = (to_text(&spans), spans.iter().map(to_json).collect::<Vec<Value>>());
    let promise = Promise::Spans { spans: spans.clone(), resolution };
    let proof = prove(toc, &pair, [&motion_a, &motion_b], window, &[promise])?;
    print_answer(&if toc.json {
        let json = json!({ "window": ends, "resolution": resolution, "spans": json });
        with_proof(toc, format!("{json}\n"), proof)?
    } else {
        with_proof(toc, text, proof)? + &sizes_line(pair.sizes(), Some(travels))
    })?;
    let has = |status: SpanStatus| spans.iter().any(|span| span.status == status);
    let outcome = match (has(SpanStatus::Contact), has(SpanStatus::Undecided)) {
        (true, _) => Outcome::Contact,
        (false, true) => Outcome::Undecided,
        (false, false) => Outcome::Separated,
    };
    Ok(outcome.reported(toc.exit_status))
}

fn word(status: SpanStatus) -> &'static str {
    match status {
        SpanStatus::Clear => "clear",
        SpanStatus::Contact => "contact",
        SpanStatus::Undecided => "undecided",
    }
}

fn to_json(span: &ContactSpan) -> Value {
    json!({ "from": span.from, "to": span.to, "status": word(span.status) })
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
