//! Answers as text, CSV fields and JSON.

use crate::arguments::FurtherArguments;
use crate::engine::{Answer, Further, Pair};
use crate::output::{printable, short};
use d2m::bvh::{Solid, StartState, TimeOfContact, Window};
use d2m_io::{AnswerLines, answer_lines, contact_fields};
pub(crate) use d2m_io::{
    clearance_word, clearance_words, evidence_sentence, feature_field, feature_sentence, start_in_json,
    start_word, vector_words as vector, verdict_word as status,
};
use glam::DVec3;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// Microseconds to three digits after the point: clocks have no more.
pub(crate) fn microseconds(time: Duration) -> f64 {
    time.as_nanos() as f64 / 1e3
}

/// A duration as a person reads it.
pub(crate) fn duration(time: Duration) -> String {
    match microseconds(time) {
        m if m < 1e3 => format!("{m:.1} µs"),
        m if m < 1e6 => format!("{:.2} ms", m / 1e3),
        m => format!("{:.2} s", m / 1e6),
    }
}

/// A number with thin groups of thousands.
fn count(number: usize) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join(" ")
}

/// What counts as a body, for a person.
pub(crate) const fn solids_words(solids: [Solid; 2]) -> &'static str {
    match solids {
        [Solid::Filled, Solid::Filled] => "filled solids",
        [Solid::Surface, Solid::Surface] => "surfaces only",
        [Solid::Filled, Solid::Surface] => "filled solid A, surface of B",
        [Solid::Surface, Solid::Filled] => "surface of A, filled solid B",
    }
}

/// The answer for a person.
pub(crate) fn text(pair: &Pair, window: Window, answer: &Answer) -> String {
    let further = &answer.further;
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
    };
    let [start, end] = [window.start(), window.end()].map(short);
    // What was in contact at the start is certified from when it was proven apart.
    let left = further.departure.as_ref().filter(|departure| departure.start != StartState::Apart);
    let left = left.and_then(|departure| Window::try_new(departure.left?.hi, window.end()).ok());
    let AnswerLines { headline, lines, .. } =
        answer_lines(&answer.verdict, left.unwrap_or(window), pair.options(), further.clearance.as_ref());
    for [label, value] in lines {
        line(&label, value);
    }
    if let Some(departure) = &further.departure {
        let left = match departure.left {
            Some(left) => format!("in contact at {}, proven apart at {}", short(left.lo), short(left.hi)),
            None if answer.verdict.contact().is_some() => "never proven apart in the window".to_owned(),
            None => "not proven to have parted".to_owned(),
        };
        line("start", format!("{}; {left}", start_word(departure.start)));
    }
    body_lines(&mut line, pair);
    let solid = solids_words(pair.solids);
    let nearer = match pair.min_separation {
        0.0 => String::new(),
        distance => format!(" · a distance of {} is contact", short(distance)),
    };
    line("query", format!("window [{start}, {end}] · {solid}{nearer}"));
    line(
        "took",
        format!("{} (after {} to build the trees)", duration(answer.took), duration(pair.preparation)),
    );
    format!("{headline}\n{text}")
}

/// The names of the bodies, with their sizes.
pub(crate) fn body_lines(line: &mut dyn FnMut(&str, String), pair: &Pair) {
    for (label, body) in [("A", &pair.a), ("B", &pair.b)] {
        line(label, format!("{} · {} triangles", printable(&body.name), count(body.mesh().triangle_count())));
    }
}

/// The answer for a program.
pub(crate) fn json(pair: &Pair, window: Window, answer: &Answer) -> String {
    let further = &answer.further;
    let mut object = json!({
        "microseconds": microseconds(answer.took),
        "window": [window.start(), window.end()],
        "solid": pair.solids == [Solid::Filled; 2],
        "solids": pair.solids.map(|solid| solid == Solid::Filled),
        "min_separation": pair.min_separation,
        "triangles": [pair.a.mesh().triangle_count(), pair.b.mesh().triangle_count()],
    });
    let mut put = |key: &str, value: Value| {
        object[key] = value;
    };
    for (key, value) in contact_fields(&answer.verdict, window) {
        put(&key, value);
    }
    if let Some(clearance) = &further.clearance {
        put("clearance", json!([clearance.lower, clearance.upper]));
        put("clearance_status", json!(clearance_word(clearance.status)));
        put("clearance_time", json!(clearance.time));
    }
    if let Some(departure) = &further.departure {
        put("left", json!(departure.left));
        put("start", json!(start_in_json(departure.start)));
        put("start_proven", json!(departure.start != StartState::Undecided));
    }
    format!("{object}\n")
}

/// The columns of every result CSV.
const CSV_COLUMNS: &str = "trial,status,toc,toc_hi,separation,microseconds,normal_x,normal_y,normal_z,point_x,point_y,point_z,feature,triangle_a,triangle_b,evidence,tolerance";

/// The header of a result CSV.
pub(crate) fn csv_header(wanted: FurtherArguments) -> String {
    let left = if wanted.leaves() { ",left_lo,left_hi" } else { "" };
    let clearance = if wanted.clearance { ",clearance_lo,clearance_hi" } else { "" };
    format!("{CSV_COLUMNS}{left}{clearance}\n")
}

/// One line of a result CSV: numbers with 17 digits; what a verdict does not have is empty.
pub(crate) fn csv_line(trial: usize, answer: &Answer, wanted: FurtherArguments) -> String {
    let microseconds = microseconds(answer.took);
    let status = status(&answer.verdict);
    let mut line = match &answer.verdict {
        TimeOfContact::Separated => format!("{trial},{status},inf,inf,,{microseconds:.3},,,,,,,,,,,"),
        TimeOfContact::Undecided { clear_until } => {
            format!("{trial},{status},{clear_until:.16e},inf,,{microseconds:.3},,,,,,,,,,,")
        }
        TimeOfContact::Contact(contact) => {
            let three = |v: DVec3| format!("{:.16e},{:.16e},{:.16e}", v.x, v.y, v.z);
            format!(
                "{trial},{status},{:.16e},{:.16e},{:.16e},{microseconds:.3},{},{},{},{},{},{},{:.16e}",
                contact.time_lo,
                contact.time_hi,
                contact.separation,
                three(contact.normal),
                three(contact.point_a),
                feature_field(contact.feature),
                contact.triangle_a,
                contact.triangle_b,
                contact.evidence,
                contact.tolerance,
            )
        }
    };
    let mut put = |bounds: Option<[f64; 2]>| {
        line += &bounds.map_or_else(|| ",,".to_owned(), |[lo, hi]| format!(",{lo:.16e},{hi:.16e}"));
    };
    let Further { clearance, departure } = &answer.further;
    if wanted.leaves() {
        put(departure.and_then(|found| found.left).map(Into::into));
    }
    if wanted.clearance {
        put(clearance.map(|found| [found.lower, found.upper]));
    }
    line.push('\n');
    line
}
