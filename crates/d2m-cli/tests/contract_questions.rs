//! Clearances and spans of pairs and of scenes, as the formats state them.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};

const CUBE: &str = "shape:box?x=0.5&y=0.5&z=0.5";

fn ask(arguments: &[&str]) -> Value {
    let run = d2m(arguments);
    assert_eq!(run.status.code(), Some(0), "{arguments:?}: {}", stderr(&run));
    serde_json::from_str(&stdout(&run)).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Flies past a wall at a distance of 0.25, through a gate, and above a floor that is 2 below.
const CELL: &str = r#"{"window": [0, 1], "tolerance": 1e-9, "bodies": [
    {"name": "wall", "mesh": "CUBE", "motion": {"x": [0, 1.25, 0]}},
    {"name": "gate", "mesh": "CUBE", "motion": {"x": [4, 0, 0]}},
    {"name": "floor", "mesh": "shape:box?x=9&y=0.5&z=9", "motion": {"x": [0, -3, 0]}},
    {"name": "tool", "mesh": "CUBE", "motion": {"x": [-4, 0, 0], "v": [16, 0, 0]}}],
    "pairs": [{"a": "tool", "b": "wall", "min_separation": 0.5}], "ignore": [["wall", "floor"], ["gate", "floor"]]}"#;

