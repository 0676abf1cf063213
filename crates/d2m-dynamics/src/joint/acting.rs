//! The forces of joints in flights of some length.

use crate::flight::problem::Problem;
use d2m_contact::{ContactPoint, JointPart, JointRow};

impl Problem<'_> {
    /// The contacts, with the forces of joints as they act in flights until `end`. None: there are no forces.
    pub(crate) fn with_forces(&self, end: f64) -> Option<Vec<ContactPoint>> {
        let force = |contact: &ContactPoint| match contact.row?.part {
            JointPart::Force { joint, number } => Some((joint, number)),
            JointPart::Rate | JointPart::Equation { .. } | JointPart::Value { .. } => None,
        };
        self.contacts.iter().find_map(|contact| force(contact))?;
        let in_flight = |contact: &&ContactPoint| {
            let Some((joint, number)) = force(contact) else { return **contact };
            let joined = &self.joints[joint];
            let pair = joined.bodies.map(|body| &*self.states[self.place(body)]);
            let laws = joined.joint.laws_of_forces(joined.value(pair), end - joined.acted.from);
            let acting = |row| {
                laws.get(number).map_or(row, |&(law, rate)| JointRow {
                    law,
                    pushing: rate,
                    target: rate,
                    ..row
                })
            };
            ContactPoint { row: contact.row.map(acting), ..**contact }
        };
        Some(self.contacts.iter().map(in_flight).collect())
    }
}
