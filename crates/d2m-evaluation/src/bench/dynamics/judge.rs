//! What a run must not do: judged by the numbers of its segments and the masses alone.
use super::energy::risen;
use super::scene::{Expectation, Scene};
use d2m::bvh::{Posed, Solid, collide};
use d2m::motion::Pose;
use d2m_dynamics::{BodyId, Joint, JointKind, Kind, Segment};
use glam::DVec3;

/// By how much the two sides of a joint may be apart after a step, in meters, as the tests of joints have it.
const APART: f64 = 1e-6;

/// How fast a body turns about z in the mean of the segments that begin after a time.
fn mean_spin(segments: &[Segment], body: BodyId, after: f64) -> f64 {
    let (mut spin, mut turn, mut length) = (0.0, 0.0, 0.0);
    for segment in segments {
        if let Some((_, flight)) = segment.changed.iter().find(|(id, _)| *id == body) {
            spin = flight.angular_velocity().z;
        }
        if segment.start >= after {
            turn += spin * (segment.end - segment.start);
            length += segment.end - segment.start;
        }
    }
    turn / length
}

/// What is wrong with a run; empty if nothing. `starts`: where all bodies began.
pub(super) fn fault(scene: &Scene, starts: &[Pose], segments: &[Segment]) -> String {
    if let Some(segment) = segments.iter().find(|segment| segment.skipped != 0.0) {
        return format!("skipped {:e} s at {}", segment.skipped, segment.start);
    }
    let is_driven = matches!(scene.expectation, Expectation::Turned | Expectation::Rate(_));
    if !is_driven && let Some(rise) = risen(scene, segments) {
        return rise;
    }
    if let Some(apart) = parted(scene, starts) {
        return apart;
    }
    let starts: Vec<DVec3> = scene.ids.iter().map(|id| starts[id.index()].translation).collect();
    let ends: Vec<DVec3> = scene.ids.iter().map(|&id| scene.simulation.position(id)).collect();
    if let Some(end) = ends.iter().find(|end| !end.is_finite()) {
        return format!("a body ends at {end}");
    }
    match scene.expectation {
        Expectation::Above(least) => {
            let mean = |places: &[DVec3]| places.iter().map(|x| x.y).sum::<f64>() / places.len() as f64;
            if let Some(low) = ends.iter().find(|end| end.y < least) {
                return format!("a body ends at the height {}", low.y);
            }
            if mean(&ends) >= mean(&starts) {
                return format!("mean height {} after {}", mean(&ends), mean(&starts));
            }
        }
        Expectation::Screw => {
            let sunk = starts[0].z - ends[0].z;
            let spin = scene.simulation.angular_velocity(scene.ids[0]).z;
            if sunk <= 0.0 || spin == 0.0 {
                return format!("the screw sank by {sunk} and turns at {spin}");
            }
        }
        Expectation::Turned => {
            let turn = scene.simulation.orientation(scene.ids[0]).to_scaled_axis().z;
            // Half a tooth at the start; the other gear turns by the same angle about +z.
            if turn > -0.5 * scene.seconds {
                return format!("the gear turned by {turn}");
            }
        }
        Expectation::Asleep => {
            let awake = scene.ids.iter().filter(|&&id| !scene.simulation.is_asleep(id)).count();
            if awake > 0 {
                return format!("{awake} bodies are awake");
            }
        }
        Expectation::Rate(rate) => {
            let spin = mean_spin(segments, scene.ids[0], scene.before + 0.5 * scene.seconds);
            if spin.is_nan() || (spin - rate).abs() > 0.05 * rate.abs() {
                return format!("it turns at {spin} in the mean");
            }
        }
        Expectation::Stays(most) => {
            let ways = ends.iter().zip(&starts).map(|(end, start)| end.distance(*start));
            let way = ways.fold(0.0, f64::max);
            if way > most {
                return format!("a body moved by {way}");
            }
        }
        Expectation::Within(most) => {
            if let Some(end) = ends.iter().find(|end| end.length() > most) {
                return format!("a body ends at {end}");
            }
        }
        Expectation::Held => {}
    }
    String::new()
}

/// Are the two sides of a joint apart?
pub(super) fn parted(scene: &Scene, starts: &[Pose]) -> Option<String> {
    let now = |id: BodyId, point: DVec3| {
        let (start, end) = (starts[id.index()], scene.simulation.pose(id));
        end.transform_point(start.rotation.conjugate() * (point - start.translation))
    };
    let apart = |joint: &Joint| {
        let second = joint.b.map_or(joint.point, |id| now(id, joint.point));
        let between = now(joint.a, joint.point) - second;
        match joint.kind {
            // Along its axis it moves. What the axis is a direction of does not turn, in the scenes here.
            JointKind::Prismatic => between.reject_from(joint.axis).length(),
            _ => between.length(),
        }
    };
    let most = scene.joints.iter().map(apart).fold(0.0, f64::max);
    (most > APART).then(|| format!("the sides of a joint are {most:e} apart"))
}

/// How many pairs are not proven apart with the bodies at these poses, of those of which one moves freely and that no
/// joint connects. Our static query judges both engines.
pub(super) fn intersecting(scene: &Scene, poses: &[Pose]) -> Result<usize, String> {
    let ids: Vec<_> = scene.simulation.ids().collect();
    let is_free = |k: usize| matches!(scene.bodies[k].kind, Kind::Dynamic);
    let is_joined = |a: usize, b: usize| {
        let is_of = |joint: &Joint| {
            let pair = (joint.a, joint.b);
            !joint.collide && (pair == (ids[a], Some(ids[b])) || pair == (ids[b], Some(ids[a])))
        };
        scene.joints.iter().any(is_of)
    };
    let posed = |k: usize| Posed::new(&scene.bodies[k].tree, poses[k]);
    let mut count = 0;
    for b in 0..ids.len() {
        for a in (0..b).filter(|&a| (is_free(a) || is_free(b)) && !is_joined(a, b)) {
            let found = collide(posed(a), posed(b), Solid::Filled).map_err(|error| error.to_string())?;
            count += usize::from(found);
        }
    }
    Ok(count)
}
