//! The command as scripts see it: answers, formats, exit codes, help.

mod shell;

use shell::{BOX_AT, Folder, HEADER, TRIALS, UNIT_BOX, d2m, refused, stderr, stdout};
use std::fs;
use std::process::{Command, Stdio};

#[test]
fn batch_writes_the_documented_csv() {
    let folder = Folder::new("batch");
    let trials = folder.file("trials.csv", TRIALS);
    for (mode, threads) in [("accurate", "1"), ("accurate", "3"), ("paper", "2"), ("capoeira", "1")] {
        let out = folder.path("results.csv");
        let run = d2m(&[
            "batch",
            UNIT_BOX,
            UNIT_BOX,
            "--trials",
            &trials,
            "--out",
            &out,
            "--mode",
            mode,
            "--threads",
            threads,
        ]);
        assert_eq!(run.status.code(), Some(0), "{mode}: {}", stderr(&run));
        assert!(run.stdout.is_empty());
        assert!(
            stderr(&run).starts_with("4 trials: 2 contact, 2 separated, 0 undecided; median "),
            "{}",
            stderr(&run)
        );
        assert_eq!(folder.names(), ["results.csv", "trials.csv"]);
        let text = fs::read_to_string(&out).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], HEADER);
        assert_eq!(lines.len(), 5);
        let fields = |line: usize| lines[line].split(',').collect::<Vec<_>>();
        assert!((1..5).all(|line| fields(line).len() == 17), "{text}");
        let number = |line: usize, field: usize| fields(line)[field].parse::<f64>().unwrap();
        assert_eq!(fields(1)[..2], ["0", "contact"]);
        assert!(number(1, 2) <= 0.25 && number(1, 2) <= number(1, 3), "{text}");
        assert!(number(1, 5) >= 0.0);
        if mode != "capoeira" {
            assert!(number(1, 2) > 0.25 - 1e-9);
            assert!(number(1, 4) > 0.0 && number(1, 4) < 6e-10, "{text}");
            assert!((number(1, 6) - 1.0).abs() < 1e-9 && (number(1, 9) + 1.0).abs() < 1e-8, "{text}");
            assert!(number(1, 13) < 12.0 && number(1, 14) < 12.0);
            assert!(
                ["vertex_face:", "face_vertex:", "edge_edge:"].iter().any(|k| fields(1)[12].starts_with(k))
            );
        }
        assert_eq!(fields(2)[..4], ["1", "separated", "inf", "inf"]);
        assert_eq!(fields(3)[..3], ["2", "separated", "inf"]);
        assert_eq!(fields(4)[..2], ["3", "contact"]);
        assert_eq!(number(4, 2), 0.0);
    }
}

