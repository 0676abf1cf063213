//! Answers as text, CSV fields and JSON.

use crate::arguments::FurtherArguments;
use crate::engine::{Answer, Further, Pair};
use crate::output::short;
use d2m::bvh::{Contact, Evidence, Solid, StartState, TimeOfContact, Window};
use d2m::feature::FeaturePair;
use glam::DVec3;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// One word for a verdict.
pub(crate) fn status(verdict: &TimeOfContact) -> &'static str {
    match verdict {
        TimeOfContact::Separated => "separated",
        TimeOfContact::Contact(_) => "contact",
        TimeOfContact::Undecided { .. } => "undecided",
    }
}

/// A feature pair without commas: `vertex_face:V:F`, `face_vertex:F:V`, `edge_edge:P-Q:R-S`, A's part first.
pub(crate) fn feature_field(feature: FeaturePair) -> String {
    match feature {
        FeaturePair::VertexFace { vertex, face } => format!("vertex_face:{vertex}:{face}"),
        FeaturePair::FaceVertex { face, vertex } => format!("face_vertex:{face}:{vertex}"),
        FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] } => format!("edge_edge:{p}-{q}:{r}-{s}"),
    }
}

pub(crate) fn feature_sentence(feature: FeaturePair) -> String {
    match feature {
        FeaturePair::VertexFace { vertex, face } => format!("vertex {vertex} of A against face {face} of B"),
        FeaturePair::FaceVertex { face, vertex } => format!("face {face} of A against vertex {vertex} of B"),
        FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] } => {
            format!("edge {p}\u{2013}{q} of A against edge {r}\u{2013}{s} of B")
        }
    }
}

pub(crate) fn start_word(start: StartState) -> &'static str {
    match start {
        StartState::Apart => "apart",
        StartState::Touching => "touching",
        StartState::Overlapping => "overlapping",
        StartState::Contained => "contained",
        StartState::Undecided => "undecided",
    }
}

/// The same in JSON, whose words are those of the formats: bodies that are not proven to touch, with a direction along which they part, are
/// `overlapping`, and `start_proven` says whether that is more than a word.
pub(crate) fn start_in_json(start: StartState) -> &'static str {
    start_word(if start == StartState::Undecided { StartState::Overlapping } else { start })
}

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

/// With so many digits after the point, or in powers of ten where that would fill the line or show nothing.
fn fixed(number: f64, digits: usize) -> String {
    match number.abs() {
        size if size >= 1e9 || (0.0 < size && size < 1e-5) => format!("{number:.digits$e}"),
        _ => format!("{number:.digits$}"),
    }
}

pub(crate) fn vector(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(|number| fixed(number, 9));
    format!("({x}, {y}, {z})")
}

/// The answer for a person.
pub(crate) fn text(pair: &Pair, window: Window, answer: &Answer) -> String {
    let further = &answer.further;
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
    };
    let [start, end] = [window.start(), window.end()].map(short);
    let headline = match &answer.verdict {
        TimeOfContact::Separated => {
            line("certified", format!("no contact anywhere from {start} to {end}"));
            if let Some(found) = &further.clearance {
                let [lower, upper] = [found.lower, found.upper].map(short);
                line("clearance", format!("[{lower}, {upper}] at t = {}", short(found.time)));
            }
            "SEPARATED".to_owned()
        }
        TimeOfContact::Undecided { clear_until } => {
            line("certified", format!("no contact from {start} until {}", short(*clear_until)));
            let then =
                "the budget or the time was used up (or the cap that holds without them); more may decide";
            line("then", then.to_owned());
            "UNDECIDED".to_owned()
        }
        TimeOfContact::Contact(contact) => {
            contact_lines(&mut line, contact, pair, window.start());
            format!("CONTACT at t = {}", short(contact.time_lo))
        }
    };
    if let Some(departure) = &further.departure {
        let left = match departure.left {
            Some(left) => format!("in contact at {}, proven apart at {}", short(left.lo), short(left.hi)),
            None => "never proven apart in the window".to_owned(),
        };
        line("start", format!("{}; {left}", start_word(departure.start)));
    }
    body_lines(&mut line, pair);
    let solid = match pair.solids {
        [Solid::Filled, Solid::Filled] => "filled solids",
        [Solid::Surface, Solid::Surface] => "surfaces only",
        [Solid::Filled, Solid::Surface] => "filled solid A, surface of B",
        [Solid::Surface, Solid::Filled] => "surface of A, filled solid B",
    };
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
        line(label, format!("{} · {} triangles", body.name, count(body.mesh().triangle_count())));
    }
}

