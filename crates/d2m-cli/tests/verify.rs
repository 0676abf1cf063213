//! Answers proven again by the command, and answer files that were edited.

mod shell;

use serde_json::{Value, json};
use shell::{Folder, d2m, stderr, stdout};
use std::fmt::Write as _;
use std::process::Output;

const BODIES: [&str; 6] = [
    "shape:gear?triangles=500",
    "shape:torus?triangles=600",
    "--motion-a",
    "x=-4,0.1,0.2;v=4,0,0;w=0,0,1",
    "--motion-b",
    "w=0.3,0.2,0.1",
];

fn run(command: &str, more: &[&str]) -> Output {
    let mut words = vec![command];
    words.extend(BODIES);
    words.extend(more);
    d2m(&words)
}

fn answer() -> Value {
    let out = run("toc", &["--json", "--verify"]);
    assert_eq!(out.status.code(), Some(0), "{}", stderr(&out));
    let answer: Value = serde_json::from_str(&stdout(&out)).unwrap();
    assert_eq!(answer["status"], "contact");
    assert_eq!(answer["verified"], true, "{answer}");
    answer
}

fn code(folder: &Folder, answer: &Value, more: &[&str]) -> (Option<i32>, String) {
    let path = folder.file("answer.json", &answer.to_string());
    let out = run("verify", &[&["--answer", &path], more].concat());
    (out.status.code(), stdout(&out) + &stderr(&out))
}

/// What `toc --json` says is verified as it is, and each edit is refuted, not proven or refused, never verified.
#[test]
fn edited_answers_are_never_verified() {
    let folder = Folder::new("verify");
    let answer = answer();
    assert_eq!(code(&folder, &answer, &[]).0, Some(0));
    let time = answer["toc"].as_f64().unwrap();
    let later = |by: f64| {
        let mut lie = answer.clone();
        let hi = answer["toc_hi"].as_f64().unwrap() + by;
        (lie["toc"], lie["time_lo"]) = (json!(time + by), json!(time + by));
        (lie["toc_hi"], lie["time_hi"], lie["time"]) = (json!(hi), json!(hi), json!([time + by, hi]));
        lie
    };
    for by in [1e-9, 1e-6, 1e-3, 0.1] {
        let (code, said) = code(&folder, &later(by), &[]);
        assert!(matches!(code, Some(3 | 20 | 21)), "{by}: {code:?} {said}");
    }
    let separated = json!({
        "status": "separated", "window": answer["window"], "min_separation": answer["min_separation"],
        "triangles": answer["triangles"], "solids": answer["solids"],
    });
    let (refuted, said) = code(&folder, &separated, &["--json"]);
    assert_eq!(refuted, Some(20), "{said}");
    let shown: Value = serde_json::from_str(&said).unwrap();
    assert!(shown["counterexample"]["time"].as_f64().unwrap() > time, "{said}");
    for (key, value) in [
        ("separation", json!(answer["separation"].as_f64().unwrap() * 2.0)),
        ("tolerance", json!(1e-3)),
        ("triangle_a", json!(answer["triangle_a"].as_u64().unwrap() + 1)),
        ("triangle_b", json!(1_000_000)),
        ("toc", json!(0.0)),
        ("time_lo", json!(-1.0)),
        ("normal", json!([1.0, 0.0, 0.0])),
        ("point", json!([1.0, 0.0, 0.0])),
        ("point_a", json!([1.0, 0.0, 0.0])),
        ("point_b", json!([1.0, 0.0, 0.0])),
        ("barycentric_a", json!([1.0, 1.0, -1.0])),
        ("closing_speed", json!(-4.0)),
        ("feature", json!("edge_edge:0-1:0-1")),
        ("status", json!("certain")),
        ("status", json!("separated")),
        ("status", json!("undecided")),
        ("evidence", json!("sure")),
        ("start", json!("contained")),
        ("window", json!([0.0, 2.0])),
        ("min_separation", json!(0.5)),
        ("triangles", json!([12, 12])),
        ("solids", json!([false, true])),
        ("solid", json!(false)),
        ("clear_until", json!(0.9)),
        ("clearance_status", json!("clear")),
        ("resolution", json!(1.0)),
    ] {
        let mut lie = answer.clone();
        lie[key] = value;
        let (code, said) = code(&folder, &lie, &[]);
        assert!(matches!(code, Some(3 | 20 | 21)), "{key}: {code:?} {said}");
        assert!(!said.trim().is_empty());
    }
    let left = r#"["separated",[0,1],0,[12,12],[true,true],null,null,null,null,"apart",[0,1],null]"#;
    for text in ["{ not json", "[]", "null", "7", r#""contact""#, left] {
        let path = folder.file("answer.json", text);
        let out = run("verify", &["--answer", &path]);
        let (code, said) = (out.status.code(), stderr(&out));
        assert!(code == Some(3) && said.contains("answer.json"), "{said}");
        assert!(text.starts_with('{') || said.contains("an object with keys"), "{said}");
        assert!(!said.contains("struct"), "{said}");
    }
    let spans = r#"{"window":[0,1],"resolution":1e-6,"spans":[[0,1,"clear",0]]}"#;
    let out = run("verify", &["--answer", &folder.file("answer.json", spans)]);
    assert!(out.status.code() == Some(3) && stderr(&out).contains("spans: "), "{}", stderr(&out));
    let other = d2m(&[
        "verify",
        "shape:box",
        BODIES[1],
        "--motion-a",
        BODIES[3],
        "--answer",
        &folder.file("a.json", &answer.to_string()),
    ]);
    assert_eq!(other.status.code(), Some(3), "{}", stderr(&other));
}

