//! Flights of a run, proven free of contact by the verifier, which shares nothing with the search.
use super::super::scene::{Error, Scene};
use d2m::bvh;
use d2m::bvh::{Posed, Topology, collide};
use d2m::motion::{ConstantTwist, RigidMotion};
use d2m::verify::{self, Body, Claim, Mesh, Query, Solid, TimeSpan, Verdict};
use d2m_dynamics::{Kind, Segment};
use std::sync::Arc;

/// Segments of a run that are proven, evenly over it, besides the last one.
const SAMPLES: usize = 16;
/// Steps of a proof at most.
const STEPS: u64 = 1 << 12;

/// What was found in sampled flights.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) proven: usize,
    pub(super) open: usize,
    pub(super) faults: Vec<String>,
}

/// Proves again that pairs stay apart in some of the segments. Where the verifier leaves that open the static query
/// decides whether they meet at the ends or in the middle, and what it finds apart is counted as open.
pub(super) fn proven(scene: &Scene, segments: &[Segment]) -> Result<Found, Error> {
    let mut meshes: Vec<(*const bvh::MeshTree, Arc<Mesh>, Solid)> = Vec::new();
    let mut mesh_of = Vec::new();
    for body in &scene.bodies {
        let tree = Arc::as_ptr(&body.tree);
        let place = meshes.iter().position(|(known, ..)| *known == tree).unwrap_or(meshes.len());
        if place == meshes.len() {
            let is_solid = Topology::new(body.tree.mesh()).is_watertight();
            let solid = if is_solid { Solid::Filled } else { Solid::Surface };
            meshes.push((tree, Arc::new(verify::mesh(body.tree.mesh())?), solid));
        }
        mesh_of.push(place);
    }
    let last = segments.iter().rposition(|segment| segment.end > segment.start);
    let stride = segments.len().div_ceil(SAMPLES).max(1);
    let mut flights = vec![ConstantTwist::REST; scene.bodies.len()];
    let mut found = Found::default();
    for (k, segment) in segments.iter().enumerate() {
        for (id, flight) in &segment.changed {
            flights[id.index()] = *flight;
        }
        let is_wanted = k % stride == 0 || Some(k) == last;
        if !is_wanted || segment.end <= segment.start || segment.skipped > 0.0 {
            continue;
        }
        let span = TimeSpan { from: segment.start, to: segment.end };
        for (a, b) in near(scene, &flights, span) {
            let body = |k: usize| {
                let (_, mesh, solid) = &meshes[mesh_of[k]];
                Body { mesh, motion: &flights[k], solid: *solid, radius: scene.bodies[k].radius }
            };
            let query = Query { bodies: [body(a), body(b)], window: span };
            match verify::verify(&query, &Claim::Clear { span, distance: 0.0 }, STEPS) {
                Verdict::Verified { .. } => found.proven += 1,
                Verdict::Refuted { time, .. } => found.faults.push(met(scene, [a, b], time)),
                Verdict::Unproven { .. } => match meet(scene, &flights, [a, b], span)? {
                    Some(time) => found.faults.push(met(scene, [a, b], time)),
                    None => found.open += 1,
                },
            }
        }
    }
    Ok(found)
}

fn met(scene: &Scene, pair: [usize; 2], time: f64) -> String {
    let [a, b] = pair.map(|k| &scene.bodies[k].name);
    format!("{a} and {b} meet at {time}")
}

/// When two bodies share a point, of three times of the span.
fn meet(
    scene: &Scene,
    flights: &[ConstantTwist],
    pair: [usize; 2],
    span: TimeSpan,
) -> Result<Option<f64>, Error> {
    for time in [span.from, 0.5 * (span.from + span.to), span.to] {
        let [a, b] = pair.map(|k| Posed::new(&scene.bodies[k].tree, flights[k].pose_and_twist(time).0));
        if collide(a, b, bvh::Solid::Filled)? {
            return Ok(Some(time));
        }
    }
    Ok(None)
}

/// Pairs, one of them free and not joined, whose spheres may meet in the span.
fn near(scene: &Scene, flights: &[ConstantTwist], span: TimeSpan) -> Vec<(usize, usize)> {
    let ids: Vec<_> = scene.simulation.ids().collect();
    let sphere = |k: usize| {
        let (pose, twist) = flights[k].pose_and_twist(span.from);
        (pose.translation, scene.simulation.radius(ids[k]) + twist.linear.length() * (span.to - span.from))
    };
    let is_free = |k: usize| matches!(scene.bodies[k].kind, Kind::Dynamic);
    let is_joined = |a: usize, b: usize| {
        let is_of = |joint: &d2m_dynamics::Joint| {
            let pair = (joint.a, joint.b);
            !joint.collide && (pair == (ids[a], Some(ids[b])) || pair == (ids[b], Some(ids[a])))
        };
        scene.joints.iter().any(is_of)
    };
    let mut pairs = Vec::new();
    for b in 0..ids.len() {
        for a in (0..b).filter(|&a| (is_free(a) || is_free(b)) && !is_joined(a, b)) {
            let ((x, r), (y, s)) = (sphere(a), sphere(b));
            if x.distance(y) <= r + s {
                pairs.push((a, b));
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Flights of a stack are proven apart; moved into each other they are refuted.
    #[test]
    fn flights_that_meet_are_noticed() {
        let mut scene = Scene::stack(3).unwrap();
        let report = scene.simulation.step().unwrap();
        let mut segments = report.segments;
        segments.extend(scene.simulation.finish());
        let found = proven(&scene, &segments).unwrap();
        assert!(found.proven >= 3 && found.open == 0 && found.faults.is_empty(), "{found:?}");
        let last = segments.len() - 1;
        let id = scene.ids[0];
        let into = ConstantTwist::REST.with_position(DVec3::Y * 1.2);
        segments[last].changed = vec![(id, into)];
        let found = proven(&scene, &segments).unwrap();
        assert!(!found.faults.is_empty(), "{found:?}");
    }
}
