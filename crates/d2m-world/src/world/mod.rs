//! Many moving bodies.

mod answers;
mod clearance;
#[cfg(feature = "audit")]
mod concluded;
mod filter;
mod first_contact;
mod pair_queue;
mod pair_state;
mod plan;
mod rest;
mod schedule;
mod search;
mod slots;
mod spans;
#[cfg(test)]
mod tests;

pub use answers::{BodyId, FirstContact, PairContact, PairProximities, WorldError};
pub use clearance::PairClearance;
pub use plan::{Candidate, PlannedMotion};
pub use spans::{PairSpans, join_spans};

use crate::box_tree::IndexPair;
use crate::{Body, Group, SharedMotion};
use d2m_bvh::{Budget, Mode, QueryOptions, Start, Window};
use d2m_motion::RigidMotion;
use filter::PairFilter;
use pair_state::PairState;
use schedule::{Rules, Schedule, Uncovered};
use slots::Slots;
use std::collections::HashMap;
use std::sync::Arc;

/// Many moving bodies: a broad phase over the boxes that they sweep, and a certified pair query for what is left.
///
/// Everything that is proven is kept until one of the two bodies changes: boxes, how long a pair is free, its contact. So a
/// simulation that goes from event to event pays for the pairs of the bodies that an event changes, not for all:
///
/// ```
/// use glam::DVec3;
/// use d2m_bvh::{MeshTree, QueryOptions, Window};
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use d2m_world::{Body, FirstContact, World};
/// use std::sync::Arc;
///
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box")?));
/// let mut world = World::new(QueryOptions::default().with_min_separation(1e-3));
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let flying = |x: f64, v: f64| {
///     ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v)
/// };
/// let ball = world.add(Body::new(Arc::clone(&cube), flying(9.0, -8.0)));
/// let away = world.add(Body::new(cube, flying(9.0, 0.0).with_position(DVec3::Y * 50.0)));
/// assert!(!world.candidates(Window::UNIT)?.contains(&(wall, away)));
///
/// let (mut time, end, mut bounces) = (0.0, 1.0, 0);
/// loop {
///     // The window shrinks from its start: what was proven of the rest of it stands.
///     match world.first_contact(Window::try_new(time, end)?)? {
///         FirstContact::Separated => break,
///         FirstContact::Contact { a, b, contact, .. } => {
///             assert_eq!((a, b), (wall, ball));
///             // Certified free until here: the bodies are apart, and nothing else has met.
///             time = contact.time_lo;
///             // Only the bodies that react get a new motion; it must hold from `time` on.
///             let here = world.body(ball).motion().pose_and_twist(time).0.translation;
///             world.set_motion(ball, flying(here.x, 8.0).with_reference_time(time));
///             bounces += 1;
///         }
///         FirstContact::Undecided { clear_until, .. } => time = clear_until,
///     }
/// }
/// assert_eq!(bounces, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A query of a window within that of an earlier one, which starts no earlier than the last one did, uses the boxes of
/// that one; any other computes them anew. Times before the start of the last query need not be covered by a new motion.
///
/// **Determinism.** Answers have the same bits at any number of threads. They may depend on earlier queries, in the last
/// digits only: a contact that was found for a longer window stands.
#[derive(Clone, Debug, Default)]
pub struct World {
    options: QueryOptions,
    slots: Slots,
    filter: Arc<PairFilter>,
    /// Of pairs that were searched. Never walked through in an order that matters.
    states: HashMap<IndexPair, PairState>,
    schedule: Schedule,
    /// Places of bodies that changed since the schedule was made, and pairs whose rules did.
    changed: Vec<u32>,
    changed_pairs: Vec<IndexPair>,
    threads: Threads,
}

/// Which threads answer a question. The answer has the same bits.
///
/// ```
/// use d2m_bvh::{QueryOptions, Window};
/// use d2m_world::{FirstContact, Threads, World};
/// // A planner that asks about many plans at once has its threads busy: each question stays on its own.
/// let world = World::new(QueryOptions::default());
/// assert_eq!(world.first_contact_among(&[], &[], Window::UNIT, Threads::Own)?, FirstContact::Separated);
/// # Ok::<(), d2m_world::WorldError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Threads {
    /// All of the current pool (feature `rayon`), once there are enough pairs.
    #[default]
    All,
    /// The one that asks: where many questions are asked side by side.
    Own,
}

