//! The simulation: bodies, settings, time.

use crate::body::rigid_body::{RigidBody, Role};
use crate::joint::rows::Joined;
use crate::numbers::LARGEST;
use crate::pairs::known::Pair;
use crate::pairs::neighbors::Neighbors;
use crate::record::Recorder;
use crate::{
    Body, BodyId, ContactImpulse, Kind, MassProperties, Segment, SimulationError, SimulationOptions,
    TouchEvent,
};
use d2m_bvh::{MeshTree, TriMesh};
use d2m_contact::{ContactPoint, Material};
use d2m_motion::Pose;
use glam::{DQuat, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The report of a step.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
/// let falling = simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 0.6))?;
/// let report = simulation.step()?;
/// assert!(report.contacts().count() == 0 && report.events == 0); // still in the air
/// assert!(simulation.position(falling).y < 0.6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// The segments that are complete now. The last segment of a step is complete after the next one (its impulses are
    /// those of that step's velocity solve); [`Simulation::finish`] gives it.
    pub segments: Vec<Segment>,
    /// Contact events in this step: those that
    /// [`SimulationOptions::max_events`](crate::SimulationOptions::max_events) limits, and impacts.
    pub events: u32,
    /// Pairs of bodies that were queried for a time of contact.
    pub queries: u64,
    /// The largest residual of the velocities that were solved for, a speed: how far they are from the law of
    /// contact. It is the natural map d |λ − P(λ − (u − b + μ |u_t| n)/d)| of a contact with the impulse λ,
    /// the relative velocity u, the least normal rate b, the projection P on Coulomb's cone and the change d
    /// of u by an impulse of one: zero where the law holds exactly.
    pub residual: f64,
    /// Bodies that begin to touch, or stop, in the order of time.
    pub touches: Vec<TouchEvent>,
}

impl StepReport {
    /// The impulses of all segments, in the order of time.
    pub fn contacts(&self) -> impl Iterator<Item = &ContactImpulse> {
        self.segments.iter().flat_map(|segment| &segment.contacts)
    }
}

/// Rigid bodies that never pass through each other.
///
/// Promise: no two bodies (not ignored, at least one of them dynamic) share a point at any time of any
/// [`Segment`]. Every segment ends at a time until which exactly its numbers are certified. The results are
/// bitwise identical at any number of threads.
///
/// ```
/// use d2m_bvh::MeshTree;
/// use d2m_dynamics::{Body, Simulation, SimulationOptions};
/// use glam::DVec3;
/// use std::sync::Arc;
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
/// let one = Body::new("one", cube).with_restitution(1.0);
/// let two = one.clone().with_position(DVec3::X * 2.0);
/// let one = simulation.add(&one.with_linear_velocity(DVec3::X * 2.0))?;
/// let two = simulation.add(&two)?;
/// while simulation.time() < 1.0 {
///     simulation.step()?;
/// }
/// assert!(simulation.linear_velocity(one).length() < 1e-9);
/// assert!((simulation.linear_velocity(two) - DVec3::X * 2.0).length() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Simulation {
    pub(crate) options: SimulationOptions,
    pub(crate) bodies: Vec<RigidBody>,
    pub(crate) pairs: BTreeMap<(usize, usize), Box<Pair>>,
    pub(crate) ignored: BTreeSet<(usize, usize)>,
    pub(crate) materials: BTreeMap<(usize, usize), Material>,
    pub(crate) time: f64,
    /// Steps since the start, which began at time 0.
    pub(crate) steps: u64,
    pub(crate) recorder: Recorder,
    /// Boxes about the flights of the bodies, and the neighbors of each.
    pub(crate) neighbors: Neighbors,
    /// The greatest kinetic energy of all bodies together so far.
    pub(crate) greatest_energy: f64,
    pub(crate) joints: Vec<Joined>,
    /// The place of the body that stands for the world, once there is a joint with the world.
    pub(crate) world: Option<usize>,
    /// Bodies that have to be checked for intersections before anything flies.
    pub(crate) unchecked: BTreeSet<usize>,
    /// For each place that there ever was, how many bodies have left it.
    pub(crate) generations: Vec<u32>,
    /// Pairs of bodies that touch, as reported, and changes that are not reported yet.
    pub(crate) touching: BTreeSet<(usize, usize)>,
    pub(crate) touches: Vec<TouchEvent>,
}

impl core::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Simulation")
            .field("time", &self.time)
            .field("bodies", &self.bodies.len())
            .finish_non_exhaustive()
    }
}

impl Simulation {
    /// No momentum, angular momentum or velocity of a body may exceed this: their products are still numbers.
    pub const LARGEST: f64 = LARGEST;

    /// An empty simulation at time 0.
    ///
    /// # Errors
    /// A setting that is not finite and positive.
    pub fn new(options: SimulationOptions) -> Result<Self, SimulationError> {
        options.check()?;
        Ok(Self {
            options,
            bodies: Vec::new(),
            pairs: BTreeMap::new(),
            ignored: BTreeSet::new(),
            materials: BTreeMap::new(),
            time: 0.0,
            steps: 0,
            recorder: Recorder::default(),
            neighbors: Neighbors::default(),
            greatest_energy: 0.0,
            joints: Vec::new(),
            world: None,
            unchecked: BTreeSet::new(),
            generations: Vec::new(),
            touching: BTreeSet::new(),
            touches: Vec::new(),
        })
    }

