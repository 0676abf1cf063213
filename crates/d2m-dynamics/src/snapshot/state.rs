//! The state of a simulation without its meshes, to be kept and restored.

use crate::body::rigid_body::{RigidBody, Role};
use crate::joint::rows::Joined;
use crate::numbers::{Fault, check_surface, material_fault};
use crate::shown::shown;
use crate::snapshot::body::BodyState;
use crate::snapshot::contents::Source;
use crate::snapshot::pair::PairState;
use crate::{Simulation, SimulationError, SimulationOptions, TouchEvent};
use d2m_contact::Material;
use std::collections::BTreeSet;

/// Everything that changes in a simulation: poses, momenta, flights, impulses of resting contacts, which
/// bodies sleep and which touch, joints, kinds, materials, groups, ignored pairs.
///
/// Promise: [`Simulation::restore`] followed by the same steps gives the same bits. Meshes and masses are not
/// in it: it belongs to a simulation that has its bodies, and perhaps others. Nothing that is read from a
/// file counts as proven: it is computed again, to the same bits as long as no query meets its budget
/// ([`SimulationOptions::node_tests`]). With the feature `serde` it can be written in any format. Motions of
/// kinematic bodies are not written; those of the simulation go on.
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
    greatest_energy: f64,
    world: Option<usize>,
    /// In the order of their places.
    bodies: Vec<BodyState>,
    pairs: Vec<PairState>,
    joints: Vec<Joined>,
    ignored: Vec<[usize; 2]>,
    materials: Vec<PairMaterial>,
    touching: Vec<[usize; 2]>,
    #[cfg_attr(feature = "serde", serde(default))]
    touches: Vec<TouchEvent>,
    unchecked: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct PairMaterial {
    bodies: [usize; 2],
    restitution: f64,
    friction: f64,
}

impl Snapshot {
    /// The state of the body at a place.
    fn state(&self, place: usize) -> Option<&BodyState> {
        let found = self.bodies.binary_search_by_key(&place, |state: &BodyState| state.id.index());
        found.ok().map(|k| &self.bodies[k])
    }

    /// Is the state of this body, at a place, in it?
    fn has(&self, body: &RigidBody, place: usize) -> bool {
        let is_same = |state: &BodyState| body.role.is_named() && body.id == state.id;
        if self.world == Some(place) {
            body.role == Role::World
        } else {
            self.state(place).is_some_and(is_same)
        }
    }

    /// Checks the settings and what concerns no single body; also that each body is there once, in the order
    /// of places.
    fn check(&self) -> Result<(), SimulationError> {
        self.options.check()?;
        let bad = |name: &'static str, value: f64, wanted: &'static str| {
            Err(SimulationError::BadOption { name, value, wanted })
        };
        if !self.time.is_finite() {
            return bad("time", self.time, "a number");
        }
        if !(self.greatest_energy.is_finite() && self.greatest_energy >= 0.0) {
            return bad("greatest energy", self.greatest_energy, "not negative");
        }
        if self.steps as f64 * self.options.step > self.time {
            return bad("steps", self.steps as f64, "no more than fit into the time");
        }
        let place = |k: usize| self.bodies[k].id.index();
        if let Some(k) = (1..self.bodies.len()).find(|&k| place(k - 1) >= place(k)) {
            return Err(SimulationError::Snapshot { place: place(k) });
        }
        let lacks = |place: &usize| !self.bodies.iter().any(|body| body.id.index() == *place);
        self.world.filter(lacks).map_or(Ok(()), |place| Err(SimulationError::Snapshot { place }))
    }
}

