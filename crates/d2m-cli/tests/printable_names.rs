//! Names hold what they like: in text they begin no line and tell the terminal nothing, in JSON they stay as they are.

mod shell;

use serde_json::Value;
use shell::{Folder, UNIT_BOX, d2m, stderr, stdout};

const ODD: [&str; 2] = ["a\nSEPARATED\u{1b}[31m", "b\r\t\u{7f}\u{9b}2J"];
const PLAIN: [&str; 2] = ["a", "b"];

fn answered(arguments: &[&str]) -> String {
    let output = d2m(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    for text in [stdout(&output), stderr(&output)] {
        let is_odd = |c: char| c.is_control() && c != '\n';
        assert!(!text.contains(is_odd), "{arguments:?}: {text:?}");
    }
    stdout(&output)
}

#[test]
fn names_begin_no_line_and_tell_the_terminal_nothing() {
    let folder = Folder::new("odd-names");
    let two = |[a, b]: [&str; 2], start: &str| {
        let bodies = serde_json::json!([
            { "name": a, "mesh": UNIT_BOX, "motion": { "x": [-3, 0, 0], "v": [4, 0, 0] } },
            { "name": b, "mesh": UNIT_BOX }]);
        serde_json::json!({ "bodies": bodies, "start": start }).to_string()
    };
    let leaving = |names: [&str; 2]| two(names, "leave").replace("-3", "1.5");
    let robot = r#"<robot name="r"><link name="w"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
        <link name="m"/><joint name="j" type="prismatic"><parent link="w"/><child link="m"/></joint></robot>"#;
    let robot = folder.file("r.urdf", robot);
    let point = |x: f64| format!(r#"{{"positions": [{x}], "time_from_start": {x}}}"#);
    let path = folder.file(
        "path.json",
        &format!(r#"{{"joint_names": ["j"], "points": [{}, {}]}}"#, point(0.0), point(1.0)),
    );
    let attached = |[a, b]: [&str; 2], x: f64| {
        let bodies = serde_json::json!([
            { "name": a, "mesh": UNIT_BOX, "attach": "m", "pose": { "x": [5, 0, 0] } },
            { "name": b, "mesh": UNIT_BOX, "pose": { "x": [x, 0, 0] } }]);
        serde_json::json!({ "bodies": bodies }).to_string()
    };
    let all = |names: [&str; 2]| -> Vec<String> {
        let [meeting, leaving, far, near] = [
            ("meeting.json", two(names, "report")),
            ("leaving.json", leaving(names)),
            ("far.json", attached(names, 9.0)),
            ("near.json", attached(names, 7.5)),
        ]
        .map(|(file, text)| folder.file(file, &text));
        let of_path = |scene: &str, more: &[&str]| {
            answered(&[&["robot", &robot, "--path", &path, "--scene", scene], more].concat())
        };
        vec![
            answered(&["scene", &meeting]),
            answered(&["scene", &meeting, "--first", "--verify"]),
            answered(&["scene", &leaving]),
            answered(&["spans", &meeting]),
            answered(&["clearance", &meeting, "--below", "9"]),
            of_path(&far, &["--clearance", "--verify"]),
            of_path(&near, &["--verify"]),
        ]
    };
    for (odd, plain) in all(ODD).iter().zip(all(PLAIN)) {
        assert_eq!(odd.lines().count(), plain.lines().count(), "{odd}");
        assert!(odd.contains(r"a\nSEPARATED\u{1b}[31m") && odd.contains(r"b\r\t\u{7f}\u{9b}2J"), "{odd}");
    }
    let meeting = folder.file("meeting.json", &two(ODD, "report"));
    let found: Value = serde_json::from_str(&stdout(&d2m(&["scene", &meeting, "--json"]))).unwrap();
    let names: Vec<&str> = ["a", "b"].map(|key| found["contacts"][0][key].as_str().unwrap()).to_vec();
    assert!(names == ODD || names == [ODD[1], ODD[0]], "{names:?}");
}

/// Where files may be called so.
#[cfg(unix)]
#[test]
fn names_of_files_begin_no_line() {
    let folder = Folder::new("odd-files");
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let mesh = folder.file("n\nv 9 9 9\u{1b}[2J.obj", obj);
    let out = folder.path("out.obj");
    let of_file = answered(&["info", &mesh, "--obj", &out]);
    let copy = std::fs::read_to_string(&out).unwrap();
    assert!(
        copy.starts_with('#') && copy.lines().filter(|line| line.starts_with("v ")).count() == 4,
        "{copy}"
    );
    let again = answered(&["info", &out]);
    assert_eq!(again.lines().skip(1).collect::<Vec<_>>(), of_file.lines().skip(1).collect::<Vec<_>>());
    for text in [answered(&["toc", &mesh, UNIT_BOX]), answered(&["distance", UNIT_BOX, &mesh])] {
        assert!(text.contains(r"n\nv 9 9 9\u{1b}[2J.obj"), "{text}");
    }
    let fault = d2m(&["info", &folder.path("no\nsuch.obj")]);
    assert!(fault.status.code() == Some(3) && stderr(&fault).lines().count() == 1, "{}", stderr(&fault));
}
