//! What a world answers.

use d2m_bvh::{Contact, Proximity, QueryError, TimeOfContact};
use d2m_motion::OutsideDomain;

/// Names a body of one [`World`](super::World): a place, and how often the place was reused, so the name of a removed body never
/// means another one.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::QueryOptions;
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, World};
/// let mut world = World::new(QueryOptions::default());
/// let first = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// world.remove(first);
/// let second = world.add(Body::new(cube, ConstantTwist::REST));
/// // The same place, another name.
/// assert!(first.index() == second.index() && first != second && world.get(first).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// The place of the body. Without removals bodies are numbered in the order in which they were added, from 0.
    pub const fn index(self) -> usize {
        self.index as usize
    }
}

/// Two bodies, the one with the smaller [`BodyId::index`] first, and what is known of them.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{QueryOptions, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, World};
/// use glam::DVec3;
/// let mut world = World::new(QueryOptions::default());
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let coming = ConstantTwist::REST.with_position(DVec3::X * 3.0).with_linear_velocity(DVec3::X * -4.0);
/// let comer = world.add(Body::new(cube, coming));
/// let all = world.contacts(Window::UNIT)?;
/// assert_eq!((all.len(), all[0].a, all[0].b), (1, wall, comer));
/// assert!(all[0].clear_until() <= 0.5 && all[0].clear_until() > 0.5 - 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PairContact {
    /// The first body.
    pub a: BodyId,
    /// The second body.
    pub b: BodyId,
    /// Their contact, or how far they are proven free; never [`TimeOfContact::Separated`].
    pub answer: TimeOfContact,
}

impl PairContact {
    /// The end of what is proven free: `time_lo` or `clear_until`.
    pub const fn clear_until(&self) -> f64 {
        match &self.answer {
            TimeOfContact::Contact(contact) => contact.time_lo,
            TimeOfContact::Undecided { clear_until } => *clear_until,
            TimeOfContact::Separated => f64::INFINITY,
        }
    }
}

/// The first contact in a world.
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
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let coming = ConstantTwist::REST.with_position(DVec3::X * 3.0).with_linear_velocity(DVec3::X * -4.0);
/// let comer = world.add(Body::new(cube, coming));
/// match world.first_contact(Window::UNIT)? {
///     FirstContact::Separated => panic!("no two bodies meet, which would be wrong here"),
///     FirstContact::Contact { a, b, contact, .. } => assert!(a == wall && b == comer && contact.time_lo <= 0.5),
///     FirstContact::Undecided { clear_until, .. } => panic!("only with a budget; free until {clear_until}"),
/// }
/// assert_eq!(world.first_contact(Window::try_new(0.0, 0.4)?)?, FirstContact::Separated);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[expect(clippy::large_enum_variant, reason = "one answer at a time, taken apart at once")]
#[derive(Clone, Debug, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum FirstContact {
    /// Certified: no two bodies meet anywhere in the window. With [`Start::Leave`](d2m_bvh::Start::Leave) that holds of pairs in contact at the start from
    /// the time on at which they are proven to have parted, here and below.
    Separated,
    /// Certified: no two bodies meet before `contact.time_lo`, and these two do by `contact.time_hi`.
    #[non_exhaustive]
    Contact {
        /// The first body: the one with the smaller place.
        a: BodyId,
        /// The second body.
        b: BodyId,
        /// Their contact. Of pairs with the same `time_lo` the one with the smallest places.
        contact: Contact,
        /// The other contacts whose brackets begin before this one's ends: which of them is first cannot be decided. Complete,
        /// except when bodies meet at the very start of the window: then the search stops, and pairs that it had not
        /// come to are not here ([`World::contacts`](super::World::contacts) finds them).
        overlapping: Vec<PairContact>,
    },
    /// The budget ran out. Certified: no contact of any pair in [start of the window, `clear_until`).
    #[non_exhaustive]
    Undecided {
        /// End of the part of the window that is proven free.
        clear_until: f64,
        /// The first body of the pair that is undecided first; of several the one with the smallest places.
        a: BodyId,
        /// The second body of that pair.
        b: BodyId,
    },
}

impl FirstContact {
    /// The contact, if two bodies meet.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{QueryOptions, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, World};
    /// use glam::DVec3;
    /// let mut world = World::new(QueryOptions::default());
    /// world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    /// let coming = ConstantTwist::REST.with_position(DVec3::X * 3.0).with_linear_velocity(DVec3::X * -4.0);
    /// world.add(Body::new(cube, coming));
    /// assert!(world.first_contact(Window::UNIT)?.contact().is_some_and(|contact| contact.time_lo <= 0.5));
    /// assert_eq!(world.first_contact(Window::try_new(0.0, 0.4)?)?.contact(), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn contact(&self) -> Option<&Contact> {
        match self {
            Self::Contact { contact, .. } => Some(contact),
            Self::Separated | Self::Undecided { .. } => None,
        }
    }
}

/// The locally closest features of two bodies of a world.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{ProximityOptions, QueryOptions};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, World};
/// use glam::DVec3;
/// let mut world = World::new(QueryOptions::default());
/// world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// world.add(Body::new(cube, ConstantTwist::REST.with_position(DVec3::Z * 1.001)));
/// let near = world.proximities(0.0, &ProximityOptions::new(0.01))?; // at time 0, features within 0.01
/// assert!(near.len() == 1 && near[0].proximities.iter().all(|p| (p.distance - 0.001).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PairProximities {
    /// The first body: the one with the smaller place.
    pub a: BodyId,
    /// The second body.
    pub b: BodyId,
    /// Ordered by distance; normals from `a` to `b`. Never empty.
    pub proximities: Vec<Proximity>,
}

/// What stopped a world query: bad input.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{QueryOptions, Window};
/// use d2m_motion::{ConstantTwist, Keyframes, Pose, Span};
/// use d2m_world::{Body, World, WorldError};
/// let mut world = World::new(QueryOptions::default());
/// // Known from 0 to 1 only.
/// let short = Keyframes::try_new(&[(0.0, Pose::IDENTITY), (1.0, Pose::IDENTITY)], Span::Linear)?;
/// let body = world.add(Body::new(Arc::clone(&cube), short));
/// world.add(Body::new(cube, ConstantTwist::REST));
/// let refused = world.first_contact(Window::try_new(0.0, 2.0)?).unwrap_err();
/// assert!(matches!(refused, WorldError::OutsideMotion { body: named, .. } if named == body));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// Of one pair.
    #[error("bodies {} and {}: {error}", a.index(), b.index())]
    Pair {
        /// The first body of the pair.
        a: BodyId,
        /// The second body of the pair.
        b: BodyId,
        /// What is wrong with it.
        error: QueryError,
    },
    /// The window of the query, or its time, is not within the times that a motion covers.
    #[error("body {}: {outside}", body.index())]
    OutsideMotion {
        /// The body that moves so: of several the one with the smallest place.
        body: BodyId,
        /// The times of the motion and of the query.
        outside: OutsideDomain,
    },
}
