//! The keys `start`, `pairs` and `radius` of scenes, and the options `--start` and `--clearance` of batches, as the formats state them.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, refused, stderr, stdout};

const CUBE: &str = "shape:box?x=0.5&y=0.5&z=0.5";

fn scene(folder: &Folder, name: &str, text: &str) -> String {
    folder.file(name, &text.replace("CUBE", CUBE))
}

fn contacts(arguments: &[&str]) -> Vec<Value> {
    let run = d2m(arguments);
    assert_eq!(run.status.code(), Some(0), "{arguments:?}: {}", stderr(&run));
    let answer: Value = serde_json::from_str(&stdout(&run)).unwrap();
    answer["contacts"].as_array().unwrap().clone()
}

fn close(value: &Value, expected: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    assert!((found - expected).abs() <= 1e-6, "{found} is not {expected}");
}

/// A part on a table that is lifted to a lamp, the table on the floor.
const LIFT: &str = r#"{"window": [0, 3], "start": "leave", "bodies": [
    {"name": "floor", "mesh": "CUBE", "motion": {"x": [0, -1, 0]}},
    {"name": "table", "mesh": "CUBE"},
    {"name": "part", "mesh": "CUBE", "motion": {"x": [0, 1, 0], "v": [0, 2, 0]}},
    {"name": "lamp", "mesh": "CUBE", "motion": {"x": [0, 6, 0]}}],
    "pairs": [{"a": "lamp", "b": "part", "min_separation": 0.5}, {"a": "table", "b": "floor", "start": "report"}]}"#;

