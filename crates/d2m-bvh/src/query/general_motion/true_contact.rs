//! From a contact of fitted motions to one of the true ones.

use super::Advance;
use crate::query::report::MOST_LEFT;
use crate::query::true_poses::PlacedTriangles;
use crate::{Contact, Evidence, Mode, StartState};

impl Advance<'_> {
    /// Data of the fitted motions expressed by the true ones: points by their weights, speeds by the true twists. That the
    /// fitted motions' features cross says of the true ones only that they are near, unless those cross as well.
    pub(super) fn true_contact(&mut self, contact: Contact) -> Contact {
        let poses = self.poses_at(contact.time_lo);
        let at = |k: usize, triangle: u32, weights: [f64; 3]| {
            let (pose, twist) = poses[k];
            let corners = self.bodies[k].body.mesh().corners(triangle as usize);
            let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            let place = pose.transform_point(point);
            (place, twist.velocity_of(place - pose.translation))
        };
        let (point_a, speed_a) = at(0, contact.triangle_a, contact.barycentric_a);
        let (point_b, speed_b) = at(1, contact.triangle_b, contact.barycentric_b);
        let inside = contact.start == StartState::Contained;
        let evidence = match contact.evidence {
            Evidence::Crossing if !inside && !self.crosses(&contact) => Evidence::Near,
            evidence => evidence,
        };
        let closing_speed = (speed_a - speed_b).dot(contact.normal);
        let contact = self.with_start(Contact { evidence, point_a, point_b, closing_speed, ..contact });
        self.with_what_is_left(contact)
    }

    /// Proof that the two triangles of a contact share a point at the end of its bracket.
    pub(super) fn crosses(&self, contact: &Contact) -> bool {
        let triangles = [contact.triangle_a, contact.triangle_b];
        PlacedTriangles::new(&self.bodies, triangles, contact.time_hi).certainly_cross()
    }

    /// The separation of the reported triangles where the true motions have them. Where numbers for time are too far apart for the
    /// tolerance, more is left at `time_lo` than the search left on its own clock: then the tolerance is what is left there, as
    /// for constant twists. A larger one takes no promise back.
    pub(super) fn with_what_is_left(&self, contact: Contact) -> Contact {
        if !matches!(contact.start, StartState::Apart | StartState::Touching) {
            return contact;
        }
        let triangles = [contact.triangle_a, contact.triangle_b];
        let separation = PlacedTriangles::new(&self.bodies, triangles, contact.time_lo).distance().upper;
        if separation.is_nan() {
            return contact;
        }
        let left = separation - self.options.min_separation;
        let covered = left <= MOST_LEFT * contact.tolerance;
        let keeps = covered || contact.start != StartState::Apart || self.options.mode == Mode::Capoeira;
        Contact { separation, tolerance: if keeps { contact.tolerance } else { left }, ..contact }
    }

    /// How the bodies stood at the start of the whole window, not of a span.
    pub(super) fn with_start(&self, contact: Contact) -> Contact {
        let start = if self.now == self.window.start() { contact.start } else { StartState::Apart };
        Contact { start, ..contact }
    }
}
