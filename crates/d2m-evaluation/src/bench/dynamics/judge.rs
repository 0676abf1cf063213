//! What a run must not do: judged by the numbers of its segments and the masses alone.
use super::scene::{Expectation, Scene};
use d2m::motion::{ConstantTwist, RigidMotion};
use d2m_dynamics::Segment;
use glam::{DMat3, DVec3};

/// The part of the greatest kinetic energy or change of the potential one by which the energy at the middles of flights may rise, as
/// docs/guarantees.md has it.
const RISE: f64 = 1.0 / 128.0;

/// What is wrong with a run; empty if nothing. `starts`: where the dynamic bodies began.
pub(super) fn fault(scene: &Scene, starts: &[DVec3], segments: &[Segment]) -> String {
    if let Some(segment) = segments.iter().find(|segment| segment.skipped != 0.0) {
        return format!("skipped {:e} s at {}", segment.skipped, segment.start);
    }
    let is_driven = matches!(scene.expectation, Expectation::Turned);
    if !is_driven && let Some(rise) = risen(scene, segments) {
        return rise;
    }
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
            if mean(&ends) >= mean(starts) {
                return format!("mean height {} after {}", mean(&ends), mean(starts));
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
    }
    String::new()
}

/// Does the energy at the middles of flights rise by more than it may?
fn risen(scene: &Scene, segments: &[Segment]) -> Option<String> {
    let simulation = &scene.simulation;
    let gravity = simulation.options().gravity;
    let mut flights = vec![ConstantTwist::REST; simulation.len()];
    let (mut least, mut rise, mut greatest) = (f64::INFINITY, 0.0f64, 0.0f64);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for segment in segments {
        for (id, flight) in &segment.changed {
            flights[id.index()] = *flight;
        }
        let middle = 0.5 * (segment.start + segment.end);
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for &id in &scene.ids {
            let properties = simulation.mass_properties(id)?;
            let (pose, twist) = flights[id.index()].pose_and_twist(middle);
            let spin = DMat3::from_quat(pose.rotation).transpose() * twist.angular;
            let doubled =
                properties.mass * twist.linear.length_squared() + spin.dot(properties.inertia * spin);
            kinetic += 0.5 * doubled;
            potential -= properties.mass * gravity.dot(pose.translation);
        }
        least = least.min(kinetic + potential);
        rise = rise.max(kinetic + potential - least);
        greatest = greatest.max(kinetic);
        (low, high) = (low.min(potential), high.max(potential));
    }
    // Bodies that rest have neither: where each keeps its gap is then what counts.
    let masses =
        scene.ids.iter().filter_map(|&id| simulation.mass_properties(id)).map(|p| p.mass).sum::<f64>();
    let lifted = masses * gravity.length() * simulation.options().gap;
    let scale = greatest.max(high - low).max(lifted);
    (rise > RISE * scale)
        .then(|| format!("the energy rose by {rise:e}; kinetic {greatest:e} at most, scale {scale:e}"))
}
