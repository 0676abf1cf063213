//! A robot's path as a page shows it.

use super::pair_spans::spans_of_pairs;
use super::{Flight, Holds, Mark, Picture, Span, Up, flights_of, push_thinned};
use crate::let_go::{Beginning, LetGo, exception};
use crate::output::short;
use d2m::bvh::{MeshTree, Moving, StartState, Window};
use d2m_robot::{PathAnswer, PathBodies};
use std::ptr;

/// Lines of text beside the picture: the pairs that were let go.
const MOST_FACTS: usize = 8;

/// The bodies of a robot and its scene along a path, and what the answer proves of it; `beginnings` are those of its pairs.
pub(crate) fn picture_of_path(
    bodies: &PathBodies<'_>,
    answer: &PathAnswer,
    beginnings: &[Beginning],
) -> Picture {
    let window = bodies.window();
    let [start, end] = [window.start(), window.end()].map(short);
    let let_go: Vec<&LetGo> = beginnings.iter().filter_map(Beginning::let_go).collect();
    let headline = match answer {
        PathAnswer::Free { .. } => format!("FREE from t = {start} to {end}{}", exception(beginnings)),
        PathAnswer::Contact(found) => {
            format!("CONTACT of {} and {} at t = {}", found.a, found.b, short(found.contact.time_lo))
        }
        PathAnswer::Undecided { free_until, .. } if *free_until <= window.start() => {
            "UNDECIDED from the start".to_owned()
        }
        PathAnswer::Undecided { free_until, .. } => {
            format!("UNDECIDED, free until t = {}{}", short(*free_until), exception(beginnings))
        }
    };
    let mut picture = Picture::new(headline, [window.start(), window.end()]);
    picture.up = Up::Z;
    picture.add_fact("bodies", bodies.len().to_string());
    picture.add_fact("pairs", format!("{} are checked", bodies.pairs().len()));
    if answer.free_until() > window.start() {
        picture.add_fact("free until", short(answer.free_until()));
    }
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
    for pair in let_go.into_iter().take(MOST_FACTS) {
        picture.add_fact("left", pair.words());
    }
    let mut found = Vec::new();
    match answer {
        PathAnswer::Free { .. } => {}
        PathAnswer::Undecided { free_until, a, b, .. } => {
            let text = format!("{a} and {b} are not decided: the budget ran out");
            found.push(Span::new(*free_until, window.end(), Holds::Undecided, &text));
        }
        PathAnswer::Contact(met) => {
            let contact = &met.contact;
            picture.add_fact("evidence", contact.evidence.to_string());
            if contact.start != StartState::Contained {
                let of = met.bodies.map(|body| bodies.moving(body).body.mesh());
                picture.marks.push(Mark::of_contact(contact, met.bodies, of));
            }
            let text = format!("first contact of {} and {}", met.a, met.b);
            found.push(Span::new(contact.time_lo, contact.time_hi, Holds::Contact, &text));
            let text = "after this the path was not examined";
            found.push(Span::new(contact.time_lo, window.end(), Holds::Unknown, text));
        }
    }
    picture.spans = spans_of_pairs(window, beginnings, "the path is proven free", found);
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
