//! `d2m robot` as scripts see it.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};

/// Two links that turn about z, one after the other, on a foot.
const ARM: &str = r#"<robot name="two">
  <link name="foot"><collision><origin xyz="0 0 -0.3"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.06 0.06"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.25 0 0.1"/><geometry><box size="0.5 0.05 0.05"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="1.5" velocity="2"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
</robot>"#;
const PATH: &str = r#"{"joint_names": ["shoulder"], "points": [
  {"positions": [0], "time_from_start": 1}, {"positions": [1.6], "time_from_start": 3}]}"#;
const SCENE: &str = r#"{"bodies": [
  {"name": "post", "mesh": "shape:box?x=0.05&y=0.05&z=1", "pose": {"x": [0, 0.8, 0]}},
  {"name": "grasped", "mesh": "shape:box?x=0.02&y=0.02&z=0.02", "attach": "lower", "pose": {"x": [0.6, 0, 0.1]}}]}"#;

struct Files {
    folder: Folder,
    robot: String,
    path: String,
    scene: String,
}

fn files(name: &str) -> Files {
    let folder = Folder::new(name);
    let [robot, path, scene] = [("arm.urdf", ARM), ("path.json", PATH), ("scene.json", SCENE)]
        .map(|(name, text)| folder.file(name, text));
    Files { folder, robot, path, scene }
}