/// What is proven of the meeting itself.
pub(crate) fn evidence_sentence(contact: &Contact, min_separation: f64) -> String {
    let distance = short(min_separation);
    match contact.evidence {
        Evidence::Crossing => "crossing: the bodies share a point at one of these times".to_owned(),
        Evidence::Near if min_separation > 0.0 => {
            format!("near: at one of these times the distance is at most {distance} + tolerance")
        }
        Evidence::Near => "near: at one of these times the distance is at most the tolerance".to_owned(),
        _ => "early: only that nothing meets before is proven; there may be no contact at all".to_owned(),
    }
}

fn contact_lines(line: &mut dyn FnMut(&str, String), contact: &Contact, pair: &Pair, window_start: f64) {
    let width = contact.time_hi - contact.time_lo;
    line("time", format!("[{}, {}]  width {width:.2e}", short(contact.time_lo), short(contact.time_hi)));
    match contact.start {
        StartState::Apart if pair.min_separation > 0.0 => {
            let distance = short(pair.min_separation);
            line(
                "certified",
                format!("further apart than {distance} before and at the first of these times"),
            );
        }
        StartState::Apart => {
            line("certified", "no contact before; disjoint at the first of these times".to_owned());
        }
        // A later keyframe begins with the bodies within the tolerance of each other.
        start if contact.time_lo > window_start => {
            line("certified", format!("no contact before; {} at this time", start_word(start)));
        }
        start => line("certified", format!("in contact from the start of the window: {}", start_word(start))),
    }
    line("evidence", evidence_sentence(contact, pair.min_separation));
    // Bodies that overlap from the start have no separation, no normal and no closing speed.
    let apart = matches!(contact.start, StartState::Apart | StartState::Touching);
    if apart {
        let raised = match pair.tolerance {
            Some(given) if contact.tolerance > given => {
                format!(" (raised from {given:.2e}: the rounding of these lengths and times allows no less)")
            }
            _ => String::new(),
        };
        let left =
            format!("{:.4e} left then, tolerance {:.2e}{raised}", contact.separation, contact.tolerance);
        line("separation", left);
        line("normal", format!("{} from A to B", vector(contact.normal)));
    }
    for (label, point, triangle, weights) in [
        ("point on A", contact.point_a, contact.triangle_a, contact.barycentric_a),
        ("point on B", contact.point_b, contact.triangle_b, contact.barycentric_b),
    ] {
        if contact.start == StartState::Contained {
            continue;
        }
        let [p, q, r] = weights;
        line(label, format!("{} · triangle {triangle} at {p:.6}, {q:.6}, {r:.6}", vector(point)));
    }
    if contact.start != StartState::Contained {
        line("features", feature_sentence(contact.feature));
    }
    if apart {
        line("closing", format!("{} along the normal, per unit of time", fixed(contact.closing_speed, 6)));
    }
}

/// The answer for a program.
pub(crate) fn json(pair: &Pair, window: Window, answer: &Answer) -> String {
    let further = &answer.further;
    let mut object = json!({
        "status": status(&answer.verdict),
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
    // The fields of the API under their own names, and the bracket and the feature as in result files.
    if let Ok(Value::Object(fields)) = serde_json::to_value(answer.verdict) {
        // When bodies had parted is said below, where it was asked.
        for (key, value) in fields.into_iter().filter(|(key, _)| key != "left") {
            put(&key, value);
        }
    }
    if let Some(clearance) = &further.clearance {
        put("clearance", json!([clearance.lower, clearance.upper]));
    }
    if let Some(departure) = &further.departure {
        put("left", json!(departure.left));
    }
    let start = further.start(&answer.verdict);
    put("start", json!(start_in_json(start)));
    put("start_proven", json!(start != StartState::Undecided));
    match &answer.verdict {
        TimeOfContact::Separated => {}
        TimeOfContact::Undecided { clear_until } => put("toc", json!(clear_until)),
        TimeOfContact::Contact(contact) => {
            put("toc", json!(contact.time_lo));
            put("toc_hi", json!(contact.time_hi));
            put("time", json!([contact.time_lo, contact.time_hi]));
            put("point", json!(contact.point_a.to_array()));
            put("feature", json!(feature_field(contact.feature)));
        }
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
