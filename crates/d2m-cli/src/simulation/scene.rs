//! Scene files of simulations.

use super::fields::{Fields, short};
use super::joints::joints;
use crate::failure::{Failure, parse_json};
use crate::load::{named, read};
use crate::mesh_library::MeshLibrary;
use crate::orientation::warn_of_json;
use crate::scene::{Ignored, Names, SceneBody, check_names};
use crate::unlike_sizes::warn_of_scene_sizes;
use d2m::bvh::Window;
use d2m::motion::AnyMotion;
use d2m_dynamics::{
    Body, BodyId, Damping, Kind, Mass, MassProperties, Motion, Simulation, SimulationOptions,
};
use d2m_io::{SceneEntry, ScenePair, UniqueKeys};
use glam::{DMat3, DVec3};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// A scene, ready to run.
#[derive(Debug)]
pub(crate) struct SimulatedScene {
    pub(crate) simulation: Simulation,
    pub(crate) names: Vec<String>,
    pub(crate) ids: Vec<BodyId>,
    pub(crate) end: f64,
    /// On so many threads, if the file says so.
    pub(crate) threads: Option<u16>,
}

const SCENE_KEYS: &[&str] =
    &["bodies", "ignore", "pairs", "joints", "simulation", "window", "min_separation", "tolerance", "start"];
/// Of a body, those that no other scene has.
const DYNAMIC_KEYS: &[&str] = &[
    "kind",
    "pose",
    "velocity",
    "density",
    "mass",
    "center",
    "inertia",
    "restitution",
    "friction",
    "damping",
];
const BODY_KEYS: &[&str] = &[
    "name",
    "mesh",
    "scale",
    "kind",
    "pose",
    "velocity",
    "motion",
    "group",
    "solid",
    "density",
    "mass",
    "center",
    "inertia",
    "restitution",
    "friction",
    "radius",
    "damping",
];

/// Reads a scene and the meshes it names, relative to its folder.
pub(crate) fn read_scene(path: &Path) -> Result<SimulatedScene, Failure> {
    let bytes = read(path)?;
    let UniqueKeys(value) = parse_json(&named(path), &bytes)?;
    let scene = Fields::new(named(path), &value, SCENE_KEYS)?;
    warn_of_json(scene.place(), &value);
    // They say nothing of a simulation, but what they say has to be something.
    scene.terms()?;
    let Settings { options, end, threads } = settings(&scene)?;
    let mut simulation = Simulation::new(options).map_err(|error| Failure::at(named(path), error))?;
    scene.required("bodies")?;
    let list = scene.list("bodies")?.map_or(&[][..], Vec::as_slice);
    if list.is_empty() {
        return Err(scene.fault("bodies", "the list is empty"));
    }
    let window = Window::try_new(0.0, end).map_err(|error| Failure::at(named(path), error))?;
    let mut library = MeshLibrary::new(path);
    let (mut bodies, mut ids) = (Vec::with_capacity(list.len()), Vec::with_capacity(list.len()));
    for (index, value) in list.iter().enumerate() {
        let place = format!("{}, {}", named(path), SceneEntry::place(index, value));
        let fields = Fields::new(place, value, BODY_KEYS)?;
        let body = SceneBody::read(fields.without(DYNAMIC_KEYS), fields.place(), window, &mut library)?;
        let described = describe(&fields, &body)?;
        ids.push(simulation.add(&described).map_err(|error| Failure::at(fields.place(), error))?);
        bodies.push(body);
    }
    check_names(scene.place(), &bodies)?;
    warn_of_scene_sizes(scene.place(), bodies.iter().map(SceneBody::named_size));
    ignore(&scene, &bodies, &ids, &mut simulation)?;
    let names: Vec<String> = bodies.into_iter().map(|body| body.name).collect();
    pairs(&scene, &names, &ids, &mut simulation)?;
    joints(&scene, &names, &ids, &mut simulation)?;
    Ok(SimulatedScene { simulation, names, ids, end, threads })
}

/// Threads at most, as for `--threads`.
const MOST_THREADS: u16 = 1024;

/// Does time tell such steps apart, all the way to the end? Multiples of a step that is longer than the way from the end to the next double
/// are never rounded to the same one, since doubles before the end are no further apart. They are fewer than 2⁵³.
pub(crate) fn are_told_apart(step: f64, end: f64) -> bool {
    step > end.next_up() - end
}

