//! First contacts: of any two bodies, and of every pair.

use super::search::Goal;
use super::{FirstContact, PairContact, World, WorldError};
use crate::box_tree::IndexPair;
use d2m_bvh::{TimeOfContact, Window};

impl World {
    /// Every pair's first contact in the window, sorted by the end of what is proven free, then by places; pairs that are
    /// proven apart for the whole window are left out. When the budget ran out, pairs that were not searched are reported as
    /// undecided from the time on at which they may meet.
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
    /// world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_linear_velocity(DVec3::X * 8.0)));
    /// for x in [3.0, 5.0, 50.0] {
    ///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * x)));
    /// }
    /// let times: Vec<f64> = world.contacts(Window::UNIT)?.iter().map(|pair| pair.clear_until()).collect();
    /// assert!(times.len() == 2 && (times[0] - 0.25).abs() < 1e-9 && (times[1] - 0.5).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    pub fn contacts(&mut self, window: Window) -> Result<Vec<PairContact>, WorldError> {
        self.contacts_with_progress(window, &|_, _| ())
    }

    /// As [`Self::contacts`]; calls `progress` after each round with the number of pairs that are done, and of all pairs
    /// that the broad phase leaves.
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    pub fn contacts_with_progress(
        &mut self,
        window: Window,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Vec<PairContact>, WorldError> {
        let finding = self.search(window, Goal::All, progress)?;
        let contacts =
            finding.contacts.iter().map(|(pair, contact)| (pair, TimeOfContact::Contact(*contact)));
        let undecided = finding
            .undecided
            .iter()
            .map(|(pair, until)| (pair, TimeOfContact::Undecided { clear_until: *until }));
        let mut all: Vec<_> =
            contacts.chain(undecided).map(|(pair, answer)| self.named(*pair, answer)).collect();
        all.sort_by(|x, y| {
            x.clear_until().total_cmp(&y.clear_until()).then_with(|| (x.a, x.b).cmp(&(y.a, y.b)))
        });
        Ok(all)
    }

    /// The first contact of any two bodies, and all that may be as early.
    ///
    /// Pairs are searched in the order of the times at which their boxes meet, and only up to the best time so far.
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
    /// let thrown = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_linear_velocity(DVec3::X * 8.0)));
    /// for x in [5.0, 3.0] {
    ///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * x)));
    /// }
    /// let FirstContact::Contact { a, b, contact, .. } = world.first_contact(Window::UNIT)? else { panic!("it hits") };
    /// assert_eq!((a, b.index()), (thrown, 2)); // the one at 3
    /// assert!(contact.time_lo <= 0.25 && contact.time_lo > 0.25 - 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    pub fn first_contact(&mut self, window: Window) -> Result<FirstContact, WorldError> {
        self.first_contact_with_progress(window, &|_, _| ())
    }

    /// As [`Self::first_contact`]; calls `progress` after each round with the number of pairs that are done, and of all pairs
    /// that the broad phase leaves. Most searches end long before the two are equal.
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
    /// use std::cell::Cell;
    /// let calls = Cell::new(0);
    /// let first = world.first_contact_with_progress(Window::UNIT, &|_done, _of| calls.set(calls.get() + 1))?;
    /// assert_eq!(first, d2m_world::FirstContact::Separated);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bad input of a pair, with its names; a motion that does not cover the window.
    pub fn first_contact_with_progress(
        &mut self,
        window: Window,
        progress: &dyn Fn(usize, usize),
    ) -> Result<FirstContact, WorldError> {
        let finding = self.search(window, Goal::First, progress)?;
        let undecided = finding.first_undecided().map(|(pair, clear_until)| {
            let [a, b] = pair.map(|place| self.slots.id(place));
            (clear_until, FirstContact::Undecided { clear_until, a, b })
        });
        let Some(&(pair, contact)) = finding.best() else {
            return Ok(undecided.map_or(FirstContact::Separated, |(_, answer)| answer));
        };
        if let Some((_, answer)) = undecided.filter(|(until, _)| *until < contact.time_lo) {
            return Ok(answer);
        }
        let others = finding
            .contacts
            .iter()
            .filter(|(other, found)| *other != pair && found.time_lo <= contact.time_hi);
        let mut overlapping: Vec<_> =
            others.map(|(other, found)| self.named(*other, TimeOfContact::Contact(*found))).collect();
        overlapping.sort_by(|x, y| {
            x.clear_until().total_cmp(&y.clear_until()).then_with(|| (x.a, x.b).cmp(&(y.a, y.b)))
        });
        let [a, b] = pair.map(|place| self.slots.id(place));
        Ok(FirstContact::Contact { a, b, contact, overlapping })
    }

    fn named(&self, pair: IndexPair, answer: TimeOfContact) -> PairContact {
        let [a, b] = pair.map(|place| self.slots.id(place));
        PairContact { a, b, answer }
    }
}
