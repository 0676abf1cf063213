//! The energy of a run, by its segments and the masses alone.

use super::scene::Scene;
use d2m::motion::{ConstantTwist, RigidMotion};
use d2m_dynamics::Segment;
use glam::DMat3;

/// The part of the greatest kinetic energy or change of the potential one by which the energy may rise, as docs/guarantees.md has it.
const RISE: f64 = 1.0 / 128.0;

/// Bodies up to which the energy at the middles of segments obeys that, too: of more than that, events of others end segments and leave
/// flights as they are (docs/guarantees.md). With joints it does whatever their number is.
const FEW: usize = 64;

/// When the energy of a body counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Middle {
    /// At the middle of its flight, which lasts until its twist is another one.
    OfFlights,
    /// At the middle of each segment, also where a flight goes on through several.
    OfSegments,
}

/// What is wrong with the energy, if it rises by more than it may.
pub(super) fn risen(scene: &Scene, segments: &[Segment]) -> Option<String> {
    let is_few = scene.ids.len() <= FEW || !scene.joints.is_empty();
    let held = if is_few { &[Middle::OfFlights, Middle::OfSegments][..] } else { &[Middle::OfFlights] };
    held.iter().find_map(|&middle| {
        let energies = Energies::of(scene, segments, middle)?;
        let scale = energies.scale(scene);
        let (rise, greatest) = (energies.rise, energies.greatest);
        (rise > RISE * scale)
            .then(|| format!("the energy rose by {rise:e}; kinetic {greatest:e} at most, scale {scale:e}"))
    })
}

/// What becomes of the energy in a run.
struct Energies {
    /// The most by which it is above what it was before.
    rise: f64,
    /// The greatest kinetic energy.
    greatest: f64,
    /// The least and the greatest potential energy.
    low: f64,
    high: f64,
}

impl Energies {
    /// None: a body has no mass.
    fn of(scene: &Scene, segments: &[Segment], middle: Middle) -> Option<Self> {
        let simulation = &scene.simulation;
        let gravity = simulation.options().gravity;
        let mut masses = vec![None; simulation.len()];
        for &id in &scene.ids {
            masses[id.index()] = Some(simulation.mass_properties(id)?);
        }
        // Kinetic and potential.
        let energy = |body: usize, flight: &ConstantTwist, time: f64| -> [f64; 2] {
            let Some(properties) = &masses[body] else { return [0.0; 2] };
            let (pose, twist) = flight.pose_and_twist(time);
            let spin = DMat3::from_quat(pose.rotation).transpose() * twist.angular;
            let doubled =
                properties.mass * twist.linear.length_squared() + spin.dot(properties.inertia * spin);
            [0.5 * doubled, -properties.mass * gravity.dot(pose.translation)]
        };
        let ends = ends_of_flights(segments, simulation.len());
        let mut flights = vec![ConstantTwist::REST; simulation.len()];
        let mut present = vec![[0.0; 2]; simulation.len()];
        let (mut least, mut rise, mut greatest) = (f64::INFINITY, 0.0f64, 0.0f64);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (segment, ends) in segments.iter().zip(&ends) {
            for ((id, flight), end) in segment.changed.iter().zip(ends) {
                flights[id.index()] = *flight;
                present[id.index()] = energy(id.index(), flight, 0.5 * (segment.start + end));
            }
            if middle == Middle::OfSegments {
                let middle = 0.5 * (segment.start + segment.end);
                for (body, flight) in flights.iter().enumerate() {
                    present[body] = energy(body, flight, middle);
                }
            }
            let sum = |k: usize| present.iter().map(|energies| energies[k]).sum::<f64>();
            let (kinetic, potential) = (sum(0), sum(1));
            least = least.min(kinetic + potential);
            rise = rise.max(kinetic + potential - least);
            greatest = greatest.max(kinetic);
            (low, high) = (low.min(potential), high.max(potential));
        }
        Some(Self { rise, greatest, low, high })
    }

    /// What a rise is a part of.
    fn scale(&self, scene: &Scene) -> f64 {
        let simulation = &scene.simulation;
        // Bodies that rest have neither: where each keeps its gap is then what counts.
        let masses =
            scene.ids.iter().filter_map(|&id| simulation.mass_properties(id)).map(|p| p.mass).sum::<f64>();
        let lifted = masses * simulation.options().gravity.length() * simulation.options().gap;
        self.greatest.max(self.high - self.low).max(lifted)
    }
}

