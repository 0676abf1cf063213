//! An answer as `d2m toc --json` printed it, read again. What contradicts itself, or is about other bodies, is refused by name: the
//! verifier judges what an answer promises, so everything else that it says is compared here.

use crate::engine::Pair;
use crate::failure::{Failure, parse_json};
use d2m::bvh::{Contact, StartState, TimeOfContact, Window};
use d2m::feature::FeaturePair;
use d2m::motion::RigidMotion;
use glam::DVec3;
use serde::Deserialize;
use serde_json::Value;

/// What an answer says besides its verdict.
#[derive(Deserialize)]
struct About {
    status: String,
    window: [f64; 2],
    min_separation: f64,
    triangles: [usize; 2],
    solids: [bool; 2],
    toc: Option<f64>,
    toc_hi: Option<f64>,
    time: Option<[f64; 2]>,
    point: Option<[f64; 3]>,
    feature: Option<String>,
}

/// Reads an answer and holds it against the bodies and the window.
pub(crate) fn read_answer(
    place: &str,
    bytes: &[u8],
    pair: &Pair,
    motions: [&dyn RigidMotion; 2],
    window: Window,
) -> Result<TimeOfContact, Failure> {
    let mut object: Value = parse_json(place, bytes)?;
    let about: About = parse_json(place, bytes)?;
    // Promises that are not judged must not be called verified.
    for key in ["left", "clearance"] {
        if object.get(key).is_some_and(|value| !value.is_null()) {
            return Err(Failure::at(place, format!("{key}: cannot be verified")));
        }
    }
    let check = |what: &str, holds: bool| {
        if holds {
            Ok(())
        } else {
            Err(Failure::at(place, format!("{what}: not an answer to this question")))
        }
    };
    check("window", about.window == [window.start(), window.end()])?;
    check("min_separation", about.min_separation == pair.min_separation)?;
    check("triangles", about.triangles == [pair.a.mesh().triangle_count(), pair.b.mesh().triangle_count()])?;
    check("solids", about.solids == pair.solids.map(|solid| solid == d2m::bvh::Solid::Filled))?;
    if let Some(text) = &about.feature {
        let feature = parse_feature(text).ok_or_else(|| Failure::at(place, format!("feature: {text:?}")))?;
        object["feature"] = serde_json::to_value(feature).map_err(|error| Failure::at(place, error))?;
    }
    if !["contact", "separated", "undecided"].contains(&about.status.as_str()) {
        return Err(Failure::at(place, format!("status: {:?} is none of an answer", about.status)));
    }
    let answer: TimeOfContact = serde_json::from_value(object)
        .map_err(|error| Failure::at(place, format!("{}: {error}", about.status)))?;
    match &answer {
        TimeOfContact::Separated => check("toc", about.toc.is_none() && about.time.is_none())?,
        TimeOfContact::Undecided { clear_until } => check("toc", about.toc == Some(*clear_until))?,
        TimeOfContact::Contact(contact) => {
            check("toc", about.toc == Some(contact.time_lo))?;
            check("toc_hi", about.toc_hi == Some(contact.time_hi))?;
            check("time", about.time == Some([contact.time_lo, contact.time_hi]))?;
            check("point", about.point == Some(contact.point_a.to_array()))?;
            agrees(place, contact, pair, motions)?;
        }
    }
    Ok(answer)
}

/// A feature pair as it is printed.
fn parse_feature(text: &str) -> Option<FeaturePair> {
    let parts: Vec<&str> = text.split(':').collect();
    let [kind, first, last] = parts.as_slice() else { return None };
    let edge = |text: &str| {
        let (p, q) = text.split_once('-')?;
        Some([p.parse().ok()?, q.parse().ok()?])
    };
    Some(match *kind {
        "vertex_face" => FeaturePair::VertexFace { vertex: first.parse().ok()?, face: last.parse().ok()? },
        "face_vertex" => FeaturePair::FaceVertex { face: first.parse().ok()?, vertex: last.parse().ok()? },
        "edge_edge" => FeaturePair::EdgeEdge { edge_a: edge(first)?, edge_b: edge(last)? },
        _ => return None,
    })
}

