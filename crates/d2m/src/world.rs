use crate::Body;
use crate::broad_phase::{SweptBox, candidates};
use d2m_bvh::{
    Contact, Mode, PairCache, QueryError, QueryOptions, TimeOfContact, Window, time_of_contact_with,
};
use std::collections::BTreeMap;

/// Names a body of one [`World`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(usize);

impl BodyId {
    /// Bodies are numbered in the order in which they were added, from 0.
    pub const fn index(self) -> usize {
        self.0
    }
}

/// The first contact in a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstContact {
    /// Certified: no two bodies meet anywhere in the window.
    Separated,
    /// Certified: no two bodies meet before `contact.time_lo`, and these two do by `contact.time_hi`.
    Contact {
        /// The first body: the one added earlier.
        a: BodyId,
        /// The second body.
        b: BodyId,
        /// Their contact.
        contact: Contact,
    },
    /// A pair's budget ran out. Certified: no contact of any pair in [start of the window, `clear_until`).
    Undecided {
        /// End of the part of the window that is proven free.
        clear_until: f64,
    },
}

/// What stopped a world query: bad input of one pair.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("bodies {} and {}: {error}", a.index(), b.index())]
pub struct WorldError {
    /// The first body of the pair.
    pub a: BodyId,
    /// The second body of the pair.
    pub b: BodyId,
    /// What is wrong with it.
    pub error: QueryError,
}

/// Many moving bodies: a broad phase over the boxes that they sweep, and a pair query for what is left. Each candidate pair
/// keeps a [`PairCache`] for the next window, which saves most searches of pairs that pass each other slowly and
/// changes no bit of any answer.
///
/// ```
/// use d2m::glam::DVec3;
/// use d2m::{Body, FirstContact, ConstantTwist, MeshTree, QueryOptions, Window, World};
/// use std::sync::Arc;
///
/// let cube = Arc::new(MeshTree::new(d2m::shapes::mesh("box")?));
/// let mut world = World::new(QueryOptions::default());
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let start = ConstantTwist::REST.with_position(DVec3::X * 9.0);
/// let slow = world.add(Body::new(Arc::clone(&cube), start.with_linear_velocity(DVec3::X * -8.0)));
/// let away = world.add(Body::new(cube, start.with_position(DVec3::Y * 50.0)));
///
/// let FirstContact::Contact { a, b, contact } = world.first_contact(Window::UNIT)? else { panic!() };
/// assert_eq!((a, b), (wall, slow));
/// assert!(contact.time_lo < contact.time_hi + 1e-12 && contact.closing_speed > 7.9);
/// assert!(!world.candidates(Window::UNIT).contains(&(wall, away)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct World {
    bodies: Vec<Body>,
    options: QueryOptions,
    /// Of the candidates of the last window.
    caches: BTreeMap<(BodyId, BodyId), PairCache>,
}

impl World {
    /// An empty world; `options` hold for every pair, but for [`Mode::Exists`], which is asked as accurate: a world
    /// promises first contacts.
    pub const fn new(options: QueryOptions) -> Self {
        Self { bodies: Vec::new(), options, caches: BTreeMap::new() }
    }

    /// Adds a body.
    pub fn add(&mut self, body: Body) -> BodyId {
        self.bodies.push(body);
        BodyId(self.bodies.len() - 1)
    }

    /// The body of that name.
    ///
    /// # Panics
    /// If the name belongs to another world that holds more bodies.
    pub fn body(&self, id: BodyId) -> &Body {
        &self.bodies[id.0]
    }

