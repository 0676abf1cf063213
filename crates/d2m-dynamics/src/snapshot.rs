//! The state of a simulation apart from its meshes, to be kept and restored.

use crate::body::{Damping, Groups, Kind};
use crate::contact::{ContactPoint, Material, tangents};
use crate::joined::Joined;
use crate::pairs::Pair;
use crate::quiet::Quiet;
use crate::rigid_body::{RigidBody, Role, Target};
use crate::{BodyId, Motion, Simulation, SimulationError, SimulationOptions};
use d2m_bvh::{MeshTree, Solid};
use d2m_feature::FeaturePair;
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Everything that changes in a simulation: poses, momenta, flights, impulses of resting contacts, who sleeps and who touches, joints, kinds,
/// materials, groups, which pairs are ignored.
///
/// Promise: [`Simulation::restore`] followed by the same steps gives the same bits. Meshes and masses are not in it: it belongs to a
/// simulation that has its bodies, and perhaps others. With the feature `serde` it can be written in any format; motions of kinematic bodies
/// are not written, those of the simulation go on.
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
    /// By ascending places.
    bodies: Vec<BodyState>,
    pairs: Vec<PairState>,
    joints: Vec<Joined>,
    ignored: Vec<[usize; 2]>,
    materials: Vec<PairMaterial>,
    touching: Vec<[usize; 2]>,
    unchecked: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct PairMaterial {
    bodies: [usize; 2],
    restitution: f64,
    friction: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum KindState {
    Dynamic,
    Static,
    Kinematic,
    Driven,
}

/// What is held of a body besides its state; lost when a snapshot is written.
#[derive(Clone, Default)]
struct Held(Option<HeldBody>);

/// What proofs about a body are about, and the motion that it follows.
#[derive(Clone)]
struct HeldBody {
    tree: Arc<MeshTree>,
    role: Role,
    center: DVec3,
    rounding: f64,
    solid: Solid,
    motion: Option<Motion>,
}

/// Snapshots are compared by their states.
impl PartialEq for Held {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl core::fmt::Debug for Held {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("Held").field(&self.0.is_some()).finish()
    }
}

impl Held {
    fn of(body: &RigidBody) -> Self {
        let motion = match &body.kind {
            Kind::Kinematic(motion) => Some(Arc::clone(motion)),
            _ => None,
        };
        let (tree, center) = (Arc::clone(&body.tree), body.center);
        let (role, rounding, solid) = (body.role, body.rounding, body.solid);
        Self(Some(HeldBody { tree, role, center, rounding, solid, motion }))
    }

    /// Is this the body that the state was taken of?
    fn is_of(&self, body: &RigidBody) -> bool {
        self.0.as_ref().is_some_and(|held| {
            Arc::ptr_eq(&held.tree, &body.tree)
                && (held.center, held.rounding) == (body.center, body.rounding)
                && (held.role, held.solid) == (body.role, body.solid)
        })
    }
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct BodyState {
    id: BodyId,
    kind: KindState,
    restitution: f64,
    friction: f64,
    damping: Damping,
    groups: Groups,
    surface_velocity: DVec3,
    target: Option<Target>,
    #[cfg_attr(feature = "serde", serde(skip))]
    held: Held,
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
    has_flown: bool,
    asleep: bool,
    quiet: Quiet,
    gained: f64,
}

/// The velocities of a flight from where the body is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct FlightState {
    linear: DVec3,
    angular: DVec3,
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
    running: [f64; 2],
    impulse: f64,
    sliding: [f64; 2],
}

impl Simulation {
    /// The state between two steps.
    pub fn snapshot(&self) -> Snapshot {
        let bodies = self.bodies.iter().filter(|body| body.role != Role::Vacant).map(BodyState::of).collect();
        let pairs = self.pairs.iter().map(|(&(a, b), pair)| PairState {
            bodies: [a, b],
            gap: pair.gap,
            nearest: pair.nearest,
            reach: pair.reach,
            contacts: pair.contacts.iter().map(ContactState::of).collect(),
        });
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
            unchecked: self.unchecked.iter().copied().collect(),
        }
    }

    /// Goes back to a state of this simulation, or of one with the same bodies. Bodies and joints that were added since are gone, joints that
    /// were taken out are there again; names of bodies that are gone never mean others. Segments begin anew there.
    ///
    /// A state of other bodies than the snapshot was taken of, or one that was written and read, is checked for intersections.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
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
    /// A body of the snapshot that was removed since; settings or numbers that cannot be used; bodies that intersect. Nothing changes then.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SimulationError> {
        snapshot.options.check()?;
        let mut next = self.clone();
        if snapshot.world.is_some() {
            next.world_at(snapshot.world)?;
        }
        let mut is_known = true;
        for state in &snapshot.bodies {
            let place = state.id.index();
            let is_world = snapshot.world == Some(place);
            let missing = SimulationError::Snapshot { place };
            let own = next.bodies.get_mut(place).filter(|own| {
                let is_same = own.role.is_named() && own.id == state.id;
                if is_world { own.role == Role::World } else { is_same }
            });
            let own = own.ok_or(missing)?;
            *own = state.restored(own, snapshot.time)?;
            is_known &= is_world || state.held.is_of(own);
        }
        let is_kept = |place: usize| {
            snapshot.bodies.binary_search_by_key(&place, |state: &BodyState| state.id.index()).is_ok()
        };
        for place in (0..next.bodies.len()).rev().filter(|&place| !is_kept(place)) {
            // Free places at the end go with the last one that is cleared.
            let role = next.bodies.get(place).map_or(Role::Vacant, |body| body.role);
            if role.is_named() {
                next.generations[place] += 1;
            }
            if role != Role::Vacant {
                next.clear_out(place);
            }
        }
        let places = next.bodies.len();
        let is_whole = |&[a, b]: &[usize; 2]| a < b && is_kept(a) && is_kept(b);
        let joined = |joint: &&Joined| joint.bodies.iter().any(|&place| place >= places);
        if let Some(joint) = snapshot.joints.iter().filter(|joint| !joint.is_gone()).find(joined) {
            return Err(SimulationError::Snapshot { place: joint.bodies[0].max(joint.bodies[1]) });
        }
        let taken =
            |pairs: &[[usize; 2]]| pairs.iter().filter(|p| is_whole(p)).map(|&[a, b]| (a, b)).collect();
        next.ignored = taken(&snapshot.ignored);
        next.touching = taken(&snapshot.touching);
        next.materials = snapshot
            .materials
            .iter()
            .filter(|pair| is_whole(&pair.bodies))
            .map(|&PairMaterial { bodies: [a, b], restitution, friction }| {
                ((a, b), Material { restitution, friction })
            })
            .collect();
        next.pairs = snapshot
            .pairs
            .iter()
            .filter(|pair| is_whole(&pair.bodies))
            .map(|state| {
                let [a, b] = state.bodies;
                let mut pair = Pair::new(state.gap);
                (pair.nearest, pair.reach) = (state.nearest, state.reach);
                pair.contacts = state.contacts.iter().map(|c| c.restored(a, b, state.gap)).collect();
                ((a, b), Box::new(pair))
            })
            .collect();
        next.joints.clone_from(&snapshot.joints);
        next.unchecked = snapshot.unchecked.iter().copied().filter(|&place| is_kept(place)).collect();
        next.options = snapshot.options;
        next.world = snapshot.world;
        (next.time, next.steps) = (snapshot.time, snapshot.steps);
        next.greatest_energy = snapshot.greatest_energy;
        next.neighbors = crate::neighbors::Neighbors::default();
        next.recorder = crate::record::Recorder::default();
        next.touches.clear();
        if !is_known {
            next.check_all()?;
        }
        *self = next;
        Ok(())
    }
}

