//! `d2m distance`, `d2m collide`, `d2m proximities` and `d2m tree`, and what the exit code says.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};
use std::fs;

const UNIT_BOX: &str = "shape:box?x=1&y=1&z=1";

fn json(arguments: &[&str]) -> Value {
    let output = d2m(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Two boxes of half size 1, three apart along an axis that a quarter turn maps from x to z.
const TURNED: &str = "x=0,0,5;q=0.7071067811865476,0,0.7071067811865475,0";

#[test]
fn distances_come_with_witnesses_and_an_interval() {
    let apart = ["distance", UNIT_BOX, UNIT_BOX, "--pose-b", TURNED];
    let value = json(&[&apart[..], &["--json"]].concat());
    assert_eq!((&value["status"], &value["state"]), (&"separated".into(), &"apart".into()));
    let [lower, distance, upper] = ["lower", "distance", "upper"].map(|key| number(&value[key]));
    assert!(lower <= distance && distance <= upper && upper - lower < 1e-11, "{value}");
    assert!((distance - 3.0).abs() < 1e-12, "{value}");
    assert!((number(&value["normal"][2]) - 1.0).abs() < 1e-12, "{value}");
    assert!((number(&value["point_a"][2]) - 1.0).abs() < 1e-12, "{value}");
    assert!((number(&value["point_b"][2]) - 4.0).abs() < 1e-12, "{value}");
    for key in ["barycentric_a", "barycentric_b"] {
        let sum: f64 = value[key].as_array().unwrap().iter().map(number).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{key}: {value}");
    }
    assert!(number(&value["triangle_a"]) < 12.0 && number(&value["triangle_b"]) < 12.0);
    assert_eq!(value["solid"], true);
    let text = stdout(&d2m(&apart));
    assert!(text.starts_with("DISTANCE 3.00000") || text.starts_with("DISTANCE 2.99999"), "{text}");
    assert!(text.contains("from A to B") && text.contains("filled solids"), "{text}");

    // A small box inside: solids are in contact, surfaces are not.
    let inside = ["distance", "shape:box?x=1&y=1&z=1&scale=0.25", UNIT_BOX, "--json"];
    let value = json(&inside);
    assert_eq!(
        (&value["status"], &value["state"], number(&value["distance"])),
        (&"contact".into(), &"contained".into(), 0.0)
    );
    let value = json(&[&inside[..], &["--surface"]].concat());
    assert!(value["status"] == "separated" && (number(&value["distance"]) - 0.75).abs() < 0.75, "{value}");
    let value = json(&["distance", UNIT_BOX, UNIT_BOX, "--pose-a", "x=0.5,0,0", "--json"]);
    assert_eq!((&value["status"], &value["state"]), (&"contact".into(), &"overlapping".into()));
}

/// A sheet is in the solid that holds it for every command, whichever of them comes first; a mesh that is open holds nothing.
#[test]
fn a_sheet_in_a_solid_is_in_it() {
    let folder = Folder::new("sheet-in-solid");
    let sheet = folder.file("sheet.obj", "v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nf 1 2 3\n");
    let lid = folder.file("open.obj", "v -9 -9 1\nv 9 -9 1\nv 0 9 1\nv 0 0 -9\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    for (holder, is_held) in [(UNIT_BOX, true), (&lid, false)] {
        for pair in [[holder, &sheet], [&sheet, holder]] {
            for command in ["toc", "distance", "collide"] {
                let value = json(&[command, pair[0], pair[1], "--json"]);
                assert_eq!(value["status"] == "contact", is_held, "{command} {pair:?}: {value}");
                assert_eq!(value["solids"], serde_json::json!(pair.map(|name| name == UNIT_BOX)), "{value}");
            }
            let distance = json(&["distance", pair[0], pair[1], "--json"]);
            assert_eq!(number(&distance["lower"]) == 0.0, is_held, "{distance}");
            let surfaces = json(&["collide", pair[0], pair[1], "--surface", "--json"]);
            assert_eq!(surfaces["status"], "separated", "{surfaces}");
        }
    }
    let text = stdout(&d2m(&["collide", &sheet, UNIT_BOX]));
    assert!(text.contains("surface of A, filled solid B"), "{text}");
}

#[test]
fn collide_names_triangles_or_containment() {
    let value = json(&["collide", UNIT_BOX, UNIT_BOX, "--pose-a", "x=0.5,0.1,0.2", "--json"]);
    assert_eq!((&value["status"], &value["contained"]), (&"contact".into(), &false.into()));
    assert!(number(&value["triangle_a"]) < 12.0 && number(&value["triangle_b"]) < 12.0);
    let value = json(&["collide", UNIT_BOX, UNIT_BOX, "--pose-a", TURNED, "--json"]);
    assert_eq!((&value["status"], &value["triangle_a"]), (&"separated".into(), &Value::Null));
    let inside = ["collide", "shape:box?x=1&y=1&z=1&scale=0.25", UNIT_BOX];
    let value = json(&[&inside[..], &["--json"]].concat());
    assert_eq!((&value["status"], &value["contained"]), (&"contact".into(), &true.into()));
    assert!(stdout(&d2m(&[&inside[..], &["--surface"]].concat())).starts_with("SEPARATED"));
    assert!(stdout(&d2m(&inside)).contains("one body is inside the other"));
}

/// A box of half size 1 that stands 0.25 above another one, turned by a little about the vertical axis.
const ABOVE: &str = "x=0,0,2.25;q=0.9,0,0,0.2";

#[test]
fn proximities_are_the_corners_of_the_patch() {
    let near = ["proximities", UNIT_BOX, UNIT_BOX, "--pose-b", ABOVE, "--margin", "0.5"];
    let value = json(&[&near[..], &["--json"]].concat());
    let all = value["proximities"].as_array().unwrap();
    assert_eq!((&value["status"], number(&value["margin"])), (&"separated".into(), 0.5));
    assert_eq!(number(&value["found"]), all.len() as f64);
    // Eight crossings of sides, and those of diagonals.
    assert!(all.len() >= 8, "{value}");
    for proximity in all {
        assert!((number(&proximity["distance"]) - 0.25).abs() < 1e-12, "{proximity}");
        assert!((number(&proximity["normal"][2]) - 1.0).abs() < 1e-12, "{proximity}");
        assert!((number(&proximity["point_a"][2]) - 1.0).abs() < 1e-12, "{proximity}");
        assert!((number(&proximity["point_b"][2]) - 1.25).abs() < 1e-12, "{proximity}");
        assert!(number(&proximity["triangle_a"]) < 12.0 && number(&proximity["triangle_b"]) < 12.0);
        assert!(proximity["feature"].as_str().unwrap().contains(':') && number(&proximity["tilt"]) == 0.0);
    }
    let reduced = json(&[&near[..], &["--reduce", "--json"]].concat());
    let kept = reduced["proximities"].as_array().unwrap();
    assert_eq!((kept.len(), &reduced["found"]), (4, &value["found"]));
    assert!(kept.iter().all(|proximity| all.contains(proximity)));
    assert_eq!(
        json(&[&near[..], &["--reduce", "0.2", "--json"]].concat())["proximities"],
        reduced["proximities"]
    );
    let text = stdout(&d2m(&[&near[..], &["--reduce"]].concat()));
    assert!(text.starts_with(&format!("4 of {} within 0.5", all.len())), "{text}");
    assert!(
        text.contains("normal (0.000000000, 0.000000000, 1.000000000)") && text.contains("12 triangles"),
        "{text}"
    );
    // A margin below the distance leaves nothing; bodies that meet have no closest features.
    let none = json(&["proximities", UNIT_BOX, UNIT_BOX, "--pose-b", ABOVE, "--margin", "0.2", "--json"]);
    assert_eq!((&none["status"], &none["found"]), (&"separated".into(), &0.into()));
    let met = ["proximities", UNIT_BOX, UNIT_BOX, "--pose-b", "x=0.5,0.25,0.1", "--margin", "1"];
    let value = json(&[&met[..], &["--json"]].concat());
    assert_eq!((&value["status"], &value["found"]), (&"contact".into(), &Value::Null));
    assert!(stdout(&d2m(&met)).starts_with("CONTACT"));
    // A tilted card: one corner is closest, the slack of the cones lets its neighbors in.
    let tilted = [
        "proximities",
        UNIT_BOX,
        UNIT_BOX,
        "--pose-b",
        "x=0,0,2.5;q=1,0.01,0.02,0",
        "--margin",
        "1",
        "--json",
    ];
    let (few, more) = (json(&tilted), json(&[&tilted[..], &["--cone-slack", "0.1"]].concat()));
    assert!(number(&few["found"]) < number(&more["found"]), "{few} {more}");
}

#[test]
fn margins_that_are_none_are_refused() {
    let base = ["proximities", UNIT_BOX, UNIT_BOX, "--pose-b", ABOVE];
    for (options, words) in [
        (&["--margin", "-1"][..], "--margin: -1 is not a distance"),
        (&["--margin", "nan"], "--margin"),
        (&["--margin", "wide"], "\"wide\" is not a number"),
        (&["--margin", "1", "--cone-slack", "-0.5"], "--cone-slack"),
        (&["--margin", "1", "--reduce=inf"], "--reduce"),
        (&["--margin", "1", "--pose-a", "v=1,0,0"], "a pose has x, q and at"),
    ] {
        refused(&[&base[..], options].concat(), &[words]);
    }
    assert_eq!(d2m(&base).status.code(), Some(2), "there is no margin to guess");
}

#[test]
fn the_exit_code_says_the_answer_where_it_is_asked_for() {
    let code = |arguments: &[&str]| d2m(arguments).status.code();
    let asked = |arguments: &[&str]| code(&[arguments, &["--exit-status"]].concat());
    for command in ["distance", "collide"] {
        let apart = [command, UNIT_BOX, UNIT_BOX, "--pose-a", "x=9,0,0"];
        let touching = [command, UNIT_BOX, UNIT_BOX, "--pose-a", "x=1,0,0"];
        assert_eq!(
            (code(&apart), asked(&apart), asked(&touching)),
            (Some(0), Some(11), Some(10)),
            "{command}"
        );
    }
    let toc = |motion: &'static str| {
        ["toc", "shape:gear", "shape:pebble", "--motion-a", motion, "--budget", "1000000"]
    };
    let [hit, miss] = [toc("x=-3,0,0;v=4,0,0"), toc("x=-9,0,0;v=-1,0,0")];
    assert_eq!((code(&hit), asked(&hit), asked(&miss)), (Some(0), Some(10), Some(11)));
    let undecided = ["toc", "shape:pebble", "shape:gear", "--motion-a", "x=-3,0,0;v=4,0,0", "--budget", "2"];
    assert_eq!((code(&undecided), asked(&undecided)), (Some(0), Some(12)));
    // Bad usage and bad input stay what they are.
    assert_eq!(asked(&["toc", UNIT_BOX]), Some(2));
    assert_eq!(asked(&["toc", UNIT_BOX, "absent.obj"]), Some(3));
    for command in [
        "toc",
        "batch",
        "features",
        "distance",
        "collide",
        "proximities",
        "scene",
        "simulate",
        "info",
        "tree",
        "view",
    ] {
        let help = stdout(&d2m(&[command, "--help"]));
        assert!(help.contains("Exit codes: 0 "), "{command}: {help}");
    }
}

#[test]
fn poses_that_are_none_are_refused() {
    for (pose, words) in [
        ("x=1,2", "x: expected 3 numbers"),
        ("q=0,0,0,0", "orientation"),
        ("v=1,0,0", "v is [1.0, 0.0, 0.0]"),
        ("x=nan,0,0", "x: nan is not finite"),
        ("y=1,0,0", "y: unknown key"),
        ("x=1e300,0,0", "1e100"),
        ("@absent.json", "absent.json"),
    ] {
        for command in ["distance", "collide"] {
            refused(&[command, UNIT_BOX, UNIT_BOX, "--pose-b", pose], &[words]);
        }
    }
    let folder = Folder::new("poses");
    let file = folder.file("pose.json", r#"{"x": [0, 9, 0], "q": [1, 0, 0, 0]}"#);
    assert!(
        stdout(&d2m(&["collide", UNIT_BOX, UNIT_BOX, "--pose-a", &format!("@{file}")]))
            .starts_with("SEPARATED")
    );
    let file = folder.file("bad.json", r#"{"x": [0, 9, 0], "p": 1}"#);
    refused(&["collide", UNIT_BOX, UNIT_BOX, "--pose-a", &format!("@{file}")], &["bad.json", "`p`"]);
}

#[test]
fn saved_trees_are_meshes_like_any_other() {
    let folder = Folder::new("trees");
    let knot = "shape:torus-knot?triangles=3000";
    let saved = folder.path("knot.d2mtree");
    let output = d2m(&["tree", knot, "--out", &saved]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(output.stdout.is_empty() && stderr(&output).contains("triangles"), "{}", stderr(&output));
    let strip = |mut value: Value| {
        value.as_object_mut().unwrap().remove("microseconds");
        value.as_object_mut().unwrap().remove("name");
        value
    };
    let motion = ["--motion-a", "x=-3,0.1,0;v=4,0,0;w=0,1,2", "--json"];
    for more in [&[][..], &["--mode", "capoeira"], &["--mode", "paper"]] {
        let answer = |mesh: &str| strip(json(&[&["toc", mesh, "shape:gear"], &motion[..], more].concat()));
        assert_eq!(answer(knot), answer(&saved));
    }
    assert_eq!(strip(json(&["info", knot, "--json"])), strip(json(&["info", &saved, "--json"])));
    // A tree of a tree is the same tree.
    let again = folder.path("again.d2mtree");
    assert_eq!(d2m(&["tree", &saved, "--out", &again]).status.code(), Some(0));
    assert_eq!(fs::read(&saved).unwrap(), fs::read(&again).unwrap());

    refused(&["tree", knot, "--out", &folder.path("knot.obj")], &["knot.obj", ".d2mtree"]);
    refused(&["tree", &saved, "--out", &saved], &["knot.d2mtree", "input"]);
    let mut bytes = fs::read(&saved).unwrap();
    let damaged = folder.path("damaged.d2mtree");
    for (length, place, words) in [
        (bytes.len(), 5000, "damaged"),
        (bytes.len() - 1, 5000, "damaged"),
        (20, 19, "bytes"),
        (6, 0, "not a written tree"),
    ] {
        let mut bytes = bytes[..length].to_vec();
        bytes[place] ^= 4;
        fs::write(&damaged, bytes).unwrap();
        refused(&["info", &damaged], &["damaged.d2mtree", words]);
    }
    bytes[8] = 9;
    fs::write(&damaged, &bytes).unwrap();
    refused(&["collide", &damaged, knot], &["damaged.d2mtree", "form 9"]);
}