#[test]
fn threads_do_not_change_answers() {
    let folder = Folder::new("threads");
    let trials: Vec<String> = (0..40)
        .map(|k| {
            format!("1,0.1,0,{0},-3,{0},0.2,5,0,0,0,{0},1,1,0,0,{0},0,0,0,0,0,0,0,2,0\n", f64::from(k) * 0.05)
        })
        .collect();
    let trials = folder.file("trials.csv", &trials.concat());
    let answers = |threads: &str| {
        let arguments =
            ["batch", "shape:gear", "shape:torus", "--trials", &trials, "--out", "-", "--threads", threads];
        let output = d2m(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let drop_time = |line: &str| {
            let mut fields: Vec<&str> = line.split(',').collect();
            fields.remove(5);
            fields.join(",")
        };
        stdout(&output).lines().map(drop_time).collect::<Vec<_>>()
    };
    let alone = answers("1");
    assert_eq!(alone.len(), 41);
    assert_eq!(alone, answers("4"));
}

#[test]
fn a_budget_is_answered_honestly() {
    let refused = d2m(&["toc", UNIT_BOX, UNIT_BOX, "--budget", "-1"]);
    assert!(stderr(&refused).contains("not a whole number such as 1000000 or 1e6"), "{}", stderr(&refused));
    assert!(stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--budget", "1e6"])).starts_with("CONTACT"));
    let folder = Folder::new("budget");
    let trials = folder.file("trials.csv", "1,0,0,0,-3,0,0,4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n");
    let output =
        d2m(&["batch", "shape:pebble", "shape:gear", "--trials", &trials, "--out", "-", "--budget", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    let fields: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    assert_eq!(fields[1], "undecided", "{text}");
    assert!((0.0..0.5).contains(&fields[2].parse::<f64>().unwrap()), "{text}");
}

/// A budget that ends at the start proves nothing, and nothing is called proven.
#[test]
fn nothing_is_certified_where_nothing_is_proven() {
    let inside = ["toc", UNIT_BOX, UNIT_BOX, "--motion-a", "x=0.5,0,0;v=9,0,0", "--budget", "0"];
    for start in ["report", "leave"] {
        let text = stdout(&d2m(&[&inside[..], &["--start", start]].concat()));
        assert!(text.starts_with("UNDECIDED") && text.contains("  certified   nothing\n"), "{text}");
        assert!(!text.contains("never proven apart"), "{text}");
    }
}

/// Also where no trial is separated: whether an option is refused is no matter of the answers.
#[test]
fn a_clearance_is_refused_before_the_search() {
    let met = ["toc", UNIT_BOX, UNIT_BOX, "--motion-a", BOX_AT, "--clearance"];
    for mode in ["capoeira", "paper"] {
        refused(&[&met[..], &["--mode", mode]].concat(), &["--mode", "clearance"]);
    }
}

#[test]
fn no_query_takes_longer_than_its_limit() {
    let start = std::time::Instant::now();
    // Two boxes turn against each other, an eighth of a turn apart: what they sweep out overlaps, they never touch.
    let a = "x=1.55,0,0;q=0.9238795325112867,0,0,0.3826834323650898;w=0,0,1e12";
    // Capoeira may stop early and call the narrow gap a contact.
    for (mode, verdict) in [("accurate", "UNDECIDED"), ("capoeira", "CONTACT"), ("paper", "UNDECIDED")] {
        let arguments = ["toc", "shape:box", "shape:box", "--motion-a", a, "--motion-b", "w=0,0,-1e12"];
        let output = d2m(&[&arguments[..], &["--time-limit", "0.2", "--mode", mode]].concat());
        assert!(stdout(&output).starts_with(verdict), "{mode}: {}{}", stdout(&output), stderr(&output));
    }
    assert!(start.elapsed().as_secs() < 60);
}

/// What bodies sweep out about their axes settles the question for any number of turns.
#[test]
fn a_trillion_turns_beside_each_other_are_clear() {
    let spin = "x=1.99,0,0;w=0,1e12,1";
    let output = d2m(&["toc", "shape:box", "shape:box", "--motion-a", spin, "--time-limit", "10"]);
    assert!(stdout(&output).starts_with("SEPARATED"), "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn a_wanted_separation_moves_the_contact() {
    let apart = ["toc", UNIT_BOX, UNIT_BOX, "--motion-a", BOX_AT, "--min-separation", "0.5"];
    let text = stdout(&d2m(&apart));
    assert!(
        text.starts_with("CONTACT at t = 0.12499999") || text.starts_with("CONTACT at t = 0.125"),
        "{text}"
    );
}

#[test]
fn toc_for_people_and_for_programs() {
    let text = stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", BOX_AT]));
    for word in
        ["CONTACT at t = 0.24999999", "separation", "normal", "point on A", "features", "of B", "took"]
    {
        assert!(text.contains(word), "{text}");
    }
    let text = stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", "x=-3,0,0;v=-4,0,0"]));
    assert!(text.starts_with("SEPARATED\n"), "{text}");
    let json = d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", BOX_AT, "--json", "--window", "0.1,0.5"]);
    let value: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(value["status"], "contact");
    let time = value["time"][0].as_f64().unwrap();
    assert!(time <= 0.25 && time > 0.25 - 1e-9);
    assert!(value["separation"].as_f64().unwrap() > 0.0);
    for key in ["normal", "point_a", "point_b", "barycentric_a", "barycentric_b"] {
        assert_eq!(value[key].as_array().unwrap().len(), 3, "{key}");
    }
    let json = d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", "x=-9,0,0", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(value["status"], "separated");
}

#[test]
fn solids_and_surfaces() {
    let inside = ["toc", "shape:icosphere", "shape:box?x=3&y=3&z=3", "--motion-a", "v=0.1,0,0"];
    assert!(stdout(&d2m(&inside)).contains("contained"));
    assert!(stdout(&d2m(&[&inside[..], &["--surface"]].concat())).starts_with("SEPARATED"));
    assert_eq!(d2m(&[&inside[..], &["--surface", "--solid"]].concat()).status.code(), Some(2));
    let folder = Folder::new("open");
    let open = folder.file("open.obj", "v -5 -5 3\nv 5 -5 3\nv 0 5 3\nf 1 2 3\n");
    let fall = ["toc", &open, UNIT_BOX, "--motion-a", "v=0,0,-4"];
    let output = d2m(&fall);
    assert!(stdout(&output).starts_with("CONTACT at t = 0.49999999"), "{}", stdout(&output));
    assert!(stderr(&output).contains("not watertight"));
    refused(&[&fall[..], &["--solid"]].concat(), &["open.obj", "not watertight"]);
}

/// A window of no length is a single time: the same answers as of any other window, proven again where that is wanted.
#[test]
fn a_window_may_be_a_single_time() {
    let ask = |command: &str, window: &str, more: &[&str]| {
        let motion = "x=-3,0,0;v=4,0,0";
        let words = [command, UNIT_BOX, UNIT_BOX, "--motion-a", motion, "--window", window];
        stdout(&d2m(&[&words[..], more].concat()))
    };
    for (time, answers) in [("0.1,0.1", ["SEPARATED", "clear"]), ("0.75,0.75", ["CONTACT", "contact"])] {
        assert!(ask("toc", time, &["--verify"]).contains(answers[0]), "{time}");
        assert!(ask("spans", time, &[]).contains(answers[1]), "{time}");
        let spans = ask("spans", time, &["--json", "--verify"]);
        assert!(spans.contains("\"resolution\":0.0") && spans.contains(answers[1]), "{spans}");
        assert!(ask("clearance", time, &["--json"]).contains(answers[1]), "{time}");
    }
}

#[test]
fn two_words_for_the_window_are_explained() {
    let output = d2m(&["toc", UNIT_BOX, UNIT_BOX, "--window", "0", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--window 0,1"), "{}", stderr(&output));
    refused(&["toc", UNIT_BOX, UNIT_BOX, "--window", "0;1"], &["\"0;1\"", "such as 0,1"]);
}

#[test]
fn trials_and_results_may_be_piped() {
    let line = r#"{"a": {"x": [-3, 0, 0], "v": [4, 0, 0]}, "window": [0, 0.5]}"#;
    let lines = format!("{line}\n\n{}\n", line.replace("0.5", "0.2"));
    let arguments = ["batch", UNIT_BOX, UNIT_BOX, "--trials", "-", "--out", "-"];
    let output = shell::d2m_with_input(&arguments, lines.as_bytes());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    let fields = |line: usize| text.lines().nth(line).unwrap().split(',').collect::<Vec<_>>();
    assert_eq!((fields(1)[1], fields(2)[1]), ("contact", "separated"), "{text}");
    assert!(["near", "crossing"].contains(&fields(1)[15]), "{text}");
    assert!((fields(1)[16].parse::<f64>().unwrap() / 1.7e-10 - 1.0).abs() < 0.1, "{text}");
    assert_eq!(fields(2)[15..], ["", ""]);
    let header = d2m_csv_header();
    let with_header = format!("{header}\n{TRIALS}");
    let output = shell::d2m_with_input(&arguments, with_header.as_bytes());
    assert_eq!(stdout(&output).lines().count(), 5, "{}", stderr(&output));
    let output = shell::d2m_with_input(&arguments, line.replace("-3", "-x").as_bytes());
    assert_eq!(output.status.code(), Some(3));
    assert!(
        stderr(&output).contains("standard input, line 1: ") && stderr(&output).contains("column"),
        "{}",
        stderr(&output)
    );
    let output = shell::d2m_with_input(&arguments, b"");
    assert!(stderr(&output).contains("standard input: is empty"), "{}", stderr(&output));
}

fn d2m_csv_header() -> String {
    let names: Vec<String> = (0..26).map(|k| format!("c{k}_")).collect();
    names.join(",")
}

#[test]
fn bad_usage_exits_with_2() {
    for arguments in [
        &[][..],
        &["toc"],
        &["toc", UNIT_BOX],
        &["batch", UNIT_BOX, UNIT_BOX, "--trials", "t.csv"],
        &["batch", UNIT_BOX, UNIT_BOX, "--trials", "t.csv", "--out", "-", "--threads", "0"],
        &["toc", UNIT_BOX, UNIT_BOX, "--mode", "fast"],
        &["toc", UNIT_BOX, UNIT_BOX, "--no-such-option"],
        &["toc", UNIT_BOX, UNIT_BOX, "--budget", "1.5"],
        &["info"],
        &["info", "--shapes", "--unit", "mm"],
        &["frobnicate"],
    ] {
        assert_eq!(d2m(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

/// Every help ends with exit codes and examples, and there is a manual page of every subcommand.
#[test]
fn every_help_has_an_example() {
    let help = |words: &[&str]| stdout(&d2m(&[words, &["--help"]].concat()));
    let all = help(&[]);
    let commands = all.split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap().lines();
    let names: Vec<&str> = commands.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() > 15 && all.contains("Examples:"), "{names:?}");
    for name in names.into_iter().filter(|&name| name != "help") {
        let text = help(&[name]);
        assert!(text.contains("Example") && text.contains("Exit codes: 0"), "{name}: {text}");
        assert!(stdout(&d2m(&["man", name])).contains(".TH"), "{name}");
    }
    assert!(stdout(&d2m(&["completions", "bash"])).contains("_d2m()"));
}

#[test]
fn info_describes_meshes_and_shapes() {
    let text = stdout(&d2m(&["info", "shape:torus?triangles=1000"]));
    assert!(
        text.contains("watertight, oriented outwards") && text.contains("Euler characteristic 0"),
        "{text}"
    );
    let value: serde_json::Value =
        serde_json::from_str(&stdout(&d2m(&["info", "shape:box", "--json"]))).unwrap();
    assert_eq!((&value["triangles"], &value["validation"]["watertight"]), (&12.into(), &true.into()));
    let shapes = stdout(&d2m(&["info", "--shapes"]));
    for name in ["box", "icosphere", "torus-knot", "screw", "nut", "chain-link", "paddle-wheel"] {
        assert!(shapes.contains(&format!("\n{name}: ")), "{name}");
    }
    assert!(
        serde_json::from_str::<serde_json::Value>(&stdout(&d2m(&["info", "--shapes", "--json"]))).is_ok()
    );
}

#[test]
fn the_demo_answers_all_scenes() {
    let output = d2m(&["demo"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    let verdicts: Vec<&str> = text
        .lines()
        .filter_map(|line| {
            ["CONTACT", "SEPARATED", "UNDECIDED"].into_iter().find(|word| line.starts_with(word))
        })
        .collect();
    assert_eq!(verdicts, ["CONTACT", "CONTACT", "SEPARATED", "CONTACT", "CONTACT", "CONTACT"], "{text}");
    assert!(text.contains("from the start of the window: contained"), "{text}");
}

#[test]
fn features_answer_line_by_line() {
    let folder = Folder::new("features");
    let rest = r#""motionB": {"q":[1,0,0,0],"x":[0,0,0],"v":[0,0,0],"w":[0,0,0]}, "t0": 0, "t1": 1"#;
    let case = |id: &str, speed: &str| {
        format!(
            r#"{{"id": "{id}", "family": "f", "kind": "point_triangle", "A": {{"p":[0.25,0.25,1]}}, "B": {{"tri":[[0,0,0],[1,0,0],[0,1,0]]}}, "motionA": {{"q":[1,0,0,0],"x":[0,0,0],"v":[0,0,{speed}],"w":[0,0,0]}}, {rest}, "toc": "none"}}"#
        )
    };
    let cases = folder.file("cases.jsonl", &format!("{}\n\n{}\n", case("falls", "-2"), case("rises", "2")));
    let out = folder.path("results.jsonl");
    let output = d2m(&["features", &cases, "--out", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(folder.names(), ["cases.jsonl", "results.jsonl"]);
    let text = fs::read_to_string(&out).unwrap();
    let lines: Vec<serde_json::Value> =
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((&lines[0]["id"], &lines[0]["status"]), (&"falls".into(), &"hit".into()));
    let time = |key: &str| lines[0][key].as_f64().unwrap();
    assert!(time("t_lo") <= 0.5 && 0.5 - 1e-9 < time("t_lo") && time("t_lo") <= time("t_hi"), "{text}");
    assert!(lines[0]["microseconds"].as_f64().unwrap() >= 0.0);
    assert_eq!((&lines[1]["id"], &lines[1]["status"]), (&"rises".into(), &"miss".into()));
    assert_eq!(stdout(&d2m(&["features", &cases, "--out", "-"])).lines().count(), 2);
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_d2m"))
        .args(["info", "--shapes"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", stderr(&output));
}