/// Bodies begin apart where some of the window is proven free. Where nothing is, nothing is said of their start, which may be in each other.
#[test]
fn what_is_not_known_of_the_start_is_not_said() {
    let folder = Folder::new("verify-start");
    let ask = |place: &str, more: &[&str]| {
        let bodies = ["shape:box?x=0.5&y=0.5&z=0.5", "shape:torus?triangles=200", "--motion-a", place];
        d2m(&[&["toc", "--json"], &bodies[..], more].concat())
    };
    let verified = |place: &str, answer: &Value| {
        let path = folder.file("answer.json", &answer.to_string());
        let bodies = ["shape:box?x=0.5&y=0.5&z=0.5", "shape:torus?triangles=200", "--motion-a", place];
        let out = d2m(&[&["verify", "--answer", &path], &bodies[..]].concat());
        (out.status.code(), stderr(&out))
    };
    for (place, budget, start, proven) in [
        ("x=0.9,0,0", "0", "overlapping", false),
        ("x=-4,0,0;v=8,0,0", "20", "apart", true),
        ("x=4,0,0", "0", "apart", true),
    ] {
        let answer: Value = serde_json::from_str(&stdout(&ask(place, &["--budget", budget]))).unwrap();
        assert_ne!(answer["status"], "contact", "{answer}");
        assert_eq!((&answer["start"], &answer["start_proven"]), (&json!(start), &json!(proven)), "{answer}");
        assert_eq!(verified(place, &answer).0, Some(0), "{answer}");
        for lie in ["apart", "touching", "overlapping", "contained"].into_iter().filter(|&lie| lie != start) {
            let mut edited = answer.clone();
            edited["start"] = json!(lie);
            let (code, said) = verified(place, &edited);
            assert!(code == Some(3) && said.contains("start: "), "{lie}: {code:?} {said}");
        }
    }
}