fn ask(arguments: &[&str]) -> Value {
    let output = d2m(&[&["robot"], arguments, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn a_path_is_free_or_until_when() {
    let Files { robot, path, scene, .. } = &files("robot-path");
    let free = ask(&[robot, "--path", path]);
    assert_eq!((free["status"].as_str(), free["free_until"].as_f64()), (Some("free"), Some(3.0)));
    assert!(free["time"].is_null() && free["a"].is_null());
    let found = ask(&[robot, "--path", path, "--scene", scene]);
    assert_eq!(found["status"], "contact");
    let [lo, hi] = [0, 1].map(|k| found["time"][k].as_f64().unwrap());
    // The side of the lower link, 0.025 wide, at the corner of the post: sin of the angle between is 0.025 / r.
    let corner = (0.05_f64.powi(2) + 0.75_f64.powi(2)).sqrt();
    let angle = (0.75_f64 / 0.05).atan() - (0.025 / corner).asin();
    let expected = 1.0 + 2.0 * angle / 1.6;
    assert!(
        lo <= expected + 1e-9 && lo > expected - 1e-8 && hi - lo < 1e-8 && found["free_until"] == lo,
        "{lo} {expected}"
    );
    let mut names = [found["a"].as_str().unwrap(), found["b"].as_str().unwrap()];
    names.sort_unstable();
    assert_eq!(names, ["lower", "post"]);
    for key in ["separation", "point", "normal", "evidence"] {
        assert!(!found[key].is_null(), "{key}");
    }
    let ignored =
        SCENE.replacen('{', r#"{"ignore": [["post", "lower"], ["post", "upper"], ["grasped", "post"]], "#, 1);
    let folder = Folder::new("robot-ignore");
    let scene = folder.file("scene.json", &ignored);
    assert_eq!(ask(&[robot, "--path", path, "--scene", &scene])["status"], "free");
    let apart = ask(&[robot, "--path", path, "--scene", &scene, "--min-separation", "0.005"]);
    assert_eq!(apart["status"], "free");
    let near = ask(&[robot, "--path", path, "--min-separation", "0.5"]);
    assert_eq!((near["status"].as_str(), near["free_until"].as_f64()), (Some("contact"), Some(1.0)));
}

#[test]
fn free_paths_say_how_near_they_come() {
    let Files { robot, path, scene, .. } = &files("robot-clearance");
    let free = ask(&[robot, "--path", path, "--clearance"]);
    let [lo, hi] = [0, 1].map(|k| free["clearance"][k].as_f64().unwrap());
    assert!(0.0 < lo && lo <= hi && hi - lo <= 1e-6 * hi, "{free}");
    let time = free["clearance_time"].as_f64().unwrap();
    assert!((1.0..=3.0).contains(&time) && free["a"].is_string() && free["b"].is_string(), "{free}");
    // A separation is taken off; what asks for more than that is no longer free.
    let near = (0.5 * lo).to_string();
    let kept = ask(&[robot, "--path", path, "--clearance", "--min-separation", &near]);
    let [l, h] = [0, 1].map(|k| kept["clearance"][k].as_f64().unwrap());
    assert!(l <= hi - 0.5 * lo && lo - 0.5 * lo <= h, "{kept}");
    let beyond = (hi * (1.0 + 1e-9)).to_string();
    let met = ask(&[robot, "--path", path, "--clearance", "--min-separation", &beyond]);
    assert!(met["status"] == "contact" && met["clearance"].is_null(), "{met}");
    let found = ask(&[robot, "--path", path, "--scene", scene, "--clearance"]);
    assert!(found["status"] == "contact" && found["clearance"].is_null(), "{found}");
    assert!(ask(&[robot, "--path", path])["clearance"].is_null());
    let text = stdout(&d2m(&["robot", robot, "--path", path, "--clearance"]));
    assert!(text.contains("  clearance   ["), "{text}");
}

#[test]
fn answers_are_proven_again() {
    let Files { folder, robot, path, scene } = &files("robot-verify");
    for arguments in [vec![], vec!["--scene", scene]] {
        let found = ask(&[&[robot, "--path", path, "--verify"], &arguments[..]].concat());
        assert!(found["verified"] == true && found["why"].is_null(), "{found}");
    }
    let round = folder.file("round.json", &SCENE.replace("\"attach\"", "\"radius\": 0.01, \"attach\""));
    let found = ask(&[robot, "--path", path, "--scene", &round, "--verify"]);
    assert!(found["verified"] == true && found["why"].is_null(), "{found}");
    assert!(ask(&[robot, "--path", path])["verified"].is_null());
    let text = stdout(&d2m(&["robot", robot, "--path", path, "--verify"]));
    assert!(text.contains("  verified    yes"), "{text}");
}

#[test]
fn bodies_have_radii() {
    let Files { folder, robot, path, scene } = &files("robot-radius");
    let until = |arguments: &[&str]| {
        let found = ask(&[&[robot, "--path", path], arguments].concat());
        assert_eq!(found["status"], "contact");
        found["free_until"].as_f64().unwrap()
    };
    let round = folder.file(
        "round.json",
        &SCENE.replace("\"pose\": {\"x\": [0, 0.8, 0]}", "\"radius\": 0.01, \"pose\": {\"x\": [0, 0.8, 0]}"),
    );
    // All other pairs are further apart.
    let [bare, kept, round] = [
        until(&["--scene", scene]),
        until(&["--scene", scene, "--min-separation", "0.01"]),
        until(&["--scene", &round]),
    ];
    assert!((kept - round).abs() < 1e-9 && round < bare - 1e-3, "{bare} {kept} {round}");
    let bad = folder.file("bad.json", &SCENE.replace("\"attach\"", "\"radius\": -1, \"attach\""));
    refused(&["robot", robot, "--path", path, "--scene", &bad], &["grasped", "radius: -1"]);
}

#[test]
fn limits_are_warned_of_and_text_says_what_is_certified() {
    let Files { robot, path, .. } = &files("robot-limits");
    let output = d2m(&["robot", robot, "--path", path, "--exit-status"]);
    assert_eq!(output.status.code(), Some(11));
    assert!(stderr(&output).contains("joint \"shoulder\": the position 1.5"), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("FREE: certified, no contact from 1 to 3"), "{}", stdout(&output));
    assert!(stdout(&output).contains("\n  checked     1 pairs of 3 bodies\n"), "{}", stdout(&output));
}

/// A path as ROS writes it: a header, efforts, and times of seconds and nanoseconds.
#[test]
fn messages_of_ros_are_paths() {
    let Files { folder, robot, path, scene } = &files("robot-ros");
    let seconds = ask(&[robot, "--path", path, "--scene", scene]);
    for (sec, nanosec) in [("sec", "nanosec"), ("secs", "nsecs")] {
        let message = format!(
            r#"{{"header": {{"stamp": {{"{sec}": 7}}, "frame_id": "foot"}}, "joint_names": ["shoulder"], "points": [
              {{"positions": [0], "velocities": [], "effort": [], "time_from_start": {{"{sec}": 0, "{nanosec}": 1000000000}}}},
              {{"positions": [1.6], "time_from_start": {{"{sec}": 2, "{nanosec}": 1000000000}}}}]}}"#
        );
        let message = folder.file("message.json", &message);
        assert_eq!(ask(&[robot, "--path", &message, "--scene", scene]), seconds);
    }
    let with = |time: &str, word: &str| {
        let file = folder.file("time.json", &PATH.replace(": 3}", &format!(": {time}}}")));
        refused(&["robot", robot, "--path", &file], &["time.json", word]);
    };
    for time in [
        r#"{"sec": 3}"#,
        r#"{"sec": 3, "nanos": 0}"#,
        r#"{"sec": 3, "secs": 3}"#,
        r#"{"sec": 3, "nanosec": NaN}"#,
    ] {
        with(time, "points[1], time_from_start: {\"");
        with(time, "is not {\"sec\", \"nanosec\"} with numbers");
    }
    with(r#"{"sec": 3, "nanosec": NaN}"#, r#"{"nanosec":"NaN","sec":3} is not"#);
    with(r#"{"sec": 3, "nanosec": 0.5}"#, "invalid type: floating point");
    with("\"3\"", "points[1], time_from_start: \"3\" is not a finite number");
}

/// A path of which nothing is checked is free, and that says nothing.
#[test]
fn what_was_checked_is_said() {
    let Files { folder, robot, path, .. } = &files("robot-checked");
    let disabled = r#"<robot name="three"><disable_collisions link1="foot" link2="lower"/></robot>"#;
    let srdf = folder.file("all.srdf", disabled);
    let output = d2m(&["robot", robot, "--path", path, "--srdf", &srdf]);
    let warnings = stderr(&output);
    assert!(warnings.contains("warning: of 3 bodies no pair is checked"), "{warnings}");
    assert!(warnings.contains("all.srdf: it is of the robot \"three\", not of \"two\""), "{warnings}");
    assert_eq!(ask(&[robot, "--path", path, "--srdf", &srdf])["pairs_checked"], 0);
    assert_eq!(ask(&[robot, "--path", path])["pairs_checked"], 1);
}

#[test]
fn bad_input_is_one_line_with_its_place() {
    let Files { folder, robot, path, scene } = &files("robot-bad");
    let file = |name: &str, text: &str| folder.file(name, text);
    let with_path =
        |text: &str, words: &[&str]| refused(&["robot", robot, "--path", &file("p.json", text)], words);
    with_path(&PATH.replace("shoulder", "knee"), &["p.json", "joint_names[0]", "\"knee\" is no joint"]);
    with_path(
        &PATH.replace(": 3}", ": 1}"),
        &["p.json", "points[1], time_from_start: 1.0 does not come after 1.0"],
    );
    with_path(&PATH.replace("[1.6]", "[NaN]"), &["p.json", "NaN"]);
    with_path(&PATH.replace("\"points\"", "\"way\""), &["p.json", "unknown field `way`"]);
    with_path(
        &PATH.replace("\"points\"", "\"interpolation\": \"quintic\", \"points\""),
        &["points[0], velocities"],
    );
    let with_scene = |text: &str, words: &[&str]| {
        refused(&["robot", robot, "--path", path, "--scene", &file("s.json", text)], words);
    };
    with_scene(
        &SCENE.replace("\"lower\"", "\"hand\""),
        &["s.json, body 1 (\"grasped\")", "\"hand\", which is no link"],
    );
    with_scene(
        &SCENE.replace("\"post\"", "\"upper\""),
        &["s.json, body 0 (\"upper\")", "a link of the robot has this name"],
    );
    with_scene(&SCENE.replace("\"pose\"", "\"place\""), &["unknown key \"place\""]);
    with_scene(
        &SCENE.replace("\"bodies\"", "\"ignore\": [[\"post\", \"tail\"]], \"bodies\""),
        &["ignore 0", "\"tail\""],
    );
    with_scene(
        &SCENE.replace(
            "\"pose\": {\"x\": [0, 0.8, 0]}",
            "\"motion\": {\"times\": [0, 2], \"poses\": [{}, {}]}",
        ),
        &["body 0 (\"post\")", "2"],
    );
    let with_robot = |text: &str, words: &[&str]| {
        refused(&["robot", &file("r.urdf", text), "--path", path, "--scene", scene], words);
    };
    with_robot(
        "<robot name=\"x\"><link name=\"a\"/></robot>",
        &["r.urdf", "none of the 1 links has collision geometry"],
    );
    let mesh = ARM.replace("<box size=\"0.2 0.2 0.2\"/>", "<mesh filename=\"package://arm/foot.stl\"/>");
    with_robot(&mesh, &["r.urdf, line 2", "link \"foot\"", "--package arm=DIR"]);
    with_robot(
        &ARM.replace("continuous", "ball"),
        &["r.urdf, line 7", "joint \"elbow\" has the unknown type"],
    );
    refused(&["robot", robot, "--path", path, "--package", "arm"], &["--package", "\"arm\" is not NAME=DIR"]);
    refused(&["robot", robot, "--path", path, "--min-separation", "-1"], &["--min-separation", "-1"]);
    refused(&["robot", "no.urdf", "--path", path], &["no.urdf"]);
    refused(&["robot", robot, "--path", path, "--srdf", "no.srdf"], &["no.srdf"]);
}

/// The page of a path shows each body of robot and scene, and calls clear what is proven free.
#[test]
fn a_path_can_be_seen() {
    let Files { folder, robot, path, scene } = &files("robot-view");
    let page = folder.path("path.html");
    let found = ask(&[robot, "--path", path, "--scene", scene, "--view", &page]);
    let html = std::fs::read_to_string(&page).unwrap();
    let data = html.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next()).unwrap();
    let shown: Value = serde_json::from_str(data).unwrap();
    let names: Vec<&str> =
        shown["bodies"].as_array().unwrap().iter().map(|body| body["name"].as_str().unwrap()).collect();
    for name in ["foot", "upper", "lower", "post", "grasped"] {
        assert!(names.contains(&name), "{name} of {names:?}");
    }
    assert_eq!((&shown["up"], &shown["window"]), (&"z".into(), &serde_json::json!([1.0, 3.0])));
    let clear = shown["spans"].as_array().unwrap().iter().find(|span| span["status"] == "clear").unwrap();
    assert_eq!((&clear["from"], &clear["to"]), (&serde_json::json!(1.0), &found["free_until"]));
    assert_eq!(shown["marks"].as_array().unwrap().len(), 1);
    refused(&["robot", robot, "--path", path, "--view", robot], &["arm.urdf", "would be overwritten"]);
    refused(&["robot", robot, "--path", path, "--view", "-"], &["--view"]);
}

/// What ends at its start is certified at no time.
#[test]
fn nothing_is_called_free_at_the_start() {
    let Files { folder, robot, path, .. } = &files("robot-start");
    let at = |more: &str| {
        let scene = format!(
            r#"{{"bodies": [{{"name": "post", "mesh": "shape:box?x=0.05&y=0.05&z=1", "pose": {{"x": [0.25, 0, 0]}}}}]{more}}}"#
        );
        folder.file("scene.json", &scene)
    };
    let said = |scene: &str, limit: &[&str]| {
        stdout(&d2m(&[&["robot", robot, "--path", path, "--scene", scene], limit].concat()))
    };
    let met = said(&at(r#", "min_separation": 0.01"#), &[]);
    assert!(
        met.starts_with("CONTACT") && met.contains("in contact from the start of the path: overlapping"),
        "{met}"
    );
    let open = said(&at(r#", "start": "leave""#), &["--time-limit", "1e-9"]);
    assert!(open.starts_with("UNDECIDED from the start: "), "{open}");
    for text in [met, open] {
        assert!(!text.contains("free from") && !text.contains("further apart"), "{text}");
    }
}