/// What the key `simulation` says.
struct Settings {
    options: SimulationOptions,
    end: f64,
    threads: Option<u16>,
}

fn settings(scene: &Fields<'_>) -> Result<Settings, Failure> {
    let mut options = SimulationOptions::default();
    let default = Value::Object(serde_json::Map::new());
    let value = scene.get("simulation").unwrap_or(&default);
    let fields = Fields::new(
        format!("{}, simulation", scene.place()),
        value,
        &["gravity", "step", "end", "gap", "max_events", "sleep", "threads"],
    )?;
    if let Some(gravity) = fields.vector("gravity")? {
        options = options.with_gravity(gravity);
    }
    let positive = |key: &str, default: f64| -> Result<f64, Failure> {
        let value = fields.number(key)?.unwrap_or(default);
        if value > 0.0 { Ok(value) } else { Err(fields.fault(key, format!("{value:?} should be positive"))) }
    };
    options = options.with_step(positive("step", options.step)?).with_gap(positive("gap", options.gap)?);
    if let Some(value) = fields.get("max_events") {
        let count = value.as_u64().and_then(|count| u32::try_from(count).ok());
        let fault =
            || fields.fault("max_events", format!("{} should be a whole number below 2^32", short(value)));
        options = options.with_max_events(count.ok_or_else(fault)?);
    }
    if let Some(sleeps) = fields.flag("sleep")? {
        options = options.with_sleeping(sleeps);
    }
    let threads = match fields.get("threads") {
        None => None,
        Some(value) => {
            let count = value.as_u64().and_then(|count| u16::try_from(count).ok());
            let count = count.filter(|count| (1..=MOST_THREADS).contains(count));
            let fault = || {
                let wanted = format!("a whole number from 1 to {MOST_THREADS}");
                fields.fault("threads", format!("{} should be {wanted}", short(value)))
            };
            Some(count.ok_or_else(fault)?)
        }
    };
    let end = positive("end", 5.0)?;
    if !are_told_apart(options.step, end) {
        let (step, next) = (options.step, end.next_up() - end);
        let reason = format!("{step:?} is too short: doubles at the end {end:?} are {next:?} apart");
        return Err(fields.fault("step", reason));
    }
    Ok(Settings { options, end, threads })
}

/// The pairs that may pass through each other.
fn ignore(
    scene: &Fields<'_>,
    bodies: &[SceneBody],
    ids: &[BodyId],
    simulation: &mut Simulation,
) -> Result<(), Failure> {
    let Some(list) = scene.list("ignore")? else { return Ok(()) };
    let names = Names::new(bodies);
    let members = |group: &str| -> Vec<BodyId> {
        let is_member = |k: &usize| bodies[*k].group.as_deref() == Some(group);
        (0..bodies.len()).filter(is_member).map(|k| ids[k]).collect()
    };
    for (index, value) in list.iter().enumerate() {
        let (first, second) = match names.ignored(&format!("{}, ignore {index}", scene.place()), value)? {
            Ignored::Pair(a, b) => (vec![ids[a]], vec![ids[b]]),
            Ignored::Groups(a, b) => (members(&a), members(&b)),
            Ignored::BodyAndGroup(a, group) => (vec![ids[a]], members(&group)),
        };
        for &a in &first {
            for &b in second.iter().filter(|b| **b != a) {
                simulation.ignore(a, b);
            }
        }
    }
    Ok(())
}

fn pairs(
    scene: &Fields<'_>,
    names: &[String],
    ids: &[BodyId],
    simulation: &mut Simulation,
) -> Result<(), Failure> {
    let Some(list) = scene.list("pairs")? else { return Ok(()) };
    let known: BTreeSet<&str> = names.iter().map(String::as_str).collect();
    let list = list.iter().map(|value| UniqueKeys(value.clone())).collect();
    let pairs = ScenePair::parse_all(list, &known).map_err(|error| Failure::at(scene.place(), error))?;
    for (index, pair) in pairs.iter().enumerate() {
        let number = |name: &String| names.iter().position(|other| other == name);
        // The names are those of bodies.
        let (Some(a), Some(b)) = (number(&pair.a), number(&pair.b)) else { continue };
        let usual = simulation.pair(ids[a], ids[b]);
        let restitution = pair.restitution.unwrap_or(usual.restitution);
        let friction = pair.friction.unwrap_or(usual.friction);
        let place = || format!("{}, pairs, entry {index}", scene.place());
        let set = simulation.set_pair(ids[a], ids[b], restitution, friction);
        set.map_err(|error| Failure::at(place(), error))?;
    }
    Ok(())
}

