//! The keys of simulations that were added later: `radius`, `damping`, `threads`, `sleep`, and pairs with all that a scene's have.

mod shell;

use serde_json::{Value, json};
use shell::{Folder, d2m, refused, stderr};
use std::fs;

const CUBE: &str = "shape:box?x=0.5&y=0.5&z=0.5";

fn run(folder: &Folder, name: &str, scene: &Value, options: &[&str]) -> Vec<Value> {
    let scene = folder.file(&format!("{name}.json"), &scene.to_string());
    let out = folder.path(&format!("{name}.jsonl"));
    let all: Vec<&str> = ["simulate", &scene, "--out", &out].iter().chain(options).copied().collect();
    let run = d2m(&all);
    assert_eq!(run.status.code(), Some(0), "{name}: {}", stderr(&run));
    fs::read_to_string(out).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The state of a body at the start of every segment in which it changes, as (time, state).
fn states(run: &[Value], index: u64) -> Vec<(f64, Value)> {
    let mut found = Vec::new();
    for segment in &run[1..] {
        let time = segment["t0"].as_f64().unwrap();
        if let Some(all) = segment["bodies"].as_array() {
            found.push((time, all[index as usize].clone()));
        }
        let changed = segment["changed"].as_array().into_iter().flatten();
        found.extend(changed.filter(|entry| entry[0] == index).map(|entry| (time, entry[1].clone())));
    }
    found
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A sphere, a capsule and a rounded box on a table, one of them touching it exactly at the start.
fn round_bodies() -> Value {
    let inertia = |i: f64| json!([[i, 0, 0], [0, i, 0], [0, 0, i]]);
    json!({"bodies": [
        {"name": "table", "mesh": "shape:box?x=5&y=0.5&z=5", "kind": "static", "pose": {"x": [0, -0.5, 0]}, "friction": 0.5},
        {"name": "ball", "mesh": "point.obj", "radius": 0.5, "mass": 1, "center": [0, 0, 0], "inertia": inertia(0.1),
            "pose": {"x": [0, 0.8, 0]}, "friction": 0.5},
        {"name": "capsule", "mesh": "rod.obj", "radius": 0.25, "mass": 1, "center": [0, 0, 0], "inertia": inertia(0.2),
            "pose": {"x": [2, 0.25, 0]}, "friction": 0.5},
        {"name": "block", "mesh": CUBE, "radius": 0.1, "pose": {"x": [-2, 0.9, 0]}, "friction": 0.5}],
        "simulation": {"end": 1.5, "gap": 1e-3}})
}

#[test]
fn bodies_with_radii_rest_on_their_surfaces() {
    let folder = Folder::new("simulation-radius");
    folder.file("point.obj", "v 0 0 0\nf 1 1 1\n");
    folder.file("rod.obj", "v 0 0 -1\nv 0 0 1\nf 1 2 2\n");
    let run = run(&folder, "round", &round_bodies(), &[]);
    for (index, height) in [(1, 0.5), (2, 0.25), (3, 0.6)] {
        let states = states(&run, index);
        let heights: Vec<f64> = states.iter().map(|(_, state)| number(&state["x"][1])).collect();
        // Of the block the lowest corner counts, of the others the axis.
        assert!(index == 3 || heights.iter().all(|y| *y >= height - 1e-15), "{index}: {heights:?}");
        let last = heights.last().unwrap();
        assert!((last - height).abs() < 3e-3, "body {index} rests at {last}");
    }
    // The mass is that of the mesh.
    assert!((number(&run[0]["bodies"][3]["mass"]) - 1000.0).abs() < 1e-9);
    assert!(run[1..].iter().all(|segment| segment["skipped"] == 0.0));
    let mut bad = round_bodies();
    bad["bodies"][1]["radius"] = json!(-0.5);
    let path = folder.file("bad.json", &bad.to_string());
    refused(
        &["simulate", &path, "--out", "-"],
        &["bad.json, body 1 (\"ball\"), radius", "-0.5 is not a finite distance"],
    );
    // Two spheres in each other.
    let mut bad = round_bodies();
    bad["bodies"][2]["pose"]["x"] = json!([0.6, 0.8, 0]);
    let path = folder.file("bad.json", &bad.to_string());
    refused(&["simulate", &path, "--out", "-"], &["ball", "capsule"]);
}

#[test]
fn velocities_fade() {
    let folder = Folder::new("simulation-damping");
    let scene = json!({"bodies": [
        {"name": "puck", "mesh": CUBE, "velocity": {"v": [3, 0, 0], "w": [0, 2, 0]}, "damping": {"linear": 0.5, "angular": 2}},
        {"name": "free", "mesh": CUBE, "pose": {"x": [0, 9, 0]}, "velocity": {"v": [3, 0, 0]}, "damping": {}}],
        "simulation": {"end": 2, "gravity": [0, 0, 0], "sleep": false, "threads": 2}});
    let lines = run(&folder, "puck", &scene, &[]);
    let (time, last) = states(&lines, 0).pop().unwrap();
    assert!(time > 1.98, "{time}");
    // The last flight began a step before the end, with the velocity of that step.
    assert!((number(&last["v"][0]) - 3.0 * (-0.5 * 2.0_f64).exp()).abs() < 1e-3, "{last}");
    assert!((number(&last["w"][1]) - 2.0 * (-2.0 * 2.0_f64).exp()).abs() < 1e-3, "{last}");
    assert_eq!(states(&lines, 1).pop().unwrap().1["v"], json!([3.0, 0.0, 0.0]));
    // The option stands for the key, and the numbers are the same.
    let again = run(&folder, "puck", &scene, &["--threads", "1"]);
    let without_wall = |lines: &[Value]| {
        let mut lines = lines.to_vec();
        for line in &mut lines {
            line["wall"] = json!(0);
        }
        lines
    };
    assert_eq!(without_wall(&lines), without_wall(&again));
    for (place, value, words) in [
        (
            "/bodies/0/damping/linear",
            json!(-1),
            &["body 0 (\"puck\"), damping", "linear: -1.0 is negative"][..],
        ),
        ("/bodies/0/damping", json!({"spin": 1}), &["damping", "unknown key \"spin\""]),
        (
            "/simulation/threads",
            json!(0),
            &["simulation", "threads: 0 should be a whole number from 1 to 1024"],
        ),
        ("/simulation/sleep", json!("no"), &["simulation", "sleep: \"no\" should be true or false"]),
    ] {
        let mut bad = scene.clone();
        *bad.pointer_mut(place).unwrap() = value;
        let path = folder.file("bad.json", &bad.to_string());
        refused(&["simulate", &path, "--out", "-"], words);
    }
}

#[test]
fn pairs_have_what_scenes_and_simulations_have() {
    let folder = Folder::new("simulation-pairs");
    let scene = json!({"start": "leave", "window": [0, 1], "min_separation": 0.0, "tolerance": 1e-9, "bodies": [
        {"name": "floor", "mesh": "shape:box?x=5&y=0.5&z=5", "kind": "static", "pose": {"x": [0, -0.5, 0]}},
        {"name": "ball", "mesh": CUBE, "pose": {"x": [0, 1, 0]}}],
        "pairs": [{"a": "ball", "b": "floor", "restitution": 1, "friction": 0.25, "start": "report", "min_separation": 0.01}],
        "simulation": {"end": 0.5}});
    let lines = run(&folder, "ball", &scene, &[]);
    // It bounces.
    assert!(states(&lines, 1).iter().any(|(_, state)| number(&state["v"][1]) > 1.0));
    for (place, value, words) in [
        ("/start", json!("go"), &["start: \"go\" is neither \"report\" nor \"leave\""][..]),
        // What says nothing of a simulation is checked as in any scene.
        ("/window", json!([1, 0]), &["bad.json, window: ", "reversed"]),
        ("/window", json!("always"), &["bad.json, window: ", "\"always\""]),
        ("/min_separation", json!(-1), &["bad.json, min_separation: -1.0 is not a finite distance"]),
        ("/min_separation", json!("wide"), &["bad.json, min_separation: ", "\"wide\""]),
        ("/tolerance", json!(0), &["bad.json, tolerance: 0.0 is not a positive finite distance"]),
        ("/tolerance", json!([1e-9]), &["bad.json, tolerance: ", "sequence"]),
        ("/window", json!([0.25, 0.5]), &[]),
        ("/min_separation", json!(0.5), &[]),
        ("/tolerance", json!(null), &[]),
        ("/pairs/0", json!(["ball", "floor"]), &["pairs, entry 0: ", "not an object with keys"]),
        ("/pairs/0/b", json!("flor"), &["pairs, entry 0, b", "\"flor\" is the name of no body"]),
        ("/pairs/0/restitution", json!(1.5), &["pairs, entry 0, restitution", "1.5 is not from 0 to 1"]),
        (
            "/pairs/0/friction",
            json!(-1),
            &["pairs, entry 0, friction", "-1.0 is not a finite coefficient that is not negative"],
        ),
        ("/pairs/0/start", json!(null), &[]),
    ] {
        let mut bad = scene.clone();
        *bad.pointer_mut(place).unwrap() = value;
        let path = folder.file("bad.json", &bad.to_string());
        if words.is_empty() {
            assert_eq!(d2m(&["simulate", &path, "--out", "-"]).status.code(), Some(0));
        } else {
            refused(&["simulate", &path, "--out", "-"], words);
        }
    }
}
