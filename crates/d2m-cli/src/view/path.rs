//! A robot's path as a page shows it.

use super::{Flight, Holds, Mark, Picture, Span, Up, flights_of, push_thinned};
use crate::output::short;
use d2m::bvh::{MeshTree, Moving, StartState, Window};
use d2m_robot::{PathAnswer, PathBodies};
use std::ptr;

/// The bodies of a robot and its scene along a path, and what the answer proves of it.
pub(crate) fn picture_of_path(bodies: &PathBodies<'_>, window: Window, answer: &PathAnswer) -> Picture {
    let [start, end] = [window.start(), window.end()].map(short);
    let headline = match answer {
        PathAnswer::Free { .. } => format!("FREE from t = {start} to {end}"),
        PathAnswer::Contact(found) => {
            format!("CONTACT of {} and {} at t = {}", found.a, found.b, short(found.contact.time_lo))
        }
        PathAnswer::Undecided { free_until, .. } => {
            format!("UNDECIDED, free until t = {}", short(*free_until))
        }
    };
    let mut picture = Picture::new(headline, [window.start(), window.end()]);
    picture.up = Up::Z;
    picture.add_fact("bodies", bodies.len().to_string());
    picture.add_fact("pairs", format!("{} are checked", bodies.pairs().len()));
    picture.add_fact("free until", short(answer.free_until()));
    let mut meshes: Vec<(*const MeshTree, f64, usize)> = Vec::new();
    for body in 0..bodies.len() {
        let moving = bodies.moving(body);
        let same =
            meshes.iter().find(|(tree, radius, _)| ptr::eq(*tree, moving.body) && *radius == moving.radius);
        let number = if let Some(&(.., number)) = same {
            number
        } else {
            let number = picture.add_mesh(bodies.name(body), moving.body.mesh(), moving.radius);
            meshes.push((moving.body, moving.radius, number));
            number
        };
        picture.add_body(bodies.name(body), number, shown_flights(&moving, window));
    }
    if let Some(found) = answer.contact() {
        let contact = &found.contact;
        picture.add_fact("evidence", contact.evidence.to_string());
        if contact.start != StartState::Contained {
            let of = found.bodies.map(|body| bodies.moving(body).body.mesh());
            picture.marks.push(Mark::of_contact(contact, found.bodies, of));
            let text = format!("first contact of {} and {}", found.a, found.b);
            picture.spans.push(Span::new(contact.time_lo, contact.time_hi, Holds::Contact, &text));
        }
    }
    let free_until = answer.free_until();
    picture.spans.push(Span::new(window.start(), free_until, Holds::Clear, "the path is proven free"));
    if free_until < window.end() {
        let text = "after this the path was not examined";
        picture.spans.push(Span::new(free_until, window.end(), Holds::Unknown, text));
    }
    picture
}

/// The pieces of a motion, as few as nobody can tell from all of them.
fn shown_flights(moving: &Moving<'_>, window: Window) -> Vec<Flight> {
    let mut shown = Vec::new();
    for flight in flights_of(moving.motion, window) {
        let at = flight.motion.at();
        let far = moving.body.mesh().vertices().iter().map(|p| (*p - at).length()).fold(0.0, f64::max);
        push_thinned(&mut shown, flight, far + moving.radius);
    }
    shown
}
