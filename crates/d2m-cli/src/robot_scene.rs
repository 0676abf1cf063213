//! Scene files around a robot: obstacles, what the robot holds, and ignored pairs.

use crate::failure::{Failure, parse_json};
use crate::load::{named, read};
use crate::mesh_library::MeshLibrary;
use crate::scene::SceneBody;
use crate::simulation::{Fields, short};
use d2m::bvh::Window;
use d2m_io::{SceneEntry, ScenePair, SceneTerms, UniqueKeys};
use d2m_robot::{Attached, Obstacle, RobotScene};
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

const SCENE_KEYS: &[&str] = &["window", "bodies", "ignore", "min_separation", "tolerance", "start", "pairs"];
const BODY_KEYS: &[&str] = &["name", "mesh", "scale", "motion", "group", "solid", "radius", "pose", "attach"];
/// Of a body, those that other scenes do not have.
const ROBOT_KEYS: &[&str] = &["pose", "attach"];

/// A scene file that was read, but for its meshes.
pub(crate) struct RobotSceneFile<'a> {
    path: &'a Path,
    value: Value,
    pub(crate) terms: SceneTerms,
}

/// Where a body is, in the world or in the frame of a link.
#[derive(Clone, Copy)]
struct Frame {
    position: DVec3,
    orientation: DQuat,
}

impl<'a> RobotSceneFile<'a> {
    /// Reads the file.
    pub(crate) fn read(path: &'a Path) -> Result<Self, Failure> {
        let place = named(path);
        let UniqueKeys(value) = parse_json(&place, &read(path)?)?;
        let fields = Fields::new(place, &value, SCENE_KEYS)?;
        let terms = fields.terms()?;
        Ok(Self { path, value, terms })
    }

    /// Adds its bodies to the robot's scene. The motions of obstacles have to cover the path, which lasts for this window.
    pub(crate) fn add_to(&self, scene: &mut RobotScene, window: Window) -> Result<(), Failure> {
        let fields = Fields::new(named(self.path), &self.value, SCENE_KEYS)?;
        let mut groups: Vec<[String; 2]> = Vec::new();
        let mut library = MeshLibrary::new(self.path);
        for (index, value) in Self::list(&fields, "bodies")?.iter().enumerate() {
            let place = format!("{}, {}", named(self.path), SceneEntry::place(index, value));
            let body = Fields::new(place, value, BODY_KEYS)?;
            let name = add_body(scene, &body, window, &mut library)?;
            if let Some(group) = body.text("group")? {
                groups.push([group.to_owned(), name]);
            }
        }
        for (index, value) in Self::list(&fields, "ignore")?.iter().enumerate() {
            let place = format!("{}, ignore {index}", named(self.path));
            let words = value.as_array().map(|list| list.iter().map(Value::as_str).collect::<Vec<_>>());
            let Some([Some(a), Some(b)]) = words.as_deref() else {
                return Err(Failure::at(place, format!("{} is not a pair of names", short(value))));
            };
            for a in members(scene, &groups, a, &place)? {
                for b in members(scene, &groups, b, &place)? {
                    scene.ignore(&a, &b);
                }
            }
        }
        self.set_pairs(&fields, scene)
    }

    /// What single pairs have of their own.
    fn set_pairs(&self, fields: &Fields<'_>, scene: &mut RobotScene) -> Result<(), Failure> {
        let entries = Self::list(fields, "pairs")?.iter().cloned().map(UniqueKeys).collect();
        let in_file = |error: d2m_io::IoError| Failure::Input(error.in_file(named(self.path)).to_string());
        let bodies = scene.names().map(str::to_owned).collect::<Vec<_>>();
        let names = bodies.iter().map(String::as_str).collect();
        for ScenePair { a, b, start, min_separation, .. } in
            ScenePair::parse_all(entries, &names).map_err(in_file)?
        {
            if let Some(start) = start {
                scene.set_start([&a, &b], start);
            }
            if let Some(distance) = min_separation {
                scene.set_min_separation([&a, &b], distance).map_err(|error| fields.fault("pairs", error))?;
            }
        }
        Ok(())
    }

    fn list<'v>(fields: &Fields<'v>, key: &str) -> Result<&'v [Value], Failure> {
        match fields.get(key) {
            None => Ok(&[]),
            Some(Value::Array(list)) => Ok(list),
            Some(other) => Err(fields.fault(key, format!("{} should be a list", short(other)))),
        }
    }
}

/// The names that a name stands for: a link's, a body's, or those of a group.
fn members(
    scene: &RobotScene,
    groups: &[[String; 2]],
    name: &str,
    place: &str,
) -> Result<Vec<String>, Failure> {
    if scene.has_name(name) {
        return Ok(vec![name.to_owned()]);
    }
    let members: Vec<String> =
        groups.iter().filter(|[group, _]| group == name).map(|[_, member]| member.clone()).collect();
    if members.is_empty() {
        let reason = format!("{name:?} is the name of no link, no body and no group");
        return Err(Failure::at(place, reason));
    }
    Ok(members)
}

/// Adds one body; its name.
fn add_body(
    scene: &mut RobotScene,
    fields: &Fields<'_>,
    window: Window,
    library: &mut MeshLibrary,
) -> Result<String, Failure> {
    let frame = frame(fields)?;
    let link = fields.text("attach")?;
    let moves = fields.get("motion").is_some_and(|motion| !motion.is_null());
    if let Some(other) = [("attach", link.is_some()), ("pose", frame.is_some())]
        .into_iter()
        .find_map(|(key, given)| (given && moves).then_some(key))
    {
        return Err(fields.fault("motion", format!("it does not go together with {other}")));
    }
    let body = SceneBody::read(fields.without(ROBOT_KEYS), fields.place(), window, library)?;
    let at = frame.unwrap_or(Frame { position: DVec3::ZERO, orientation: DQuat::IDENTITY });
    let fault = |error: d2m_robot::RobotError| Failure::at(fields.place(), error);
    let (name, tree, radius) = (body.name.clone(), Arc::clone(&body.tree), body.radius);
    if let Some(link) = link {
        let attached = Attached::new(&name, link, tree, at.position, at.orientation).map_err(fault)?;
        scene.attach(attached.with_solid(body.solid).with_radius(radius)).map_err(fault)?;
        return Ok(name);
    }
    let obstacle = if moves {
        Obstacle::moving(&name, tree, body.motion)
    } else {
        Obstacle::at_rest(&name, tree, at.position, at.orientation).map_err(fault)?
    };
    scene.add_obstacle(obstacle.with_solid(body.solid).with_radius(radius)).map_err(fault)?;
    Ok(name)
}

fn frame(fields: &Fields<'_>) -> Result<Option<Frame>, Failure> {
    let Some(pose) = fields.get("pose") else { return Ok(None) };
    let pose = Fields::new(format!("{}, pose", fields.place()), pose, &["x", "q"])?;
    let position = pose.vector("x")?.unwrap_or_default();
    let orientation = pose.quaternion("q")?.unwrap_or_default();
    Ok(Some(Frame { position, orientation }))
}