/// When the flights end that begin with each segment, in the order of its bodies.
fn ends_of_flights(segments: &[Segment], bodies: usize) -> Vec<Vec<f64>> {
    let last = segments.last().map_or(0.0, |segment| segment.end);
    let mut next = vec![last; bodies];
    let of = |segment: &Segment| {
        let end = |body: usize| core::mem::replace(&mut next[body], segment.start);
        segment.changed.iter().map(|(id, _)| id.index()).map(end).collect()
    };
    let mut ends: Vec<Vec<f64>> = segments.iter().rev().map(of).collect();
    ends.reverse();
    ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_dynamics::BodyId;
    use glam::DVec3;

    /// Of a stack: its bodies that move, and no segment yet.
    fn scene() -> (Scene, Vec<BodyId>) {
        let scene = Scene::stack(2).unwrap();
        let ids = scene.ids.clone();
        (scene, ids)
    }

    fn segment(start: f64, end: f64, changed: Vec<(BodyId, ConstantTwist)>) -> Segment {
        let mut simulation = Scene::stack(2).unwrap().simulation;
        let mut segment = simulation.step().unwrap().segments.swap_remove(0);
        (segment.start, segment.end, segment.changed) = (start, end, changed);
        segment
    }

    /// At this height at this time, with this velocity.
    fn flight(time: f64, height: f64, velocity: f64) -> ConstantTwist {
        ConstantTwist::REST
            .with_position(DVec3::Y * (height - velocity * time))
            .with_linear_velocity(DVec3::Y * velocity)
    }

    /// Two bodies fall; the flight of the second ends in the middle of the first one's. With the velocities of their own middles the energy is
    /// what it was; at the middles of segments the first one has more or less than that.
    #[test]
    fn the_energy_of_a_flight_counts_at_its_own_middle() {
        let (scene, ids) = scene();
        let g = scene.simulation.options().gravity.length();
        let (speed, way) = (|time: f64| -g * time, |time: f64| 9.0 - 0.5 * g * time * time);
        // A flight's velocity is that of its middle, its places at both ends are right.
        let between = |start: f64, end: f64| flight(start, way(start), speed(0.5 * (start + end)));
        let segments = [
            segment(1.0, 1.1, vec![(ids[0], between(1.0, 1.1)), (ids[1], between(1.0, 1.1))]),
            segment(1.1, 1.15, vec![(ids[0], between(1.1, 1.2)), (ids[1], between(1.1, 1.15))]),
            segment(1.15, 1.2, vec![(ids[1], between(1.15, 1.2))]),
        ];
        assert_eq!(ends_of_flights(&segments, 3), [vec![1.1, 1.1], vec![1.2, 1.15], vec![1.2]]);
        let rise = |middle| Energies::of(&scene, &segments, middle).unwrap().rise;
        let mass = scene.simulation.mass_properties(ids[0]).unwrap().mass;
        // The middle of a chord lies m g (g h²/8) below the parabola: of a flight of half the length a quarter of that.
        let chord = |h: f64| mass * g * g * h * h / 8.0;
        let expected = chord(0.1) - chord(0.05);
        assert!((rise(Middle::OfFlights) - expected).abs() < 1e-6 * expected, "{}", rise(Middle::OfFlights));
        // A quarter of a flight before its middle.
        let early = mass * g * -speed(1.15) * 0.025;
        assert!(rise(Middle::OfSegments) > 0.9 * early && early > 20.0 * expected);
    }

    /// A flight that goes on too fast.
    #[test]
    fn a_body_that_gains_energy_is_noticed() {
        let (scene, ids) = scene();
        let run = |speed: f64| {
            let segments = [
                segment(0.0, 0.1, vec![(ids[0], flight(0.0, 5.0, 1.0)), (ids[1], flight(0.0, 9.0, 0.0))]),
                segment(0.1, 0.2, vec![(ids[0], flight(0.1, 5.1, speed))]),
            ];
            risen(&scene, &segments)
        };
        assert_eq!(run(-0.5), None);
        assert!(run(1.1).unwrap().contains("the energy rose by"));
    }
}