impl BodyState {
    fn of(body: &RigidBody) -> Self {
        let kind = match &body.kind {
            Kind::Dynamic => KindState::Dynamic,
            Kind::Static => KindState::Static,
            Kind::Kinematic(_) => KindState::Kinematic,
            Kind::Driven => KindState::Driven,
        };
        Self {
            id: body.id,
            kind,
            restitution: body.restitution,
            friction: body.friction,
            damping: body.damping,
            groups: body.groups,
            surface_velocity: body.surface_velocity,
            target: body.target,
            held: Held::of(body),
            time: body.time,
            position: body.position,
            orientation: body.orientation,
            momentum: body.momentum,
            angular_momentum: body.angular_momentum,
            force: body.force,
            torque: body.torque,
            flight: FlightState {
                linear: body.flight.linear_velocity(),
                angular: body.flight.angular_velocity(),
            },
            horizon: body.horizon.is_finite().then_some(body.horizon),
            version: body.version,
            has_flown: body.has_flown,
            asleep: body.asleep,
            quiet: body.quiet,
            gained: body.gained,
        }
    }

    /// The body in this state.
    fn restored(&self, own: &RigidBody, now: f64) -> Result<RigidBody, SimulationError> {
        let bad = |name: &'static str, value: String| SimulationError::BadBody {
            body: own.name.to_string(),
            name,
            value,
        };
        let motion = self.held.0.as_ref().and_then(|held| held.motion.clone());
        let kind = match (self.kind, motion, &own.kind) {
            (KindState::Dynamic, ..) => Kind::Dynamic,
            (KindState::Static, ..) => Kind::Static,
            (KindState::Driven, ..) => Kind::Driven,
            (KindState::Kinematic, Some(motion), _) => Kind::Kinematic(motion),
            (KindState::Kinematic, None, Kind::Kinematic(motion)) => Kind::Kinematic(Arc::clone(motion)),
            (KindState::Kinematic, None, _) => return Err(bad("motion", "of a snapshot".to_owned())),
        };
        let mut body = own.clone();
        let is_other = core::mem::discriminant(&kind) != core::mem::discriminant(&own.kind);
        if is_other {
            // What a motion of another time would place is placed by the snapshot.
            let rebuilt = if matches!(kind, Kind::Kinematic(_)) { Kind::Driven } else { kind.clone() };
            body = own.with_kind(rebuilt, self.time)?;
        }
        body.kind = kind;
        (body.restitution, body.friction) = (self.restitution, self.friction);
        (body.damping, body.groups) = (self.damping, self.groups);
        (body.surface_velocity, body.target) = (self.surface_velocity, self.target);
        body.time = self.time;
        (body.position, body.orientation) = (self.position, self.orientation);
        (body.momentum, body.angular_momentum) = (self.momentum, self.angular_momentum);
        (body.force, body.torque) = (self.force, self.torque);
        body.horizon = self.horizon.unwrap_or(f64::INFINITY);
        (body.version, body.has_flown) = (self.version, self.has_flown);
        (body.asleep, body.quiet) = (self.asleep, self.quiet);
        // It flies from where it is: what is checked is what the next step begins with. What no step moves stands still.
        let flight = if body.is_awake() { self.flight } else { FlightState::default() };
        body.flight = ConstantTwist::try_new(self.position, self.orientation, flight.linear, flight.angular)
            .and_then(|twist| twist.try_with_at(body.center))
            .and_then(|twist| twist.try_with_reference_time(now))
            .map_err(|_| bad("flight of the snapshot", format!("{flight:?}")))?;
        body.gained = self.gained;
        (body.held, body.free, body.lead) = (false, false, None);
        Ok(body)
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
            running: contact.running,
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
            running: self.running,
            row: None,
            impulse: self.impulse,
            sliding: self.sliding,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use d2m_bvh::MeshTree;

