//! What a world answers.

use d2m_bvh::{Contact, Proximity, QueryError, TimeOfContact};
use d2m_motion::OutsideDomain;

/// Names a body of one [`World`](super::World): a place, and how often the place was reused, so the name of a removed body never
/// means another one.
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
#[expect(clippy::large_enum_variant, reason = "one answer at a time, taken apart at once")]
#[derive(Clone, Debug, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum FirstContact {
    /// Certified: no two bodies meet anywhere in the window.
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

/// The locally closest features of two bodies of a world.
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