    /// Replaces a body, with another motion for the next window for instance.
    ///
    /// # Panics
    /// If the name belongs to another world that holds more bodies.
    pub fn set_body(&mut self, id: BodyId, body: Body) {
        self.bodies[id.0] = body;
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Is the world empty?
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The pairs that the broad phase cannot exclude, smaller id first, ascending. Every pair that comes within
    /// `min_separation` during the window is among them.
    pub fn candidates(&self, window: Window) -> Vec<(BodyId, BodyId)> {
        let margin = self.options.min_separation;
        let boxes: Vec<_> = self.bodies.iter().map(|body| SweptBox::enclose(body, window, margin)).collect();
        candidates(&boxes).into_iter().map(|(a, b)| (BodyId(a), BodyId(b))).collect()
    }

    /// The first contact of each candidate pair over the whole window; separated pairs are left out.
    ///
    /// # Errors
    /// Bad input of a pair, with its names.
    pub fn contacts(&mut self, window: Window) -> Result<Vec<(BodyId, BodyId, TimeOfContact)>, WorldError> {
        let mut found = Vec::new();
        for (a, b) in self.cached_candidates(window) {
            let answer = self.pair(a, b, window)?;
            if !answer.is_separated() {
                found.push((a, b, answer));
            }
        }
        Ok(found)
    }

    /// The first contact of any two bodies. Windows of later pairs end at the best time so far, so a crowded world
    /// costs little more than its first contact. Of pairs that meet at the same `time_lo` the smallest ids win.
    ///
    /// # Errors
    /// Bad input of a pair, with its names.
    pub fn first_contact(&mut self, window: Window) -> Result<FirstContact, WorldError> {
        let mut best: Option<(BodyId, BodyId, Contact)> = None;
        let mut clear_until = f64::INFINITY;
        for (a, b) in self.cached_candidates(window) {
            let end = best.map_or(window.end(), |(.., contact)| contact.time_hi.min(window.end()));
            let shortened = Window::try_new(window.start(), end).unwrap_or(window);
            match self.pair(a, b, shortened)? {
                TimeOfContact::Separated => {}
                TimeOfContact::Undecided { clear_until: until } => clear_until = clear_until.min(until),
                TimeOfContact::Contact(contact) => {
                    if best.is_none_or(|(.., old)| contact.time_lo < old.time_lo) {
                        best = Some((a, b, contact));
                    }
                }
            }
        }
        Ok(match best {
            Some((a, b, contact)) if contact.time_lo <= clear_until => {
                FirstContact::Contact { a, b, contact }
            }
            _ if clear_until < f64::INFINITY => FirstContact::Undecided { clear_until },
            _ => FirstContact::Separated,
        })
    }

    /// The candidates; caches of other pairs are dropped.
    fn cached_candidates(&mut self, window: Window) -> Vec<(BodyId, BodyId)> {
        let candidates = self.candidates(window);
        self.caches.retain(|pair, _| candidates.binary_search(pair).is_ok());
        candidates
    }

    fn pair(&mut self, a: BodyId, b: BodyId, window: Window) -> Result<TimeOfContact, WorldError> {
        let options = match self.options.mode {
            Mode::Exists => self.options.with_mode(Mode::Accurate),
            _ => self.options,
        };
        let cache = self.caches.entry((a, b)).or_default();
        time_of_contact_with(self.bodies[a.0].moving(), self.bodies[b.0].moving(), window, &options, cache)
            .map_err(|error| WorldError { a, b, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_bvh::MeshTree;
    use d2m_motion::ConstantTwist;
    use glam::DVec3;
    use std::sync::Arc;

    /// Steps of a world of its own, each a new one without caches, and steps of one world: the same answers.
    #[test]
    fn caches_change_nothing() {
        let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
        let bodies = |step: u32| {
            let passing = ConstantTwist::REST
                .with_position(DVec3::new(-2.0, 0.0, 1.2 - 0.02 * f64::from(step)))
                .with_linear_velocity(DVec3::X * 4.0)
                .with_angular_velocity(DVec3::Z);
            let away = ConstantTwist::REST.with_position(DVec3::Y * f64::from(step % 7));
            [ConstantTwist::REST, passing, away].map(|motion| Body::new(Arc::clone(&ring), motion))
        };
        let filled = |step: u32| {
            let mut world = World::new(QueryOptions::default());
            for body in bodies(step) {
                world.add(body);
            }
            world
        };
        let (mut one, mut met, mut apart) = (filled(0), 0, 0);
        for step in 0..40 {
            for (k, body) in bodies(step).into_iter().enumerate() {
                one.set_body(BodyId(k), body);
            }
            let contacts = one.contacts(Window::UNIT).unwrap();
            assert_eq!(contacts, filled(step).contacts(Window::UNIT).unwrap(), "step {step}");
            let first = one.first_contact(Window::UNIT).unwrap();
            assert_eq!(first, filled(step).first_contact(Window::UNIT).unwrap(), "step {step}");
            assert!(one.caches.keys().eq(&one.candidates(Window::UNIT)));
            met += u32::from(!contacts.is_empty());
            apart += u32::from(contacts.is_empty());
        }
        assert!(met > 10 && apart > 3, "{met} {apart}");
    }

    /// With "any contact will do" the later of two would be as good as the first, and its time any time.
    #[test]
    fn first_contacts_are_first_in_any_mode() {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
        for mode in [Mode::Accurate, Mode::Exists] {
            let mut world = World::new(QueryOptions::default().with_mode(mode));
            world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
            for (axis, distance) in [(DVec3::X, 7.0), (DVec3::Y, 5.0), (DVec3::Z, 6.0)] {
                let coming = ConstantTwist::REST.with_position(axis * distance);
                world.add(Body::new(Arc::clone(&cube), coming.with_linear_velocity(axis * -8.0)));
            }
            let FirstContact::Contact { a, b, contact } = world.first_contact(Window::UNIT).unwrap() else {
                panic!("three of them arrive")
            };
            assert_eq!((a.index(), b.index()), (0, 2), "{mode:?}");
            assert!(contact.time_lo <= 0.375 && contact.time_lo > 0.375 - 1e-9, "{mode:?}: {contact:?}");
        }
    }
}
