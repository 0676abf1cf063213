//! Bodies with radii: the query of their meshes, and its answer on the rounded surfaces.
//!
//! A body with the radius r is everything within r of its mesh. Two such bodies are further than s apart exactly where their meshes are
//! further than s + r_A + r_B apart, so the separation of the query carries the radii, and the witness points move along
//! the normal.

use crate::{Contact, MeshTree, Moving, QueryError, QueryOptions, StartState, TimeOfContact};
use d2m_lanes::UP;
use d2m_mesh::margin::sum_of_radii;

/// The radii of two bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) radii: [f64; 2],
}

impl Rounded {
    /// # Errors
    /// [`QueryError::BadRadius`].
    pub(super) fn try_new(bodies: [&Moving<'_>; 2]) -> Result<Self, QueryError> {
        let radii = bodies.map(|body| body.radius);
        match radii.iter().position(|radius| !(radius.is_finite() && *radius >= 0.0)) {
            Some(body) => Err(QueryError::BadRadius { body, value: radii[body] }),
            None => Ok(Self { radii }),
        }
    }

    /// Both radii, not less than their sum.
    pub(super) fn sum(&self) -> f64 {
        sum_of_radii(self.radii)[1]
    }

    fn are_none(&self) -> bool {
        self.radii == [0.0; 2]
    }

    /// The options of the query of the meshes.
    ///
    /// # Errors
    /// [`QueryError::BadMinSeparation`].
    pub(super) fn options(
        &self,
        trees: [&MeshTree; 2],
        options: &QueryOptions,
    ) -> Result<QueryOptions, QueryError> {
        if self.are_none() {
            return Ok(*options);
        }
        let value = options.min_separation;
        if !(value.is_finite() && value >= 0.0) {
            return Err(QueryError::BadMinSeparation { value });
        }
        let size = |k: usize| trees[k].radius() + self.radii[k];
        let tolerance = options.tolerance_of(size(0).max(size(1)));
        let separation = if value == 0.0 { self.sum() } else { (value + self.sum()).next_up() };
        Ok(options.with_tolerance(tolerance).with_min_separation(separation))
    }

    /// The tolerance of the rounded bodies: the sum of the radii and the separation are rounded twice.
    pub(super) fn tolerance(&self, of_meshes: f64) -> f64 {
        let [a, b] = self.radii;
        if self.are_none() { of_meshes } else { (of_meshes + 4.0 * f64::EPSILON * (a + b)) * UP }
    }

    /// The answer of that query as one about the rounded bodies.
    pub(super) fn answer(&self, answer: TimeOfContact) -> TimeOfContact {
        match answer {
            TimeOfContact::Contact(contact) if !self.are_none() => {
                TimeOfContact::Contact(self.contact(contact))
            }
            other => other,
        }
    }

    /// How the rounded bodies stand at the start, by the contact of their meshes there: where these are nearer to each other than the radii reach
    /// the insides of what is within those of them overlap.
    pub(super) fn start(&self, contact: &Contact) -> StartState {
        match contact.start {
            start @ (StartState::Apart | StartState::Contained) => start,
            _ if contact.separation < sum_of_radii(self.radii)[0] => StartState::Overlapping,
            start => start,
        }
    }

    fn contact(&self, contact: Contact) -> Contact {
        if contact.start == StartState::Contained {
            return contact;
        }
        let [a, b] = self.radii;
        Contact {
            start: self.start(&contact),
            point_a: contact.point_a + contact.normal * a,
            point_b: contact.point_b - contact.normal * b,
            separation: (contact.separation - self.sum()).max(0.0),
            tolerance: self.tolerance(contact.tolerance),
            ..contact
        }
    }
}
