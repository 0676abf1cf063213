//! The picture of a simulation.

use super::{Flight, Holds, Mark, Picture, Span, Up, push_thinned};
use crate::failure::{Failure, json_fault, parse_json};
use crate::load::read;
use crate::mesh_library::MeshLibrary;
use crate::output::short;
use d2m::bvh::TriMesh;
use d2m::motion::ConstantTwist;
use d2m::motion::serde_object::{Object, all};
use glam::{DQuat, DVec3};
use serde::Deserialize;
use serde_json::Value;
use std::collections::HashMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// How long an impulse is marked: as long as a picture of a film, in seconds.
const MARKED: f64 = 1.0 / 24.0;
/// Impulses that are marked: the largest ones. More would fill the page and hide each other.
const MOST_MARKS: usize = 4000;
/// The longest run that is read: a small compressed file cannot fill the memory.
const MOST_BYTES: u64 = 4 << 30;

/// The first line of a run.
#[derive(Deserialize)]
struct Header {
    scene: String,
    #[serde(deserialize_with = "all")]
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
    #[serde(default, deserialize_with = "all")]
    bodies: Vec<State>,
    #[serde(default)]
    changed: Vec<(usize, Object<State>)>,
    #[serde(default, deserialize_with = "all")]
    contacts: Vec<Impulse>,
    #[serde(default)]
    skipped: f64,
    #[serde(default)]
    thinned: bool,
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
    #[serde(rename = "impulse")]
    momentum: [f64; 3],
}

/// The mesh of a body, as its scene states it.
#[derive(Deserialize)]
struct BodyMesh {
    name: String,
    mesh: String,
    scale: Option<Value>,
    #[serde(default)]
    radius: f64,
}

#[derive(Deserialize)]
struct SceneFile {
    #[serde(deserialize_with = "all")]
    bodies: Vec<BodyMesh>,
    #[serde(default)]
    simulation: SimulationFile,
}

#[derive(Deserialize, Default)]
struct SimulationFile {
    gravity: Option<[f64; 3]>,
}

/// What the lines of a run say.
struct Run {
    header: Header,
    window: [f64; 2],
    flights: Vec<Vec<Flight>>,
    /// Each with the size of its impulse.
    marks: Vec<(f64, Mark)>,
    skipped: f64,
    is_thinned: bool,
}

/// Reads a run, and the meshes of its scene.
pub(crate) fn picture_of_run(path: &Path) -> Result<Picture, Failure> {
    let Run { header, window, flights, mut marks, skipped, is_thinned } = Run::read(path)?;
    let [start, end] = window.map(short);
    let mut picture =
        Picture::new(format!("{} bodies from t = {start} to {end}", header.bodies.len()), window);
    picture.is_real_time = true;
    picture.add_fact("scene", &header.scene);
    picture.add_fact("impulses", marks.len().to_string());
    picture.add_fact("given up", if skipped > 0.0 { format!("{skipped} s") } else { "no time".to_owned() });
    let scene_file = scene_path(path, &header.scene);
    let stated: SceneFile = parse_json(&scene_file.display().to_string(), &read(&scene_file)?)?;
    picture.up = up_against(stated.simulation.gravity);
    let library = MeshLibrary::new(&scene_file);
    let mut meshes: HashMap<String, (usize, f64)> = HashMap::new();
    for (body, flights) in header.bodies.iter().zip(flights) {
        let place =
            |reason: String| Failure::at(format!("{}, body {:?}", scene_file.display(), body.name), reason);
        let BodyMesh { name, mesh, scale, radius } = stated
            .bodies
            .iter()
            .find(|stated| stated.name == body.name)
            .ok_or_else(|| place("the run has this body, the scene has not".to_owned()))?;
        let key = format!("{mesh} {scale:?} {radius} {:?}", body.center);
        let (number, reach) = if let Some(&known) = meshes.get(&key) {
            known
        } else {
            let scale =
                d2m_io::parse_scale(scale.as_ref()).map_err(|reason| place(format!("scale: {reason}")))?;
            let tree = library.mesh(mesh, scale)?;
            let reach = reach_from(tree.mesh(), body.center) + radius;
            let new = (picture.add_mesh(name, tree.mesh(), *radius), reach);
            meshes.insert(key, new);
            new
        };
        let mut shown = Vec::new();
        for flight in flights {
            push_thinned(&mut shown, flight, reach);
        }
        picture.add_body(&body.name, number, shown);
    }
    picture.notes.push("bodies are drawn within 1e-4 of their size of where they are".to_owned());
    if marks.len() > MOST_MARKS {
        marks.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        marks.truncate(MOST_MARKS);
        picture.notes.push(format!("marked are the {MOST_MARKS} largest impulses"));
    }
    picture.marks = marks.into_iter().map(|(_, mark)| mark).collect();
    picture.marks.sort_by(|a, b| a.from.total_cmp(&b.from));
    let (holds, text) = if is_thinned {
        (Holds::Unknown, "this run was thinned for viewing: it proves nothing between its lines")
    } else {
        (Holds::Clear, "the simulation proved all bodies apart")
    };
    picture.spans.push(Span::new(window[0], window[1], holds, text));
    Ok(picture)
}

