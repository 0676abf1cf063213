//! The conclusions about flights on which a simulation relies, for the feature `audit`.

use crate::body::rigid_body::RigidBody;
use d2m_bvh::audit::{Audited, Conclusion, Part, Place, Promise, report};

/// Reports the conclusion that the surfaces of two bodies are further apart than a distance in their present
/// flights.
pub(crate) fn conclude(place: Place, [a, b]: [&RigidBody; 2], [from, to]: [f64; 2], distance: f64) {
    let bodies =
        [Audited::new(&a.tree, &a.flight, Part::Whole), Audited::new(&b.tree, &b.flight, Part::Whole)];
    report(&Conclusion { place, bodies, from, to, distance, promise: Promise::Apart });
}