impl World {
    /// An empty world; `options` hold for every pair, but [`Mode::Exists`] counts as accurate: a world
    /// promises first contacts. The budget of the options is one for each query of the world, over all pairs. With [`Start::Leave`] what
    /// holds at the start of a query's window is let go, pair by pair; such pairs are asked anew by each query.
    pub fn new(options: QueryOptions) -> Self {
        let options = match options.mode {
            Mode::Exists => options.with_mode(Mode::Accurate),
            _ => options,
        };
        Self { options, ..Self::default() }
    }

    /// The options of the world.
    pub const fn options(&self) -> &QueryOptions {
        &self.options
    }

    /// Another budget for the queries from now on, say one that can be cancelled. What is proven stands.
    ///
    /// ```
    /// use d2m_bvh::{Budget, Canceller, QueryOptions};
    /// let mut world = d2m_world::World::new(QueryOptions::default());
    /// let canceller = Canceller::new();
    /// world.set_budget(Budget::UNLIMITED.with_cancel(canceller.flag()));
    /// assert!(world.options().budget.cancel.is_some());
    /// ```
    pub const fn set_budget(&mut self, budget: Budget) {
        self.options.budget = budget;
    }

    /// Adds a body.
    pub fn add(&mut self, body: Body) -> BodyId {
        let id = self.slots.insert(body);
        self.changed.push(id.index);
        id
    }

