//! Bodies that are in contact at the start, which counts no more once they have parted: what answers claim of them.

use super::claims::{MOST_LEFT, at, contact_claim};
use super::rounding::{Scale, resolvable};
use super::{Claim, Reason, TimeSpan};
use crate::{
    Budget, Departure, Mode, Moving, QueryError, QueryOptions, Start, StartState, TimeOfContact, Window,
    departure, time_of_contact,
};

/// The separation above s up to which bodies have not left each other for certain, in tolerances: they have where they are proven further apart
/// than 3 of them, of which a search that stops knows as much as [`MOST_LEFT`] less; and steps from time to time there may double that.
const NOT_LEFT: f64 = 2.0 * (3.0 + MOST_LEFT);

/// What an answer of [`departure`](crate::departure) claims. Until they have left, or to the end of the window, the bodies are near each other in
/// each part of the time that is as long as the engine's samples are apart: a contact after they had parted is not passed over in silence.
///
/// # Errors
/// As [`claim`](super::claim).
pub fn departure_claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &Departure,
) -> Result<Claim, Reason> {
    // Where the search of the start was ended nothing is known.
    let is_nothing = answer.answer == TimeOfContact::Undecided { clear_until: window.start() };
    if answer.start == StartState::Undecided && answer.left.is_none() && is_nothing {
        return Ok(Claim::All(Vec::new()));
    }
    let scale = Scale::new(bodies, window, options, window.start());
    let within = |time: f64, tolerances: f64| Claim::Within {
        span: at(time),
        distance: options.min_separation + tolerances * scale.most,
        triangles: None,
    };
    let every = resolvable(window, window.default_resolution());
    let stay_until = |to: f64| Claim::Often {
        span: TimeSpan { from: window.start(), to },
        distance: options.min_separation + NOT_LEFT * scale.most,
        every,
    };
    let mut claims = Vec::new();
    match answer.start {
        StartState::Apart => {}
        StartState::Contained => claims.push(Claim::Held { time: window.start() }),
        // As at any time of contact.
        _ => claims.push(within(window.start(), MOST_LEFT)),
    }
    let Some(left) = answer.left else {
        match answer.answer {
            // What never parts is in contact from the start.
            TimeOfContact::Contact(contact)
                if contact.start == answer.start && contact.start != StartState::Apart =>
            {
                claims.push(contact_claim(bodies, window, options, &answer.answer, None)?);
                // Where they are not proven to have left.
                claims.extend([within(window.end(), MOST_LEFT), stay_until(window.end())]);
            }
            // Bodies that begin apart have left at once.
            TimeOfContact::Undecided { .. } if is_nothing && answer.start != StartState::Apart => {
                claims.extend(start_claim(bodies, window, options, answer.start)?);
            }
            _ => return Err(Reason::Malformed),
        }
        return Ok(Claim::All(claims));
    };
    if !(window.start() <= left.lo && left.lo <= left.hi && left.hi <= window.end()) {
        return Err(Reason::Malformed);
    }
    if answer.start == StartState::Apart {
        // Bodies that begin apart leave nothing: what is said of the rest is said of all of the window.
        if [left.lo, left.hi] != [window.start(); 2] {
            return Err(Reason::Malformed);
        }
        claims.push(Claim::Clear { span: at(window.start()), distance: options.min_separation });
    } else {
        claims.extend(start_claim(bodies, window, options, answer.start)?);
        // From a time on at which they are proven within s + δ; if there is none, from the start.
        claims.push(within(left.lo, if left.lo == window.start() { MOST_LEFT } else { 1.0 }));
        // Further apart than s + δ, with δ at least as it was asked for.
        claims.push(Claim::Clear { span: at(left.hi), distance: options.min_separation + scale.asked });
        claims.push(stay_until(left.hi));
    }
    let rest = Window::try_new(left.hi, window.end()).map_err(|_| Reason::Malformed)?;
    claims.push(contact_claim(bodies, rest, options, &answer.answer, answer.left)?);
    Ok(Claim::All(claims))
}

/// How two bodies are said to stand at the start, where that is more than near each other. A departure names no triangles and no normal: those
/// that the search finds are tried.
fn start_claim(
    [a, b]: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    start: StartState,
) -> Result<Option<Claim>, Reason> {
    let reason = match start {
        StartState::Overlapping => Reason::NotOverlapping,
        StartState::Touching => Reason::NotParted,
        _ => return Ok(None),
    };
    let now = Window::try_new(window.start(), window.start()).map_err(|_| Reason::Malformed)?;
    // What is left of a time limit is another one at each search.
    let plain = options.with_start(Start::Report).with_mode(Mode::Accurate).with_budget(Budget::UNLIMITED);
    let found = time_of_contact(*a, *b, now, &plain).map_err(|_| Reason::Malformed)?;
    if found.contact().is_some_and(|contact| contact.start == start) {
        contact_claim(&[*a, *b], now, &plain, &found, None).map(Some)
    } else {
        Err(reason)
    }
}

/// The departure that an answer of a query with [`Start::Leave`] is the end of. When the bodies had parted is said only of those that meet
/// again; of others it is what the search finds, which is proven with the rest. Of bodies that have not parted until then, the answer
/// says nothing but that, and what the search finds takes its place.
///
/// # Errors
/// As [`departure`].
pub(super) fn departed(
    [a, b]: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
) -> Result<Departure, QueryError> {
    let mut found = departure(*a, *b, window, options)?;
    match answer {
        TimeOfContact::Contact(contact) => (found.left, found.answer) = (contact.left, *answer),
        _ if found.left.is_some_and(|left| left.hi <= clear_until(answer, window)) => found.answer = *answer,
        _ => {}
    }
    Ok(found)
}

/// The time until which an answer says that nothing counts.
pub(super) fn clear_until(answer: &TimeOfContact, window: Window) -> f64 {
    match answer {
        TimeOfContact::Separated => window.end(),
        TimeOfContact::Undecided { clear_until } => *clear_until,
        TimeOfContact::Contact(contact) => contact.time_lo,
    }
}

pub(super) fn leaving_claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
) -> Result<Claim, Reason> {
    let until = clear_until(answer, window);
    if !window.contains(until) {
        return Err(Reason::Malformed);
    }
    if *answer == (TimeOfContact::Undecided { clear_until: window.start() }) {
        return Ok(Claim::All(Vec::new()));
    }
    let whole = departed(bodies, window, options, answer).map_err(|_| Reason::Malformed)?;
    if clear_until(&whole.answer, window) < until {
        return Err(Reason::NotLeft);
    }
    departure_claim(bodies, window, options, &whole)
}