impl Run {
    fn read(path: &Path) -> Result<Self, Failure> {
        let bytes = unpacked(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let place = |line: usize| format!("{}, line {}", path.display(), line + 1);
        let mut lines = text
            .trim_start_matches('\u{feff}')
            .lines()
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty());
        let (line, first) = lines.next().unwrap_or_default();
        let Object(header) = serde_json::from_str::<Object<Header>>(first)
            .map_err(|error| Failure::at(place(line), json_fault(&error, first)))?;
        let flights = header.bodies.iter().map(|_| Vec::new()).collect();
        let window = [f64::NEG_INFINITY; 2];
        let mut run = Self { header, window, flights, marks: Vec::new(), skipped: 0.0, is_thinned: false };
        let mut is_first = true;
        for (line, text) in lines {
            let fault = |reason: String| Failure::at(place(line), reason);
            let Object(segment) = serde_json::from_str::<Object<Segment>>(text)
                .map_err(|error| fault(json_fault(&error, text)))?;
            let start = segment.t0;
            run.add(segment).map_err(fault)?;
            if core::mem::take(&mut is_first) {
                run.window[0] = start;
            }
        }
        if is_first {
            return Err(Failure::at(path.display(), "the run has no segments"));
        }
        if let Some(index) = run.flights.iter().position(Vec::is_empty) {
            let reason = format!("body {:?} is in no segment", run.header.bodies[index].name);
            return Err(Failure::at(path.display(), reason));
        }
        Ok(run)
    }

    fn add(&mut self, segment: Segment) -> Result<(), String> {
        let (start, end) = (segment.t0, segment.t1);
        if start > end {
            return Err(format!("the segment from {start:?} to {end:?} is reversed"));
        }
        let [_, before] = self.window;
        if start < before {
            return Err(format!("t0 {start:?} is before {before:?}, the end of the segment before"));
        }
        self.window[1] = end;
        self.skipped += segment.skipped;
        self.is_thinned |= segment.thinned;
        let all = segment.bodies.into_iter().enumerate();
        let changed = segment.changed.into_iter().map(|(index, Object(state))| (index, state));
        for (index, state) in all.chain(changed) {
            let (Some(body), Some(flights)) = (self.header.bodies.get(index), self.flights.get_mut(index))
            else {
                let count = self.header.bodies.len();
                return Err(format!("body {index} is out of range, the run has {count} bodies"));
            };
            let motion = state.motion(DVec3::from_array(body.center), start);
            let motion = motion.map_err(|error| format!("body {:?}: {error}", body.name))?;
            flights.push(Flight { start, end, motion });
        }
        for last in self.flights.iter_mut().filter_map(|flights| flights.last_mut()) {
            last.end = end;
        }
        for contact in segment.contacts {
            let [point, normal, momentum] =
                [contact.point, contact.normal, contact.momentum].map(DVec3::from_array);
            let mark = Mark { from: end, until: end + MARKED, points: [point; 2], normal, triangles: None };
            self.marks.push((momentum.length(), mark));
        }
        Ok(())
    }
}

/// The bytes of a run, unpacked where its name says that it is packed.
fn unpacked(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = read(path)?;
    if path.extension().is_none_or(|extension| extension != "gz") {
        return Ok(bytes);
    }
    let mut text = Vec::new();
    let mut decoder = flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(MOST_BYTES + 1);
    decoder.read_to_end(&mut text).map_err(|error| Failure::at(path.display(), error))?;
    if text.len() as u64 > MOST_BYTES {
        return Err(Failure::at(path.display(), format!("it unpacks to more than {MOST_BYTES} bytes")));
    }
    Ok(text)
}

/// How far a mesh reaches from a point.
fn reach_from(mesh: &TriMesh, center: [f64; 3]) -> f64 {
    let center = DVec3::from_array(center);
    mesh.vertices().iter().map(|p| (*p - center).length()).fold(0.0, f64::max)
}

/// Up is where things do not fall to; y if they do not fall.
fn up_against(gravity: Option<[f64; 3]>) -> Up {
    match gravity {
        Some([x, y, z]) if z.abs() > x.abs() && z.abs() > y.abs() => Up::Z,
        _ => Up::Y,
    }
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
