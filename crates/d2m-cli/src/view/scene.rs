//! A scene as a page shows it.

use super::pair_spans::spans_of_pairs;
use super::{Holds, Mark, Picture, Span, Up, flights_of};
use crate::failure::Failure;
use crate::let_go::Beginning;
use crate::output::short;
use crate::scene::Scene;
use d2m::bvh::{MeshTree, QueryOptions, StartState, TimeOfContact, Window};
use d2m::motion::AnyMotion;
use d2m::{BodyId, PairContact};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::sync::Arc;

/// Lines of text of one kind beside the picture: the first contacts, and the pairs that were let go.
const MOST_FACTS: usize = 8;

/// Finds the contacts of a scene, which is in this file.
pub(crate) fn picture_of_scene(scene: &Scene, file: &str, options: QueryOptions) -> Result<Picture, Failure> {
    let mut world = scene.world(options);
    let contacts = world.contacts(scene.window).map_err(|error| Failure::at(file, scene.describe(error)))?;
    let window = [scene.window.start(), scene.window.end()];
    let [start, end] = window.map(short);
    let headline = format!("{} bodies from t = {start} to {end}", scene.bodies.len());
    let mut picture = Picture::new(headline, window);
    let name = |id: BodyId| scene.bodies[id.index()].name.as_str();
    let beginnings = beginnings(scene, options);
    add_facts(&mut picture, &contacts, &name);
    for pair in beginnings.iter().filter_map(Beginning::let_go).take(MOST_FACTS) {
        picture.add_fact("left", pair.words());
    }
    let is_arm = |motion: &AnyMotion| matches!(motion, AnyMotion::Chain(_));
    if scene.bodies.iter().any(|body| is_arm(&body.motion)) {
        picture.up = Up::Z;
    }
    let mut meshes: Vec<(Arc<MeshTree>, f64, usize)> = Vec::new();
    for body in &scene.bodies {
        let known =
            meshes.iter().find(|(tree, radius, _)| Arc::ptr_eq(tree, &body.tree) && *radius == body.radius);
        let number = if let Some(&(.., number)) = known {
            number
        } else {
            let number = picture.add_mesh(&body.name, body.tree.mesh(), body.radius);
            meshes.push((Arc::clone(&body.tree), body.radius, number));
            number
        };
        picture.add_body(&body.name, number, flights_of(&body.motion, scene.window));
    }
    for pair in &contacts {
        if let TimeOfContact::Contact(contact) = &pair.answer
            && contact.start != StartState::Contained
        {
            let bodies = [pair.a, pair.b].map(BodyId::index);
            let meshes = bodies.map(|index| scene.bodies[index].tree.mesh());
            picture.marks.push(Mark::of_contact(contact, bodies, meshes));
        }
    }
    picture.spans = spans(&contacts, scene.window, &beginnings);
    Ok(picture)
}

/// From when on the answers count, of all pairs that are to leave.
fn beginnings(scene: &Scene, options: QueryOptions) -> Vec<Beginning> {
    if !scene.lets_go() {
        return Vec::new();
    }
    let of = |pair: [usize; 2]| {
        let [a, b] = pair.map(|body| &scene.bodies[body]);
        let options = scene.pair_options(pair, options);
        Beginning::of([&a.name, &b.name], [a.moving(), b.moving()], scene.window, &options)
    };
    scene.pairs().into_par_iter().map(of).collect()
}

fn add_facts<'n>(picture: &mut Picture, contacts: &[PairContact], name: &dyn Fn(BodyId) -> &'n str) {
    let undecided = contacts.iter().filter(|pair| pair.answer.contact().is_none()).count();
    picture.add_fact("in contact", format!("{} pairs", contacts.len() - undecided));
    if undecided > 0 {
        picture.add_fact("undecided", format!("{undecided} pairs"));
    }
    for pair in contacts.iter().take(MOST_FACTS) {
        let names = format!("{} and {}", name(pair.a), name(pair.b));
        match &pair.answer {
            TimeOfContact::Contact(contact) => {
                let label = format!("t = {}", short(contact.time_lo));
                picture.add_fact(&label, format!("{names} ({})", contact.evidence));
            }
            TimeOfContact::Undecided { clear_until } => {
                picture.add_fact(&format!("t = {}", short(*clear_until)), format!("{names} (undecided)"));
            }
            TimeOfContact::Separated => {}
        }
    }
}

/// What the answers to all pairs prove: clear until the earliest contact or undecided pair, and of later times each pair's own first contact.
fn spans(contacts: &[PairContact], window: Window, beginnings: &[Beginning]) -> Vec<Span> {
    let mut found = Vec::new();
    let (mut first_contact, mut first_undecided, mut undecided) = (None, window.end(), 0_usize);
    for pair in contacts {
        match &pair.answer {
            TimeOfContact::Contact(contact) => {
                let text = "two bodies are in their first contact";
                found.push(Span::new(contact.time_lo, contact.time_hi, Holds::Contact, text));
                first_contact = Some(first_contact.map_or(contact.time_lo, |t: f64| t.min(contact.time_lo)));
            }
            TimeOfContact::Undecided { clear_until } => {
                first_undecided = first_undecided.min(*clear_until);
                undecided += 1;
            }
            TimeOfContact::Separated => {}
        }
    }
    if undecided > 0 {
        let pairs = if undecided == 1 { "1 pair is".to_owned() } else { format!("{undecided} pairs are") };
        let text = format!("{pairs} not decided after this time: the budget or the time ran out");
        found.push(Span::new(first_undecided, window.end(), Holds::Undecided, &text));
    }
    if let Some(first_contact) = first_contact {
        let decided = if undecided > 0 { " and are decided" } else { "" };
        let text = format!("after the first contact: pairs that have none{decided} are proven apart");
        found.push(Span::new(first_contact, window.end(), Holds::Unknown, &text));
    }
    spans_of_pairs(window, beginnings, "all pairs are proven apart", found)
}