/// A start that is not proven has a word that says nothing: answers are verified without it, and not with it.
#[test]
fn a_start_that_is_not_proven_is_but_a_word() {
    let folder = Folder::new("verify-word");
    // A cube in a hole of its size, which it cannot leave, and one of which the budget ends the search of the start.
    let hollow = hollow_cube();
    let hollow = folder.file("hollow.obj", &hollow);
    let fits = [hollow.as_str(), "shape:box?x=0.5&y=0.5&z=0.5"];
    let cubes = ["shape:box?x=0.5&y=0.5&z=0.5"; 2];
    for (bodies, place, budget) in
        [(fits, "x=0,0,0", "1000000"), (cubes, "x=3,0,0;v=-1,0,0", "0"), (cubes, "x=0.5,0,0", "0")]
    {
        for start in ["report", "leave"] {
            let words = [&bodies[..], &["--motion-b", place, "--start", start]].concat();
            let out = d2m(&[&["toc", "--json", "--budget", budget], &words[..]].concat());
            let answer: Value = serde_json::from_str(&stdout(&out)).unwrap();
            if answer["status"] == "separated" {
                continue;
            }
            let code = |answer: &Value| {
                let path = folder.file("answer.json", &answer.to_string());
                d2m(&[&["verify", "--answer", &path], &words[..]].concat()).status.code()
            };
            assert_eq!((&answer["start"], &answer["start_proven"]), (&json!("overlapping"), &json!(false)));
            assert_eq!(code(&answer), Some(0), "{answer}");
            for (word, proven, refused) in
                [("overlapping", true, 21), ("apart", true, 21), ("apart", false, 3), ("touching", false, 3)]
            {
                let mut lie = answer.clone();
                (lie["start"], lie["start_proven"]) = (json!(word), json!(proven));
                // That they overlap is true of the last ones, and proven where it is part of the answer.
                let is_true = place == "x=0.5,0,0" && word == "overlapping" && start == "leave";
                let code = code(&lie);
                let is_refused = code == Some(refused) || refused == 21 && code == Some(3);
                assert!(
                    if is_true { code == Some(0) } else { is_refused || code == Some(20) },
                    "{code:?} {lie}"
                );
            }
        }
    }
}

/// A cube of half side one with a hole of half side a half.
fn hollow_cube() -> String {
    let mut text = String::new();
    for (half, inward) in [(1.0, false), (0.5, true)] {
        let first = if inward { 9 } else { 1 };
        for i in 0..8 {
            let at = |axis: i32| if i >> axis & 1 == 0 { -half } else { half };
            writeln!(text, "v {} {} {}", at(0), at(1), at(2)).unwrap();
        }
        for mut face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            if inward {
                face.reverse();
            }
            let [a, b, c, d] = face.map(|i| i + first);
            writeln!(text, "f {a} {b} {c} {d}").unwrap();
        }
    }
    text
}

/// Answers of other questions: as they are printed they are verified, edited they are not.
#[test]
fn answers_of_every_question_are_verified() {
    let folder = Folder::new("verify-questions");
    let bodies = |motion: &'static str| ["shape:box", "shape:box", "--motion-a", motion];
    let (through, past) = ("x=-4,0.1,0.2;v=8,0,0;w=0,0,0.3", "x=-4,0.1,1.5;v=8,0,0;w=0,0,0.3");
    let (parting, met) = ("x=1,0.1,0.2;v=2,0,0", "x=0.5,0.1,0.2;v=8,0,0");
    for (words, motion, edits) in [
        (&["spans"][..], through, &[("spans/0/to", 0.5), ("spans/1/from", 0.3), ("spans/2/from", 0.5)][..]),
        (
            &["clearance"],
            past,
            &[("clearance/0", 0.6), ("clearance/1", 0.34), ("time", 0.2), ("point_a/0", 3.0)],
        ),
        (&["clearance"], through, &[("clearance/0", 0.1), ("time", 0.5)]),
        (&["toc", "--clearance"], past, &[("clearance/0", 0.6), ("clearance/1", 0.34)]),
        (&["toc", "--start", "leave"], parting, &[("left/1", 0.0), ("left/0", 0.5)]),
        (&["toc", "--start", "leave"], met, &[("left/1", 0.001), ("left/1", 2.0)]),
    ] {
        let asked = [words, &bodies(motion), &["--json", "--verify"]].concat();
        let out = d2m(&asked);
        let answer: Value =
            serde_json::from_str(&stdout(&out)).unwrap_or_else(|_| panic!("{}", stderr(&out)));
        assert_eq!(answer["verified"], true, "{words:?} {answer}");
        let again = |answer: &Value| {
            let path = folder.file("answer.json", &answer.to_string());
            let out = d2m(&[&["verify"][..], &bodies(motion), &["--answer", &path]].concat());
            (out.status.code(), stdout(&out) + &stderr(&out))
        };
        assert_eq!(again(&answer).0, Some(0), "{words:?} {}", again(&answer).1);
        for (place, value) in edits {
            let mut lie = answer.clone();
            *lie.pointer_mut(&format!("/{place}")).unwrap() = json!(value);
            let (code, said) = again(&lie);
            assert!(matches!(code, Some(3 | 20 | 21)), "{words:?} {place} {value}: {code:?} {said}");
        }
    }
}

