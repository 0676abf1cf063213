//! `d2m scene` as scripts see it.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};

fn example(name: &str) -> String {
    format!("{}/../../docs/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_example_scenes_are_answered_the_same_at_any_number_of_threads() {
    for (name, expected) in
        [("robot-arm", "tool post"), ("conveyor", "gate long crate"), ("stones", "body 25 body 49")]
    {
        let scene = example(name);
        let all = d2m(&["scene", &scene, "--json", "--threads", "1"]);
        assert_eq!(all.status.code(), Some(0), "{}", stderr(&all));
        assert!(stderr(&all).is_empty(), "an example needs no warning: {}", stderr(&all));
        assert_eq!(stdout(&d2m(&["scene", &scene, "--json", "--threads", "3"])), stdout(&all));
        let all: Value = serde_json::from_str(&stdout(&all)).unwrap();
        let first = d2m(&["scene", &scene, "--json", "--first", "--exit-status"]);
        assert_eq!(first.status.code(), Some(10), "{}", stderr(&first));
        let first: Value = serde_json::from_str(&stdout(&first)).unwrap();
        assert_eq!(first["window"], all["window"]);
        let [all, first] = [all, first].map(|answer| answer["contacts"].as_array().unwrap().clone());
        let times: Vec<f64> = all.iter().map(|contact| contact["toc"].as_f64().unwrap()).collect();
        assert!(times.is_sorted());
        let pair = |contact: &Value| {
            format!("{} {}", contact["a"].as_str().unwrap(), contact["b"].as_str().unwrap())
        };
        assert_eq!((pair(&all[0]).as_str(), pair(&first[0]).as_str()), (expected, expected));
        let keys = [
            "a",
            "b",
            "status",
            "toc",
            "toc_hi",
            "separation",
            "tolerance",
            "evidence",
            "normal",
            "point",
            "feature",
            "triangle_a",
            "triangle_b",
        ];
        for contact in all.iter().chain(&first) {
            assert!(keys.iter().all(|key| !contact[key].is_null()), "{contact}");
            assert!(contact["toc"].as_f64() <= contact["toc_hi"].as_f64());
        }
    }
}

#[test]
fn bad_scenes_are_refused_with_their_place() {
    let folder = Folder::new("bad-scenes");
    let twice = r#"{"bodies": [{"name": "a", "mesh": "shape:box"}, {"name": "a", "mesh": "shape:box"}]}"#;
    let scene = folder.file("twice.json", twice);
    refused(&["scene", &scene], &["twice.json, body 1", "\"a\""]);
    refused(&["scene", "none.json"], &["none.json"]);
    let alone = folder.file("alone.json", r#"{"bodies": [{"name": "a", "mesh": "shape:box"}]}"#);
    let answer = d2m(&["scene", &alone, "--exit-status"]);
    assert_eq!(answer.status.code(), Some(11));
    assert!(stdout(&answer).starts_with("SEPARATED"), "{}", stdout(&answer));
}

/// That no two bodies meet of which all are ignored is no proof of anything, and is said.
#[test]
fn a_scene_of_which_no_pair_is_checked_is_warned_of() {
    let folder = Folder::new("no-pairs");
    let scene = |ignored: &str| {
        let bodies = r#"{"name": "a", "mesh": "shape:box"}, {"name": "b", "mesh": "shape:box"}"#;
        folder.file("scene.json", &format!(r#"{{"bodies": [{bodies}], "ignore": [{ignored}]}}"#))
    };
    for command in ["scene", "clearance", "spans"] {
        let run = d2m(&[command, &scene(r#"["a", "b"]"#)]);
        assert!(stderr(&run).contains("of 2 bodies no pair is checked"), "{command}: {}", stderr(&run));
        assert!(stderr(&d2m(&[command, &scene("")])).is_empty());
    }
}
