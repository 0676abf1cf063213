use super::*;
use std::fs;

/// Writes a scene and reads it.
fn read_text(name: &str, text: &str) -> Result<Scene, String> {
    let folder = std::env::temp_dir().join(format!("d2m-scene-tests-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    let scene = Scene::read(&path).map_err(|failure| failure.to_string());
    fs::remove_file(&path).unwrap();
    scene
}

#[test]
fn every_key_is_read() {
    let text = r#"{"window": [0.5, 2], "min_separation": 0.25, "tolerance": 1e-6, "bodies": [
        {"name": "a", "mesh": "shape:box?x=1&y=1&z=1", "scale": [1, 2, 0.5], "group": "g", "solid": false},
        {"name": "b", "mesh": "shape:box?x=1&y=1&z=1", "motion": {"x": [9, 0, 0], "v": [-1, 0, 0]}},
        {"name": "c", "mesh": "shape:box?x=1&y=1&z=1", "group": "g",
         "motion": {"times": [0, 3], "poses": [{}, {"x": [1, 0, 0]}]}}],
        "ignore": [["a", "b"], ["g", "g"], ["b", "g"]]}"#;
    let scene = read_text("all.json", text).unwrap();
    assert_eq!((scene.window.start(), scene.window.end(), scene.min_separation), (0.5, 2.0, 0.25));
    assert_eq!(scene.bodies[0].tree.mesh().vertices()[7].abs(), glam::DVec3::new(1.0, 2.0, 0.5));
    assert!(std::sync::Arc::ptr_eq(&scene.bodies[1].tree, &scene.bodies[2].tree));
    let expected = [
        Ignored::Pair(0, 1),
        Ignored::Groups("g".to_owned(), "g".to_owned()),
        Ignored::BodyAndGroup(1, "g".to_owned()),
    ];
    assert_eq!(scene.ignored, expected);
    assert!(scene.world(QueryOptions::default()).candidates(scene.window).unwrap().is_empty());
}

#[test]
fn faults_name_file_place_and_value() {
    let body = r#"{"name": "a", "mesh": "shape:box"}"#;
    let cases = [
        (format!(r#"{{"bodies": [{body}], "colour": 1}}"#), "unknown field `colour`"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "colour": 1}]}"#.to_owned(), "body 0 (\"a\"): unknown field `colour`"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box",
 "mesh": "shape:torus"}]}"#.to_owned(), "duplicate field `mesh` at line 2"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "motion": {"v": [1, 0, 0], "v": [0, 1, 0]}}]}"#.to_owned(), "duplicate field `v` at line 1"),
        (format!(r#"{{"bodies": [{body}], "bodies": []}}"#), "duplicate field `bodies`"),
        (format!(r#"{{"bodies": [{body}, {body}]}}"#), "body 1: the name \"a\" is that of body 0 too"),
        (r#"{"bodies": [{"mesh": "shape:box"}]}"#.to_owned(), "body 0: missing field `name`"),
        (r#"{"bodies": [{"name": "a", "mesh": "none.obj"}]}"#.to_owned(), "none.obj"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "scale": 0}]}"#.to_owned(), "body 0 (\"a\"), scale: 0 has to be"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "scale": [1, 2]}]}"#.to_owned(), "scale: [1,2] is neither"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "motion": {"y": 1}}]}"#.to_owned(), "body 0 (\"a\"), motion: unknown field `y`"),
        (r#"{"bodies": [{"name": "a", "mesh": "shape:box", "motion": {"times": [0, 0.5], "poses": [{}, {}]}}]}"#.to_owned(), "covers the times from 0.0 to 0.5"),
        (format!(r#"{{"bodies": [{body}], "window": [1, 0]}}"#), "window: time window [1.0, 0.0]"),
        (format!(r#"{{"bodies": [{body}], "min_separation": -1}}"#), "min_separation: -1.0 is not"),
        (format!(r#"{{"bodies": [{body}], "tolerance": 0}}"#), "tolerance: 0.0 is not"),
        (format!(r#"{{"bodies": [{body}], "ignore": [["a", "z"]]}}"#), "ignore 0: \"z\" is the name of no body"),
        (format!(r#"{{"bodies": [{body}], "ignore": [["a"]]}}"#), "ignore 0: [\"a\"] is not a pair"),
        (format!(r#"{{"bodies": [{body}], "window": [0, 1e999]}}"#), "number out of range at line 1"),
        ("{".to_owned(), "line 1"),
    ];
    for (index, (text, expected)) in cases.iter().enumerate() {
        let name = format!("bad-{index}.json");
        let fault = read_text(&name, text).err().unwrap_or_else(|| panic!("{text} was read"));
        assert!(fault.contains(expected) && fault.contains(&name), "{fault}\n{expected}");
    }
}
