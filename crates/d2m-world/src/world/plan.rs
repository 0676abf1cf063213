//! A planner's question: would this motion be free of contact?

use super::schedule::{MeetingSpan, Schedule};
use super::{BodyId, FirstContact, Threads, World, WorldError};
use crate::SharedMotion;
use d2m_bvh::Window;
use std::sync::Arc;

/// A motion that a body might take.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{QueryOptions, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, FirstContact, PlannedMotion, World};
/// use glam::DVec3;
/// let mut world = World::new(QueryOptions::default());
/// world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * 4.0)));
/// let tool = world.add(Body::new(cube, ConstantTwist::REST));
/// let short_of_it = Arc::new(ConstantTwist::REST.with_linear_velocity(DVec3::X * 2.0));
/// let plan = [PlannedMotion { body: tool, motion: short_of_it }];
/// assert_eq!(world.first_contact_of(&plan, Window::UNIT)?, FirstContact::Separated);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct PlannedMotion {
    /// The body, or link of an arm.
    pub body: BodyId,
    /// What it would do.
    pub motion: SharedMotion,
}

/// A pair that a broad phase has left, and when.
///
/// ```
/// use d2m_bvh::{MeshTree, QueryOptions, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, Candidate, FirstContact, PlannedMotion, Threads, World};
/// use glam::DVec3;
/// use std::sync::Arc;
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let mut world = World::new(QueryOptions::default());
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let cart = world.add(Body::new(cube, ConstantTwist::REST.with_position(DVec3::X * -5.0)));
/// let way = ConstantTwist::REST.with_position(DVec3::X * -5.0).with_linear_velocity(DVec3::X * 8.0);
/// let plan = [PlannedMotion { body: cart, motion: Arc::new(way) }];
/// // They can only meet in the second half: the caller has proven it.
/// let pair = Candidate { a: wall, b: cart, from: 0.25, until: 1.0 };
/// let first = world.first_contact_among(&plan, &[pair], Window::UNIT, Threads::Own)?;
/// assert!(matches!(first, FirstContact::Contact { contact, .. } if (contact.time_lo - 0.5).abs() < 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// One of the bodies.
    pub a: BodyId,
    /// The other one.
    pub b: BodyId,
    /// Known to be apart in the part of the window before this time.
    pub from: f64,
    /// Known to be apart in the part of the window after this time.
    pub until: f64,
}

impl core::fmt::Debug for PlannedMotion {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("PlannedMotion").field("body", &self.body).finish_non_exhaustive()
    }
}

impl World {
    /// If these bodies moved so, and all others as they do: would one of these touch anything, and when first? The world stays
    /// as it is.
    ///
    /// [`FirstContact::Separated`] is a proof that the motion is free; of a [`FirstContact::Contact`] everything before
    /// `contact.time_lo` is. Pairs of bodies that are not planned are not queried. Ignored pairs and groups hold, so an
    /// arm of several links, each a body, ignores the pairs of links that a joint connects. Fastest after another query of the world
    /// whose window holds this one: then the boxes of the other bodies are known.
    ///
    /// ```
    /// use glam::DVec3;
    /// use d2m_bvh::{MeshTree, QueryOptions, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, FirstContact, PlannedMotion, World};
    /// use std::sync::Arc;
    /// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut world = World::new(QueryOptions::default());
    /// let obstacle = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * 4.0)));
    /// let tool = world.add(Body::new(cube, ConstantTwist::REST));
    /// let plan = |velocity: DVec3| {
    ///     let motion = Arc::new(ConstantTwist::REST.with_linear_velocity(velocity));
    ///     [PlannedMotion { body: tool, motion }]
    /// };
    /// let straight = world.first_contact_of(&plan(DVec3::X * 6.0), Window::UNIT)?;
    /// let FirstContact::Contact { a, contact, .. } = straight else { panic!("{straight:?}") };
    /// assert_eq!(a, obstacle);
    /// assert!((contact.time_lo - 0.5).abs() < 1e-9);
    /// let around = world.first_contact_of(&plan(DVec3::new(6.0, 6.0, 0.0)), Window::UNIT)?;
    /// assert_eq!(around, FirstContact::Separated);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    ///
    /// # Panics
    /// If a body was removed, or its name belongs to another world.
    pub fn first_contact_of(
        &self,
        plan: &[PlannedMotion],
        window: Window,
    ) -> Result<FirstContact, WorldError> {
        let (mut world, planned) = self.planned(plan);
        let schedule = Schedule::of_some(world.rules(), window, &planned, &self.schedule, &self.changed);
        world.schedule = schedule.map_err(|uncovered| world.uncovered(uncovered))?;
        world.first_contact(window)
    }

    /// As [`World::first_contact_of`] for a caller with a broad phase of its own, say one that knows the joints of an arm: only
    /// these pairs are queried, each from `from` to `until`. Ignored pairs and separations of pairs hold. The answer is a proof as far
    /// as the caller's broad phase is one: that all other pairs, and these at other times of the window, are further apart than their
    /// separation.
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the time in which its pair is queried.
    ///
    /// # Panics
    /// If a body was removed, or its name belongs to another world.
    pub fn first_contact_among(
        &self,
        plan: &[PlannedMotion],
        candidates: &[Candidate],
        window: Window,
        threads: Threads,
    ) -> Result<FirstContact, WorldError> {
        let (mut world, _) = self.planned(plan);
        let mut given: Vec<_> = candidates
            .iter()
            .filter_map(|&Candidate { a, b, from, until }| {
                // What is not there panics.
                let _ = [a, b].map(|id| world.body(id));
                let (start, end) = (from.max(window.start()), until.min(window.end()));
                Some((world.pair(a, b)?, MeetingSpan { start, end, clear_after: window.end() }))
            })
            .collect();
        given.sort_by_key(|(pair, _)| *pair);
        given.dedup_by(|(pair, more), (kept, span)| {
            let is_same = pair == kept;
            if is_same {
                (span.start, span.end) = (span.start.min(more.start), span.end.max(more.end));
            }
            is_same
        });
        world.threads = threads;
        world.schedule = Schedule::of_given(world.rules(), window, given);
        world.first_contact(window)
    }

    /// A copy in which bodies move as planned, and their places.
    pub(super) fn planned(&self, plan: &[PlannedMotion]) -> (Self, Vec<u32>) {
        let mut world = Self {
            options: self.options,
            slots: self.slots.clone(),
            filter: Arc::clone(&self.filter),
            ..Self::default()
        };
        for planned in plan {
            world.set_shared_motion(planned.body, planned.motion.clone());
        }
        let mut planned = core::mem::take(&mut world.changed);
        planned.sort_unstable();
        planned.dedup();
        (world, planned)
    }
}
