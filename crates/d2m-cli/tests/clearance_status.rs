//! A clearance says that its budget ran out, wherever it stands.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, stderr, stdout};

/// The arm turns towards the wall and stops before it.
const ARM: &str = r#"<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="mid"/>
  <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
  <link name="wall"><collision><origin xyz="0 0.7 0"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="mid"/><axis xyz="0 0 1"/></joint>
  <joint name="weld" type="fixed"><parent link="mid"/><child link="arm"/></joint>
  <joint name="hold" type="fixed"><parent link="base"/><child link="wall"/><origin xyz="0 0.2 0"/></joint></robot>"#;
const PATH: &str = r#"{"joint_names": ["turn"], "points": [
  {"positions": [0], "time_from_start": 0}, {"positions": [1], "time_from_start": 1}]}"#;
const ENDED: &str = "(undecided: the budget or the time was used up)";

fn answered(arguments: &[&str]) -> String {
    let output = d2m(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// The line of text about the clearance, and the fields of the JSON answer.
fn both(arguments: &[&str]) -> (String, Value) {
    let text = answered(arguments);
    let line = text.lines().find(|line| line.trim_start().starts_with("clearance")).unwrap_or_default();
    let object = serde_json::from_str(&answered(&[arguments, &["--json"]].concat())).unwrap();
    (line.to_owned(), object)
}

fn width(object: &Value) -> f64 {
    let [lower, upper] = [0, 1].map(|k| object["clearance"][k].as_f64().unwrap());
    upper - lower
}

#[test]
fn a_path_whose_clearance_was_not_decided_says_so() {
    let folder = Folder::new("clearance-of-paths");
    let [robot, path] = [("arm.urdf", ARM), ("path.json", PATH)].map(|(name, text)| folder.file(name, text));
    let asked = ["robot", &robot, "--path", &path, "--clearance"];
    let (line, found) = both(&asked);
    assert!(!line.contains("undecided") && found["clearance_status"] == "clear", "{line} {found}");
    let (line, ended) = both(&[&asked[..], &["--time-limit", "1e-12"]].concat());
    assert_eq!(
        (&ended["status"], &ended["clearance_status"]),
        (&"free".into(), &"undecided".into()),
        "{ended}"
    );
    assert!(line.contains(ENDED) && width(&ended) > width(&found), "{line} {ended}");
}

#[test]
fn a_pair_whose_clearance_was_not_decided_says_so() {
    let asked = ["toc", "shape:gear", "shape:torus-knot", "--motion-a", "x=0,0,9;w=0,0,3", "--clearance"];
    let (line, found) = both(&asked);
    assert!(!line.contains("undecided") && found["clearance_status"] == "clear", "{line} {found}");
    let (line, ended) = both(&[&asked[..], &["--budget", "5"]].concat());
    assert_eq!(
        (&ended["status"], &ended["clearance_status"]),
        (&"separated".into(), &"undecided".into()),
        "{ended}"
    );
    assert!(line.contains(ENDED) && width(&ended) > width(&found), "{line} {ended}");
}

/// What the budget leaves open is not said to come within a limit that it is beyond.
#[test]
fn pairs_that_are_not_decided_only_may_come_near() {
    let folder = Folder::new("clearance-of-scenes");
    let scene = r#"{"bodies": [{"name": "gear", "mesh": "shape:gear", "motion": {"x": [-3, 3.2, 0.1], "v": [4, 0, 0], "w": [0, 0, 5]}},
        {"name": "ring", "mesh": "shape:torus"}]}"#;
    let scene = folder.file("scene.json", scene);
    // The two are 1.220702 apart, and some 1.220705 where the search begins.
    let said =
        |limit: &str, budget: &str| answered(&["clearance", &scene, "--below", limit, "--budget", budget]);
    for (limit, budget, expected) in [
        ("1.22", "1000000", "0 of all pairs come within 1.22\n"),
        ("1.23", "1000000", "1 of all pairs come within 1.23\n"),
        ("1.22", "1", "0 of all pairs come within 1.22, 1 more may\n"),
        ("1.23", "1", "1 of all pairs come within 1.23\n"),
    ] {
        let text = said(limit, budget);
        assert!(text.contains(expected), "{text}");
        assert_eq!(text.contains(ENDED), budget == "1", "{text}");
    }
}
