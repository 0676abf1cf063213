//! What the roundings of an answer may be, from the lengths of its scene.

use super::Reason;
use crate::{Contact, Moving, Pose, QueryOptions, Twist, Window};
use d2m_motion::{CertifiedState, length};
use glam::DMat3;

/// The error γ of a distance of placed triangles, as a part of the lengths of the scene: 2⁻⁴⁴, four times the 128 units of 2⁻⁵³ that the
/// documentation of [`Contact::tolerance`] names (δ is at least 2γ), for lengths that are summed here in another order.
const ERROR: f64 = 1.0 / 17_592_186_044_416.0;

/// How far a point may be off that is placed by boxes around balls of positions and of rotations, in their radii: a product of two matrices
/// adds up √3 of the radius in each entry, the entries of a row times a point √3 of its length, and three components √3 of each. (3√3.)
const BOXES: f64 = 5.196_152_422_706_632;

/// What enclosures of motions leave open of both bodies' places at one time raises the engine's δ to 16 times that, where it is no more than
/// [`PLACES`] (docs/theory/motions.md, "Wide enclosures"). It is that in the middle of a span, here that at a time of it, so a quarter more may be.
const ROUNDED_PLACES: f64 = 16.0 * 1.25;
/// What counts as rounding of them, as a part of the lengths that they are about.
const PLACES: f64 = 512.0 * f64::EPSILON;

/// What the engine adds up it rounds up by 1e-14, which is less than this.
const ROUNDED_UP: f64 = 1.0 + 64.0 * f64::EPSILON;

/// How far the bodies go at most from one number for a time to the next; further is no number.
const LARGEST: f64 = f64::MAX / 1024.0;

/// How large the scene of a query is at a time of it, and how exactly anything can be known of it.
pub(super) struct Scale {
    /// δ as it was asked for.
    pub(super) asked: f64,
    /// The largest δ that is not a way to be right about anything: what was asked for, what the roundings of the scene's lengths (2γ) and
    /// of the enclosures of both poses may need, and what the bodies move from one number for a time to the next.
    pub(super) most: f64,
    /// The part of that which the enclosures of both poses may need.
    pub(super) raised: f64,
    /// γ, and what the enclosures of both poses at that time say of it: how far a distance of two triangles may be off.
    pub(super) error: f64,
    /// The same of points in the coordinates of the world, of bodies that are placed in plain numbers.
    pub(super) world_error: f64,
    /// The same of a distance of two triangles at rest at that time: how far the bodies go in the window is no part of it.
    pub(super) error_at_rest: f64,
}

impl Scale {
    pub(super) fn new(bodies: &[Moving<'_>; 2], window: Window, options: &QueryOptions, time: f64) -> Self {
        let sizes = bodies.map(|moving| moving.body.radius() + moving.radius);
        let states = [window.start(), time].map(|t| bodies.map(|moving| moving.motion.pose_and_twist(t)));
        let reaches = [0, 1].map(|k| {
            let (pose, _) = states[0][k];
            sizes[k] + length(bodies[k].body.center() - pose.at)
        });
        let apart = |[(a, _), (b, _)]: &[(Pose, Twist); 2]| length(a.translation - b.translation);
        let speed = |[(_, a), (_, b)]: &[(Pose, Twist); 2]| {
            let turning = length(a.angular) * reaches[0] + length(b.angular) * reaches[1];
            length(a.linear - b.linear) + turning
        };
        let travel = speed(&states[0]).max(speed(&states[1])) * window.length();
        let lengths = reaches[0] + reaches[1] + apart(&states[0]).max(apart(&states[1])) + travel;
        let lengths = lengths + options.min_separation;
        let clock = 8.0 * speed(&states[1]) * (time.next_up() - time).max(time - time.next_down());
        let asked = options.tolerance_of(sizes[0].max(sizes[1]));
        // Distances of bodies with radii are those of their meshes less both.
        let radii = 8.0 * f64::EPSILON * (bodies[0].radius + bodies[1].radius);
        let near = reaches[0] + reaches[1] + apart(&states[1]);
        let origin = states[1][0].0.translation;
        let enclosed = bodies.map(|body| body.motion.enclose_state_about(time, origin));
        let radius = |state: &CertifiedState| state.position_radius + state.rotation_radius * near;
        let places = radius(&enclosed[0]) + radius(&enclosed[1]);
        // How far plain numbers place the bodies from where the enclosures do.
        let plain = |k: usize| {
            let (pose, state) = (states[1][k].0, &enclosed[k]);
            let turn = DMat3::from_quat(pose.rotation.normalize()) - state.rotation;
            let turned = length(turn.x_axis) + length(turn.y_axis) + length(turn.z_axis);
            let off = length(pose.translation - origin - state.position) + turned * near;
            if pose.at == state.at && off.is_finite() { off } else { 0.0 }
        };
        let error = ERROR * lengths + BOXES * places;
        let far = states[1].each_ref().map(|(pose, _)| length(pose.translation));
        let raised = ROUNDED_PLACES * places.min(PLACES * (far[0] + far[1] + reaches[0] + reaches[1]));
        Self {
            asked,
            most: (asked * ROUNDED_UP + radii).max(2.0 * ERROR * lengths).max(raised).max(clock).min(LARGEST),
            raised,
            error,
            world_error: error + ERROR * far[0].max(far[1]) + plain(0) + plain(1),
            error_at_rest: ERROR * near + BOXES * places,
        }
    }

    /// What the separation of a contact may be off by: γ, as it is the distance of two triangles to rounding; and no more than half of δ,
    /// which is at least 2γ.
    pub(super) fn error_of(&self, contact: &Contact) -> f64 {
        self.error.min(0.5 * contact.tolerance)
    }

    /// Is this a tolerance that an answer may have?
    pub(super) fn accept(&self, tolerance: f64) -> Result<(), Reason> {
        accept(tolerance, self.most)
    }
}

/// A length of time, no shorter than two numbers for a time of the window are apart.
pub(super) fn resolvable(window: Window, length: f64) -> f64 {
    let clock = window.start().abs().max(window.end().abs());
    length.max(2.0 * (clock.next_up() - clock))
}

/// Is a tolerance one that an answer may have, if this is the largest of those?
pub(super) fn accept(tolerance: f64, most: f64) -> Result<(), Reason> {
    if tolerance >= 0.0 && tolerance <= most { Ok(()) } else { Err(Reason::Tolerance) }
}