fn cell(folder: &Folder, name: &str, edits: &[(&str, &str)]) -> String {
    let text = edits.iter().fold(CELL.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    folder.file(name, &text.replace("CUBE", CUBE))
}

#[test]
fn bodies_that_meet_have_no_clearance() {
    // Head on, askew, overlapping at the start, flush at the start, one in the other, and turning in the other.
    for (motion, time) in [
        ("x=-4,0,0;v=8,0,0", 0.375),
        ("x=-4,0.1,0.05;v=8,0,0;w=0.1,0.3,0.2", 0.36),
        ("x=0.2,0,0", 0.0),
        ("x=1,0,0", 0.0),
        ("x=0.2,0.1,0;w=1,2,0", 0.0),
    ] {
        let found = ask(&["clearance", CUBE, CUBE, "--motion-a", motion, "--json"]);
        assert_eq!(found["status"], "contact", "{motion}: {found}");
        assert_eq!(found["clearance"], serde_json::json!([0.0, 0.0]), "{motion}: {found}");
        assert!((number(&found["time"]) - time).abs() < 0.01, "{motion}: {found}");
        let toc = ask(&["toc", CUBE, CUBE, "--motion-a", motion, "--json"]);
        assert!((number(&found["time"]) - number(&toc["toc"])).abs() < 1e-9, "{motion}: {found}");
    }
    let inside = ask(&["clearance", "shape:box?x=0.1&y=0.1&z=0.1", CUBE, "--json"]);
    assert_eq!(
        (&inside["status"], &inside["clearance"]),
        (&"contact".into(), &serde_json::json!([0.0, 0.0]))
    );
}

#[test]
fn the_nearest_pair_of_a_scene() {
    let folder = Folder::new("question-clearance");
    let met = cell(&folder, "met.json", &[]);
    let found = ask(&["clearance", &met, "--json"]);
    assert_eq!(
        (&found["a"], &found["b"], &found["status"]),
        (&"gate".into(), &"tool".into(), &"contact".into())
    );
    assert_eq!(found["clearance"], serde_json::json!([0.0, 0.0]), "{found}");
    assert!((number(&found["time"]) - 7.0 / 16.0).abs() < 1e-6, "{found}");
    // Without the gate the wall is nearest: separations count nothing.
    let past = cell(&folder, "past.json", &[("[4, 0, 0]", "[4, 4, 0]")]);
    let found = ask(&["clearance", &past, "--json", "--below", "2.5", "--accuracy", "1e-8"]);
    assert_eq!(
        (&found["a"], &found["b"], &found["status"]),
        (&"wall".into(), &"tool".into(), &"clear".into())
    );
    let [lo, hi] = [0, 1].map(|k| number(&found["clearance"][k]));
    assert!(lo <= 0.25 && hi >= 0.25 - 1e-12 && hi - lo <= 4e-9, "{found}");
    for key in
        ["time", "point_a", "point_b", "normal", "feature", "triangle_a", "triangle_b", "tolerance", "window"]
    {
        assert!(!found[key].is_null(), "{key}: {found}");
    }
    let pairs = found["pairs"].as_array().unwrap();
    let names: Vec<String> = pairs.iter().map(|pair| format!("{} {}", pair["a"], pair["b"])).collect();
    assert_eq!(names, [r#""wall" "tool""#, r#""floor" "tool""#], "{found}");
    assert!((number(&pairs[1]["clearance"][1]) - 2.0).abs() < 1e-6, "{found}");
    let text = stdout(&d2m(&["clearance", &past, "--below", "2.5", "--exit-status"]));
    assert!(text.starts_with("CLEARANCE wall \u{2013} tool: [0.2"), "{text}");
    assert!(text.contains("2 of all pairs come within 2.5"), "{text}");
    assert_eq!(d2m(&["clearance", &past, "--exit-status"]).status.code(), Some(11));
    let alone = folder.file("alone.json", r#"{"bodies": [{"name": "a", "mesh": "shape:box"}]}"#);
    assert!(ask(&["clearance", &alone, "--json"])["clearance"].is_null());
    for (arguments, words) in [
        (
            &["clearance", &past, "--motion-a", "v=1,0,0"][..],
            &["--motion-a", "the scene says this itself"][..],
        ),
        (&["clearance", &past, "--below=-1"], &["--below", "-1 is not a finite distance"]),
        (&["clearance", &past, "--accuracy", "0"], &["--accuracy", "0 is not a positive finite number"]),
        (&["clearance", CUBE, CUBE, "--below", "1"], &["--below", "it is for scenes"]),
        (&["clearance", CUBE], &[CUBE, "a second mesh is missing"]),
        (&["spans", CUBE], &[CUBE, "a second mesh is missing"]),
        (&["clearance", "none.json"], &["none.json"]),
    ] {
        refused(arguments, words);
    }
    // The usual question has two meshes.
    assert_eq!(d2m(&["toc", CUBE]).status.code(), Some(2));
}

#[test]
fn the_spans_of_a_scene() {
    let folder = Folder::new("question-spans");
    let path = cell(&folder, "cell.json", &[]);
    let found = ask(&["spans", &path, "--json", "--resolution", "1e-4"]);
    assert_eq!((&found["window"], &found["resolution"]), (&serde_json::json!([0.0, 1.0]), &1e-4.into()));
    let pairs = found["pairs"].as_array().unwrap();
    let names: Vec<String> = pairs.iter().map(|pair| format!("{} {}", pair["a"], pair["b"])).collect();
    assert_eq!(names, [r#""wall" "tool""#, r#""gate" "tool""#], "{found}");
    let spans = found["spans"].as_array().unwrap();
    let words: Vec<&str> = spans.iter().map(|span| span["status"].as_str().unwrap()).collect();
    // Within 0.5 of the wall, which is 0.25 from its way, while |x| is below 1 + √3/4; then through the gate.
    assert_eq!(words, ["clear", "contact", "clear", "contact", "clear"], "{found}");
    let reach = 1.0 + 0.1875_f64.sqrt();
    let ends = [(4.0 - reach) / 16.0, (4.0 + reach) / 16.0, 7.0 / 16.0, 9.0 / 16.0];
    for (k, end) in ends.into_iter().enumerate() {
        assert!((number(&spans[k]["to"]) - end).abs() <= 1.01e-4, "{k}: {found}");
        assert_eq!(spans[k]["to"], spans[k + 1]["from"]);
    }
    assert_eq!((number(&spans[0]["from"]), number(&spans[4]["to"])), (0.0, 1.0));
    let text = d2m(&["spans", &path, "--exit-status"]);
    assert_eq!(text.status.code(), Some(10));
    assert!(stdout(&text).contains("gate \u{2013} tool: SPANS: 3"), "{}", stdout(&text));
    let alone = folder.file("alone.json", r#"{"bodies": [{"name": "a", "mesh": "shape:box"}]}"#);
    let clear = ask(&["spans", &alone, "--json"]);
    assert_eq!(clear["spans"], serde_json::json!([{"from": 0.0, "to": 1.0, "status": "clear"}]));
}

/// A body with a radius is everything within it of its mesh: each question about two meshes is one about two bodies.
#[test]
fn bodies_with_radii() {
    let radii = ["--radius-a", "0.25", "--radius-b=0.5", "--json"];
    let with = |first: &[&str]| ask(&[first, &radii[..]].concat());
    // Cubes of edge 1 whose meshes are 2 apart, and whose bodies are 1.25 apart.
    let still = with(&["distance", CUBE, CUBE, "--pose-b", "x=3,0,0"]);
    assert!((number(&still["distance"]) - 1.25).abs() < 1e-12, "{still}");
    assert!((number(&still["point_a"][0]) - 0.75).abs() < 1e-12, "{still}");
    let near = with(&["proximities", CUBE, CUBE, "--pose-b", "x=3,0,0", "--margin", "1.3"]);
    assert!((number(&near["proximities"][0]["distance"]) - 1.25).abs() < 1e-12, "{near}");
    let far = with(&["proximities", CUBE, CUBE, "--pose-b", "x=3,0,0", "--margin", "1.2"]);
    assert_eq!(far["found"], 0, "{far}");
    for (x, status, start) in [("x=1.8,0,0", "separated", "apart"), ("x=1.7,0,0", "contact", "overlapping")] {
        let collide = with(&["collide", CUBE, CUBE, "--pose-b", x]);
        assert_eq!((&collide["status"], &collide["start"]), (&status.into(), &start.into()), "{collide}");
    }

    let closing = ["--motion-a", "x=-3,0,0;v=4,0,0", "--verify"];
    let toc = with(&[&["toc", CUBE, CUBE][..], &closing].concat());
    assert!((number(&toc["toc"]) - 0.3125).abs() < 1e-9 && toc["verified"] == true, "{toc}");
    let folder = Folder::new("radii");
    let answer = folder.file("toc.json", &toc.to_string());
    let again = ["verify", CUBE, CUBE, "--motion-a", "x=-3,0,0;v=4,0,0", "--answer", &answer];
    assert_eq!(d2m(&[&again[..], &radii].concat()).status.code(), Some(0));
    // Of the meshes alone that is no answer: these are not their points.
    assert_eq!(d2m(&again).status.code(), Some(3));
    let spans = with(&[&["spans", CUBE, CUBE, "--resolution=1e-3"][..], &closing].concat());
    assert!((number(&spans["spans"][0]["to"]) - 0.3125).abs() < 1e-9, "{spans}");
    let passing = ["clearance", CUBE, CUBE, "--motion-a", "x=-3,2,0;v=6,0,0", "--verify"];
    let clearance = with(&passing);
    assert!((number(&clearance["clearance"][1]) - 0.25).abs() < 1e-6, "{clearance}");
    assert_eq!(clearance["verified"], true, "{clearance}");
    let text = d2m(&["distance", CUBE, CUBE, "--pose-b", "x=3,0,0", "--radius-a", "0.25"]);
    assert!(
        stdout(&text).ends_with("sizes       A is 2.232 across · B is 1.732 across\n"),
        "{}",
        stdout(&text)
    );

    for command in ["toc", "distance"] {
        refused(&[command, CUBE, CUBE, "--radius-a", "-1"], &["--radius-a", "-1 is not a finite radius"]);
        refused(&[command, CUBE, CUBE, "--radius-b", "nan"], &["--radius-b", "finite radius"]);
    }
    refused(
        &["toc", CUBE, CUBE, "--radius-b=1", "--mode=paper"],
        &["--radius-b", "reference method has none"],
    );
    let scene = cell(&folder, "cell.json", &[]);
    refused(&["clearance", &scene, "--radius-a=1"], &["--radius-a", "the scene says this itself"]);
}

/// The clearances of a scene are proven again pair by pair, and its text ends with what bodies are like.
#[test]
fn clearances_of_a_scene_are_verified() {
    let folder = Folder::new("scene-verified");
    let apart = cell(&folder, "apart.json", &[("\"x\": [4, 0, 0]", "\"x\": [4, 2, 0]")]);
    let nearest = ask(&["clearance", &apart, "--verify", "--json"]);
    assert!(nearest["verified"] == true && number(&nearest["proof_steps"]) >= 4.0, "{nearest}");
    let below = ask(&["clearance", &apart, "--verify", "--below", "1.75", "--json"]);
    assert!(below["verified"] == true && below["pairs"].as_array().is_some_and(|p| p.len() > 1), "{below}");
    let text = d2m(&["clearance", &apart, "--verify"]);
    let text = stdout(&text);
    let (body, sizes) = text.trim_end().rsplit_once('\n').unwrap();
    assert!(body.contains("verified    yes"), "{text}");
    assert_eq!(
        sizes,
        "  sizes       from 1.732 (wall) to 25.48 (floor) across · moves up to 16 (tool) · turns up to 0° (tool)"
    );
    for command in ["spans", "scene"] {
        let run = d2m(&[command, &apart]);
        assert!(stdout(&run).ends_with(&format!("{sizes}\n")), "{command}: {}", stdout(&run));
    }
}

/// The spans of all pairs of a scene are proven again, those of pairs that are left out of the answer, too.
#[test]
fn spans_of_a_scene_are_verified() {
    let folder = Folder::new("scene-spans-verified");
    let through = cell(&folder, "through.json", &[]);
    let spans = ask(&["spans", &through, "--verify", "--json"]);
    assert!(spans["pairs"].as_array().is_some_and(|pairs| pairs.len() == 2), "{spans}");
    let of_pair = number(&spans["proof_steps"]);
    assert!(spans["verified"] == true && of_pair >= 4.0, "{spans}");
    // Nothing meets: that no pair does is proven.
    let edits = [("\"x\": [4, 0, 0]", "\"x\": [4, 2, 0]"), ("\"x\": [0, 1.25, 0]", "\"x\": [0, 9, 0]")];
    let apart = cell(&folder, "apart.json", &edits);
    let clear = ask(&["spans", &apart, "--verify", "--json"]);
    let steps = number(&clear["proof_steps"]);
    assert!(clear["verified"] == true && clear["pairs"] == serde_json::json!([]) && steps >= 3.0, "{clear}");
    let text = d2m(&["spans", &apart, "--verify"]);
    assert!(stdout(&text).contains("verified    yes"), "{}", stdout(&text));
}
