//! Queries about the bodies where they are now.

use crate::body::rigid_body::Role;
use crate::shown::shown;
use crate::{BodyId, Simulation};
use d2m_bvh::{
    Contact, Distance, DistanceOptions, Evidence, MeshError, MeshTree, Posed, QueryError, QueryOptions,
    Solid, TriMesh, Window, distance_within,
};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::ConstantTwist;
use d2m_world::{Body, FirstContact, Group, PlannedMotion, World, WorldError};
use glam::DVec3;
use std::sync::Arc;

/// The bodies of a simulation as they are now, at rest in a [`World`]. Its queries state which bodies are
/// near ([`World::proximities`], [`World::clearances_below`]) and what something would meet on its way
/// ([`World::first_contact_of`]). Pairs that do not meet in the simulation are ignored there, so sensors meet
/// nothing. The simulation goes on without it.
///
/// ```
/// use d2m_bvh::{MeshTree, ProximityOptions, QueryOptions};
/// use d2m_dynamics::{Body, Kind, RayAnswer, Simulation, SimulationOptions};
/// use glam::DVec3;
/// use std::sync::Arc;
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let floor = simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static))?;
/// let falling = simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 2.0))?;
/// simulation.step()?;
/// let now = simulation.frozen(QueryOptions::default());
/// // From above: the falling cube, whose top has sunk by half a millimeter.
/// match now.ray(DVec3::Y * 5.0, DVec3::NEG_Y * 10.0)? {
///     RayAnswer::Hit { body, lo, hi, .. } => assert!(body == falling && lo <= 2.5005 && hi >= 2.5 && hi - lo < 1e-6),
///     other => panic!("{other:?}"),
/// }
/// let gap = now.distance(floor, falling)?;
/// assert!(gap.lower > 0.999 && gap.upper < 1.0);
/// let near = now.world().proximities(0.0, &ProximityOptions::new(1.0))?;
/// assert_eq!(near.iter().map(|pair| (now.id(pair.a), now.id(pair.b))).collect::<Vec<_>>(), [(floor, falling)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Frozen {
    world: World,
    /// The bodies' names in the simulation, by places of the world.
    ids: Vec<BodyId>,
}

/// The first body that a ray meets, if any.
///
/// ```
/// # use d2m_bvh::{MeshTree, QueryOptions};
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, RayAnswer, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let wall = simulation.add(&Body::new("wall", cube))?;
/// let now = simulation.frozen(QueryOptions::default());
/// // From 2 towards the wall, whose face is at -0.5.
/// let hit = now.ray(DVec3::X * -2.0, DVec3::X * 4.0)?;
/// assert!(matches!(hit, RayAnswer::Hit { body, lo, .. } if body == wall && lo <= 1.5 && lo > 1.499));
/// assert_eq!(now.ray(DVec3::X * -2.0, DVec3::Y)?, RayAnswer::Free);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RayAnswer {
    /// Certified: the ray meets nothing on its way.
    Free,
    /// Certified: the ray meets nothing before `lo` of its way, and by `hi` it is within the tolerance, and
    /// the minimum separation, of this body.
    Hit {
        /// The first body that it meets.
        body: BodyId,
        /// The length of the way along which it meets nothing.
        lo: f64,
        /// The length of the way by which it has met the body.
        hi: f64,
        /// The point of the body's surface.
        point: DVec3,
        /// Outward unit normal of the body there.
        normal: DVec3,
    },
    /// The budget ran out, or a search that may stop early stopped before it met anything. Certified: the ray
    /// meets nothing before `free_until` of its way.
    Undecided {
        /// The length of the way along which it meets nothing.
        free_until: f64,
    },
}

/// Bodies that neither forces nor contacts move: two of them do not meet.
const HELD: Group = Group(0);
/// Bodies that forces and contacts move.
const MOVED: Group = Group(1);
/// Bodies through which others pass.
const SENSED: Group = Group(2);

impl Simulation {
    /// The bodies where they are now, for queries with these options.
    pub fn frozen(&self, options: QueryOptions) -> Frozen {
        let mut world = World::new(options);
        for (a, b) in [(HELD, HELD), (SENSED, HELD), (SENSED, MOVED), (SENSED, SENSED)] {
            world.ignore_groups(a, b, true);
        }
        let ids: Vec<BodyId> = self.ids().collect();
        let added: Vec<d2m_world::BodyId> = ids
            .iter()
            .map(|id| {
                let own = &self.bodies[id.index()];
                let pose = own.pose_at(self.time);
                let rest = ConstantTwist::REST
                    .with_at(own.center)
                    .with_position(pose.translation)
                    .with_orientation(pose.rotation);
                let body =
                    Body::new(Arc::clone(&own.tree), rest).with_solid(own.solid).with_radius(own.rounding);
                let group = match own.role {
                    Role::Sensor => SENSED,
                    _ if own.is_dynamic() => MOVED,
                    _ => HELD,
                };
                world.add(body.with_group(group))
            })
            .collect();
        let is_of = |pair: (usize, usize)| {
            let find = |place| ids.binary_search_by_key(&place, |id: &BodyId| id.index()).ok();
            Some([added[find(pair.0)?], added[find(pair.1)?]])
        };
        for [a, b] in self.ignored.iter().filter_map(|&pair| is_of(pair)) {
            world.ignore_pair(a, b, true);
        }
        let of_groups = |id: &BodyId| self.bodies[id.index()].groups;
        for (k, a) in ids.iter().enumerate().filter(|(_, id)| of_groups(id) != crate::Groups::ALL) {
            for (l, b) in ids.iter().enumerate().filter(|(l, _)| *l != k) {
                if !of_groups(a).admit(of_groups(b)) {
                    world.ignore_pair(added[k], added[l], true);
                }
            }
        }
        Frozen { world, ids }
    }
}

