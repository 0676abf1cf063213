//! Scene files: many bodies with their motions, as `d2m scene` and others take them.

mod body;
mod ignored;
#[cfg(test)]
mod tests;

pub(crate) use body::{SceneBody, place_of};
pub(crate) use ignored::{Ignored, Names};

use crate::failure::Failure;
use crate::load::read;
use crate::mesh_library::MeshLibrary;
use crate::unique_keys::UniqueKeys;
use d2m::bvh::{QueryOptions, Window};
use d2m::{Body, BodyId, Group, World, WorldError};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The keys of a scene file; what is inside of them is checked one by one, so that messages can say where.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneForm {
    #[serde(default)]
    window: Option<[f64; 2]>,
    bodies: Vec<UniqueKeys>,
    #[serde(default)]
    ignore: Vec<UniqueKeys>,
    #[serde(default)]
    min_separation: f64,
    #[serde(default)]
    tolerance: Option<f64>,
}

/// A scene file that was read and checked.
pub(crate) struct Scene {
    pub(crate) window: Window,
    pub(crate) bodies: Vec<SceneBody>,
    ignored: Vec<Ignored>,
    min_separation: f64,
    tolerance: Option<f64>,
}

impl Scene {
    /// Reads the file, its meshes and its motions.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let place = path.display();
        let bytes = read(path)?;
        // Twice: first for faults with line and column, which are lost in a value.
        let form: SceneForm = serde_json::from_slice(&bytes)
            .map_err(|error| Failure::at(place.to_string(), body::hinted(&error)))?;
        let [start, end] = form.window.unwrap_or([0.0, 1.0]);
        let window =
            Window::try_new(start, end).map_err(|error| Failure::at(format!("{place}, window"), error))?;
        let wanted = |key: &str, value: f64, good: bool, what: &str| {
            let reason = || Failure::at(format!("{place}, {key}"), format!("{value:?} is not {what}"));
            if good { Ok(()) } else { Err(reason()) }
        };
        let separation = form.min_separation;
        let is_separation = separation >= 0.0 && separation.is_finite();
        wanted("min_separation", separation, is_separation, "a finite distance that is not negative")?;
        if let Some(tolerance) = form.tolerance {
            let is_tolerance = tolerance > 0.0 && tolerance.is_finite();
            wanted("tolerance", tolerance, is_tolerance, "a positive finite distance")?;
        }
        let mut library = MeshLibrary::new(path);
        let mut bodies = Vec::with_capacity(form.bodies.len());
        for (index, UniqueKeys(value)) in form.bodies.into_iter().enumerate() {
            let body_place = format!("{place}, {}", place_of(index, &value));
            let body = SceneBody::read(value, &body_place, window, &mut library)?;
            bodies.push(body);
        }
        check_names(&place.to_string(), &bodies)?;
        let names = Names::new(&bodies);
        let mut ignored = Vec::with_capacity(form.ignore.len());
        for (index, UniqueKeys(value)) in form.ignore.into_iter().enumerate() {
            ignored.push(names.ignored(&format!("{place}, ignore {index}"), &value)?);
        }
        Ok(Self { window, bodies, ignored, min_separation: separation, tolerance: form.tolerance })
    }

    /// What stopped a query of the scene's world, with the bodies' names.
    pub(crate) fn describe(&self, error: WorldError) -> String {
        let name = |id: BodyId| &self.bodies[id.index()].name;
        match error {
            WorldError::Pair { a, b, error } => format!("bodies {:?} and {:?}: {error}", name(a), name(b)),
            WorldError::OutsideMotion { body, outside } => format!("body {:?}: {outside}", name(body)),
            other => other.to_string(),
        }
    }

    /// The world of the scene; its bodies have the numbers that they have in the file.
    pub(crate) fn world(&self, options: QueryOptions) -> World {
        let mut options = options.with_min_separation(self.min_separation);
        if let Some(tolerance) = self.tolerance {
            options = options.with_tolerance(tolerance);
        }
        let mut world = World::new(options);
        let mut groups: BTreeMap<&str, Group> = BTreeMap::new();
        let mut ids: Vec<BodyId> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let mut moving = Body::new(body.tree.clone(), body.motion.clone()).with_solid(body.solid);
            if let Some(name) = &body.group {
                let next = Group(groups.len() as u32);
                moving = moving.with_group(*groups.entry(name).or_insert(next));
            }
            ids.push(world.add(moving));
        }
        for ignored in &self.ignored {
            match ignored {
                Ignored::Pair(a, b) => world.ignore_pair(ids[*a], ids[*b], true),
                Ignored::Groups(a, b) => {
                    if let (Some(&a), Some(&b)) = (groups.get(a.as_str()), groups.get(b.as_str())) {
                        world.ignore_groups(a, b, true);
                    }
                }
                Ignored::BodyAndGroup(a, group) => {
                    let members =
                        self.bodies.iter().enumerate().filter(|(_, body)| body.group.as_ref() == Some(group));
                    for (b, _) in members {
                        world.ignore_pair(ids[*a], ids[b], true);
                    }
                }
            }
        }
        world
    }
}

/// No two bodies may have the same name.
pub(crate) fn check_names(place: &str, bodies: &[SceneBody]) -> Result<(), Failure> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        if let Some(earlier) = seen.insert(&body.name, index) {
            let reason = format!("the name {:?} is that of body {earlier} too", body.name);
            return Err(Failure::at(format!("{place}, body {index}"), reason));
        }
    }
    Ok(())
}