impl Simulation {
    /// The state between two steps.
    pub fn snapshot(&self) -> Snapshot {
        let bodies = self.bodies.iter().filter(|body| body.role != Role::Vacant).map(BodyState::of).collect();
        let pairs = self.pairs.iter().map(|(&(a, b), pair)| PairState::of([a, b], pair));
        let materials = self.materials.iter().map(|(&(a, b), material)| PairMaterial {
            bodies: [a, b],
            restitution: material.restitution,
            friction: material.friction,
        });
        let listed = |pairs: &BTreeSet<(usize, usize)>| pairs.iter().map(|&(a, b)| [a, b]).collect();
        Snapshot {
            options: self.options,
            time: self.time,
            steps: self.steps,
            greatest_energy: self.greatest_energy,
            world: self.world,
            bodies,
            pairs: pairs.collect(),
            joints: self.joints.clone(),
            ignored: listed(&self.ignored),
            materials: materials.collect(),
            touching: listed(&self.touching),
            touches: self.touches.clone(),
            unchecked: self.unchecked.iter().copied().collect(),
        }
    }

    /// Removes what the snapshot does not have: bodies that were added since, and the world if it has another
    /// place there, or none.
    fn make_way(&mut self, snapshot: &Snapshot) {
        for place in (0..self.bodies.len()).rev() {
            // Free places at the end go with the last one that is cleared.
            let Some(body) = self.bodies.get(place) else { continue };
            if body.role == Role::Vacant || snapshot.has(body, place) {
                continue;
            }
            if body.role.is_named() {
                self.generations[place] += 1;
            }
            if self.world == Some(place) {
                self.world = None;
            }
            self.clear_out(place);
        }
    }

    /// Goes back to a state of this simulation, or of one with the same bodies. Bodies and joints that were
    /// added since are gone, joints that were removed are there again; names of bodies that are gone never
    /// mean others. Segments begin anew there.
    ///
    /// A state with other bodies than those of which it was taken, or one that was written and read, is
    /// checked for intersections.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// let before = simulation.snapshot();
    /// simulation.apply_impulse(body, DVec3::X * 1000.0, DVec3::ZERO)?;
    /// simulation.step()?;
    /// simulation.restore(&before)?;
    /// assert_eq!((simulation.time(), simulation.position(body)), (0.0, DVec3::ZERO));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A body of the snapshot that was removed since; settings or numbers that cannot be used, with the names
    /// of body and number ([`SimulationError::BadBody`], [`SimulationError::TooLarge`],
    /// [`SimulationError::BadJoint`], [`SimulationError::BadPair`]); bodies that intersect. Nothing changes
    /// then.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SimulationError> {
        snapshot.check()?;
        let mut next = self.clone();
        next.make_way(snapshot);
        snapshot.world.map_or(Ok(()), |place| next.have_world(place))?;
        let mut own_places = BTreeSet::new();
        for state in &snapshot.bodies {
            let place = state.id.index();
            let missing = SimulationError::Snapshot { place };
            let own = next.bodies.get_mut(place).filter(|own| snapshot.has(own, place)).ok_or(missing)?;
            check_surface(&own.name, state.surface_velocity, &snapshot.options)?;
            *own = state.restored(own, snapshot.time)?;
            own.id = state.id;
            if snapshot.world == Some(place) || state.is_of(own) {
                own_places.insert(place);
            }
        }
        let is_kept = |place: usize| snapshot.state(place).is_some();
        let is_whole = |&[a, b]: &[usize; 2]| a < b && is_kept(a) && is_kept(b);
        for joint in snapshot.joints.iter().filter(|joint| !joint.is_gone()) {
            if let Some(&place) = joint.bodies.iter().find(|&&place| !is_kept(place)) {
                return Err(SimulationError::Snapshot { place });
            }
            joint.check(joint.bodies.map(|place| &next.bodies[place]))?;
        }
        let taken =
            |pairs: &[[usize; 2]]| pairs.iter().filter(|p| is_whole(p)).map(|&[a, b]| (a, b)).collect();
        next.ignored = taken(&snapshot.ignored);
        next.touching = taken(&snapshot.touching);
        next.materials.clear();
        for pair in snapshot.materials.iter().filter(|pair| is_whole(&pair.bodies)) {
            let &PairMaterial { bodies: [a, b], restitution, friction } = pair;
            if let Some(Fault { name, value, reason, .. }) = material_fault(restitution, friction) {
                let [a, b] = [a, b].map(|place| next.bodies[place].name.to_string());
                return Err(SimulationError::BadPair { a, b, name, value: shown([value]), reason });
            }
            next.materials.insert((a, b), Material::new(restitution, friction));
        }
        next.pairs.clear();
        for state in snapshot.pairs.iter().filter(|pair| is_whole(&pair.bodies)) {
            let [a, b] = state.bodies;
            let is_own = own_places.contains(&a) && own_places.contains(&b);
            let source = if is_own { Source::Held } else { Source::Read };
            let pair = state.restored([&next.bodies[a], &next.bodies[b]], source)?;
            next.pairs.insert((a, b), Box::new(pair));
        }
        next.joints.clone_from(&snapshot.joints);
        next.unchecked = snapshot.unchecked.iter().copied().filter(|&place| is_kept(place)).collect();
        next.options = snapshot.options;
        next.world = snapshot.world;
        (next.time, next.steps) = (snapshot.time, snapshot.steps);
        next.greatest_energy = snapshot.greatest_energy;
        next.neighbors = crate::pairs::neighbors::Neighbors::default();
        next.recorder = crate::record::Recorder::default();
        next.touches.clone_from(&snapshot.touches);
        if own_places.len() < snapshot.bodies.len() {
            next.check_all()?;
        }
        *self = next;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::contents::Held;
    use crate::{Body, Joint, JointKind, Kind};
    use d2m_bvh::MeshTree;
    use glam::DVec3;
    use std::sync::Arc;