    /// The present time.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// The settings.
    pub const fn options(&self) -> &SimulationOptions {
        &self.options
    }

    /// Is there a joint that was not removed?
    pub(crate) fn has_joints(&self) -> bool {
        !self.joints.iter().all(Joined::is_gone)
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.bodies.iter().filter(|body| body.role.is_named()).count()
    }

    /// All bodies, in the order of their places: the order in which they were added, as long as none was
    /// removed.
    ///
    /// ```
    /// # use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let one = simulation.add(&Body::new("one", Arc::clone(&cube)))?;
    /// let two = simulation.add(&Body::new("two", cube).with_position(DVec3::X * 3.0))?;
    /// assert_eq!(simulation.ids().collect::<Vec<_>>(), [one, two]);
    /// let highest = simulation.ids().map(|id| simulation.position(id).y).fold(f64::MIN, f64::max);
    /// assert_eq!(highest, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + use<> {
        let ids: Vec<BodyId> =
            self.bodies.iter().filter(|body| body.role.is_named()).map(|body| body.id).collect();
        ids.into_iter()
    }

    /// True if the simulation has no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The body's name.
    pub fn name(&self, body: BodyId) -> &str {
        &self.bodies[self.place(body)].name
    }

    /// Mass properties; `None` for static and kinematic bodies.
    pub fn mass_properties(&self, body: BodyId) -> Option<MassProperties> {
        let body = &self.bodies[self.place(body)];
        let (mass, center, inertia) = (body.mass, body.center, body.inertia);
        body.is_dynamic().then_some(MassProperties { mass, center, inertia })
    }

    /// The point of the mesh frame whose position is reported: the center of mass.
    pub fn center(&self, body: BodyId) -> DVec3 {
        self.bodies[self.place(body)].center
    }

    /// No point of the body is further from its center of mass.
    pub fn radius(&self, body: BodyId) -> f64 {
        self.bodies[self.place(body)].radius
    }

    /// World position of the center of mass.
    pub fn position(&self, body: BodyId) -> DVec3 {
        self.pose(body).translation
    }

    /// Orientation of the mesh frame.
    pub fn orientation(&self, body: BodyId) -> DQuat {
        self.pose(body).rotation
    }

    /// Pose of the mesh frame; its reference point is the center of mass.
    pub fn pose(&self, body: BodyId) -> Pose {
        self.bodies[self.place(body)].pose_at(self.time)
    }

    /// Velocity of the center of mass in the last flight.
    pub fn linear_velocity(&self, body: BodyId) -> DVec3 {
        self.bodies[self.place(body)].shown_velocity().linear
    }

    /// Angular velocity in the last flight, world axes.
    pub fn angular_velocity(&self, body: BodyId) -> DVec3 {
        self.bodies[self.place(body)].shown_velocity().angular
    }

    /// Angular momentum about the center of mass, world axes.
    pub fn angular_momentum(&self, body: BodyId) -> DVec3 {
        self.bodies[self.place(body)].angular_momentum
    }

    /// Does the body sleep?
    pub fn is_asleep(&self, body: BodyId) -> bool {
        self.bodies[self.place(body)].asleep
    }

    /// May these two meet, so that the simulation considers them?
    pub(crate) fn meets(&self, a: usize, b: usize) -> bool {
        let (one, two) = (&self.bodies[a], &self.bodies[b]);
        (one.is_dynamic() || two.is_dynamic())
            && (one.role, two.role) == (Role::Body, Role::Body)
            && self.is_admitted(a, b)
    }

    /// Do their groups admit these two to each other, and is the pair not ignored?
    pub(crate) fn is_admitted(&self, a: usize, b: usize) -> bool {
        self.bodies[a].groups.admit(self.bodies[b].groups) && !self.ignored.contains(&(a.min(b), a.max(b)))
    }

    /// Makes the body that stands for the world, without a place.
    pub(crate) fn new_world(&self) -> Result<RigidBody, SimulationError> {
        let wanted = "a length that is not lost";
        let bad = |_| SimulationError::BadOption { name: "gap", value: self.options.gap, wanted };
        let tree = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO).map_err(bad)?));
        self.made(&Body::new("the world", tree).with_kind(Kind::Static))
    }

    /// Gives the world this place if it is free, or the first free one.
    pub(crate) fn settle_world(&mut self, world: RigidBody, place: Option<usize>) {
        let id = self.settle_in(world, place);
        self.bodies[id.index()].role = Role::World;
        self.world = Some(id.index());
    }

    /// Makes the world if there is none, at this place if it is free.
    pub(crate) fn have_world(&mut self, place: usize) -> Result<(), SimulationError> {
        if self.world.is_none() {
            let world = self.new_world()?;
            self.settle_world(world, Some(place));
        }
        Ok(())
    }

    /// The contacts that a pair had when it was measured last.
    pub(crate) fn contacts(&self, pair: (usize, usize)) -> &[ContactPoint] {
        self.pairs.get(&pair).map_or(&[], |pair| &pair.contacts)
    }

    pub(crate) fn material(&self, a: usize, b: usize) -> Material {
        let (one, two) = (&self.bodies[a], &self.bodies[b]);
        self.materials.get(&(a.min(b), a.max(b))).copied().unwrap_or(Material::new(
            one.restitution.max(two.restitution),
            0.5 * (one.friction + two.friction),
        ))
    }
}
