//! Touches: which bodies touch, and since when.

use crate::body::rigid_body::Role;
use crate::pairs::closest_features::AROUND;
use crate::{BodyId, Simulation, TouchChange, TouchEvent};
use d2m_contact::Momenta;
use std::collections::BTreeMap;

impl Simulation {
    /// Do these two bodies touch, as the last [`TouchEvent`] of them said?
    ///
    /// # Panics
    /// If one of them was removed.
    pub fn touch(&self, a: BodyId, b: BodyId) -> bool {
        let (a, b) = (self.place(a), self.place(b));
        self.touching.contains(&(a.min(b), a.max(b)))
    }

    fn report_touch(&mut self, (a, b): (usize, usize), time: f64, change: TouchChange) {
        let [a, b] = [a, b].map(|place| self.bodies[place].id);
        self.touches.push(TouchEvent { a, b, time, change });
    }

    /// Begins a touch: an impulse has acted between two bodies.
    pub(crate) fn begin_touch(&mut self, pair: (usize, usize), time: f64) {
        if self.touching.insert(pair) {
            self.report_touch(pair, time, TouchChange::Began);
        }
    }

    /// Ends a touch: two bodies are clear of each other.
    pub(crate) fn end_touch(&mut self, pair: (usize, usize), time: f64) {
        if self.touching.remove(&pair) {
            self.report_touch(pair, time, TouchChange::Ended);
        }
    }

    /// At the end of a step that began at a time, ends the touches of pairs without impulses (`pressed` are
    /// those with some) that were found apart, if one of the bodies moves; and of pairs that may not meet any
    /// more, wherever they are: these are queried no longer.
    pub(crate) fn end_touches(&mut self, began: f64, pressed: &BTreeMap<(usize, usize), [Momenta; 2]>) {
        let most = AROUND * self.options.gap;
        let is_near = |pair: &(usize, usize)| {
            let nearest = self.pairs.get(pair).and_then(|pair| pair.nearest);
            nearest.is_some_and(|distance| distance <= most)
        };
        let moves = |&(a, b): &(usize, usize)| self.bodies[a].is_awake() || self.bodies[b].is_awake();
        let is_solid = |&(a, b): &(usize, usize)| [a, b].iter().all(|&i| self.bodies[i].role == Role::Body);
        let ended = |pair: &&(usize, usize)| {
            let is_apart = !pressed.contains_key(*pair) && moves(pair) && !is_near(pair);
            is_solid(pair) && (is_apart || !self.meets(pair.0, pair.1))
        };
        let ended: Vec<(usize, usize)> = self.touching.iter().filter(ended).copied().collect();
        for pair in ended {
            self.end_touch(pair, began);
        }
    }

    /// Ends the touches of a body that is about to be removed.
    pub(crate) fn end_touches_of(&mut self, place: usize) {
        let has = |&&(a, b): &&(usize, usize)| a == place || b == place;
        let ended: Vec<(usize, usize)> = self.touching.iter().filter(has).copied().collect();
        for pair in ended {
            self.end_touch(pair, self.time);
        }
    }
}
