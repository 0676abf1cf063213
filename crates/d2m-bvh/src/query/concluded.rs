//! Conclusions about moving bodies, whatever their motions (feature `audit`).

use crate::{Contact, Mode, Moving, QueryOptions, Solid, StartState, TimeOfContact, Window};
use d2m_mesh::audit::{Audited, Conclusion, Part, Place, Promise, report};

/// A span of the bodies' own time, and a distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claimed {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) distance: f64,
}

/// The bodies' surfaces are further apart.
pub(super) fn conclude_apart(place: Place, bodies: &[Moving<'_>; 2], claimed: Claimed) {
    conclude(place, Promise::Apart, bodies, [Part::Whole; 2], claimed);
}

/// Something of two triangles.
pub(super) fn conclude_of_triangles(
    place: Place,
    promise: Promise,
    bodies: &[Moving<'_>; 2],
    [a, b]: [u32; 2],
    claimed: Claimed,
) {
    conclude(place, promise, bodies, [Part::Triangle(a), Part::Triangle(b)], claimed);
}

/// Bodies share a point all the time, of which at least one is filled.
pub(super) fn conclude_overlap(
    bodies: &[Moving<'_>; 2],
    solids: [Solid; 2],
    Claimed { from, to, distance }: Claimed,
) {
    let body = |k: usize| Audited {
        is_filled: solids[k] == Solid::Filled,
        ..Audited::new(bodies[k].body, bodies[k].motion, Part::Whole)
    };
    let (place, promise) = (Place::Staying, Promise::Stays);
    report(&Conclusion { place, bodies: [body(0), body(1)], from, to, distance, promise });
}

fn conclude(
    place: Place,
    promise: Promise,
    bodies: &[Moving<'_>; 2],
    parts: [Part<'_>; 2],
    Claimed { from, to, distance }: Claimed,
) {
    let body = |k: usize| Audited::new(bodies[k].body, bodies[k].motion, parts[k]);
    report(&Conclusion { place, bodies: [body(0), body(1)], from, to, distance, promise });
}

/// What an answer says of the time before a contact. That of a mode that asks for nothing else than whether there is one says nothing.
pub(super) fn conclude_answer(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
) {
    let to = match *answer {
        TimeOfContact::Separated => window.end(),
        TimeOfContact::Contact(Contact { time_lo, start: StartState::Apart, .. })
            if options.mode != Mode::Exists =>
        {
            time_lo
        }
        _ => return,
    };
    let body = |k: usize| Audited {
        is_filled: bodies[k].solid_in(options) == Solid::Filled,
        ..Audited::new(bodies[k].body, bodies[k].motion, Part::Whole)
    };
    report(&Conclusion {
        place: Place::Answer,
        bodies: [body(0), body(1)],
        from: window.start(),
        to,
        distance: options.min_separation,
        promise: Promise::Clear,
    });
}

impl TimeOfContact {
    /// Until when a search that was asked until `end` proves its level; `None` where it says nothing of that.
    pub(super) fn free_until(&self, end: f64) -> Option<f64> {
        match *self {
            Self::Separated => Some(end),
            Self::Contact(Contact { time_lo, start: StartState::Apart, .. }) => Some(time_lo),
            _ => None,
        }
    }
}

/// The sum of two distances, less what its rounding and that of a sum with a third one may add.
pub(super) fn sum_of_distances(a: f64, b: f64, beside: f64) -> f64 {
    (a + b) - 2.0 * f64::EPSILON * (a + b + beside)
}
