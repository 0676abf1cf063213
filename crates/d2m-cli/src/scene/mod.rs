//! Scene files: many bodies with their motions, as `d2m scene` and others take them.

mod body;
mod ignored;
#[cfg(test)]
mod tests;

pub(crate) use body::SceneBody;
pub(crate) use ignored::{Ignored, Names};

use crate::failure::Failure;
use crate::load::{named, read};
use crate::mesh_library::MeshLibrary;
use crate::orientation::warn_of_json;
use crate::output::note;
use crate::unlike_sizes::warn_of_scene_sizes;
use d2m::bvh::{QueryOptions, Start, Window};
use d2m::{Body, BodyId, Group, World, WorldError};
use d2m_io::{SceneFile, ScenePair};
use std::collections::BTreeMap;
use std::path::Path;

/// A scene file that was read and checked.
pub(crate) struct Scene {
    pub(crate) window: Window,
    pub(crate) bodies: Vec<SceneBody>,
    ignored: Vec<Ignored>,
    min_separation: f64,
    tolerance: Option<f64>,
    start: Start,
    pairs: BTreeMap<[usize; 2], ScenePair>,
}

impl Scene {
    /// Reads the file, its meshes and its motions.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let place = named(path);
        let bytes = read(path)?;
        let file = SceneFile::parse(&bytes).map_err(|error| error.in_file(place.as_str()))?;
        if let Ok(value) = serde_json::from_slice(&bytes) {
            warn_of_json(&place, &value);
        }
        let SceneFile { window, bodies: entries, ignore, min_separation, tolerance, start, pairs, .. } = file;
        let mut library = MeshLibrary::new(path);
        let mut bodies = Vec::with_capacity(entries.len());
        for (index, entry) in entries.into_iter().enumerate() {
            let place = format!("{place}, body {index} ({:?})", entry.name);
            let body = SceneBody::new(entry, &place, window, &mut library)?;
            bodies.push(body);
        }
        let names = Names::new(&bodies);
        let ignored = ignore
            .iter()
            .enumerate()
            .map(|(index, [a, b])| names.pair(&format!("{place}, ignore {index}"), a, b))
            .collect::<Result<_, _>>()?;
        let numbers: BTreeMap<&str, usize> =
            bodies.iter().enumerate().map(|(index, body)| (body.name.as_str(), index)).collect();
        let numbered = pairs.into_iter().filter_map(|pair| {
            let [a, b] = [&pair.a, &pair.b].map(|name| numbers.get(name.as_str()).copied());
            Some((ascending([a?, b?]), pair))
        });
        let pairs = numbered.collect();
        Ok(Self { window, bodies, ignored, min_separation, tolerance, start, pairs })
    }

    /// The same with what counts of bodies that are in contact at the start.
    pub(crate) fn with_start(self, start: Start) -> Self {
        Self { start, ..self }
    }

    /// Warns where no pair is checked, and where a body is probably in another unit; `file`: where the scene is.
    pub(crate) fn warn(&self, file: &str) {
        if self.each_pair().next().is_none() {
            let count = self.bodies.len();
            note(&format!(
                "d2m: warning: {file}: of {count} bodies no pair is checked: the answer says nothing"
            ));
        }
        warn_of_scene_sizes(file, self.bodies.iter().map(SceneBody::named_size));
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

    /// The pairs of bodies that are not ignored.
    pub(crate) fn pairs(&self) -> Vec<[usize; 2]> {
        self.each_pair().collect()
    }

    fn each_pair(&self) -> impl Iterator<Item = [usize; 2]> {
        let group = |body: usize| self.bodies[body].group.as_deref();
        let in_groups = move |[a, b]: [usize; 2], one: &str, other: &str| {
            group(a) == Some(one) && group(b) == Some(other)
        };
        let is_ignored = move |pair: [usize; 2]| {
            let [a, b] = pair;
            self.ignored.iter().any(|ignored| match ignored {
                Ignored::Pair(p, q) => [*p, *q] == pair || [*q, *p] == pair,
                Ignored::Groups(one, other) => in_groups(pair, one, other) || in_groups(pair, other, one),
                Ignored::BodyAndGroup(body, of) => {
                    (a == *body && group(b) == Some(of)) || (b == *body && group(a) == Some(of))
                }
            })
        };
        let count = self.bodies.len();
        let pairs = (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]));
        pairs.filter(move |&pair| !is_ignored(pair))
    }

    /// Is a contact at the start let go, of some pair?
    pub(crate) fn lets_go(&self) -> bool {
        self.start == Start::Leave || self.pairs.values().any(|pair| pair.start == Some(Start::Leave))
    }

    /// Has it a tolerance of its own?
    pub(crate) const fn states_tolerance(&self) -> bool {
        self.tolerance.is_some()
    }

    /// The options of its queries.
    pub(crate) const fn options(&self, options: QueryOptions) -> QueryOptions {
        let mut options = options.with_min_separation(self.min_separation).with_start(self.start);
        if let Some(tolerance) = self.tolerance {
            options = options.with_tolerance(tolerance);
        }
        options
    }

    /// The options of the queries of a pair.
    pub(crate) fn pair_options(&self, pair: [usize; 2], options: QueryOptions) -> QueryOptions {
        let mut options = self.options(options);
        if let Some(own) = self.pairs.get(&ascending(pair)) {
            options.min_separation = own.min_separation.unwrap_or(options.min_separation);
            options.start = own.start.unwrap_or(options.start);
        }
        options
    }

    /// The world of the scene; its bodies have the numbers that they have in the file.
    pub(crate) fn world(&self, options: QueryOptions) -> World {
        let mut world = World::new(self.options(options));
        let mut groups: BTreeMap<&str, Group> = BTreeMap::new();
        let mut ids: Vec<BodyId> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let mut moving = Body::new(body.tree.clone(), body.motion.clone()).with_solid(body.solid);
            moving = moving.with_radius(body.radius);
            if let Some(name) = &body.group {
                let next = Group(groups.len() as u32);
                moving = moving.with_group(*groups.entry(name).or_insert(next));
            }
            ids.push(world.add(moving));
        }
        for ([a, b], own) in &self.pairs {
            world.set_min_separation(ids[*a], ids[*b], own.min_separation);
            world.set_start(ids[*a], ids[*b], own.start);
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

/// The smaller number first.
fn ascending([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
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
