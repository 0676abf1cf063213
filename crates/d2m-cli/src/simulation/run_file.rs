//! The lines of a run file: every number with the digits that give its bits back. (They are packed where they are written: `output`.)

use d2m::motion::ConstantTwist;
use d2m_dynamics::{BodyId, ContactImpulse, Segment, Simulation};
use glam::{DMat3, DVec3};
use serde_json::json;
use std::fmt::Write;

/// The first line.
pub(crate) fn header(scene: &str, names: &[String], simulation: &Simulation, ids: &[BodyId]) -> String {
    let rows = |m: DMat3| m.transpose().to_cols_array_2d();
    let bodies: Vec<_> = names
        .iter()
        .zip(ids)
        .map(|(name, &id)| match simulation.mass_properties(id) {
            Some(p) => {
                json!({"name": name, "mass": p.mass, "center": p.center.to_array(), "inertia": rows(p.inertia)})
            }
            None => json!({"name": name, "mass": null, "center": simulation.center(id).to_array(), "inertia": null}),
        })
        .collect();
    format!("{}\n", json!({"scene": scene, "bodies": bodies}))
}

/// What the line of a segment holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Line {
    /// All bodies: the first one.
    First,
    /// The bodies whose motion changed.
    Later,
    /// All bodies, at a time between the segments that were certified: for viewing.
    Thinned,
}

/// Appends the line of a segment.
pub(crate) fn segment(out: &mut String, segment: &Segment, names: &[String], line: Line, wall: f64) {
    let _ = write!(out, "{{\"t0\":{:?},\"t1\":{:?}", segment.start, segment.end);
    if line == Line::Thinned {
        out.push_str(",\"thinned\":true");
    }
    if line == Line::Later {
        out.push_str(",\"changed\":[");
        for (k, (id, flight)) in segment.changed.iter().enumerate() {
            let _ = write!(out, "{}[{},", if k > 0 { "," } else { "" }, id.index());
            body(out, flight, segment.start);
            out.push(']');
        }
    } else {
        out.push_str(",\"bodies\":[");
        for (k, (_, flight)) in segment.changed.iter().enumerate() {
            out.push_str(if k > 0 { "," } else { "" });
            body(out, flight, segment.start);
        }
    }
    out.push_str("],\"contacts\":[");
    for (k, c) in segment.contacts.iter().enumerate() {
        out.push_str(if k > 0 { "," } else { "" });
        contact(out, c, names);
    }
    let _ = writeln!(out, "],\"skipped\":{:?},\"wall\":{wall:?}}}", segment.skipped);
}

fn body(out: &mut String, flight: &ConstantTwist, start: f64) {
    debug_assert_eq!(flight.reference_time().to_bits(), start.to_bits());
    let q = flight.orientation();
    out.push_str("{\"x\":");
    vector(out, flight.position());
    let _ = write!(out, ",\"q\":[{:?},{:?},{:?},{:?}],\"v\":", q.w, q.x, q.y, q.z);
    vector(out, flight.linear_velocity());
    out.push_str(",\"w\":");
    vector(out, flight.angular_velocity());
    out.push('}');
}

fn contact(out: &mut String, contact: &ContactImpulse, names: &[String]) {
    let name = |id: BodyId| json!(names[id.index()]);
    let _ = write!(out, "{{\"a\":{},\"b\":{},\"point\":", name(contact.a), name(contact.b));
    vector(out, contact.point);
    out.push_str(",\"normal\":");
    vector(out, contact.normal);
    out.push_str(",\"impulse\":");
    vector(out, contact.impulse);
    out.push('}');
}

fn vector(out: &mut String, v: DVec3) {
    let _ = write!(out, "[{:?},{:?},{:?}]", v.x, v.y, v.z);
}