#[test]
fn contacts_at_the_start_are_let_go() {
    let folder = Folder::new("contract-leave");
    let path = scene(&folder, "lift.json", LIFT);
    let found = contacts(&["scene", &path, "--json"]);
    assert_eq!(found.len(), 2, "{found:?}");
    let [resting, met] = [&found[0], &found[1]];
    // These two have a start of their own.
    assert_eq!(
        (&resting["a"], &resting["b"], &resting["start"]),
        (&"floor".into(), &"table".into(), &"touching".into())
    );
    assert!(
        resting.get("left").is_none() && resting["toc"] == 0.0 && resting["start_proven"] == true,
        "{resting}"
    );
    // These two begin apart, and have a separation of their own.
    assert_eq!((&met["a"], &met["b"], &met["start"]), (&"part".into(), &"lamp".into(), &"apart".into()));
    close(&met["toc"], 1.75);
    close(&met["separation"], 0.5);
    assert_eq!(met["left"], serde_json::json!([0.0, 0.0]), "{met}");
    // The part leaves the table for good: that it was in contact is said beside the contacts.
    let answer: Value = serde_json::from_str(&stdout(&d2m(&["scene", &path, "--json"]))).unwrap();
    let left = answer["left"].as_array().unwrap();
    assert!(left.len() == 1 && left[0]["start"] == "touching", "{answer}");
    assert_eq!([&left[0]["a"], &left[0]["b"]], [&Value::from("table"), &"part".into()]);
    assert!(left[0]["left"][1].as_f64().is_some_and(|time| time > 0.0 && time < 1e-6), "{answer}");
    let words = stdout(&d2m(&["scene", &path]));
    assert!(words.contains("but for what was in contact at the start until it had parted"), "{words}");
    assert!(words.contains("left: table \u{2013} part: touching at the start, proven apart at"), "{words}");
    // With a word that is none, or other names.
    for (from, to, words) in [
        (
            r#""start": "leave", "bodies""#,
            r#""start": "go", "bodies""#,
            &["lift.json", "start", "\"go\" is neither \"report\" nor \"leave\""][..],
        ),
        (r#""start": "leave", "bodies""#, r#""start": 1, "bodies""#, &["start", "1 is neither"]),
        (r#""start": "report""#, r#""start": "stay""#, &["pairs, entry 1, start", "\"stay\""]),
        (r#""a": "lamp""#, r#""a": "lamb""#, &["pairs, entry 0, a", "\"lamb\" is the name of no body"]),
        (r#""b": "floor""#, r#""b": "table""#, &["pairs, entry 1", "no pair with itself"]),
        (
            r#""a": "table", "b": "floor""#,
            r#""a": "part", "b": "lamp""#,
            &["pairs, entry 1", "the pair of entry 0 too"],
        ),
        (
            r#""min_separation": 0.5"#,
            r#""min_separation": -0.5"#,
            &["pairs, entry 0, min_separation", "-0.5 is not"],
        ),
        (
            r#""min_separation": 0.5"#,
            r#""min_distance": 0.5"#,
            &["pairs, entry 0", "unknown field `min_distance`"],
        ),
        (
            r#""min_separation": 0.5"#,
            r#""restitution": 2"#,
            &["pairs, entry 0, restitution", "2.0 is not from 0 to 1"],
        ),
    ] {
        assert!(LIFT.contains(from));
        let bad = scene(&folder, "lift.json", &LIFT.replace(from, to));
        refused(&["scene", &bad, "--json"], words);
    }
}

#[test]
fn what_parts_and_comes_back_says_when_it_had_left() {
    let folder = Folder::new("contract-left");
    // Turns about an axis at x = 3: leaves the cube at the origin and comes back.
    let text = r#"{"window": [0, 1], "bodies": [{"name": "rest", "mesh": "CUBE"},
        {"name": "arm", "mesh": "CUBE", "motion": {"x": [1.5, 0, 0], "at": [1.5, 0, 0], "w": [0, 0, 6.283185307179586]}},
        {"name": "stuck", "mesh": "CUBE", "motion": {"x": [0, 0, 0.5]}}],
        "ignore": [["arm", "stuck"]], "start": "leave"}"#;
    let path = scene(&folder, "left.json", text);
    let found = contacts(&["scene", &path, "--json"]);
    // Never proven apart: in contact from the start.
    let stuck = found.iter().find(|contact| contact["b"] == "stuck").expect("they overlap all the time");
    assert!(stuck["toc"] == 0.0 && stuck["left"].is_null() && stuck.get("left").is_some(), "{stuck}");
    assert_eq!((&stuck["status"], &stuck["start"]), (&"contact".into(), &"overlapping".into()));
    let arm = found.iter().find(|contact| contact["b"] == "arm").expect("it comes back");
    let [lo, hi] = [0, 1].map(|k| arm["left"][k].as_f64().unwrap());
    assert!(0.0 <= lo && lo <= hi && hi < arm["toc"].as_f64().unwrap(), "{arm}");
    let text = stdout(&d2m(&["scene", &path]));
    assert!(text.contains("overlapping from the start, and never proven apart"), "{text}");
    assert!(text.contains("at the start, proven apart at"), "{text}");
    // The option stands for the key.
    let report = contacts(&["scene", &path, "--json", "--start", "report"]);
    assert!(
        report.iter().all(|contact| contact["toc"] == 0.0 && contact.get("left").is_none()),
        "{report:?}"
    );
    let proven = d2m(&["scene", &path, "--json", "--first", "--verify"]);
    let proven: Value = serde_json::from_str(&stdout(&proven)).unwrap();
    assert_eq!(proven["verified"], true, "{proven}");
}

#[test]
fn bodies_have_radii() {
    let folder = Folder::new("contract-radius");
    folder.file("point.obj", "v 0 0 0\nf 1 1 1\n");
    folder.file("rod.obj", "v 0 -1 0\nv 0 1 0\nf 1 2 2\n");
    let text = r#"{"window": [0, 1], "tolerance": 1e-10, "bodies": [
        {"name": "ball", "mesh": "point.obj", "radius": 0.25, "motion": {"x": [4, 0, 0], "v": [-4, 0, 0]}},
        {"name": "post", "mesh": "rod.obj", "radius": 0.75},
        {"name": "box", "mesh": "CUBE", "radius": 0.1, "motion": {"x": [0, 3, 0]}}],
        "pairs": [{"a": "box", "b": "post", "min_separation": 0.65}]}"#;
    let path = scene(&folder, "round.json", text);
    let found = contacts(&["scene", &path, "--json", "--first"]);
    let met = &found[0];
    assert_eq!(
        (&met["a"], &met["b"]),
        (&"post".into(), &"box".into()),
        "0.75, 0.1 and 0.65 are 1.5: {found:?}"
    );
    let apart = text.replace("0.65", "0.6");
    let path = scene(&folder, "round.json", &apart);
    let found = contacts(&["scene", &path, "--json"]);
    assert_eq!(found.len(), 1, "{found:?}");
    let met = &found[0];
    assert_eq!((&met["a"], &met["b"]), (&"ball".into(), &"post".into()));
    close(&met["toc"], 0.75);
    close(&met["point"][0], 0.75);
    close(&met["normal"][0], -1.0);
    let proven = d2m(&["scene", &path, "--json", "--first", "--verify"]);
    let proven: Value = serde_json::from_str(&stdout(&proven)).unwrap();
    assert_eq!(proven["verified"], true, "{proven}");
    for (bad, word) in [("-0.25", "-0.25 is not a finite distance"), ("\"big\"", "invalid type")] {
        let path =
            scene(&folder, "bad.json", &text.replace(r#""radius": 0.25"#, &format!(r#""radius": {bad}"#)));
        refused(&["scene", &path], &["bad.json, body 0 (\"ball\")", word]);
    }
}

#[test]
fn batches_let_go_and_state_clearances() {
    let folder = Folder::new("contract-batch");
    // Lifted from the cube below it; passing by at a distance of 1; overlapping and at rest.
    let trials = folder.file(
        "t.jsonl",
        r#"{"a": {"x": [0, 1, 0], "v": [0, 1, 0]}}
{"a": {"x": [-4, 2, 0], "v": [8, 0, 0]}}
{"a": {"x": [0.5, 0, 0]}}
{"a": {"x": [0, 1, 0], "w": [0, 0, 7]}, "window": [0, 1]}
"#,
    );
    let batch = |options: &[&str]| {
        let all: Vec<&str> =
            ["batch", CUBE, CUBE, "--trials", &trials, "--out", "-"].iter().chain(options).copied().collect();
        let run = d2m(&all);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        let rows: Vec<Vec<String>> =
            stdout(&run).lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        assert!(
            stderr(&run).contains("t.jsonl: 1 trials have a body that turns more than once"),
            "{}",
            stderr(&run)
        );
        rows
    };
    let plain = batch(&[]);
    assert_eq!((plain[0].len(), plain[0].last().unwrap().as_str()), (17, "tolerance"));
    let rows = batch(&["--start", "leave", "--clearance", "--verify"]);
    assert_eq!(rows[0][17..], ["left_lo", "left_hi", "clearance_lo", "clearance_hi"]);
    assert!(rows.iter().all(|row| row.len() == 21), "{rows:?}");
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    assert_eq!(
        (rows[1][1].as_str(), rows[2][1].as_str(), rows[3][1].as_str()),
        ("separated", "separated", "contact")
    );
    assert!(number(1, 17) >= 0.0 && number(1, 18) > 0.0 && number(1, 18) < 1e-6, "{:?}", rows[1]);
    assert!((number(2, 17), number(2, 18)) == (0.0, 0.0), "{:?}", rows[2]);
    assert!(
        number(2, 19) <= 1.0 && number(2, 20) >= 1.0 && number(2, 20) - number(2, 19) <= 1e-6,
        "{:?}",
        rows[2]
    );
    // It never parts: in contact from the start, and it has no clearance.
    assert!(number(3, 2) == 0.0 && rows[3][17..].iter().all(String::is_empty), "{:?}", rows[3]);
}

#[test]
fn options_of_other_questions_are_refused() {
    for (command, option) in
        [("clearance", "--start=leave"), ("spans", "--start=leave"), ("spans", "--clearance")]
    {
        let (name, _) = option.split_once('=').unwrap_or((option, ""));
        // Neither does the help show it.
        let (run, help) = (d2m(&[command, CUBE, CUBE, option]), d2m(&[command, "--help"]));
        assert_eq!(run.status.code(), Some(2), "{}", stderr(&run));
        assert!(stderr(&run).contains(&format!("unexpected argument '{name}'")), "{}", stderr(&run));
        assert!(!String::from_utf8_lossy(&help.stdout).contains(&format!("{name} ")), "{command} {name}");
    }
    // What turns more than once is warned of by all of them.
    for command in ["toc", "clearance", "spans"] {
        let run = d2m(&[command, CUBE, CUBE, "--motion-a", "x=3,0,0;w=0,0,9", "--motion-b", "w=0,6,4"]);
        assert!(
            stderr(&run).contains("--motion-a: the body turns 1.432 times"),
            "{command}: {}",
            stderr(&run)
        );
        assert!(stderr(&run).contains("--motion-b: the body turns"), "{command}: {}", stderr(&run));
    }
    let folder = Folder::new("contract-turns");
    let text = r#"{"bodies": [{"name": "a", "mesh": "CUBE", "motion": {"w": [0, 0, 360]}}]}"#;
    let run = d2m(&["scene", &scene(&folder, "turn.json", text)]);
    assert!(
        stderr(&run).contains("turn.json, body 0 (\"a\"), motion: the body turns 57.3 times"),
        "{}",
        stderr(&run)
    );
}

#[test]
fn answers_about_departures_are_verified() {
    let folder = Folder::new("contract-verify");
    let pair = [CUBE, CUBE, "--motion-a", "x=0,1,0;v=0,1,0"];
    let ask = |words: &[&str]| {
        let all: Vec<&str> = words[..1].iter().chain(&pair).chain(&words[1..]).copied().collect();
        d2m(&all)
    };
    let answer = folder.file("left.json", &stdout(&ask(&["toc", "--start", "leave", "--json"])));
    let plain = folder.file("plain.json", &stdout(&ask(&["toc", "--json"])));
    for options in [&[][..], &["--start", "leave"]] {
        let all: Vec<&str> = ["verify", "--answer", &answer].iter().chain(options).copied().collect();
        assert_eq!(ask(&all).status.code(), Some(0), "{}", stderr(&ask(&all)));
    }
    assert_eq!(ask(&["verify", "--answer", &plain, "--start", "report"]).status.code(), Some(0));
    for (file, start, word) in [(&answer, "report", "--start leave"), (&plain, "leave", "--start report")] {
        let run = ask(&["verify", "--answer", file, "--start", start]);
        assert_eq!(run.status.code(), Some(3));
        assert!(stderr(&run).contains(word), "{}", stderr(&run));
    }
}

/// A cube goes out of another one until they part, at 0.38, and from 0.5 on both turn against each other, so
/// that no bound shows them apart.
fn turning(folder: &Folder, rate: f64, more: &str) -> String {
    let (place, turn) = ("[[0.9, 1.3], [1.55]]", std::f64::consts::FRAC_PI_4);
    let value = |pieces: &str| format!(r#"{{"times": [0, 0.5, 1], "pieces": {pieces}}}"#);
    let (place, a, b) = (
        value(place),
        value(&format!("[[{turn}], [{turn}, {rate}]]")),
        value(&format!("[[0], [0, -{rate}]]")),
    );
    let text = format!(
        r#"{{"start": "leave", "bodies": [{{"name": "a", "mesh": "shape:box", "motion": {{"chain": [
            {{"joint": "prismatic", "axis": [1, 0, 0], "value": {place}}},
            {{"joint": "revolute", "axis": [0, 0, 1], "value": {a}}}]}}}},
        {{"name": "b", "mesh": "shape:box", "motion": {{"chain": [
            {{"joint": "revolute", "axis": [0, 0, 1], "value": {b}}}]}}}}{more}]}}"#
    );
    folder.file("turning.json", &text)
}

