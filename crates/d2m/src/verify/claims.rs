//! What answers claim.

use super::rounding::{Scale, accept, resolvable};
use super::witness::{are_near, clearance_fault, witness_fault};
use super::{Claim, Reason, TimeSpan};
use crate::{Clearance, ClearanceOptions, ContactSpan, SpanStatus};
use crate::{Contact, Mode, Moving, QueryOptions, StartState, TimeOfContact, Window};
use d2m_bvh::{ClearanceStatus, Evidence, TimeBracket};

/// The separation that may be left above s, in tolerances.
pub(super) const MOST_LEFT: f64 = Contact::MOST_LEFT;
/// The width of a clearance in tolerances, where that is more than its accuracy.
const WIDTH: f64 = 4.0;

/// Of a width w that is to be proven, rounding hides what is left where a pair that a search stops at, [`MOST_LEFT`] of its tolerances above the
/// level, is not nearer by a quarter of w: so three quarters of w are no more than that, and w at most this many of the tolerances
/// that rounding needs.
const HIDDEN: f64 = MOST_LEFT / 0.75;

/// How far bodies that touch are moved to part, at most, in errors of a distance at rest: the engine moves them by 2⁹ of its own, which are
/// smaller.
const LAYER: f64 = 1024.0;

pub(super) const fn at(time: f64) -> TimeSpan {
    TimeSpan { from: time, to: time }
}

/// What an answer claims of bodies that had parted then, or that nothing is let go of.
pub(super) fn contact_claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
    left: Option<TimeBracket>,
) -> Result<Claim, Reason> {
    let clear = |to: f64| Claim::Clear {
        span: TimeSpan { from: window.start(), to },
        distance: options.min_separation,
    };
    match answer {
        TimeOfContact::Separated => Ok(clear(window.end())),
        // At its end they may touch, and so they may from the start.
        TimeOfContact::Undecided { clear_until } if *clear_until == window.start() => {
            Ok(Claim::All(Vec::new()))
        }
        TimeOfContact::Undecided { clear_until } => Ok(clear(*clear_until)),
        TimeOfContact::Contact(contact) => {
            let is_span = window.start() <= contact.time_lo
                && contact.time_lo <= contact.time_hi
                && contact.time_hi <= window.end();
            // A meeting that nothing is shown of has no later end.
            let is_bracket = contact.evidence != Evidence::Early || contact.time_lo == contact.time_hi;
            // Nothing, or the same, is said of when bodies had parted.
            let is_left = contact.left.is_none() || contact.left == left;
            if !(contact.separation >= 0.0 && is_span && is_bracket && is_left) {
                return Err(Reason::Malformed);
            }
            let scale = Scale::new(bodies, window, options, contact.time_lo);
            scale.accept(contact.tolerance)?;
            if witness_fault(bodies, window, options, contact).is_some() {
                return Err(Reason::Witness);
            }
            if options.mode == Mode::Exists && contact.start == StartState::Apart {
                // Of the time before it nothing is said, but of the start.
                let apart = Claim::Clear { span: at(window.start()), distance: options.min_separation };
                let met = meeting(contact, options, contact.evidence).ok_or(Reason::NothingClaimed)?;
                return Ok(Claim::All(vec![apart, met]));
            }
            let mut claims = Vec::new();
            match contact.start {
                StartState::Apart => claims.push(clear(contact.time_lo)),
                _ if contact.time_lo != window.start() => return Err(Reason::Malformed),
                StartState::Overlapping | StartState::Contained if contact.separation != 0.0 => {
                    return Err(Reason::Malformed);
                }
                StartState::Contained => return Ok(Claim::Held { time: contact.time_lo }),
                // At least one end of them is near, whatever the separation: then, and for surfaces of more triangles than can cross.
                StartState::Overlapping => {
                    let triangles = [contact.triangle_a, contact.triangle_b];
                    return Ok(Claim::Overlapping { time: contact.time_lo, triangles });
                }
                StartState::Touching => claims.push(Claim::Parted {
                    time: contact.time_lo,
                    along: contact.normal,
                    most: LAYER * scale.error_at_rest,
                }),
                StartState::Undecided => {}
            }
            let most = options.min_separation + MOST_LEFT * contact.tolerance;
            if options.mode == Mode::Accurate && contact.separation > most {
                return Err(Reason::Distance);
            }
            let off = scale.error_of(contact);
            // Of rounded bodies that overlap at the start the separation says only that.
            let radii = bodies[0].radius + bodies[1].radius;
            let deepest = if contact.separation == 0.0 { 2.0 * radii } else { 0.0 };
            claims.push(Claim::Apart {
                time: contact.time_lo,
                triangles: [contact.triangle_a, contact.triangle_b],
                least: contact.separation - off - deepest,
                most: contact.separation + off,
            });
            claims.extend(meeting(contact, options, contact.evidence));
            Ok(Claim::All(claims))
        }
    }
}

fn meeting(contact: &Contact, options: &QueryOptions, evidence: Evidence) -> Option<Claim> {
    let above = match evidence {
        Evidence::Crossing => 0.0,
        Evidence::Near => contact.tolerance,
        _ => return None,
    };
    Some(Claim::Within {
        span: TimeSpan { from: contact.time_lo, to: contact.time_hi },
        distance: options.min_separation + above,
        triangles: Some([contact.triangle_a, contact.triangle_b]),
    })
}

