//! The state of a simulation apart from its meshes, to be kept and restored.

use crate::contact::{ContactPoint, Material, tangents};
use crate::pairs::Pair;
use crate::{Simulation, SimulationError, SimulationOptions};
use d2m_feature::FeaturePair;
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};

/// Everything that changes in a simulation: poses, momenta, flights, impulses of resting contacts, who sleeps.
///
/// Promise: [`Simulation::restore`] followed by the same steps gives the same bits. Meshes, masses and motions are not in
/// it: it belongs to a simulation with the same bodies. With the feature `serde` it can be written in any format.
///
/// ```
/// use d2m_bvh::MeshTree;
/// use d2m_dynamics::{Body, Simulation, SimulationOptions};
/// use std::sync::Arc;
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let body = simulation.add(&Body::new("cube", cube))?;
/// let before = simulation.snapshot();
/// simulation.step()?;
/// let once = simulation.position(body);
/// simulation.restore(&before)?;
/// assert_eq!(simulation.time(), 0.0);
/// simulation.step()?;
/// assert_eq!(simulation.position(body), once);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot {
    options: SimulationOptions,
    time: f64,
    steps: u64,
    checked: usize,
    greatest_energy: f64,
    bodies: Vec<BodyState>,
    pairs: Vec<PairState>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct BodyState {
    time: f64,
    position: DVec3,
    orientation: DQuat,
    momentum: DVec3,
    angular_momentum: DVec3,
    force: DVec3,
    torque: DVec3,
    flight: FlightState,
    /// None: without end.
    horizon: Option<f64>,
    version: u64,
    asleep: bool,
    quiet: f64,
    slowest: f64,
    gained: f64,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct FlightState {
    position: DVec3,
    orientation: DQuat,
    linear: DVec3,
    angular: DVec3,
    time: f64,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct PairState {
    bodies: [usize; 2],
    gap: f64,
    nearest: Option<f64>,
    reach: f64,
    contacts: Vec<ContactState>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct ContactState {
    feature: FeaturePair,
    normal: DVec3,
    distance: f64,
    arm_a: DVec3,
    arm_b: DVec3,
    point: DVec3,
    restitution: f64,
    friction: f64,
    impulse: f64,
    sliding: [f64; 2],
}

impl Simulation {
    /// The state between two steps.
    pub fn snapshot(&self) -> Snapshot {
        let bodies = self.bodies.iter().map(|body| BodyState {
            time: body.time,
            position: body.position,
            orientation: body.orientation,
            momentum: body.momentum,
            angular_momentum: body.angular_momentum,
            force: body.force,
            torque: body.torque,
            flight: FlightState {
                position: body.flight.position(),
                orientation: body.flight.orientation(),
                linear: body.flight.linear_velocity(),
                angular: body.flight.angular_velocity(),
                time: body.flight.reference_time(),
            },
            horizon: body.horizon.is_finite().then_some(body.horizon),
            version: body.version,
            asleep: body.asleep,
            quiet: body.quiet,
            slowest: body.slowest,
            gained: body.gained,
        });
        let pairs = self.pairs.iter().map(|(&(a, b), pair)| PairState {
            bodies: [a, b],
            gap: pair.gap,
            nearest: pair.nearest,
            reach: pair.reach,
            contacts: pair.contacts.iter().map(ContactState::of).collect(),
        });
        Snapshot {
            options: self.options,
            time: self.time,
            steps: self.steps,
            checked: self.checked,
            greatest_energy: self.greatest_energy,
            bodies: bodies.collect(),
            pairs: pairs.collect(),
        }
    }

    /// Goes back to a state of this simulation, or of one with the same bodies. Segments begin anew there.
    ///
    /// # Errors
    /// Another number of bodies, settings or numbers that cannot be used.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SimulationError> {
        let (found, expected) = (snapshot.bodies.len(), self.bodies.len());
        if found != expected {
            return Err(SimulationError::Snapshot { found, expected });
        }
        snapshot.options.check()?;
        let mut bodies = self.bodies.clone();
        for (body, state) in bodies.iter_mut().zip(&snapshot.bodies) {
            let flight = &state.flight;
            let bad = |_| SimulationError::BadBody {
                body: body.name.to_string(),
                name: "flight of the snapshot",
                value: format!("{flight:?}"),
            };
            body.flight =
                ConstantTwist::try_new(flight.position, flight.orientation, flight.linear, flight.angular)
                    .and_then(|twist| twist.try_with_at(body.center))
                    .and_then(|twist| twist.try_with_reference_time(flight.time))
                    .map_err(bad)?;
            body.time = state.time;
            body.position = state.position;
            body.orientation = state.orientation;
            body.momentum = state.momentum;
            body.angular_momentum = state.angular_momentum;
            body.force = state.force;
            body.torque = state.torque;
            body.horizon = state.horizon.unwrap_or(f64::INFINITY);
            body.version = state.version;
            body.asleep = state.asleep;
            body.quiet = state.quiet;
            body.slowest = state.slowest;
            body.gained = state.gained;
            body.held = false;
        }
        let whole =
            |pair: &&PairState| pair.bodies.iter().all(|&i| i < expected) && pair.bodies[0] < pair.bodies[1];
        self.pairs = snapshot
            .pairs
            .iter()
            .filter(whole)
            .map(|state| {
                let [a, b] = state.bodies;
                let mut pair = Pair::new(state.gap);
                (pair.nearest, pair.reach) = (state.nearest, state.reach);
                pair.contacts = state.contacts.iter().map(|c| c.restored(a, b, state.gap)).collect();
                ((a, b), Box::new(pair))
            })
            .collect();
        self.bodies = bodies;
        self.options = snapshot.options;
        (self.time, self.steps) = (snapshot.time, snapshot.steps);
        self.checked = snapshot.checked.min(expected);
        self.greatest_energy = snapshot.greatest_energy;
        self.neighbors = crate::broad_phase::Neighbors::default();
        self.recorder = crate::record::Recorder::default();
        Ok(())
    }
}

impl ContactState {
    fn of(contact: &ContactPoint) -> Self {
        Self {
            feature: contact.feature,
            normal: contact.normal,
            distance: contact.distance,
            arm_a: contact.arm_a,
            arm_b: contact.arm_b,
            point: contact.point,
            restitution: contact.material.restitution,
            friction: contact.material.friction,
            impulse: contact.impulse,
            sliding: contact.sliding,
        }
    }

    fn restored(&self, a: usize, b: usize, gap: f64) -> ContactPoint {
        ContactPoint {
            a,
            b,
            feature: self.feature,
            normal: self.normal,
            tangents: tangents(self.normal),
            distance: self.distance,
            is_expected: false,
            gap,
            arm_a: self.arm_a,
            arm_b: self.arm_b,
            point: self.point,
            material: Material { restitution: self.restitution, friction: self.friction },
            row: None,
            impulse: self.impulse,
            sliding: self.sliding,
        }
    }
}
