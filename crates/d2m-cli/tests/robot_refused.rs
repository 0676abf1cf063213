//! Robots, paths and scenes that `d2m robot` reads in any form, or refuses in one line with the place.

mod robot_case;
mod shell;

use robot_case::{CUBE, Case, path, slide, wall};
use shell::{d2m, refused, stderr, stdout};

#[test]
fn texts_of_every_kind_are_read_or_refused_by_line() {
    let case = Case::new("robot-files-texts");
    let plain = slide(CUBE, "");
    let commented = plain.replace("<link name=\"m\">", "<!-- <link name=\"x\"> --><link name=\"m\">");
    let texts = [
        format!("\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- ä -->\n{plain}")
            .replace('\n', "\r\n"),
        format!("<?xml version='1.0'?>\n<!DOCTYPE robot>\n{commented}"),
        plain.replace("<robot name=\"slide\">", "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"),
    ];
    for text in texts {
        case.meets(&text, &format!("\u{feff}{}", path("4").replace(", ", ",\r\n")), &wall(3.0), 0.5);
    }
    let wide: Vec<u8> =
        std::iter::once(0xfeff).chain(plain.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let arguments = case.arguments(&plain, &path("4"), None);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    std::fs::write(case.folder.path("r.urdf"), wide).unwrap();
    assert_eq!(d2m(&arguments).status.code(), Some(0));
    std::fs::write(case.folder.path("r.urdf"), b"<robot>\n<!-- \xe4 -->\n</robot>").unwrap();
    refused(&arguments, &["r.urdf, line 2", "0xe4"]);
    let with = |from: &str, to: &str| plain.replacen(from, to, 1);
    for (text, words) in [
        (
            with("<link name=\"m\">", "<link name=\"m\">\n<xacro:block/>"),
            "r.urdf, line 4: an unknown namespace prefix",
        ),
        (
            with("slide\">", "s\" xmlns:xacro=\"http://ros.org/wiki/xacro\">")
                .replace("<geometry>", "<xacro:x/><geometry>"),
            "<xacro:x>: this is a xacro file",
        ),
        (with("1 1 1", "${size} 1 1"), "the size of <box> is \"${size}\""),
        (with("1 1 1", "1,1,1"), "line 3: the size of <box> is \"1,1,1\", not three numbers"),
        (with("1 1 1", "1 1e400 1"), "the size of <box> is \"1e400\""),
        (with("1 1 1", "1 1e200 1"), "link \"m\": vertex 0: coordinate y"),
        (with("<geometry>", "<origin/><origin/><geometry>"), "<collision> has a second <origin>"),
        (with("</geometry>", "<sphere radius=\"1\"/></geometry>"), "<sphere> is a second shape"),
        (with("</geometry>", "</geometry><geometry/>"), "<collision> has a second <geometry>"),
        (with("name=\"m\"", "name=\"world\""), "line 3: a second link has the name \"world\""),
        (
            with("<link name=\"m\">", "<link name=\"lost\"/><link name=\"m\">"),
            "\"world\" and \"lost\" among them",
        ),
        (with("parent link=\"world\"", "parent link=\"m\""), "line 3: the link \"m\" is carried by itself"),
        (with("parent link=\"world\"", "parent link=\"World\""), "the parent \"World\" is no link"),
        (
            with(
                "</joint>",
                "</joint>\n<joint name=\"j\" type=\"fixed\"><parent link=\"m\"/><child link=\"world\"/></joint>",
            ),
            "line 5: a second joint has the name \"j\"",
        ),
        (
            with(
                "</joint>",
                "</joint><joint name=\"i\" type=\"fixed\"><parent link=\"m\"/><child link=\"world\"/></joint>",
            ),
            "there is no root",
        ),
        (
            with(
                "</joint>",
                "</joint><joint name=\"i\" type=\"fixed\"><parent link=\"world\"/><child link=\"m\"/></joint>",
            ),
            "joints \"j\" and \"i\" both carry the link \"m\"",
        ),
        (plain.replace(CUBE, ""), "r.urdf: none of the 2 links has collision geometry"),
        (with("</robot>", ""), "line 1: the root node was opened but never closed"),
        (with("type=\"prismatic\"", "type=\"Prismatic\""), "unknown type \"Prismatic\""),
        (with("</joint>", "<origin rpy=\"1e300 0 0\"/></joint>"), "joint \"j\": rpy[0]: 1e300"),
    ] {
        case.refused(&text, &path("1"), &["r.urdf", words]);
    }
    // Neither deep nor empty files end it.
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(100_000), "</a>".repeat(100_000));
    case.refused(&deep, &path("1"), &["r.urdf: the robot has no link"]);
    case.refused("", &path("1"), &["r.urdf"]);
}