impl Frozen {
    /// The world; at any of its times the bodies are where they were.
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The simulation's name of a body of the world.
    ///
    /// # Panics
    /// If the name is of another world, with more bodies.
    pub fn id(&self, body: d2m_world::BodyId) -> BodyId {
        self.ids[body.index()]
    }

    /// The world's name of a body of the simulation; none if it was not there.
    pub fn body(&self, body: BodyId) -> Option<d2m_world::BodyId> {
        let place = self.ids.binary_search(&body).ok()?;
        self.world.ids().nth(place)
    }

    /// The first body that a point meets on a straight way from `origin` to `origin + way`:
    /// [`World::first_contact_of`] of a body that is a point, in any group. It passes through sensors, as
    /// bodies do.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn ray(&self, origin: DVec3, way: DVec3) -> Result<RayAnswer, RayError> {
        let mut world = self.world.clone();
        let motion = ConstantTwist::try_new(origin, glam::DQuat::IDENTITY, way, DVec3::ZERO)
            .map_err(|_| RayError::BadRay { origin, way })?;
        let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO)?));
        // It meets what a moving body would meet, in any group.
        let body = world.add(Body::new(point, motion).with_group(MOVED));
        let plan = [PlannedMotion { body, motion: Arc::new(motion) }];
        // The length of a part of the way, rounded outward.
        let length = IntervalVec3::point(way).norm();
        let along = |part: f64| length * Interval::point(part);
        Ok(match world.first_contact_of(&plan, Window::UNIT)? {
            FirstContact::Separated => RayAnswer::Free,
            FirstContact::Undecided { clear_until, .. } => {
                RayAnswer::Undecided { free_until: along(clear_until).lo().max(0.0) }
            }
            // A search that stopped early may be near nothing, at any time.
            FirstContact::Contact { contact, .. } if contact.evidence == Evidence::Early => {
                RayAnswer::Undecided { free_until: along(contact.time_lo).lo().max(0.0) }
            }
            FirstContact::Contact { a, contact, .. } => {
                // The point was added last, so it is the second body.
                let Contact { time_lo, time_hi, point_a, normal, .. } = contact;
                let (lo, hi) = (along(time_lo).lo().max(0.0), along(time_hi).hi());
                RayAnswer::Hit { body: self.id(a), lo, hi, point: point_a, normal }
            }
        })
    }

    /// The distance of two bodies, even of an ignored pair: [`d2m_bvh::distance`]. It is zero where one is
    /// filled and holds the other.
    ///
    /// # Errors
    /// A pair that cannot be queried.
    ///
    /// # Panics
    /// If one of them was not there.
    pub fn distance(&self, a: BodyId, b: BodyId) -> Result<Distance, QueryError> {
        let of = |id: BodyId| {
            let body = self.body(id).unwrap_or_else(|| panic!("{id:?} was not in the simulation"));
            self.world.body(body)
        };
        let bodies = [of(a), of(b)];
        let solids = bodies.map(|body| body.solid().unwrap_or(Solid::Surface));
        let [one, two] = bodies.map(|body| Posed::new(body.tree(), body.motion().pose_and_twist(0.0).0));
        let options = DistanceOptions::default().with_solids(solids);
        // Without a cutoff there is always a closest pair of triangles.
        let found = distance_within(one, two, &options)?.ok_or(QueryError::BadPose { body: 0 })?;
        Ok(found.with_radii(bodies.map(Body::radius)))
    }
}

/// A ray that cannot be followed.
///
/// ```
/// use d2m_dynamics::{RayError, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let empty = Simulation::new(SimulationOptions::default())?;
/// let error = empty.frozen(d2m_bvh::QueryOptions::default()).ray(DVec3::ZERO, DVec3::INFINITY).unwrap_err();
/// assert!(matches!(error, RayError::BadRay { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RayError {
    /// Its numbers are not finite.
    #[error("a ray from {} along {} cannot be followed", shown(origin.to_array()), shown(way.to_array()))]
    BadRay {
        /// Where it begins.
        origin: DVec3,
        /// Its way.
        way: DVec3,
    },
    /// The point of the ray could not be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A pair that cannot be queried.
    #[error(transparent)]
    World(#[from] WorldError),
}