    /// Two cubes, three apart, and what a file keeps of them.
    fn written() -> (Simulation, Snapshot) {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        for x in [0.0, 3.0] {
            simulation.add(&Body::new("cube", Arc::clone(&cube)).with_position(DVec3::X * x)).unwrap();
        }
        simulation.step().unwrap();
        let mut snapshot = simulation.snapshot();
        for state in &mut snapshot.bodies {
            state.held = Held::default();
        }
        (simulation, snapshot)
    }

    /// What was changed in a file is checked where the next step begins with it.
    #[test]
    fn a_place_of_a_file_is_checked() {
        let (mut simulation, mut snapshot) = written();
        simulation.restore(&snapshot).unwrap();
        snapshot.bodies[1].position = DVec3::X * 0.5;
        assert!(matches!(simulation.restore(&snapshot), Err(SimulationError::Intersecting { .. })));
    }

    /// What a file says is asleep and fast stands still: nothing would be proven of its flight.
    #[test]
    fn what_is_asleep_in_a_file_stands_still() {
        let (mut simulation, mut snapshot) = written();
        snapshot.bodies[1].asleep = true;
        snapshot.bodies[1].flight.linear = DVec3::X * -100.0;
        simulation.restore(&snapshot).unwrap();
        for _ in 0..5 {
            simulation.step().unwrap();
        }
        assert_eq!(simulation.position(snapshot.bodies[1].id), DVec3::X * 3.0);
    }
}
