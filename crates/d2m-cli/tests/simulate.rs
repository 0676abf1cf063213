//! `d2m simulate` as scripts see it.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr};

/// The example of the documentation.
const PILE: &str = include_str!("../../../docs/scenes/pile.json");

fn lines(path: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A line without the time that it took.
fn timeless(mut line: Value) -> Value {
    if let Some(fields) = line.as_object_mut() {
        fields.remove("wall");
    }
    line
}

#[test]
fn runs_join_from_start_to_end_and_are_the_same_at_any_number_of_threads() {
    let folder = Folder::new("simulate-runs");
    let scene = folder.file("pile.json", PILE);
    let runs: Vec<Vec<Value>> = ["1", "2"]
        .iter()
        .map(|threads| {
            let run = folder.path(&format!("run-{threads}.jsonl"));
            let output = d2m(&["simulate", &scene, "--out", &run, "--threads", threads]);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            assert!(stderr(&output).contains("s a simulated second"), "{}", stderr(&output));
            lines(&run).into_iter().map(timeless).collect()
        })
        .collect();
    assert_eq!(runs[0], runs[1]);
    let run = &runs[0];
    let names: Vec<&str> =
        run[0]["bodies"].as_array().unwrap().iter().map(|b| b["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["floor", "low", "high", "ring"]);
    assert_eq!(run[1]["bodies"].as_array().unwrap().len(), 4);
    let mut time = 0.0;
    for segment in &run[1..] {
        assert_eq!(segment["t0"].as_f64(), Some(time));
        time = segment["t1"].as_f64().unwrap();
        assert_eq!(segment["skipped"].as_f64(), Some(0.0));
    }
    assert_eq!(time, 1.5);
    assert!(run.iter().any(|line| line["contacts"].as_array().is_some_and(|c| !c.is_empty())));
}

#[test]
fn bodies_that_overlap_at_the_start_are_named_and_an_old_run_stays() {
    let folder = Folder::new("simulate-overlap");
    let scene = folder.file("overlap.json", &PILE.replace("[0, 0.6, 0]", "[0, 0.4, 0]"));
    let run = folder.path("run.jsonl");
    refused(&["simulate", &scene, "--out", &run], &["overlap.json", "floor", "low", "intersect"]);
    assert!(!std::path::Path::new(&run).exists());
    let run = folder.file("old.jsonl", "an old run\n");
    refused(&["simulate", &scene, "--out", &run], &["intersect", "nothing was written to", "old.jsonl"]);
    assert_eq!(std::fs::read_to_string(&run).unwrap(), "an old run\n");
}

#[test]
fn a_run_that_cannot_go_on_keeps_its_segments() {
    let folder = Folder::new("simulate-crushed");
    let text = r#"{"bodies": [
        {"name": "wall", "mesh": "shape:box?x=0.5&y=0.5&z=0.5", "kind": "static", "pose": {"x": [1.5, 0, 0]}},
        {"name": "nut", "mesh": "shape:box?x=0.5&y=0.5&z=0.5"},
        {"name": "press", "mesh": "shape:box?x=0.5&y=0.5&z=0.5", "kind": "kinematic", "motion": {"x": [-1.5, 0, 0], "v": [2, 0, 0]}}],
        "simulation": {"gravity": [0, 0, 0], "end": 2}}"#;
    let scene = folder.file("crushed.json", text);
    let run = folder.path("run.jsonl");
    let output = d2m(&["simulate", &scene, "--out", &run]);
    assert_eq!(output.status.code(), Some(3));
    let message = stderr(&output);
    assert!(["crushed.json", "press", "nut"].iter().all(|word| message.contains(word)), "{message}");
    let run = lines(&run);
    let last = run.last().unwrap()["t1"].as_f64().unwrap();
    assert!(run.len() > 10 && last > 0.2 && last < 1.0, "{last}");
    assert!(message.contains(&format!("run.jsonl holds the run until t = {last:?}")), "{message}");
    // One that ends before its first step has no pace.
    let scene =
        folder.file("pushed.json", &text.replace("\"gravity\": [0, 0, 0]", "\"gravity\": [1e308, 0, 0]"));
    let output = d2m(&["simulate", &scene, "--out", &folder.path("none.jsonl")]);
    assert_eq!(output.status.code(), Some(3));
    assert!(stderr(&output).starts_with("0 simulated, 0 contact events, 0 skipped\n"), "{}", stderr(&output));
}

/// The file of an earlier, longer run is cut off before the first segment is written, and grows step by step.
#[test]
fn a_run_replaces_the_whole_of_an_older_one() {
    let folder = Folder::new("simulate-again");
    let scene = folder.file("pile.json", &PILE.replace("\"end\": 1.5", "\"end\": 0.1"));
    let run = folder.file("run.jsonl", &"an old run that was much longer\n".repeat(10_000));
    let output = d2m(&["simulate", &scene, "--out", &run]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let run = lines(&run);
    assert_eq!(run.last().unwrap()["t1"].as_f64(), Some(0.1));
    assert_eq!(run[1]["t0"].as_f64(), Some(0.0));
}

/// A body that follows its motion.
const MOVING: &str = r#"{"bodies": [{"name": "press", "mesh": "shape:box", "kind": "kinematic", "motion": {"x": [-1.5, 0, 0], "v": [2, 0, 0]}}]}"#;

#[test]
fn bad_scenes_are_refused_with_their_place() {
    let folder = Folder::new("simulate-bad");
    let cases = [
        (PILE.replace("\"end\": 1.5", "\"end\": 0"), "end"),
        (PILE.replace("\"step\": 0.02", "\"step\": -1"), "step"),
        (
            PILE.replace("\"step\": 0.02", "\"step\": 1e-300"),
            "simulation: step: 1e-300 is too short: doubles at the end 1.5 are 2.220446049250313e-16 apart",
        ),
        // As far as the next double: two multiples of it may be rounded to one time.
        (
            PILE.replace("\"step\": 0.02", "\"step\": 2.220446049250313e-16"),
            "step: 2.220446049250313e-16 is too short",
        ),
        (
            PILE.replace("\"restitution\": 0.3", "\"density\": 1e308"),
            "body high: density 1e308: with the volume of ",
        ),
        (PILE.replace("\"restitution\": 0.3", "\"mass\": 1e-300"), "mass 1e-300: with the volume of "),
        (PILE.replace("\"restitution\": 0.3", "\"restitution\": 1.5"), "restitution"),
        (PILE.replace("\"restitution\": 0.3", "\"mass\": 0"), "mass"),
        (PILE.replace("\"restitution\": 0.3", "\"density\": -7800"), "density"),
        (PILE.replace("\"restitution\": 0.3", "\"bounce\": 1"), "bounce"),
        (PILE.replace("[0.96, 0.28, 0, 0]", "[0, 0, 0, 0]"), "q"),
        (PILE.replace("[1, 2, 3]", "[1, 2]"), "w"),
        (PILE.replace("\"high\"", "\"low\""), "low"),
        (PILE.replace("\"static\"", "\"fixed\""), "fixed"),
        (PILE.replace("\"friction\": 0.5}", "\"friction\": 1e999}"), "number"),
        (
            MOVING.replace("\"motion\"", "\"pose\": {\"x\": [9, 0, 0]}, \"motion\""),
            "body 0 (\"press\"): motion, pose: ",
        ),
        (
            MOVING.replace("\"motion\"", "\"velocity\": {}, \"motion\""),
            "body 0 (\"press\"): motion, velocity: ",
        ),
        (MOVING.replace("kinematic", "static"), "follows none"),
        (
            MOVING.replace("{\"x\": [-1.5, 0, 0], \"v\": [2, 0, 0]}", "[]"),
            "body 0 (\"press\"), motion: invalid type: sequence",
        ),
    ];
    for (index, (text, word)) in cases.iter().enumerate() {
        let scene = folder.file(&format!("bad-{index}.json"), text);
        refused(
            &["simulate", &scene, "--out", &folder.path("run.jsonl")],
            &[&format!("bad-{index}.json"), word],
        );
    }
}

#[test]
fn runs_are_thinned_and_packed() {
    let folder = Folder::new("thinned");
    let scene = r#"{"bodies": [
        {"name": "ground", "mesh": "shape:box?x=1&y=1&z=1", "scale": [5, 1, 5], "kind": "static", "pose": {"x": [0, -1, 0]}},
        {"name": "falls", "mesh": "shape:box?x=1&y=1&z=1", "scale": 0.25, "pose": {"x": [0, 1, 0]}}],
        "simulation": {"end": 1.0, "step": 0.02}}"#;
    let scene = folder.file("scene.json", scene);
    let (run, packed) = (folder.path("run.jsonl"), folder.path("run.jsonl.gz"));
    for out in [&run, &packed] {
        let output = d2m(&["simulate", &scene, "--out", out, "--every", "0.25"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let text = std::fs::read_to_string(&run).unwrap();
    let mut unpacked = String::new();
    let file = std::fs::File::open(&packed).unwrap();
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(file), &mut unpacked).unwrap();
    let lines = |text: &str| -> Vec<serde_json::Value> {
        text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let (lines, others) = (lines(&text), lines(&unpacked));
    assert_eq!((lines.len(), others.len()), (4, 4));
    for (k, line) in lines.iter().enumerate() {
        assert_eq!(
            (line["t0"].as_f64(), line["t1"].as_f64()),
            (Some(0.25 * k as f64), Some(0.25 * (k + 1) as f64))
        );
        assert_eq!((&line["thinned"], line["bodies"].as_array().unwrap().len()), (&true.into(), 2));
        assert_eq!(line["bodies"], others[k]["bodies"]);
    }
    // Free fall for a quarter of a second.
    let height = lines[1]["bodies"][1]["x"][1].as_f64().unwrap();
    assert!((height - (1.0 - 0.5 * 9.81 * 0.0625)).abs() < 0.03, "{height}");
    refused(&["simulate", &scene, "--out", &run, "--every", "0"], &["--every", "positive"]);
    refused(&["simulate", &scene, "--out", &run, "--every", "1e-300"], &["--every", "too many segments"]);
}