    type Change = &'static dyn Fn(&mut Snapshot);

    /// Two cubes, three apart, and their state as a file keeps it.
    fn written() -> (Simulation, Snapshot) {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        for x in [0.0, 3.0] {
            simulation.add(&Body::new("cube", Arc::clone(&cube)).with_position(DVec3::X * x)).unwrap();
        }
        simulation.step().unwrap();
        let snapshot = read(simulation.snapshot());
        (simulation, snapshot)
    }

    /// The part of a snapshot that a file keeps.
    fn read(mut snapshot: Snapshot) -> Snapshot {
        for state in &mut snapshot.bodies {
            state.held = Held::default();
        }
        snapshot
    }

    /// Bodies that tumble onto a floor, and onto each other.
    fn heap() -> Simulation {
        let shape = |name: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(name).unwrap()));
        let mut simulation = Simulation::new(SimulationOptions::default().with_step(1.0 / 64.0)).unwrap();
        let floor = Body::new("floor", shape("box?x=5&y=0.5&z=5")).with_kind(Kind::Static);
        simulation.add(&floor.with_position(DVec3::Y * -0.5)).unwrap();
        let shapes = ["tetrahedron?scale=0.4", "box?x=0.2&y=0.3&z=0.2", "icosphere?triangles=80&scale=0.3"];
        for (k, name) in shapes.into_iter().enumerate() {
            let spin = DVec3::new(2.0, -1.0, 1.5) * (1.0 + k as f64);
            let body = Body::new(name, shape(name)).with_friction(0.5).with_restitution(0.5 * (k % 2) as f64);
            let place = DVec3::new(0.1 * k as f64, 0.6 + 0.7 * k as f64, 0.0);
            simulation.add(&body.with_position(place).with_angular_velocity(spin)).unwrap();
        }
        simulation
    }

    /// From each state of a run the next step has the same bits, whether the state was held or read.
    #[test]
    fn every_state_goes_on_with_the_same_bits() {
        let mut next = heap();
        for k in 0..60 {
            let simulation = next.clone();
            next.step().unwrap();
            let after = next.snapshot();
            for snapshot in [simulation.snapshot(), read(simulation.snapshot())] {
                let mut other = next.clone();
                other.restore(&snapshot).unwrap();
                assert_eq!(other.snapshot(), snapshot, "{k}");
                other.step().unwrap();
                assert_eq!(other.snapshot(), after, "{k}");
            }
        }
        assert!(next.touch(next.bodies[0].id, next.bodies[1].id));
    }

    /// Settings, places and joints that no simulation comes to are refused by their names.
    #[test]
    fn states_that_cannot_be_are_refused() {
        let (mut simulation, whole) = written();
        let ids: Vec<_> = simulation.ids().collect();
        let hinge = Joint::new(JointKind::Revolute, ids[0], Some(ids[1]), DVec3::X);
        simulation.add_joint(&hinge).unwrap();
        simulation.set_pair(ids[0], ids[1], 0.5, 0.5).unwrap();
        let jointed = read(simulation.snapshot());
        let refused = |change: Change| {
            let mut changed = jointed.clone();
            change(&mut changed);
            simulation.clone().restore(&changed).unwrap_err().to_string()
        };
        let pair = "cube and cube";
        let changes: [(&str, &str, Change); 15] = [
            ("", "time", &|s| s.time = f64::INFINITY),
            ("", "steps", &|s| s.steps = u64::MAX),
            ("", "greatest energy", &|s| s.greatest_energy = f64::NAN),
            ("", "gravity", &|s| s.options.gravity.y = f64::NAN),
            ("place 0", "", &|s| s.bodies.swap(0, 1)),
            ("place 7", "", &|s| s.world = Some(7)),
            ("place 9", "", &|s| s.joints[0].bodies[1] = 9),
            (pair, "pair", &|s| s.joints[0].bodies.swap(0, 1)),
            (pair, "pair", &|s| s.joints[0].bodies = [0, 0]),
            (pair, "limits", &|s| s.joints[0].joint.limits = Some([1.0, 0.0])),
            (pair, "friction", &|s| s.joints[0].joint.friction = -1.0),
            (pair, "times of the forces", &|s| s.joints[0].acted.from = f64::NAN),
            (pair, "motor's impulse", &|s| s.joints[0].owed = f64::INFINITY),
            (pair, "restitution", &|s| s.materials[0].restitution = 2.0),
            (pair, "friction", &|s| s.materials[0].friction = f64::NAN),
        ];
        for (who, what, change) in changes {
            let said = refused(change);
            assert!(said.contains(who) && said.contains(what), "{who} {what}: {said}");
        }
        simulation.restore(&jointed).unwrap();
        simulation.restore(&whole).unwrap();
    }

    /// A body and itself are no pair that a snapshot could lose.
    #[test]
    fn nothing_is_kept_of_a_body_and_itself() {
        let (mut simulation, _) = written();
        let ids: Vec<_> = simulation.ids().collect();
        simulation.ignore(ids[0], ids[0]);
        simulation.ignore(ids[1], ids[0]);
        simulation.set_pair(ids[0], ids[0], 0.5, 0.5).unwrap();
        let snapshot = simulation.snapshot();
        simulation.restore(&snapshot).unwrap();
        assert_eq!(simulation.snapshot(), snapshot);
    }

    /// Time that has passed without steps is skipped at once, and where no number of steps leads on an error
    /// says so.
    #[test]
    fn steps_go_on_after_a_long_time() {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.step_to(1e9).unwrap();
        simulation.step().unwrap();
        assert!(simulation.time() > 1e9 && simulation.time() < 1e9 + 0.02);
        simulation.step_to(1e30).unwrap();
        assert!(simulation.step().unwrap_err().to_string().contains("end of the step"));
    }

    /// Changes in a file are checked where the next step begins with them.
    #[test]
    fn a_place_of_a_file_is_checked() {
        let (mut simulation, mut snapshot) = written();
        simulation.restore(&snapshot).unwrap();
        snapshot.bodies[1].position = DVec3::X * 0.5;
        assert!(matches!(simulation.restore(&snapshot), Err(SimulationError::Intersecting { .. })));
    }

    /// A body that is asleep and fast according to a file stands still: nothing would be proven of its
    /// flight.
    #[test]
    fn what_is_asleep_in_a_file_stands_still() {
        let (mut simulation, mut snapshot) = written();
        snapshot.bodies[1].asleep = true;
        let flight = snapshot.bodies[1].flight;
        snapshot.bodies[1].flight = flight.with_linear_velocity(DVec3::X * -100.0);
        simulation.restore(&snapshot).unwrap();
        for _ in 0..5 {
            simulation.step().unwrap();
        }
        assert_eq!(simulation.position(snapshot.bodies[1].id), DVec3::X * 3.0);
    }
}
