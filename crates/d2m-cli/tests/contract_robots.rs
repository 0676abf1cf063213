//! Scenes of robots have the keys `start` and `pairs`, and paths are warned of where joints turn far.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

const LIFT: &str = r#"<robot name="lift">
  <link name="rail"/>
  <link name="hand"><collision><origin xyz="0 0 0.6"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="wrist"/>
  <joint name="up" type="prismatic"><parent link="rail"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="0" upper="9" effort="1" velocity="9"/></joint>
  <joint name="spin" type="continuous"><parent link="hand"/><child link="wrist"/><axis xyz="0 0 1"/></joint></robot>"#;
const PATH: &str = r#"{"joint_names": ["up", "spin"], "points": [{"positions": [0, 0], "time_from_start": 0},
    {"positions": [TOP, TURN], "time_from_start": 2}]}"#;
/// The part stands on the table, held by the hand above it; there is a ceiling at 2.
const SCENE: &str = r#"{START "bodies": [
    {"name": "part", "mesh": "shape:box?x=0.5&y=0.5&z=0.25", "attach": "hand", "pose": {"x": [0, 0, 0.25]}},
    {"name": "table", "mesh": "shape:box?x=2&y=2&z=0.5", "pose": {"x": [0, 0, -0.5]}},
    {"name": "ceiling", "mesh": "shape:box?x=2&y=2&z=0.5", "pose": {"x": [0, 0, 2.5]}}]}"#;

