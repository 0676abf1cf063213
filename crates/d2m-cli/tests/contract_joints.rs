//! `"joints"` of simulations: they hold in every segment of the run file, and what cannot be a joint is refused by its place.

mod shell;

use serde_json::{Value, json};
use shell::{Folder, d2m, refused, stderr};
use std::fs;

const BAR: &str = "shape:box?x=0.5&y=0.05&z=0.05";

fn run(folder: &Folder, name: &str, scene: &Value) -> Vec<Value> {
    let scene = folder.file(&format!("{name}.json"), &scene.to_string());
    let out = folder.path(&format!("{name}.jsonl"));
    let run = d2m(&["simulate", &scene, "--out", &out]);
    assert_eq!(run.status.code(), Some(0), "{name}: {}", stderr(&run));
    fs::read_to_string(out).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The states of all bodies at the start of each segment.
fn states(run: &[Value]) -> Vec<Vec<Value>> {
    let mut now: Vec<Value> = Vec::new();
    let mut all = Vec::new();
    for segment in &run[1..] {
        if let Some(bodies) = segment["bodies"].as_array() {
            now.clone_from(bodies);
        }
        for entry in segment["changed"].as_array().into_iter().flatten() {
            now[entry[0].as_u64().unwrap() as usize] = entry[1].clone();
        }
        // Those that fly on have their places of an earlier segment: only those of this one count.
        let is_new = |k: &usize| segment["bodies"].is_array() || changed(segment, *k);
        all.push((0..now.len()).map(|k| if is_new(&k) { now[k].clone() } else { Value::Null }).collect());
    }
    all
}

fn changed(segment: &Value, body: usize) -> bool {
    segment["changed"].as_array().into_iter().flatten().any(|entry| entry[0] == body)
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    core::array::from_fn(|k| value[k].as_f64().unwrap_or_else(|| panic!("{value}")))
}

/// A point of a body in the world; its center of mass is the origin of its mesh.
fn point(state: &Value, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [w, a, b, c] = numbers::<4>(&state["q"]);
    let place = numbers::<3>(&state["x"]);
    // r + 2 w (v × r) + 2 v × (v × r)
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let first = cross([a, b, c], [x, y, z]);
    let second = cross([a, b, c], first);
    core::array::from_fn(|k| place[k] + [x, y, z][k] + 2.0 * (w * first[k] + second[k]))
}

fn apart(p: [f64; 3], q: [f64; 3]) -> f64 {
    (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>().sqrt()
}

/// A double pendulum, a slide that a motor drives to its limit, and a weight on a spring.
fn scene() -> Value {
    json!({"bodies": [
        {"name": "upper", "mesh": BAR, "pose": {"x": [0.5, 0, 0]}},
        {"name": "lower", "mesh": BAR, "pose": {"x": [1.5, 0, 0]}},
        {"name": "cart", "mesh": BAR, "pose": {"x": [0, 0, 3]}},
        {"name": "weight", "mesh": BAR, "pose": {"x": [0, 0, 6]}}],
        "joints": [
            {"name": "pin", "kind": "revolute", "a": "upper", "b": null, "point": [0, 0, 0], "axis": [0, 0, 2]},
            {"name": "elbow", "kind": "spherical", "a": "upper", "b": "lower", "point": [1, 0, 0]},
            {"name": "rail", "kind": "prismatic", "a": "cart", "point": [0, 0, 3], "axis": [-1, 0, 0], "limits": [-1, 0.5],
                "motor": {"velocity": 1, "max": 100}, "friction": 1},
            {"name": "spring", "kind": "prismatic", "a": "weight", "b": null, "point": [0, 0, 6], "axis": [0, -1, 0],
                "spring": {"stiffness": 1000, "damping": 200}}],
        "simulation": {"end": 2.0, "step": 0.005, "sleep": false}})
}

#[test]
fn joints_hold_in_the_run_file() {
    let folder = Folder::new("simulation-joints");
    let run = run(&folder, "joints", &scene());
    let all = states(&run);
    let mut lowest = 0.0f64;
    for states in &all {
        if !states[0].is_null() {
            let pin = apart(point(&states[0], [-0.5, 0.0, 0.0]), [0.0; 3]);
            assert!(pin < 1e-5, "the pin is off by {pin}");
        }
        if !states[0].is_null() && !states[1].is_null() {
            let elbow = apart(point(&states[0], [0.5, 0.0, 0.0]), point(&states[1], [-0.5, 0.0, 0.0]));
            assert!(elbow < 1e-5, "the elbow is off by {elbow}");
            lowest = lowest.min(numbers::<3>(&states[1]["x"])[1]);
        }
    }
    assert!(lowest < -1.0, "it swings: {lowest}");
    assert!(run[1..].iter().all(|segment| segment["skipped"] == 0.0));
    let last = |body: usize| {
        let last = all.iter().rev().map(|states| &states[body]).find(|state| !state.is_null());
        numbers::<3>(&last.unwrap()["x"])
    };
    // The world is the second body: it moves by 0.5 along -x against the cart, which goes the other way.
    assert!(apart(last(2), [0.5, 0.0, 3.0]) < 1e-3, "{:?}", last(2));
    // Ten kilograms.
    assert!(apart(last(3), [0.0, -10.0 * 9.81 / 1000.0, 6.0]) < 2e-3, "{:?}", last(3));
}

/// Two bodies of a joint may overlap, unless they are to touch each other.
#[test]
fn bodies_of_a_joint_meet_where_they_are_told_to() {
    let folder = Folder::new("simulation-joints-collide");
    let mut scene = scene();
    scene["bodies"][1]["pose"]["x"] = json!([0.9, 0, 0]);
    scene["joints"][1]["point"] = json!([0.7, 0, 0]);
    run(&folder, "passing", &scene);
    scene["joints"][1]["collide"] = json!(true);
    let path = folder.file("meeting.json", &scene.to_string());
    refused(&["simulate", &path, "--out", "-"], &["upper", "lower", "intersect at the start"]);
}

#[test]
fn joints_that_cannot_be_are_refused_by_their_place() {
    let folder = Folder::new("simulation-joints-refused");
    let with = |joint: usize, key: &str, value: Value| {
        let mut scene = scene();
        scene["joints"][joint][key] = value;
        scene
    };
    let cases = [
        (
            with(0, "kind", json!("hinge")),
            "joints, entry 0",
            "\"hinge\" is not fixed, revolute, prismatic or spherical",
        ),
        (with(1, "b", json!("nobody")), "joints, entry 1", "no body \"nobody\""),
        (with(1, "limits", json!([0, 1])), "joints, entry 1", "only revolute and prismatic joints have one"),
        (with(0, "axis", json!([0, 0, 0])), "joints, entry 0", "axis"),
        (with(2, "limits", json!([1, -1])), "joints, entry 2", "limits"),
        (with(2, "motor", json!({"velocity": 1, "position": 1})), "joints, entry 2, motor", "one of the two"),
        (with(2, "torque", json!(1)), "joints, entry 2", "torque"),
        (with(3, "friction", json!(-1)), "joints, entry 3", "friction -1"),
        (with(1, "b", json!("upper")), "joints, entry 1", "pair"),
    ];
    for (k, (scene, place, reason)) in cases.into_iter().enumerate() {
        let path = folder.file(&format!("bad{k}.json"), &scene.to_string());
        refused(&["simulate", &path, "--out", "-"], &[&format!("bad{k}.json"), place, reason]);
    }
}

/// The example scene: a drawer that opens towards +z, whose joint is with the world and whose value therefore falls.
#[test]
fn limits_that_do_not_hold_at_the_start_are_warned_of() {
    let folder = Folder::new("simulation-joints-start");
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scenes/door.json");
    let scene: Value = serde_json::from_str(&fs::read_to_string(example).unwrap()).unwrap();
    let all = run(&folder, "door", &scene);
    let drawer = states(&all).into_iter().filter_map(|bodies| numbers_of(&bodies[2])).next_back().unwrap();
    assert!((drawer[2] - 1.2).abs() < 1e-3, "{drawer:?}");
    let mut far = scene;
    far["joints"][1]["limits"] = json!([0.1, 0.4]);
    far["simulation"]["end"] = json!(0.01);
    let far = folder.file("far.json", &far.to_string());
    let warned = stderr(&d2m(&["simulate", &far, "--out", &folder.path("far.jsonl")]));
    let expected =
        "far.json, joints, entry 1: limits: [0.1, 0.4] do not hold at the start, where the value is 0";
    assert!(warned.contains(expected), "{warned}");
    assert_eq!(warned.matches("warning").count(), 1, "{warned}");
}

/// The place of a state that is given.
fn numbers_of(state: &Value) -> Option<[f64; 3]> {
    state.is_object().then(|| numbers(&state["x"]))
}
