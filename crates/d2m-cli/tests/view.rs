//! `d2m view`: pages that need no network.

mod shell;

use shell::{Folder, d2m, refused, stderr, stdout};
use std::fs;

const UNIT_BOX: &str = "shape:box?x=1&y=1&z=1";

/// What the page shows.
fn data(html: &str) -> serde_json::Value {
    let start = html.split("id=\"data\">").nth(1).unwrap();
    serde_json::from_str(start.split("</script>").next().unwrap()).unwrap()
}

#[test]
fn a_view_is_one_page_that_fetches_nothing() {
    let folder = Folder::new("view");
    let page = folder.path("view.html");
    let motion = ["--motion-a", "x=-3,0,0;v=4,0,0;w=0,0,2"];
    let output = d2m(&[&["view", "shape:gear", UNIT_BOX, "--out", &page], &motion[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.starts_with("<!DOCTYPE html>") && html.trim_end().ends_with("</html>"));
    assert!(html.contains("CONTACT at t = ") && !html.contains("{{"));
    for word in ["<script src", "<link", "import(", "fetch("] {
        let own = html.split("<script>").next().unwrap().to_owned() + html.rsplit("<script>").next().unwrap();
        assert!(!own.contains(word), "{word}");
    }
    // A name cannot end the script.
    let mesh = folder.file("<script>.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let output = d2m(&["view", &mesh, UNIT_BOX, "--out", "-"]);
    assert!(!stdout(&output).contains("<script>.obj"), "{}", stderr(&output));
    refused(&["view", "shape:gear", "--out", &page], &["B", "missing"]);
}

#[test]
fn scenes_and_simulations_are_viewed() {
    let scene = format!("{}/../../docs/scenes/robot-arm.json", env!("CARGO_MANIFEST_DIR"));
    let output = d2m(&["view", &scene, "--out", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let shown = data(&stdout(&output));
    assert!(shown["bodies"].as_array().unwrap().len() > 2 && !shown["marks"].as_array().unwrap().is_empty());

    let folder = Folder::new("runs");
    let scene = r#"{"bodies": [
        {"name": "ground", "mesh": "shape:box?x=1&y=1&z=1", "scale": [5, 1, 5], "kind": "static", "pose": {"x": [0, -1, 0]}},
        {"name": "falls", "mesh": "shape:box?x=1&y=1&z=1", "scale": 0.25, "pose": {"x": [0, 1, 0]}}],
        "simulation": {"end": 1.0, "step": 0.02}}"#;
    let scene = folder.file("scene.json", scene);
    let run = folder.path("run.jsonl");
    let output = d2m(&["simulate", &scene, "--out", &run]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = d2m(&["view", &run, "--out", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let shown = data(&stdout(&output));
    assert_eq!((shown["window"][1].as_f64(), shown["real_time"].as_bool()), (Some(1.0), Some(true)));
    let segments = |body: usize| shown["bodies"][body]["segments"].as_array().unwrap().clone();
    assert!(segments(1).len() > 20 && segments(0).len() == 1, "{} {}", segments(1).len(), segments(0).len());
    assert_eq!((&segments(0)[0][0], &segments(0)[0][1]), (&0.0.into(), &1.0.into()));
    assert!(!shown["marks"].as_array().unwrap().is_empty());

    let text = fs::read_to_string(&run).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    for (fault, words) in [
        (lines[1..].join("\n"), "line 1: missing field"),
        (lines[0].to_owned(), "no segments"),
        (format!("{}\n{{\"t0\": 0}}", lines[0]), "line 2: missing field `t1`"),
        (
            format!(
                "{}\n{{\"t0\": 0, \"t1\": 1, \"changed\": [[9, {{\"x\": [0,0,0], \"q\": [1,0,0,0], \"v\": [0,0,0], \"w\": [0,0,0]}}]]}}",
                lines[0]
            ),
            "body 9 is out of range",
        ),
    ] {
        let broken = folder.file("broken.jsonl", &fault);
        refused(&["view", &broken, "--out", "-"], &["broken.jsonl", words]);
    }
    refused(&["view", &run, UNIT_BOX, "--out", "-"], &["alone"]);
}