#[test]
fn numbers_of_paths_are_named_by_point_and_joint() {
    let case = Case::new("robot-files-paths");
    let plain = slide(CUBE, "");
    let bad = |from: &str, to: &str, words: &[&str]| {
        let words: Vec<&str> = words.iter().copied().chain(["p.json"]).collect();
        case.refused(&plain, &path("1").replacen(from, to, 1), &words);
    };
    let list = "points[1], positions[0]";
    for word in ["NaN", "-Infinity", "1e999", "null", "\"1\""] {
        bad("[1]", &format!("[{word}]"), &[list, word, "not a finite number (joint \"j\")"]);
    }
    bad("\"time_from_start\": 1", "\"time_from_start\": NaN", &["points[1], time_from_start: NaN"]);
    bad(
        "\"time_from_start\": 1",
        "\"time_from_start\": {\"sec\": 1}",
        &["points[1], time_from_start: {\"sec\":1}"],
    );
    bad(
        "\"time_from_start\": 1",
        "\"time_from_start\": 0",
        &["points[1], time_from_start: 0.0 does not come after 0.0"],
    );
    bad(
        "\"time_from_start\": 1",
        "\"time_from_start\": -1",
        &["points[1], time_from_start: -1.0 does not come after"],
    );
    bad("\"time_from_start\": 1", "\"time_from_start\": 1e-320", &["joint \"j\"", "1e-320"]);
    bad("[1]", "[1], \"velocities\": [NaN]", &["points[1], velocities[0]: NaN"]);
    bad("[1]", "[]", &["points[1], positions: 0 numbers for 1 joints"]);
    bad("[1]", "[1, 2]", &["points[1], positions: 2 numbers for 1 joints"]);
    bad("[\"j\"]", "[\"j\", \"j\"]", &["joint_names[1]: \"j\" is named twice"]);
    bad("[\"j\"]", "[\"J\"]", &["joint_names[0]: \"J\" is no joint of the robot (j)"]);
    bad("[\"j\"]", "[]", &["joint_names"]);
    bad("\"points\"", "\"interpolation\": \"spline\", \"points\"", &["`spline`"]);
    bad("\"points\"", "\"interpolation\": \"cubic\", \"points\"", &["points[0], velocities: 0 numbers"]);
    for (text, words) in [
        ("", "the file is empty"),
        ("{}", "missing field `joint_names`"),
        ("{\"joint_names\": [\"j\"], \"points\": []}", "points: 0 of them"),
        (
            "{\"joint_names\": [\"j\"], \"points\": [{\"positions\": [0], \"time_from_start\": 0}]}",
            "points: 1 of them",
        ),
        ("{\"joint_names\": [\"j\"], \"points\": [{\"positions\": [0 \"", "p.json"),
    ] {
        case.refused(&plain, text, &["p.json", words]);
    }
}

#[test]
fn what_lies_around_the_robot_is_named_too() {
    let case = Case::new("robot-files-around");
    let plain = slide(CUBE, "");
    let srdf = |text: &str| {
        let mut arguments = case.arguments(&plain, &path("4"), Some(&wall(3.0)));
        arguments.extend(["--srdf".to_owned(), case.folder.file("r.srdf", text)]);
        arguments
    };
    // Of links that the robot does not have it is said so; the rest holds.
    let arguments =
        srdf("<robot name=\"x\">\n<disable_collisions link1=\"m\" link2=\"hand\" reason=\"Never\"/></robot>");
    let output = d2m(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(
        stderr(&output).contains("r.srdf, line 2: the robot has no link \"hand\""),
        "{}",
        stderr(&output)
    );
    assert!(stdout(&output).contains("\"contact\""));
    for (text, words) in [
        ("", "r.srdf, line 1"),
        (
            "<robot><disable_collisions link1=\"m\"/></robot>",
            "r.srdf, line 1: <disable_collisions> has no link2",
        ),
        ("<robott/>", "<robott> where <robot> is expected"),
    ] {
        let arguments = srdf(text);
        refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), &[words]);
    }
    // Obstacles with motions of their own cover the path's time.
    let flying = |times: &str| {
        format!(
            r#"{{"bodies": [{{"name": "wall", "mesh": "shape:box?x=0.5&y=5&z=5", "motion": {{"times": {times}, "poses": [{{"x": [5, 0, 0]}}, {{"x": [3, 0, 0]}}]}}}}]}}"#
        )
    };
    // Its near side is at 4.5 − 2t, the cube's at 0.5 + 2t.
    case.meets(&plain, &path("2"), &flying("[0, 1]"), 1.0);
    case.meets(&plain, &path("4"), &flying("[0, 1]"), 4.0 / 6.0);
    for times in ["[0, 0.5]", "[0.25, 2]", "[3, 4]"] {
        let arguments = case.arguments(&plain, &path("4"), Some(&flying(times)));
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        refused(&arguments, &["s.json, body 0 (\"wall\"), motion", "not the whole window from 0.0 to 1.0"]);
    }
    // Sizes from the smallest to the largest that there are end nothing.
    for radius in ["1e-320", "1e-200", "1e50", "1.7e308"] {
        let link = format!("<collision><geometry><sphere radius=\"{radius}\"/></geometry></collision>");
        let (found, _) = case.ask(&slide(&link, ""), &path("4"), &wall(3.0));
        assert_ne!(
            found["status"],
            if radius.starts_with("1e-") { "undecided" } else { "free" },
            "{radius}: {found}"
        );
    }
}
