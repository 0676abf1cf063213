//! The picture of a simulation.

use super::{Flight, Mark, Picture};
use crate::failure::{Failure, json_fault, parse_json};
use crate::load::read;
use crate::mesh_library::{MeshLibrary, read_scale};
use d2m::motion::ConstantTwist;
use glam::{DQuat, DVec3};
use serde::Deserialize;
use serde_json::Value;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// How long an impulse is marked: as long as a picture of a film, in seconds.
const MARKED: f64 = 1.0 / 24.0;

/// The first line of a run.
#[derive(Deserialize)]
struct Header {
    scene: String,
    bodies: Vec<HeaderBody>,
}

#[derive(Deserialize)]
struct HeaderBody {
    name: String,
    /// In the axes of the mesh.
    center: [f64; 3],
}

/// A line after the first one.
#[derive(Deserialize)]
struct Segment {
    t0: f64,
    t1: f64,
    #[serde(default)]
    bodies: Vec<State>,
    #[serde(default)]
    changed: Vec<(usize, State)>,
    #[serde(default)]
    contacts: Vec<Impulse>,
}

#[derive(Deserialize)]
struct State {
    x: [f64; 3],
    q: [f64; 4],
    v: [f64; 3],
    w: [f64; 3],
}

#[derive(Deserialize)]
struct Impulse {
    point: [f64; 3],
    normal: [f64; 3],
}

/// The mesh of a body, as its scene states it.
#[derive(Deserialize)]
struct BodyMesh {
    name: String,
    mesh: String,
    scale: Option<Value>,
}

#[derive(Deserialize)]
struct SceneMeshes {
    bodies: Vec<BodyMesh>,
}

/// Reads a run, and the meshes of its scene.
pub(crate) fn picture_of_run(path: &Path) -> Result<Picture, Failure> {
    let bytes = read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let place = |line: usize| format!("{}, line {}", path.display(), line + 1);
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (line, first) = lines.next().unwrap_or_default();
    let header: Header =
        serde_json::from_str(first).map_err(|error| Failure::at(place(line), json_fault(&error, first)))?;
    let mut flights: Vec<Vec<Flight>> = header.bodies.iter().map(|_| Vec::new()).collect();
    let (mut marks, mut window) = (Vec::new(), None);
    for (line, text) in lines {
        let fault = |reason: String| Failure::at(place(line), reason);
        let segment: Segment = serde_json::from_str(text).map_err(|error| fault(json_fault(&error, text)))?;
        let (start, end) = (segment.t0, segment.t1);
        if start > end {
            return Err(fault(format!("the segment from {start:?} to {end:?} is reversed")));
        }
        window = Some([window.map_or(start, |[first, _]: [f64; 2]| first), end]);
        let all = segment.bodies.into_iter().enumerate();
        for (index, state) in all.chain(segment.changed) {
            let (Some(body), Some(flights)) = (header.bodies.get(index), flights.get_mut(index)) else {
                let count = header.bodies.len();
                return Err(fault(format!("body {index} is out of range, the run has {count} bodies")));
            };
            let motion = state.motion(DVec3::from_array(body.center), start);
            let motion = motion.map_err(|error| fault(format!("body {:?}: {error}", body.name)))?;
            flights.push(Flight { start, end, motion });
        }
        for last in flights.iter_mut().filter_map(|flights| flights.last_mut()) {
            last.end = end;
        }
        for contact in segment.contacts {
            let [point, normal] = [contact.point, contact.normal].map(DVec3::from_array);
            marks.push(Mark { from: end, until: end + MARKED, point, normal });
        }
    }
    let Some(window) = window else { return Err(Failure::at(path.display(), "the run has no segments")) };
    if let Some(index) = flights.iter().position(Vec::is_empty) {
        let reason = format!("body {:?} is in no segment", header.bodies[index].name);
        return Err(Failure::at(path.display(), reason));
    }
    let headline = format!("{} bodies from t = {} to {}", header.bodies.len(), window[0], window[1]);
    let facts = vec![header.scene.clone(), format!("{} impulses", marks.len())];
    let mut picture = Picture::new(headline, facts, window, true);
    let scene = scene_path(path, &header.scene);
    let bytes = read(&scene)?;
    let stated: SceneMeshes = parse_json(&scene.display().to_string(), &bytes)?;
    let scene_place = |name: &str| format!("{}, body {name:?}", scene.display());
    let library = MeshLibrary::new(&scene);
    let mut meshes = HashMap::new();
    for (body, flights) in header.bodies.iter().zip(&flights) {
        let BodyMesh { name, mesh, scale } =
            stated.bodies.iter().find(|stated| stated.name == body.name).ok_or_else(|| {
                Failure::at(scene.display(), format!("body {:?} of the run is not in it", body.name))
            })?;
        let key = format!("{mesh} {scale:?}");
        let number = if let Some(&number) = meshes.get(&key) {
            number
        } else {
            let scale = read_scale(scale.as_ref())
                .map_err(|reason| Failure::at(scene_place(name), format!("scale: {reason}")))?;
            let number = picture.add_mesh(library.mesh(mesh, scale)?.mesh());
            meshes.insert(key, number);
            number
        };
        picture.add_body(&body.name, number, flights);
    }
    for mark in &marks {
        picture.add_mark(mark);
    }
    Ok(picture)
}

/// The scene as it was named when it ran, or beside the run.
fn scene_path(run: &Path, scene: &str) -> PathBuf {
    let named = PathBuf::from(scene);
    let beside = run.with_file_name(named.file_name().unwrap_or_default());
    if !named.exists() && beside.exists() { beside } else { named }
}

impl State {
    fn motion(&self, center: DVec3, time: f64) -> Result<ConstantTwist, d2m::motion::MotionError> {
        let [w, x, y, z] = self.q;
        let [position, v, turn] = [self.x, self.v, self.w].map(DVec3::from_array);
        ConstantTwist::try_new(position, DQuat::from_xyzw(x, y, z, w), v, turn)?
            .try_with_at(center)?
            .try_with_reference_time(time)
    }
}