/// What moves the body, and how.
fn describe(fields: &Fields<'_>, read: &SceneBody) -> Result<Body, Failure> {
    let mut body =
        Body::new(&read.name, Arc::clone(&read.tree)).with_solid(read.solid).with_radius(read.radius);
    if let Some(damping) = fields.object("damping", &["linear", "angular"])? {
        let rate = |key: &str| match damping.number(key)?.unwrap_or(0.0) {
            rate if rate >= 0.0 => Ok(rate),
            rate => Err(damping.fault(key, format!("{rate:?} is negative"))),
        };
        body.damping = Damping { linear: rate("linear")?, angular: rate("angular")? };
    }
    body.kind = kind(fields, &read.motion)?;
    if let Some(pose) = fields.object("pose", &["x", "q"])? {
        body.position = pose.vector("x")?.unwrap_or_default();
        body.orientation = pose.quaternion("q")?.unwrap_or_default();
    }
    if let Some(velocity) = fields.object("velocity", &["v", "w"])? {
        body.linear_velocity = velocity.vector("v")?.unwrap_or_default();
        body.angular_velocity = velocity.vector("w")?.unwrap_or_default();
    }
    body.restitution = fields.number("restitution")?.unwrap_or(0.0);
    body.friction = fields.number("friction")?.unwrap_or(0.0);
    mass(fields, &mut body)?;
    Ok(body)
}

fn kind(fields: &Fields<'_>, motion: &AnyMotion) -> Result<Kind, Failure> {
    let kind = fields.text("kind")?.unwrap_or("dynamic");
    match (kind, fields.get("motion").is_some_and(|motion| !motion.is_null())) {
        ("dynamic", false) => Ok(Kind::Dynamic),
        // A kinematic body without a motion rests where its pose is.
        ("static" | "kinematic", false) => Ok(Kind::Static),
        ("kinematic", true) => {
            // The motion says where the body is and how fast it moves: one of two answers would be ignored.
            if let Some(key) = ["pose", "velocity"].into_iter().find(|key| fields.get(key).is_some()) {
                let reason = "a kinematic body with a motion has its pose and velocity from there: give one of the two";
                return Err(fields.fault(&format!("motion, {key}"), reason));
            }
            let motion: Motion = Arc::new(motion.clone());
            Ok(Kind::Kinematic(motion))
        }
        ("dynamic" | "static", true) => {
            Err(fields.fault("motion", format!("a {kind} body follows none; is it kinematic?")))
        }
        _ => Err(fields.fault("kind", format!("{kind:?} is not dynamic, kinematic or static"))),
    }
}

/// What is given counts; what is not follows from the closed mesh.
fn mass(fields: &Fields<'_>, body: &mut Body) -> Result<(), Failure> {
    let (density, mass) = (fields.number("density")?, fields.number("mass")?);
    let (center, inertia): (Option<DVec3>, Option<DMat3>) =
        (fields.vector("center")?, fields.matrix("inertia")?);
    if density.is_some() && mass.is_some() {
        return Err(fields.fault("density", "a body has a density or a mass, not both"));
    }
    if !matches!(body.kind, Kind::Dynamic) {
        return Ok(());
    }
    let mesh = body.tree.mesh();
    let fault = |error| Failure::at(fields.place(), error);
    body.mass = match (mass, center, inertia) {
        (Some(mass), Some(center), Some(inertia)) => {
            Mass::Given(MassProperties::try_new(mass, center, inertia).map_err(fault)?)
        }
        (mass, None, None) => mass.map_or(Mass::Density(density.unwrap_or(1000.0)), Mass::Total),
        _ => {
            let whole = match mass {
                Some(mass) => MassProperties::try_from_mass(mesh, mass),
                None => MassProperties::try_from_density(mesh, density.unwrap_or(1000.0)),
            };
            let whole = whole.map_err(fault)?;
            let (center, inertia) = (center.unwrap_or(whole.center), inertia.unwrap_or(whole.inertia));
            Mass::Given(MassProperties::try_new(whole.mass, center, inertia).map_err(fault)?)
        }
    };
    Ok(())
}
