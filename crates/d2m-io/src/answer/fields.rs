//! Answers as JSON objects: what is stated of them wherever they are written.

use super::words::{clearance_word, feature_field, start_in_json, verdict_word};
use d2m_bvh::{Clearance, Distance, StartState, TimeOfContact, Window};
use serde_json::{Map, Value, json};

/// What is stated of a first contact: the fields of [`Contact`](d2m_bvh::Contact) under their own names, the time as `toc`, `toc_hi`
/// and `time`, the point and the feature pair as in result files, and how the bodies stand at the start of the window that was asked about.
/// (Bodies that are separated begin apart, and undecided ones where some of the window is proven free; else nothing is known of it.)
///
/// ```
/// use d2m_bvh::{TimeOfContact, Window};
/// let fields = d2m_io::contact_fields(&TimeOfContact::Undecided { clear_until: 0.5 }, Window::UNIT);
/// assert_eq!((&fields["status"], &fields["toc"], &fields["start"]), (&"undecided".into(), &0.5.into(), &"apart".into()));
/// let fields = d2m_io::contact_fields(&TimeOfContact::Undecided { clear_until: 0.0 }, Window::UNIT);
/// assert_eq!(fields["start_proven"], false);
/// ```
pub fn contact_fields(verdict: &TimeOfContact, window: Window) -> Map<String, Value> {
    let mut fields = match serde_json::to_value(verdict) {
        Ok(Value::Object(fields)) => fields,
        _ => Map::new(),
    };
    let mut put = |key: &str, value: Value| fields.insert(key.to_owned(), value);
    put("status", json!(verdict_word(verdict)));
    let mut start = StartState::Apart;
    match verdict {
        TimeOfContact::Separated => {}
        TimeOfContact::Undecided { clear_until } => {
            if *clear_until <= window.start() {
                start = StartState::Undecided;
            }
            put("toc", json!(clear_until));
        }
        TimeOfContact::Contact(contact) => {
            start = contact.start;
            put("toc", json!(contact.time_lo));
            put("toc_hi", json!(contact.time_hi));
            put("time", json!([contact.time_lo, contact.time_hi]));
            put("point", json!(contact.point_a.to_array()));
            put("feature", json!(feature_field(contact.feature)));
        }
    }
    put("start", json!(start_in_json(start)));
    put("start_proven", json!(start != StartState::Undecided));
    // When bodies had parted is stated where that was asked.
    fields.remove("left");
    fields
}

/// What is stated of a least distance.
///
/// ```
/// use d2m_bvh::{ClearanceOptions, MeshTree, Moving, Window, clearance};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let tree = MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1")?);
/// let away = ConstantTwist::REST.with_position(DVec3::X * 3.0);
/// let options = ClearanceOptions::default();
/// let rest = ConstantTwist::REST;
/// let found = clearance(Moving::new(&tree, &rest), Moving::new(&tree, &away), Window::UNIT, &options)?;
/// let fields = d2m_io::clearance_fields(&found);
/// assert_eq!(fields["status"], "clear");
/// assert!(fields["clearance"][0].as_f64().is_some_and(|distance| (distance - 1.0).abs() < 1e-5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn clearance_fields(found: &Clearance) -> Value {
    json!({
        "status": clearance_word(found.status),
        "clearance": [found.lower, found.upper],
        "time": found.time,
        "point_a": found.point_a.to_array(),
        "point_b": found.point_b.to_array(),
        "normal": found.normal.to_array(),
        "feature": feature_field(found.feature),
        "triangle_a": found.triangle_a,
        "triangle_b": found.triangle_b,
        "tolerance": found.tolerance,
    })
}

/// What is stated of a distance of bodies at rest.
///
/// ```
/// use d2m_bvh::{MeshTree, Posed, Solid, distance};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let tree = MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1")?);
/// let away = Pose { translation: DVec3::X * 3.0, ..Pose::IDENTITY };
/// let found = distance(Posed::new(&tree, Pose::IDENTITY), Posed::new(&tree, away), Solid::Filled)?;
/// let fields = d2m_io::distance_fields(&found);
/// assert_eq!(fields["status"], "separated");
/// assert!(fields["distance"].as_f64().is_some_and(|distance| (distance - 1.0).abs() < 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn distance_fields(found: &Distance) -> Value {
    let status = if found.state == StartState::Apart { "separated" } else { "contact" };
    json!({
        "status": status,
        "state": start_in_json(found.state),
        "start": start_in_json(found.state),
        "start_proven": found.state != StartState::Undecided,
        "distance": found.value,
        "lower": found.lower,
        "upper": found.upper,
        "normal": found.normal.to_array(),
        "point_a": found.point_a.to_array(),
        "point_b": found.point_b.to_array(),
        "triangle_a": found.triangle_a,
        "triangle_b": found.triangle_b,
        "barycentric_a": found.barycentric_a,
        "barycentric_b": found.barycentric_b,
    })
}