#[test]
fn a_part_leaves_its_table() {
    let folder = Folder::new("contract-robot");
    let robot = folder.file("lift.urdf", LIFT);
    let path =
        |top: &str, turn: &str| folder.file("path.json", &PATH.replace("TOP", top).replace("TURN", turn));
    let scene = |start: &str| folder.file("scene.json", &SCENE.replace("START", start));
    let run = |top: &str, start: &str| {
        let run = d2m(&["robot", &robot, "--path", &path(top, "1"), "--scene", &scene(start), "--json"]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        serde_json::from_str::<Value>(&stdout(&run)).unwrap()
    };
    let plain = run("1", "");
    assert_eq!((&plain["status"], &plain["time"][0]), (&"contact".into(), &0.0.into()), "{plain}");
    let leaving = [
        r#""start": "leave","#,
        r#""pairs": [{"a": "part", "b": "table", "start": "leave"}],"#,
        r#""start": "leave", "pairs": [{"a": "ceiling", "b": "hand", "start": "report"}],"#,
    ];
    for start in leaving {
        let free = run("1", start);
        assert_eq!(free["status"], "free", "{start}");
        assert!(free["left"][0]["start"] == "touching" && free["left"][0]["b"] == "table", "{free}");
        assert!(free["left"][0]["left"][1].as_f64().is_some_and(|time| time < 1e-6), "{free}");
        // The hand's top is at 0.7: it meets the ceiling at 1.3 of the way.
        let met = run("2", start);
        assert_eq!(met["status"], "contact", "{met}");
        assert!((met["time"][0].as_f64().unwrap() - 1.3).abs() < 1e-6, "{met}");
        assert!([&met["a"], &met["b"]].contains(&&Value::from("ceiling")), "{met}");
    }
    // Only where it is said.
    let other = run("1", r#""start": "leave", "pairs": [{"a": "table", "b": "part", "start": "report"}],"#);
    assert_eq!((&other["status"], &other["time"][0]), (&"contact".into(), &0.0.into()), "{other}");
    for (start, words) in [
        (r#""start": "go","#, &["scene.json", "start: \"go\" is neither"][..]),
        (
            r#""pairs": [{"a": "part", "b": "tabel", "start": "leave"}],"#,
            &["pairs, entry 0, b", "\"tabel\" is the name of no body"],
        ),
        (r#""pairs": [{"a": "part", "start": "leave"}],"#, &["pairs, entry 0", "missing field `b`"]),
        (
            r#""pairs": [{"a": "part", "b": "table", "min_separation": -1}],"#,
            &["pairs, entry 0", "min_separation", "-1"],
        ),
        (
            r#""pairs": [{"a": "part", "b": "table"}, {"a": "table", "b": "part", "start": "leave"}],"#,
            &["pairs, entry 1", "entry 0 too"],
        ),
    ] {
        refused(&["robot", &robot, "--path", &path("1", "1"), "--scene", &scene(start)], words);
    }
    // The hand is kept 0.4 away from the ceiling, the part from the table not at all: that is stated, and proven again.
    let kept = r#""start": "leave", "pairs": [{"a": "ceiling", "b": "hand", "min_separation": 0.4}],"#;
    let clearance =
        r#""pairs": [{"a": "ceiling", "b": "hand", "min_separation": 0.4}], "ignore": [["part", "table"]],"#;
    for (top, start, expected) in
        [("1", leaving[0], None), ("2", leaving[1], Some(1.3)), ("2", kept, Some(0.9))]
    {
        let files = [path(top, "1"), scene(start)];
        let run = d2m(&["robot", &robot, "--path", &files[0], "--scene", &files[1], "--verify", "--json"]);
        let found: Value = serde_json::from_str(&stdout(&run)).unwrap();
        assert!(found["verified"] == true, "{top} {start}: {found}");
        let time = found["time"][0].as_f64();
        assert!(
            time.is_none_or(|time| time < expected.unwrap() && time > expected.unwrap() - 1e-6),
            "{found}"
        );
        assert_eq!(time.is_some(), expected.is_some(), "{found}");
    }
    // The hand's top comes to 1.2, 0.8 below the ceiling and so 0.4 above what is kept; it begins 0.5 above the table.
    let files = [path("0.5", "1"), scene(clearance)];
    let run = d2m(&["robot", &robot, "--path", &files[0], "--scene", &files[1], "--clearance", "--json"]);
    let found: Value = serde_json::from_str(&stdout(&run)).unwrap();
    let upper = found["clearance"][1].as_f64().unwrap();
    assert!((upper - 0.4).abs() < 1e-6 && found["a"] != found["b"], "{found}");
    let turned = d2m(&["robot", &robot, "--path", &path("9", "90"), "--scene", &scene(leaving[0])]);
    assert!(stderr(&turned).contains("joint \"spin\" turns 14.32 times on the path"), "{}", stderr(&turned));
    assert!(!stderr(&turned).contains("joint \"up\" turns"), "{}", stderr(&turned));
}

/// A path of six hundred million turns takes days: why is said at once, not when the answer is there; also of turns that queries of two bodies refuse.
#[test]
fn joints_that_turn_far_are_named_before_the_search() {
    let folder = Folder::new("contract-far");
    let arm = r#"<robot name="arm"><link name="base"/>
      <link name="hand"><collision><origin xyz="1 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
      <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/></joint>
      <link name="tip"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.5 0.1 0.1"/></geometry></collision></link>
      <joint name="bend" type="continuous"><parent link="hand"/><child link="tip"/><origin xyz="1.6 0 0"/><axis xyz="0 0 1"/></joint></robot>"#;
    let post =
        r#"{"bodies": [{"name": "post", "mesh": "shape:box?x=0.1&y=0.1&z=2", "pose": {"x": [2.9, 0, 0]}}]}"#;
    let robot = folder.file("arm.urdf", arm);
    let scene = folder.file("post.json", post);
    for way in ["4e9", "1e13"] {
        let path = r#"{"joint_names": ["turn", "bend"], "points": [{"positions": [0, 0.5], "time_from_start": 0},
            {"positions": [WAY, 1], "time_from_start": 1}]}"#;
        let path = folder.file("far.json", &path.replace("WAY", way));
        let mut run = Command::new(env!("CARGO_BIN_EXE_d2m"))
            .args(["robot", &robot, "--path", &path, "--scene", &scene])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut errors = BufReader::new(run.stderr.take().unwrap());
        let (said, heard) = mpsc::channel();
        thread::spawn(move || {
            let mut line = String::new();
            errors.read_line(&mut line).unwrap();
            said.send(line)
        });
        let line = heard.recv_timeout(Duration::from_secs(20));
        run.kill().unwrap();
        run.wait().unwrap();
        assert!(line.as_ref().is_ok_and(|line| line.contains("joint \"turn\" turns ")), "{way}: {line:?}");
    }
}

/// Also of joints that the path does not name, and of turns between its points.
#[test]
fn joints_that_follow_and_that_come_back_are_named_too() {
    let folder = Folder::new("contract-turns");
    let arm = r#"<robot name="arm"><link name="base"><collision><origin xyz="0 0 9"/><geometry><box size="1 1 1"/></geometry></collision></link>
      <link name="hand"><collision><geometry><box size="1 0.1 0.1"/></geometry></collision></link><link name="wheel"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/></joint>
      <joint name="roll" type="continuous"><parent link="base"/><child link="wheel"/><mimic joint="turn" multiplier="-100"/></joint></robot>"#;
    let robot = folder.file("arm.urdf", arm);
    let said = |points: &str| {
        let path = folder.file("path.json", &format!(r#"{{"joint_names": ["turn"], "points": [{points}]}}"#));
        let run = d2m(&["robot", &robot, "--path", &path]);
        let lines = stderr(&run);
        let turns =
            lines.lines().filter_map(|line| line.split_once("joint \"")).map(|(_, text)| text.to_owned());
        turns.collect::<Vec<_>>()
    };
    let words = "times on the path; angles are radians";
    let straight = r#"{"positions": [0], "time_from_start": 0}, {"positions": [1], "time_from_start": 1}"#;
    assert_eq!(said(straight), [format!("roll\" turns 15.92 {words}")]);
    // 1000·t(1 − t)(1 − 2t): twice from −500/√27 to 500/√27, in all 2000/√27 radians.
    let curved = r#"{"positions": [0], "velocities": [1000], "time_from_start": 0},
        {"positions": [0], "velocities": [1000], "time_from_start": 1}"#;
    let found = said(curved);
    let turns: Vec<f64> = found.iter().map(|text| text.split(' ').nth(2).unwrap().parse().unwrap()).collect();
    let expected = 2000.0 / 27.0_f64.sqrt() / std::f64::consts::TAU;
    assert!(
        found.len() == 2 && found[0].starts_with("turn\"") && found[1].starts_with("roll\""),
        "{found:?}"
    );
    assert!(
        (turns[0] / expected - 1.0).abs() < 0.01 && (turns[1] / expected - 100.0).abs() < 1.0,
        "{found:?}"
    );
}

/// Motions of every JSON form, splines among them, wherever a motion is read.
#[test]
fn splines_are_motions() {
    const CUBE: &str = "shape:box?x=0.5&y=0.5&z=0.5";
    let folder = Folder::new("contract-splines");
    let spline = r#"{"times": [0, 0.5, 1], "poses": [{"x": [-4, 0, 0]}, {"x": [-2, 0.25, 0]}, {"x": [4, 0, 0]}], "join": "quintic"}"#;
    let motion = format!("@{}", folder.file("spline.json", spline));
    let ask = |command: &str, options: &[&str]| -> Value {
        let pair = [command, CUBE, CUBE, "--motion-a", &motion, "--json"];
        let run = d2m(&pair.iter().chain(options).copied().collect::<Vec<_>>());
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        serde_json::from_str(&stdout(&run)).unwrap()
    };
    let met = ask("toc", &["--verify"]);
    assert!(met["status"] == "contact" && met["verified"] == true, "{met}");
    let time = met["toc"].as_f64().unwrap();
    assert!(time > 0.5 && time < 1.0, "{met}");
    assert_eq!(ask("spans", &[])["spans"].as_array().unwrap().len(), 3);
    let scene = format!(
        r#"{{"bodies": [{{"name": "a", "mesh": "{CUBE}", "motion": {spline}}}, {{"name": "b", "mesh": "{CUBE}"}}]}}"#
    );
    let scene = folder.file("scene.json", &scene);
    let found = d2m(&["scene", &scene, "--json"]);
    let found: Value = serde_json::from_str(&stdout(&found)).unwrap();
    assert!((found["contacts"][0]["toc"].as_f64().unwrap() - time).abs() < 1e-6, "{found}");
    let trials = folder.file("t.jsonl", &format!("{{\"a\": {spline}, \"b\": {{\"q\": [2, 0, 0, 0]}}}}\n"));
    let run = d2m(&["batch", CUBE, CUBE, "--trials", &trials, "--out", "-"]);
    assert!(stdout(&run).contains("contact"), "{}", stdout(&run));
    assert!(stderr(&run).contains("1 trials have a quaternion that is not of length 1"), "{}", stderr(&run));
    refused(
        &["toc", CUBE, CUBE, "--motion-a", &motion, "--window", "0,2"],
        &["--motion-a", "the motion covers the times from 0.0 to 1.0"],
    );
}