/// What is let go and undecided later was no more free at the start than what is let go and decided.
#[test]
fn an_undecided_pair_is_not_called_free_before_it_has_parted() {
    let folder = Folder::new("contract-undecided");
    let path = turning(&folder, 1e12, "");
    for more in [&[][..], &["--first"]] {
        let asked = [&["scene", &path, "--time-limit", "0.5"], more].concat();
        let text = stdout(&d2m(&asked));
        assert!(text.starts_with("UNDECIDED") && !text.contains("certified free"), "{text}");
        assert!(
            text.contains("until it had parted") && text.contains("a \u{2013} b: undecided from then on")
        );
        assert!(
            text.contains("left: a \u{2013} b: overlapping at the start, proven apart at 0.37"),
            "{text}"
        );
        let answer: Value = serde_json::from_str(&stdout(&d2m(&[&asked[..], &["--json"]].concat()))).unwrap();
        assert_eq!(answer["contacts"][0]["status"], "undecided", "{answer}");
        assert!(answer["left"][0]["left"][1].as_f64().is_some_and(|time| time < 0.38), "{answer}");
    }
    // Where nothing is proven, nothing is said, whatever counts of the start.
    for start in ["leave", "report"] {
        let text = stdout(&d2m(&["scene", &path, "--time-limit", "1e-9", "--start", start]));
        assert!(text.contains("undecided from the start") && !text.contains("certified"), "{text}");
    }
}

/// When a pair had parted is no part of the search, and its limit holds all the same.
#[test]
fn a_limit_also_holds_for_when_pairs_had_parted() {
    let folder = Folder::new("contract-limit");
    let fly = r#", {"name": "wall", "mesh": "shape:box", "motion": {"x": [9, 0, 0]}},
        {"name": "fly", "mesh": "shape:box", "motion": {"x": [9, 9, 0], "v": [0, -18, 0]}}"#;
    let path = turning(&folder, 1e9, fly);
    let start = std::time::Instant::now();
    let text = stdout(&d2m(&["scene", &path, "--first", "--time-limit", "0.5"]));
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    assert!(text.starts_with("CONTACT of 1 pair") && text.contains("until it had parted"), "{text}");
}
