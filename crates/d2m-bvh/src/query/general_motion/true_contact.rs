//! From a contact of fitted motions to one of the true ones.

use super::Advance;
use crate::moving::triangles_of;
use crate::query::at_start::of_pair;
use crate::{Contact, Evidence, Mode, StartState};
use d2m_feature::TrianglesAt;
use d2m_mesh::margin::direction;
use glam::DVec3;

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

    /// A time at which the triangles of a contact of fitted motions are certainly near each other. Where these motions are in contact at
    /// the start of the window it is that or none: at any other time nobody would know how the bodies stood then.
    pub(super) fn time_of_meeting(&self, contact: &Contact) -> Option<f64> {
        let triangles = [contact.triangle_a, contact.triangle_b];
        let meeting = self.meeting();
        if self.with_start(*contact).start == StartState::Apart {
            meeting.found_near(triangles, contact.time_lo)
        } else {
            meeting.are_near(triangles, self.now).then_some(self.now)
        }
    }

    /// The contact of the same triangles at such a time.
    pub(super) fn met_at(&self, time: f64, contact: &Contact, tolerance: f64) -> Contact {
        let found = self.of_same_triangles(time, contact);
        let start = match found.start {
            StartState::Apart => StartState::Apart,
            // Whether they overlap is judged afterwards.
            _ => StartState::Touching,
        };
        Contact { evidence: Evidence::Near, start, tolerance, ..found }
    }

    /// The data of the triangles of a contact where the true motions have them at a time, which is all of its bracket.
    pub(super) fn of_same_triangles(&self, time: f64, contact: &Contact) -> Contact {
        let triangles = [contact.triangle_a, contact.triangle_b];
        let near = TrianglesAt::new(&triangles_of(&self.bodies, triangles), time).distance();
        let normal = direction(near.point_b - near.point_a);
        let normal = if normal == DVec3::ZERO { contact.normal } else { normal };
        let then = self.with_start(Contact { time_lo: time, time_hi: time, ..*contact });
        of_pair(then, &self.bodies, triangles, normal)
    }

    /// Proof that the two triangles of a contact share a point at the end of its bracket.
    pub(super) fn crosses(&self, contact: &Contact) -> bool {
        let triangles = [contact.triangle_a, contact.triangle_b];
        TrianglesAt::new(&triangles_of(&self.bodies, triangles), contact.time_hi).certainly_cross()
    }

    /// The separation of the reported triangles where the true motions have them. Where numbers for time are too far apart for the
    /// tolerance, more is left at `time_lo` than the search left on its own clock: then the tolerance is what is left there, as
    /// for constant twists. A larger one takes no promise back.
    pub(super) fn with_what_is_left(&self, contact: Contact) -> Contact {
        if !matches!(contact.start, StartState::Apart | StartState::Touching) {
            return contact;
        }
        let triangles = [contact.triangle_a, contact.triangle_b];
        let separation =
            TrianglesAt::new(&triangles_of(&self.bodies, triangles), contact.time_lo).distance().upper;
        if separation.is_nan() {
            return contact;
        }
        let left = separation - self.options.min_separation;
        let covered = left <= Contact::MOST_LEFT * contact.tolerance;
        let keeps = covered || contact.start != StartState::Apart || self.options.mode == Mode::Capoeira;
        Contact { separation, tolerance: if keeps { contact.tolerance } else { left }, ..contact }
    }

    /// How the bodies stood at the start of the whole window, not of a span.
    pub(super) fn with_start(&self, contact: Contact) -> Contact {
        let start = if self.now == self.window.start() { contact.start } else { StartState::Apart };
        Contact { start, ..contact }
    }
}
