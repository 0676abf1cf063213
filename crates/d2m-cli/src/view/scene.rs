//! A scene as a page shows it.

use super::{Holds, Mark, Picture, Span, Up, flights_of};
use crate::failure::Failure;
use crate::load::named;
use crate::output::short;
use crate::scene::Scene;
use d2m::bvh::{MeshTree, QueryOptions, StartState, TimeOfContact};
use d2m::motion::AnyMotion;
use d2m::{BodyId, PairContact};
use std::path::Path;
use std::sync::Arc;

/// Lines of text beside the picture: the first contacts.
const MOST_FACTS: usize = 8;

/// Reads a scene and finds its contacts.
pub(crate) fn picture_of_scene(path: &Path, options: QueryOptions) -> Result<Picture, Failure> {
    let scene = Scene::read(path)?;
    let mut world = scene.world(options);
    let contacts =
        world.contacts(scene.window).map_err(|error| Failure::at(named(path), scene.describe(error)))?;
    let window = [scene.window.start(), scene.window.end()];
    let [start, end] = window.map(short);
    let headline = format!("{} bodies from t = {start} to {end}", scene.bodies.len());
    let mut picture = Picture::new(headline, window);
    let name = |id: BodyId| scene.bodies[id.index()].name.as_str();
    add_facts(&mut picture, &contacts, &name);
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
    picture.spans = spans(&contacts, window);
    Ok(picture)
}

fn add_facts<'n>(picture: &mut Picture, contacts: &[PairContact], name: &dyn Fn(BodyId) -> &'n str) {
    let undecided = contacts.iter().filter(|pair| pair.answer.contact().is_none()).count();
    picture.add_fact("in contact", format!("{} pairs", contacts.len() - undecided));
    if undecided > 0 {
        picture.add_fact("undecided", format!("{undecided} pairs"));
    }
    for pair in contacts.iter().take(MOST_FACTS) {
        if let Some(contact) = pair.answer.contact() {
            let who = format!("{} and {} ({})", name(pair.a), name(pair.b), contact.evidence);
            picture.add_fact(&format!("t = {}", short(contact.time_lo)), who);
        }
    }
}

/// What the first contacts of all pairs prove: clear until the earliest, and of later times each pair's own first contact.
fn spans(contacts: &[PairContact], [start, end]: [f64; 2]) -> Vec<Span> {
    let mut spans = Vec::new();
    let mut clear_until = end;
    for pair in contacts {
        match &pair.answer {
            TimeOfContact::Contact(contact) => {
                clear_until = clear_until.min(contact.time_lo);
                let text = "two bodies are in their first contact";
                spans.push(Span::new(contact.time_lo, contact.time_hi, Holds::Contact, text));
            }
            TimeOfContact::Undecided { clear_until: until } => clear_until = clear_until.min(*until),
            TimeOfContact::Separated => {}
        }
    }
    spans.push(Span::new(start, clear_until, Holds::Clear, "all pairs are proven apart"));
    if clear_until < end {
        let text = "after the first contact: pairs without a contact in the list are apart";
        spans.push(Span::new(clear_until, end, Holds::Unknown, text));
    }
    spans
}
