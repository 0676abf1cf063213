//! Conclusions about bodies at rest (feature `audit`): they are about time zero of motions that rest in the poses.

use crate::Posed;
use crate::audit::{Audited, Conclusion, Part, Place, Promise, is_heard, report};
use d2m_motion::ConstantTwist;

/// Parts of two bodies are further apart than a distance, or no further.
pub(super) fn conclude_at_rest(
    place: Place,
    promise: Promise,
    bodies: [Posed<'_>; 2],
    parts: [Part<'_>; 2],
    distance: f64,
) {
    if is_heard() {
        let [a, b] = bodies.map(|Posed { pose, .. }| {
            ConstantTwist::REST
                .with_orientation(pose.rotation)
                .with_position(pose.translation)
                .with_at(pose.at)
        });
        let bodies = [Audited::new(bodies[0].body, &a, parts[0]), Audited::new(bodies[1].body, &b, parts[1])];
        report(&Conclusion { place, bodies, from: 0.0, to: 0.0, distance, promise });
    }
}
