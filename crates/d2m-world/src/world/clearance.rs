//! How near the bodies of a world come to each other.

use super::schedule::Uncovered;
use super::{BodyId, PlannedMotion, World, WorldError};
use crate::box_tree::IndexPair;
use crate::nearest::{PairDistance, PairFault, PairsOfBodies};
use d2m_bvh::{Clearance, ClearanceOptions, Moving, Window};
use d2m_motion::CoveredMotion;

/// The least distance of two bodies of a world over a window.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{ClearanceOptions, QueryOptions, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, World};
/// use glam::DVec3;
/// let mut world = World::new(QueryOptions::default());
/// for x in [0.0, 3.0, 7.0] {
///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * x)));
/// }
/// let near = world.clearances_below(3.5, Window::UNIT, &ClearanceOptions::default())?;
/// let places: Vec<_> = near.iter().map(|pair| (pair.a.index(), pair.b.index())).collect();
/// assert_eq!(places, [(0, 1), (1, 2)]); // 2 and 3 apart
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub struct PairClearance {
    /// The first body: the one with the smaller place.
    pub a: BodyId,
    /// The second body.
    pub b: BodyId,
    /// Their least distance.
    pub clearance: Clearance,
}

/// Bodies of a world in the form of pair queries, and the pairs that count, by their places in the lists.
struct Listed<'w> {
    places: Vec<u32>,
    bodies: Vec<Moving<'w>>,
    pairs: Vec<[usize; 2]>,
}

impl World {
    /// The least distance of all pairs that are not ignored, over a window: which two bodies come nearest, when, and how near. `None` where
    /// there is no pair. The budget of the options is one for all pairs; separations count nothing.
    ///
    /// Promise: no two bodies come nearer than `clearance.lower` at any time of the window, and these two come as near as
    /// `clearance.upper`. The enclosure is as narrow as that of [`d2m_bvh::clearance`].
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{ClearanceOptions, QueryOptions, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, World};
    /// use glam::DVec3;
    /// let mut world = World::new(QueryOptions::default());
    /// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    /// let passing = ConstantTwist::REST.with_position(DVec3::new(-4.0, 1.25, 0.0)).with_linear_velocity(DVec3::X * 8.0);
    /// let thrown = world.add(Body::new(Arc::clone(&cube), passing));
    /// world.add(Body::new(cube, ConstantTwist::REST.with_position(DVec3::Z * 9.0)));
    /// let nearest = world.nearest_pair(Window::UNIT, &ClearanceOptions::default())?.expect("there are pairs");
    /// assert_eq!((nearest.a, nearest.b), (wall, thrown));
    /// assert!(nearest.clearance.lower <= 0.25 && 0.25 <= nearest.clearance.upper);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// What a body counts as is said by it or by the options of the world; `solid` of these options has no part in it.
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    pub fn nearest_pair(
        &self,
        window: Window,
        options: &ClearanceOptions,
    ) -> Result<Option<PairClearance>, WorldError> {
        let listed = self.listed(window, |_| true)?;
        let found = listed.of(window).nearest(options, 0.0);
        Ok(found.map_err(|fault| self.fault(&listed, fault))?.map(|found| self.named_pair(&listed, found)))
    }

    /// As [`World::nearest_pair`], if these bodies moved so and all others as they do: of the pairs with one of these.
    ///
    /// ```
    /// # use d2m_bvh::{MeshTree, QueryOptions, Window};
    /// # use d2m_motion::ConstantTwist;
    /// # use d2m_world::{Body, World};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let at = |x: f64, v: f64| ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
    /// let mut world = World::new(QueryOptions::default());
    /// let wall = world.add(Body::new(Arc::clone(&cube), at(0.0, 0.0)));
    /// let cart = world.add(Body::new(cube, at(-5.0, 2.0)));
    /// use d2m_bvh::ClearanceOptions;
    /// use d2m_world::PlannedMotion;
    /// // Were it faster, it would come within one unit of the wall: nothing changes in the world.
    /// let plan = [PlannedMotion { body: cart, motion: Arc::new(at(-5.0, 3.0)) }];
    /// let nearest = world.nearest_pair_of(&plan, Window::UNIT, &ClearanceOptions::default())?.expect("there is a pair");
    /// assert!((nearest.a, nearest.b) == (wall, cart) && nearest.clearance.lower <= 1.0 && nearest.clearance.upper >= 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`World::nearest_pair`].
    ///
    /// # Panics
    /// If a body was removed, or its name belongs to another world.
    pub fn nearest_pair_of(
        &self,
        plan: &[PlannedMotion],
        window: Window,
        options: &ClearanceOptions,
    ) -> Result<Option<PairClearance>, WorldError> {
        let (world, planned) = self.planned(plan);
        let listed = world.listed(window, |pair| is_among(&planned, pair))?;
        let found = listed.of(window).nearest(options, 0.0);
        Ok(found.map_err(|fault| world.fault(&listed, fault))?.map(|found| world.named_pair(&listed, found)))
    }

