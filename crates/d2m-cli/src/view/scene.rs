//! The picture of a scene.

use super::{Mark, Picture, flights_of};
use crate::failure::Failure;
use crate::report::short;
use crate::scene::Scene;
use d2m::bvh::{MeshTree, QueryOptions, StartState};
use std::path::Path;
use std::sync::Arc;

/// Lines of text beside the picture: the first contacts.
const MOST_FACTS: usize = 8;

/// Part of the window for which a contact is marked: bodies fly on through each other.
const MARKED: f64 = 0.05;

/// Reads a scene and finds its contacts.
pub(crate) fn picture_of_scene(path: &Path, options: QueryOptions) -> Result<Picture, Failure> {
    let scene = Scene::read(path)?;
    let mut world = scene.world(options);
    let contacts =
        world.contacts(scene.window).map_err(|error| Failure::at(path.display(), scene.describe(error)))?;
    let [start, end] = [scene.window.start(), scene.window.end()];
    let headline = format!("{} bodies from t = {} to {}", scene.bodies.len(), short(start), short(end));
    let undecided = contacts.iter().filter(|pair| pair.answer.contact().is_none()).count();
    let mut facts = vec![format!("{} pairs in contact", contacts.len() - undecided)];
    if undecided > 0 {
        facts.push(format!("{undecided} pairs undecided"));
    }
    for pair in &contacts {
        if let Some(contact) = pair.answer.contact() {
            let [a, b] = [pair.a, pair.b].map(|id| &scene.bodies[id.index()].name);
            facts.push(format!("t = {}: {a} and {b} ({})", short(contact.time_lo), contact.evidence));
        }
    }
    facts.truncate(MOST_FACTS);
    let mut picture = Picture::new(headline, facts, [start, end], false);
    let mut meshes: Vec<(Arc<MeshTree>, usize)> = Vec::new();
    for body in &scene.bodies {
        let known = meshes.iter().find(|(tree, _)| Arc::ptr_eq(tree, &body.tree)).map(|&(_, number)| number);
        let number = known.unwrap_or_else(|| {
            let number = picture.add_mesh(body.tree.mesh());
            meshes.push((Arc::clone(&body.tree), number));
            number
        });
        picture.add_body(&body.name, number, &flights_of(&body.motion, scene.window));
    }
    for contact in contacts.iter().filter_map(|pair| pair.answer.contact()) {
        if contact.start != StartState::Contained {
            let (point, normal) = ((contact.point_a + contact.point_b) * 0.5, contact.normal);
            picture.add_mark(&Mark {
                from: contact.time_lo,
                until: contact.time_lo + MARKED * scene.window.length(),
                point,
                normal,
            });
        }
    }
    Ok(picture)
}