/// The nearest place of two bodies that turn is narrow in time: an answer says when it is, and is verified
/// again.
#[test]
fn a_least_distance_says_when_it_is() {
    let folder = Folder::new("verify-nearest");
    let bodies = ["shape:gear", "shape:torus", "--motion-a", "x=-3,3.2,0.1;v=4,0,0;w=0,0,5"];
    let out = d2m(&[&["toc", "--clearance", "--json"], &bodies[..]].concat());
    let answer: Value = serde_json::from_str(&stdout(&out)).unwrap();
    let code = |answer: &Value| {
        let path = folder.file("answer.json", &answer.to_string());
        d2m(&[&["verify"][..], &bodies, &["--answer", &path]].concat()).status.code()
    };
    assert_eq!(code(&answer), Some(0), "{answer}");
    for (key, value, expected) in [
        ("clearance_time", json!(0.5), 20),
        ("clearance_time", json!(1.5), 3),
        ("clearance_status", json!("contact"), 3),
        ("evidence", json!("near"), 3),
        ("separation", json!(0.1), 3),
    ] {
        let mut lie = answer.clone();
        lie[key] = value;
        assert_eq!(code(&lie), Some(expected), "{lie}");
    }
}

const SCENE: &str = r#"{"bodies": [
    {"name": "a", "mesh": "shape:box", "motion": {"x": [-4, 0.1, 0.2], "v": [4, 0, 0]}},
    {"name": "b", "mesh": "shape:box"},
    {"name": "c", "mesh": "shape:torus", "motion": {"x": [0, 9, 0]}},
    {"name": "inside", "mesh": "shape:icosphere", "scale": 0.1, "group": "parts"}],
    "ignore": [["b", "parts"]]}"#;

/// Scenes are proven pair by pair, ignored pairs left out, and batches for a share of their trials.
#[test]
fn scenes_and_batches_are_verified() {
    let folder = Folder::new("verify-scene");
    let scene = folder.file("scene.json", SCENE);
    let out = d2m(&["scene", &scene, "--first", "--json", "--verify"]);
    let answer: Value = serde_json::from_str(&stdout(&out)).unwrap();
    assert_eq!(answer["verified"], true, "{answer}");
    assert_eq!(d2m(&["scene", &scene, "--verify"]).status.code(), Some(2));
    let row = "1,0,0,0,-3,0.1,0.2,4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n";
    let trials = folder.file("trials.csv", &row.repeat(4));
    for (share, said) in [("1", "4 of 4 answers verified"), ("0.5", "2 of 2 answers verified")] {
        let results = folder.path("results.csv");
        let out = d2m(&[
            "batch",
            "shape:box",
            "shape:box",
            "--trials",
            &trials,
            "--out",
            &results,
            "--verify",
            share,
        ]);
        assert!(out.status.code() == Some(0) && stderr(&out).contains(said), "{}", stderr(&out));
    }
}