/// Points, weights, normal, speed and features of a contact agree with its triangles and its time, up to rounding.
fn agrees(
    place: &str,
    contact: &Contact,
    pair: &Pair,
    motions: [&dyn RigidMotion; 2],
) -> Result<(), Failure> {
    let refuse = |what: &str| {
        Err(Failure::at(place, format!("{what}: it is not that of these triangles at that time")))
    };
    let meshes = [pair.a.mesh(), pair.b.mesh()];
    let numbers = [contact.triangle_a, contact.triangle_b];
    for (k, name) in ["triangle_a", "triangle_b"].into_iter().enumerate() {
        if numbers[k] as usize >= meshes[k].triangle_count() {
            return refuse(name);
        }
    }
    // What is inside a body has no closest points.
    if contact.start == StartState::Contained {
        return Ok(());
    }
    let corners = [0, 1].map(|k| meshes[k].triangles()[numbers[k] as usize]);
    let of_a = |vertices: &[u32]| vertices.iter().all(|v| corners[0].contains(v));
    let of_b = |vertices: &[u32]| vertices.iter().all(|v| corners[1].contains(v));
    let is_theirs = match contact.feature {
        FeaturePair::VertexFace { vertex, face } => of_a(&[vertex]) && face == numbers[1],
        FeaturePair::FaceVertex { face, vertex } => face == numbers[0] && of_b(&[vertex]),
        FeaturePair::EdgeEdge { edge_a, edge_b } => of_a(&edge_a) && of_b(&edge_b),
    };
    if !is_theirs {
        return refuse("feature");
    }
    let states = motions.map(|motion| motion.pose_and_twist(contact.time_lo));
    let weights = [contact.barycentric_a, contact.barycentric_b];
    let points = [contact.point_a, contact.point_b];
    let placed = [0, 1].map(|k| {
        let corners = meshes[k].corners(numbers[k] as usize);
        let (pose, _) = states[k];
        corners.into_iter().zip(weights[k]).map(|(p, w)| pose.transform_point(p) * w).sum::<DVec3>()
    });
    // Points are printed in doubles of the world's coordinates.
    let size = pair.sizes()[0].max(pair.sizes()[1]) + points[0].length() + states[0].0.translation.length();
    let off = contact.tolerance + 1e-9 * size;
    for (k, name) in [("point_a", "barycentric_a"), ("point_b", "barycentric_b")].into_iter().enumerate() {
        if weights[k].iter().any(|w| !(-1e-12..=1.0 + 1e-12).contains(w))
            || (weights[k].iter().sum::<f64>() - 1.0).abs() > 1e-9
        {
            return refuse(name.1);
        }
        if points[k].distance(placed[k]).is_nan() || points[k].distance(placed[k]) > off {
            return refuse(name.0);
        }
    }
    if contact.start == StartState::Overlapping {
        return Ok(());
    }
    let gap = points[1] - points[0];
    let is_normal = (contact.normal.length() - 1.0).abs() < 1e-9
        && (contact.separation <= 8.0 * off
            || gap.distance(contact.normal * contact.separation) <= 4.0 * off);
    if !is_normal {
        return refuse("normal");
    }
    let velocity = |k: usize| states[k].1.velocity_of(points[k] - states[k].0.translation);
    let closing = (velocity(0) - velocity(1)).dot(contact.normal);
    let fastest = velocity(0).length() + velocity(1).length() + states[0].1.angular.length() * size;
    if (closing - contact.closing_speed).abs() > 1e-6 * fastest || contact.closing_speed.is_nan() {
        return refuse("closing_speed");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::feature_field;

    #[test]
    fn features_are_read_as_they_are_written() {
        for feature in [
            FeaturePair::VertexFace { vertex: 3, face: 40 },
            FeaturePair::FaceVertex { face: 7, vertex: 0 },
            FeaturePair::EdgeEdge { edge_a: [1, 2], edge_b: [30, 4] },
        ] {
            assert_eq!(parse_feature(&feature_field(feature)), Some(feature));
        }
        for text in
            ["", "vertex_face:1", "edge_edge:1:2", "face:1:2", "vertex_face:-1:2", "edge_edge:1-2:3-4:5"]
        {
            assert_eq!(parse_feature(text), None, "{text}");
        }
    }
}
