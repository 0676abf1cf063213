//! The problem that is solved for the flights of an island: its bodies, contacts and joints, and the
//! properties that decide how flights are tried.

use crate::SimulationOptions;
use crate::body::rigid_body::RigidBody;
use crate::flight::solved_body::moves;
use crate::joint::rows::Joined;
use d2m_contact::{Company, ContactPoint};
use std::borrow::Cow;

/// Jointed bodies are alike up to this ratio of masses.
const LIKE: f64 = 4.0;

/// The bodies of an island, their contacts and joints.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'s> {
    /// Body numbers, ascending, and the bodies, to which impacts have been applied.
    pub(crate) members: &'s [usize],
    pub(crate) states: &'s [Cow<'s, RigidBody>],
    pub(crate) contacts: &'s [&'s ContactPoint],
    pub(crate) options: &'s SimulationOptions,
    pub(crate) joints: &'s [Joined],
    pub(crate) company: Company,
}

impl Problem<'_> {
    /// Do joints connect bodies of unlike masses, or hold one between others?
    pub(crate) fn may_be_braked(&self) -> bool {
        let rows = || self.contacts.iter().filter(|contact| contact.row.is_some());
        let ends =
            rows().flat_map(|contact| [contact.a, contact.b]).map(|body| &self.states[self.place(body)]);
        !are_alike(ends.map(|s| &**s)) || self.has_chain()
    }

    /// The indices of the bodies that motors drive against each other.
    pub(crate) fn driven(&self) -> impl Iterator<Item = usize> {
        let joints = self.numbers().into_iter().map(|number| &self.joints[number]);
        let driven = joints.filter(|joined| joined.joint.motor.is_some());
        driven.flat_map(|joined| joined.bodies).map(|body| self.place(body))
    }

    /// Is a body held by more than one joint?
    fn has_chain(&self) -> bool {
        let ends = self.numbers().into_iter().flat_map(|number| self.joints[number].bodies);
        let mut held: Vec<usize> = ends.filter(|&body| moves(&self.states[self.place(body)])).collect();
        held.sort_unstable();
        held.windows(2).any(|two| two[0] == two[1])
    }

    pub(crate) fn place(&self, body: usize) -> usize {
        self.members.binary_search(&body).unwrap_or_default()
    }

    /// The numbers of those joints among the contacts that connect two bodies, in order.
    pub(crate) fn numbers(&self) -> Vec<usize> {
        let mut numbers: Vec<usize> = self.contacts.iter().filter_map(|contact| contact.joint()).collect();
        numbers.dedup();
        numbers.retain(|&number| self.joints[number].is_between_bodies());
        numbers
    }

    /// Do joints or locks hold any of the bodies?
    pub(crate) fn has_rows(&self) -> bool {
        self.contacts.iter().any(|contact| contact.row.is_some())
    }

    /// Do joints hold bodies of like masses? Light ones between heavy ones oscillate faster than they turn.
    pub(crate) fn has_like_joints(&self) -> bool {
        self.has_rows() && are_alike(self.states.iter().map(|s| &**s))
    }

    /// The speed that covers a gap in a step.
    pub(crate) fn speed(&self) -> f64 {
        self.options.gap / self.options.step
    }
}

/// Are the masses of the bodies that impulses move alike?
fn are_alike<'b>(bodies: impl Iterator<Item = &'b RigidBody>) -> bool {
    let masses = bodies.filter(|s| moves(s)).map(|s| s.mass);
    let (least, most) = masses.fold((f64::INFINITY, 0.0f64), |(lo, hi), m| (lo.min(m), hi.max(m)));
    most <= LIKE * least
}
