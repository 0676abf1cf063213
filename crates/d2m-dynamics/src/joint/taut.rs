//! Chains that are pulled taut.
//!
//! The light bodies of a slack chain take up all of the energy of heavy bodies that pull it straight: they
//! turn so fast that no flight is short enough. And a closed chain may have no way to move although its
//! equations for velocities allow one: a straight bridge of planks that is pinned at both ends gives way
//! across it only by lengths of the second order. No impulse has an arm there, so the corrections of a
//! flight's end diverge in flights of any length. The bodies of such chains move as one until the end of the
//! flight. That is an inelastic impact: it keeps momenta and takes the energy of their motions against each
//! other.

use crate::flight::problem::Problem;
use crate::flight::solved_body::moves;
use crate::joint::rows::{Ahead, Joined};
use d2m_contact::ContactPoint;
use d2m_mesh::DisjointSets;

impl Problem<'_> {
    /// The contacts and rows of the problem, where these joints hold their bodies as they are, and all joints
    /// with those.
    pub(crate) fn locked(&self, numbers: &[usize], ahead: Ahead) -> (Vec<ContactPoint>, Vec<Joined>) {
        let mut held = self.joints.to_vec();
        let is_replaced = |c: &&&ContactPoint| c.joint().is_some_and(|joint| numbers.contains(&joint));
        let mut rows: Vec<ContactPoint> =
            self.contacts.iter().filter(|c| !is_replaced(c)).map(|c| **c).collect();
        for &number in numbers {
            let pair = self.joints[number].bodies.map(|body| &*self.states[self.place(body)]);
            held[number] = self.joints[number].fixed_at(pair);
            rows.extend(held[number].rows(number, pair, ahead));
        }
        (rows, held)
    }

    /// The numbers of the joints that hold the bodies to others, the world among them, in order. None: no
    /// chain is closed.
    pub(crate) fn of_closed_chains(&self) -> Option<Vec<usize>> {
        let (numbers, ground) = (self.numbers(), self.states.len());
        let mut joined = DisjointSets::new(ground + 1);
        let closes = numbers.iter().any(|&number| {
            let pair = self.joints[number].bodies.map(|body| {
                let place = self.place(body);
                if moves(&self.states[place]) { place as u32 } else { ground as u32 }
            });
            let is_closed = joined.root(pair[0]) == joined.root(pair[1]);
            joined.join(pair);
            is_closed
        });
        closes.then_some(numbers)
    }

    /// The numbers, in order, of the joints between two moving bodies; about other joints the chain may turn.
    /// None: there are none, or a motor drives one.
    pub(crate) fn between_moved(&self) -> Option<Vec<usize>> {
        let mut numbers = self.numbers();
        let is_moved = |body: usize| moves(&self.states[self.place(body)]);
        numbers.retain(|&number| self.joints[number].bodies.into_iter().all(is_moved));
        let is_driven = numbers.iter().any(|&number| self.joints[number].joint.motor.is_some());
        (!is_driven && !numbers.is_empty()).then_some(numbers)
    }
}