    /// The pairs that are not ignored and come within a distance in a window, by their least distances: all others are proven to be at least
    /// so far apart. The budget of the options is one for each pair.
    ///
    /// ```
    /// # use d2m_bvh::{MeshTree, QueryOptions, Window};
    /// # use d2m_motion::ConstantTwist;
    /// # use d2m_world::{Body, World};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let at = |x: f64, v: f64| ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
    /// let mut world = World::new(QueryOptions::default());
    /// let wall = world.add(Body::new(Arc::clone(&cube), at(0.0, 0.0)));
    /// let cart = world.add(Body::new(cube, at(-5.0, 2.0)));
    /// use d2m_bvh::ClearanceOptions;
    /// // It ends two units before the wall.
    /// let below = |limit: f64| world.clearances_below(limit, Window::UNIT, &ClearanceOptions::default());
    /// assert!(below(1.9)?.is_empty());
    /// assert_eq!(below(2.1)?.iter().map(|pair| (pair.a, pair.b)).collect::<Vec<_>>(), [(wall, cart)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`World::nearest_pair`].
    pub fn clearances_below(
        &self,
        limit: f64,
        window: Window,
        options: &ClearanceOptions,
    ) -> Result<Vec<PairClearance>, WorldError> {
        let listed = self.listed(window, |_| true)?;
        let found = listed.of(window).below(limit, options).map_err(|fault| self.fault(&listed, fault))?;
        Ok(found.into_iter().map(|found| self.named_pair(&listed, found)).collect())
    }

    /// The bodies, whose motions have to cover the window, and the pairs that are not ignored.
    fn listed(&self, window: Window, counts: impl Fn(IndexPair) -> bool) -> Result<Listed<'_>, WorldError> {
        let all = (0..self.slots.places() as u32).filter_map(|place| Some((place, self.slots.at(place)?)));
        // What is not said of a body is said by the options of the world, not by those of a clearance.
        let (places, bodies): (Vec<u32>, Vec<Moving<'_>>) = all
            .map(|(place, body)| (place, body.moving()))
            .map(|(place, moving)| (place, moving.with_solid(moving.solid_in(&self.options))))
            .unzip();
        for (&place, body) in places.iter().zip(&bodies) {
            let covered = CoveredMotion::try_new(body.motion, window.start(), window.end());
            if let Err(outside) = covered {
                return Err(self.uncovered(Uncovered { place, outside }));
            }
        }
        let numbers = 0..places.len();
        let pairs = numbers.flat_map(|a| (a + 1..places.len()).map(move |b| [a, b]));
        let is_wanted = |[a, b]: &[usize; 2]| {
            let pair = [places[*a], places[*b]];
            counts(pair) && !self.filter.ignores(pair, self.slots.groups(pair))
        };
        let pairs = pairs.filter(is_wanted).collect();
        Ok(Listed { places, bodies, pairs })
    }

    fn fault(&self, listed: &Listed<'_>, PairFault { pair, error }: PairFault) -> WorldError {
        let [a, b] = pair.map(|body| self.slots.id(listed.places[body]));
        WorldError::Pair { a, b, error }
    }

    fn named_pair(&self, listed: &Listed<'_>, found: PairDistance) -> PairClearance {
        let [a, b] = found.pair.map(|body| self.slots.id(listed.places[body]));
        PairClearance { a, b, clearance: found.clearance }
    }
}

/// Is one of the two among these places, which ascend?
pub(super) fn is_among(places: &[u32], pair: IndexPair) -> bool {
    pair.iter().any(|place| places.binary_search(place).is_ok())
}

impl Listed<'_> {
    fn of(&self, window: Window) -> PairsOfBodies<'_> {
        PairsOfBodies { bodies: &self.bodies, pairs: &self.pairs, window }
    }
}