/// What an answer of [`clearance`](crate::clearance) claims: the enclosure, its width, and for bodies that meet that they are apart before.
///
/// # Errors
/// As [`claim`](super::claim).
pub fn clearance_claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &ClearanceOptions,
    answer: &Clearance,
) -> Result<Claim, Reason> {
    let Clearance { lower, upper, time, .. } = *answer;
    if !(0.0 <= lower && lower <= upper && window.start() <= time && time <= window.end()) {
        return Err(Reason::Malformed);
    }
    let mut query = QueryOptions::default();
    query.tolerance = options.tolerance;
    let scale = Scale::new(bodies, window, &query, time);
    // Where it hides more of the width than that, the width becomes the tolerance.
    let hidden = if answer.status == ClearanceStatus::Contact { 0.0 } else { HIDDEN * scale.raised };
    let most = scale.most.max(hidden);
    let width = (options.accuracy * upper).max(WIDTH * most);
    let is_cut = lower >= options.cutoff || answer.status == ClearanceStatus::Undecided;
    if !is_cut && upper - lower > width {
        return Err(Reason::Tolerance);
    }
    // Bodies that meet come as near as tolerances resolve, whatever the accuracy of others.
    if answer.status == ClearanceStatus::Contact && (lower > 0.0 || upper > WIDTH * scale.most) {
        return Err(Reason::Distance);
    }
    accept(answer.tolerance, most)?;
    let above = WIDTH * scale.most;
    // Bodies that meet are within the tolerance of each other at the time of contact, or one holds the other.
    let is_held = upper == 0.0 && !are_near(bodies, answer, above + scale.world_error);
    if !is_held && clearance_fault(bodies, answer, scale.world_error, above).is_some() {
        return Err(Reason::Witness);
    }
    // The least distance is not below `lower`: above the number before it.
    let clear =
        |to: f64, distance: f64| Claim::Clear { span: TimeSpan { from: window.start(), to }, distance };
    let mut claims = Vec::new();
    if lower > 0.0 {
        claims.push(clear(window.end(), lower.next_down()));
    } else if answer.status == ClearanceStatus::Clear {
        return Err(Reason::Malformed);
    } else if answer.status == ClearanceStatus::Contact && upper == 0.0 && time > window.start() {
        // Where the budget ended the search, the time is one at which they meet, not the first one.
        claims.push(clear(time, 0.0));
    }
    if is_held {
        claims.push(Claim::Held { time });
    } else if upper == 0.0 {
        // What they meet at later is not at this time: there they are as near as at a time of contact.
        claims.push(Claim::Within {
            span: at(time),
            distance: MOST_LEFT * scale.most + scale.error,
            triangles: Some([answer.triangle_a, answer.triangle_b]),
        });
    }
    claims.push(Claim::Within {
        // An upper end is that of the engine's own roundings of two triangles at that time. Bodies that meet are within the tolerance after the
        // time of contact.
        span: TimeSpan { from: time, to: if upper > 0.0 { time } else { window.end() } },
        distance: match answer.status {
            _ if upper > 0.0 => upper + scale.error_at_rest,
            ClearanceStatus::Contact => scale.most,
            _ => 0.0,
        },
        triangles: Some([answer.triangle_a, answer.triangle_b]),
    });
    Ok(Claim::All(claims))
}

/// What an answer of [`contact_spans`](crate::contact_spans) claims: clear spans are clear, and end near the minimum separation where
/// a contact follows; spans of contact begin and end within the resolution of a time at which the bodies are within s + δ, and no part
/// of them that is as long as the resolution is without one.
///
/// # Errors
/// As [`claim`](super::claim).
pub fn spans_claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    resolution: Option<f64>,
    answer: &[ContactSpan],
) -> Result<Claim, Reason> {
    let resolution = resolution.unwrap_or(window.default_resolution());
    let covers = answer.first().is_some_and(|span| span.from == window.start())
        && answer.last().is_some_and(|span| span.to == window.end())
        && answer.windows(2).all(|pair| pair[0].to == pair[1].from && pair[0].from < pair[0].to)
        && answer.iter().all(|span| span.from <= span.to);
    if !(covers && resolution >= 0.0 && resolution.is_finite()) {
        return Err(Reason::Malformed);
    }
    let within = |from: f64, to: f64, above: f64| {
        let span = TimeSpan { from: from.max(window.start()), to: to.min(window.end()) };
        Claim::Within { span, distance: options.min_separation + above, triangles: None }
    };
    let mut claims = Vec::new();
    for (index, span) in answer.iter().enumerate() {
        // At either end rounding may be the greater one.
        let scales = [span.from, span.to].map(|time| Scale::new(bodies, window, options, time));
        let is_tolerance = scales.iter().any(|scale| scale.accept(span.tolerance).is_ok());
        if span.status != SpanStatus::Undecided && !is_tolerance {
            return Err(Reason::Tolerance);
        }
        match span.status {
            SpanStatus::Clear => {
                let time = TimeSpan { from: span.from, to: span.to };
                claims.push(Claim::Clear { span: time, distance: options.min_separation });
                if answer.get(index + 1).is_some_and(|next| next.status == SpanStatus::Contact) {
                    claims.push(within(span.to, span.to, MOST_LEFT * scales[1].most));
                }
            }
            SpanStatus::Contact => {
                // What is within the level was found with the engine's own roundings.
                let error = scales[0].error_at_rest.max(scales[1].error_at_rest);
                let above = span.tolerance.max(scales[0].asked) + error;
                let near = |time: f64| within(time - resolution, time + resolution, above);
                claims.extend([near(span.from), near(span.to)]);
                claims.push(Claim::Often {
                    span: TimeSpan { from: span.from, to: span.to },
                    distance: options.min_separation + above,
                    every: resolvable(window, resolution),
                });
            }
            SpanStatus::Undecided => {}
        }
    }
    Ok(Claim::All(claims))
}