    /// Takes a body out; none if it is not there any more. Its name never means another body; what was said about its
    /// pairs ([`Self::ignore_pair`], [`Self::set_min_separation`]) is forgotten.
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
    /// assert!(world.remove(cart).is_some() && world.remove(cart).is_none());
    /// assert_eq!(world.ids().collect::<Vec<_>>(), [wall]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn remove(&mut self, id: BodyId) -> Option<Body> {
        let body = self.slots.remove(id)?;
        Arc::make_mut(&mut self.filter).forget(id.index);
        self.states.retain(|pair, _| !pair.contains(&id.index));
        self.changed.push(id.index);
        Some(body)
    }

    /// The body of that name, if it is there.
    pub fn get(&self, id: BodyId) -> Option<&Body> {
        self.slots.get(id)
    }

    /// The body of that name.
    ///
    /// # Panics
    /// If the body was removed, or the name belongs to another world.
    pub fn body(&self, id: BodyId) -> &Body {
        self.slots.get(id).unwrap_or_else(|| panic!("{id:?} is not in this world"))
    }

    /// The bodies' names, in the order of their places.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.slots.ids()
    }

    /// Replaces a body.
    ///
    /// # Panics
    /// If the body was removed, or the name belongs to another world.
    pub fn set_body(&mut self, id: BodyId, body: Body) {
        *self.change(id) = body;
    }

    /// Gives a body another motion.
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
    /// use d2m_world::FirstContact;
    /// assert_eq!(world.first_contact(Window::UNIT)?, FirstContact::Separated);
    /// world.set_motion(cart, at(-5.0, 8.0));
    /// assert!(matches!(world.first_contact(Window::UNIT)?, FirstContact::Contact { a, .. } if a == wall));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If the body was removed, or the name belongs to another world.
    pub fn set_motion(&mut self, id: BodyId, motion: impl RigidMotion + Send + 'static) {
        self.set_shared_motion(id, Arc::new(motion));
    }

    /// As [`Self::set_motion`], with a motion that others may hold too.
    ///
    /// # Panics
    /// If the body was removed, or the name belongs to another world.
    pub fn set_shared_motion(&mut self, id: BodyId, motion: SharedMotion) {
        self.change(id).set_motion(motion);
    }

    fn change(&mut self, id: BodyId) -> &mut Body {
        let body = self.slots.get_mut(id).unwrap_or_else(|| panic!("{id:?} is not in this world"));
        self.changed.push(id.index);
        body
    }

    /// The places of two bodies, ascending; `None`: one of them was removed, or they are one body, which is no pair.
    fn pair(&self, a: BodyId, b: BodyId) -> Option<IndexPair> {
        let is_pair = a != b && self.slots.holds(a) && self.slots.holds(b);
        is_pair.then(|| [a.index.min(b.index), a.index.max(b.index)])
    }

    /// Whether contacts of these two bodies are ignored (they are not, at first). Nothing happens if one of them was removed, or if they are
    /// one body.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{QueryOptions, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, FirstContact, World};
    /// let mut world = World::new(QueryOptions::default());
    /// let [upper, lower] = [0, 1].map(|_| world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST)));
    /// world.ignore_pair(upper, lower, true); // a joint connects them
    /// assert_eq!(world.first_contact(Window::UNIT)?, FirstContact::Separated);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ignore_pair(&mut self, a: BodyId, b: BodyId, ignored: bool) {
        let Some(pair) = self.pair(a, b) else { return };
        let filter = Arc::make_mut(&mut self.filter);
        if ignored {
            filter.ignore(pair);
        } else if filter.restore(pair) {
            self.changed_pairs.push(pair);
        }
    }

    /// Whether contacts between a body of one group and a body of the other are ignored; the two groups may be the same.
    pub fn ignore_groups(&mut self, a: Group, b: Group, ignored: bool) {
        let filter = Arc::make_mut(&mut self.filter);
        if ignored {
            filter.ignore_groups(a, b);
        } else if filter.restore_groups(a, b) {
            self.schedule.clear();
        }
    }

    /// The separation at which these two bodies count as in contact, instead of that of the options; `None`: that of the
    /// options again. What is not finite or negative is refused by the next query. Nothing happens if one of the two was
    /// removed, or if they are one body.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{QueryOptions, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, FirstContact, World};
    /// use glam::DVec3;
    /// let mut world = World::new(QueryOptions::default());
    /// let a = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    /// let b = world.add(Body::new(cube, ConstantTwist::REST.with_position(DVec3::X * 1.5))); // 0.5 apart
    /// assert_eq!(world.first_contact(Window::UNIT)?, FirstContact::Separated);
    /// world.set_min_separation(a, b, Some(0.6));
    /// assert!(matches!(world.first_contact(Window::UNIT)?, FirstContact::Contact { .. }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_min_separation(&mut self, a: BodyId, b: BodyId, separation: Option<f64>) {
        let Some(pair) = self.pair(a, b) else { return };
        Arc::make_mut(&mut self.filter).set_separation(pair, separation);
        self.changed_pairs.push(pair);
    }

    /// What counts of these two bodies if they are in contact at the start of a window, instead of what the options say; `None`: what the
    /// options say. With [`Start::Leave`] the answer of the pair is its first contact after the bodies have parted, with
    /// [`Contact::left`](d2m_bvh::Contact::left). Nothing happens if one of the two was removed, or if they are one body.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{QueryOptions, Start, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, FirstContact, World};
    /// use glam::DVec3;
    /// let mut world = World::new(QueryOptions::default());
    /// let table = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    /// let lifted = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z);
    /// let part = world.add(Body::new(cube, lifted)); // stands on the table
    /// assert!(matches!(world.first_contact(Window::UNIT)?, FirstContact::Contact { .. }));
    /// world.set_start(table, part, Some(Start::Leave));
    /// assert_eq!(world.first_contact(Window::UNIT)?, FirstContact::Separated);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_start(&mut self, a: BodyId, b: BodyId, start: Option<Start>) {
        let Some(pair) = self.pair(a, b) else { return };
        Arc::make_mut(&mut self.filter).set_start(pair, start);
        // What was proven of the pair may be about the other question.
        self.states.remove(&pair);
        self.changed_pairs.push(pair);
    }

    /// The options of a pair: those of the world, with the minimum separation and the start that the two have of their own. Bodies that were
    /// removed have nothing of their own.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::QueryOptions;
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, World};
    /// let mut world = World::new(QueryOptions::default());
    /// let [a, b] = [(); 2].map(|()| world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST)));
    /// world.set_min_separation(a, b, Some(0.5));
    /// assert_eq!(world.pair_options(b, a).min_separation, 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn pair_options(&self, a: BodyId, b: BodyId) -> QueryOptions {
        let Some(pair) = self.pair(a, b) else { return self.options };
        let separation = self.filter.separation(pair, self.options.min_separation);
        let start = self.filter.start(pair, self.options.start);
        self.options.with_min_separation(separation).with_start(start)
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.slots.count()
    }

    /// Is the world empty?
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The pairs that the broad phase cannot exclude, smaller place first, ascending. Every pair that comes within its minimum
    /// separation during the window, and is not ignored, is among them, and so is every pair that its
    /// tolerance puts in contact at the start.
    ///
    /// # Errors
    /// A motion that does not cover the window.
    pub fn candidates(&self, window: Window) -> Result<Vec<(BodyId, BodyId)>, WorldError> {
        let mut schedule = Schedule::default();
        schedule.prepare(self.rules(), window, &[]).map_err(|uncovered| self.uncovered(uncovered))?;
        Ok(schedule.pairs().into_iter().map(|[a, b]| (self.slots.id(a), self.slots.id(b))).collect())
    }

    fn uncovered(&self, Uncovered { place, outside }: Uncovered) -> WorldError {
        WorldError::OutsideMotion { body: self.slots.id(place), outside }
    }

    fn rules(&self) -> Rules<'_> {
        Rules { slots: &self.slots, filter: &self.filter, options: &self.options }
    }
}
