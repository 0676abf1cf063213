//! Files that the command reads and writes: bad ones are named, results are complete or absent and replace no input.

mod shell;

use shell::{BOX_AT, Folder, HEADER, TRIALS, UNIT_BOX, d2m, refused, stdout};
use std::fs;
use std::path::Path;

#[test]
fn motions_from_files() {
    let folder = Folder::new("motions");
    let linear = folder.file("linear.json", r#"{"x": [-3, 0, 0], "v": [4, 0, 0]}"#);
    let text = stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", &format!("@{linear}")]));
    assert!(text.starts_with("CONTACT at t = 0.24999999"), "{text}");
    // Waits for one unit of time, then comes.
    let keyframes = folder.file(
        "keyframes.json",
        r#"{"times": [0, 1, 2], "spans": [{"x": [-3, 0, 0]}, {"x": [-3, 0, 0], "v": [4, 0, 0], "t": 1}]}"#,
    );
    let motion = format!("@{keyframes}");
    let text = stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", &motion, "--window", "0,2"]));
    assert!(text.starts_with("CONTACT at t = 1.24999999"), "{text}");
    let text = stdout(&d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-b", &motion, "--window", "0,1.2"]));
    assert!(text.starts_with("SEPARATED"), "{text}");
    refused(
        &["toc", UNIT_BOX, UNIT_BOX, "--motion-a", &motion, "--window", "0,3"],
        &["--motion-a", "covers the times from 0.0 to 2.0", "3"],
    );
    let broken = folder.file("broken.json", "{\"x\": [1, 2");
    refused(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", &format!("@{broken}")], &["broken.json", "line 1"]);
    let unknown = folder.file("unknown.json", "{\"y\": 3}");
    refused(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", &format!("@{unknown}")], &["unknown.json", "y"]);
}

#[test]
fn bad_input_is_named_and_leaves_nothing() {
    let folder = Folder::new("bad");
    let trials = folder.file("good.csv", TRIALS);
    let meshes = [
        ("empty.obj", "", "is empty"),
        ("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "line 2: vertex 2: x is nan"),
        ("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "line 4: vertex index 7"),
        ("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no triangles"),
        ("mesh.abc", "v 0 0 0\n", "unknown kind"),
        ("mesh", "v 0 0 0\n", "unknown kind"),
        ("words.stl", "hello", "neither"),
        ("words.ply", "hello", "ply"),
    ];
    for (name, contents, word) in meshes {
        let mesh = folder.file(name, contents);
        let out = folder.path("out.csv");
        refused(&["info", &mesh], &[name, word]);
        refused(&["toc", UNIT_BOX, &mesh], &[name, word]);
        refused(&["batch", &mesh, UNIT_BOX, "--trials", &trials, "--out", &out], &[name, word]);
    }
    refused(&["info", &folder.path("absent.obj")], &["absent.obj"]);
    refused(&["info", &folder.path(".obj")], &[".obj"]);
    fs::create_dir(Path::new(&folder.path("")).join("folder.obj")).unwrap();
    refused(&["info", &folder.path("folder.obj")], &["folder.obj", "folder"]);
    refused(&["info", "shape:sfere"], &["sfere", "icosphere"]);
    refused(&["info", "shape:torus?triangles=many"], &["torus", "many"]);

    let line = TRIALS.lines().next().unwrap();
    let trials_files = [
        ("empty.csv", String::new(), "is empty"),
        ("blank.csv", "\n\n".to_owned(), "no trials"),
        ("short.csv", format!("{line}\n1,2,3\n"), "line 2: expected 26 numbers"),
        ("word.csv", format!("{line}\n{}\n", line.replace("-3", "x")), "line 2: field 5 (x1 of A): \"x\""),
        ("nan.csv", line.replace("-3", "NaN"), "line 1: field 5 (x1 of A): NaN"),
        ("far.csv", format!("\n{}", line.replace("-3", "1e300")), "line 2: field 5 (x1 of A): 1e300"),
        ("fast.csv", format!("\n{line}\n{}9e12\n", &line[..line.len() - 1]), "line 3 (trial 1): motion of B"),
        ("zero.csv", line.replacen('1', "0", 1), "line 1: motion of A"),
        ("binary.csv", "\u{0}\u{1}\u{2}".to_owned(), "line 1"),
    ];
    for (name, contents, word) in trials_files {
        let file = folder.file(name, &contents);
        let out = folder.path("out.csv");
        refused(&["batch", UNIT_BOX, UNIT_BOX, "--trials", &file, "--out", &out], &[name, word]);
    }
    refused(
        &["batch", UNIT_BOX, UNIT_BOX, "--trials", &trials, "--out", &folder.path("no/out.csv")],
        &["no"],
    );
    refused(
        &["batch", UNIT_BOX, UNIT_BOX, "--trials", &trials, "--out", &folder.path("folder.obj")],
        &["folder"],
    );
    let cases = folder.file("cases.jsonl", "{\"id\": \"a\"}\n");
    refused(
        &["features", &cases, "--out", &folder.path("out.jsonl")],
        &["cases.jsonl, line 1: missing field"],
    );
    let straight = r#"{"id": "a", "kind": "point_triangle_linear", "t0_points": [[0,0,1],[0,0,0],[1,0,0],[0,1,0]], "t1_points": [[0,0,-1],[0,0,0],[1,0,0],[0,1,0]]}"#;
    for (fault, words) in [
        ("{broken".to_owned(), "line 3: key must be a string (before column 2)"),
        (straight.replace("point_triangle_linear", "point_cube"), "line 3: unknown variant `point_cube`"),
        (straight.replace("-1]", "1e999]"), "line 3: number out of range"),
    ] {
        let cases = folder.file("third.jsonl", &format!("\u{feff}{straight}\n\n{fault}\n"));
        refused(&["features", &cases, "--out", &folder.path("out.jsonl")], &["third.jsonl", words]);
    }
    refused(&["features", &cases, "--out", "-", "--tolerance", "0"], &["--tolerance", "positive"]);
    refused(&["features", &cases, "--out", "-", "--min-separation", "-1"], &["--min-separation", "negative"]);
    refused(&["features", &folder.path("absent.jsonl"), "--out", "-"], &["absent.jsonl"]);
    refused(&["features", &folder.path("blank.csv"), "--out", "-"], &["blank.csv", "no cases"]);
    refused(&["features", &folder.path("empty.csv"), "--out", "-"], &["empty.csv", "is empty"]);
    assert!(!folder.names().iter().any(|name| name.starts_with("out") || name.contains("tmp")));

    for (option, value, word) in [
        ("--window", "1,0", "reversed"),
        ("--window", "0,inf", "finite"),
        ("--window", "0", "T0,T1"),
        ("--window", "a,b", "\"a\""),
        ("--motion-a", "q=0,0,0,0", "(0.0, 0.0, 0.0, 0.0)"),
        ("--motion-a", "v=1,2", "3 numbers"),
        ("--motion-b", "v=nan,0,0", "nan"),
        ("--motion-b", "u=1,2,3", "u"),
        ("--motion-b", "w=1e300,0,0", "turns by"),
        ("--motion-b", "@", "name of a file"),
        ("--window", "-1e308,1e308", "length"),
        ("--tolerance", "0", "positive"),
        ("--tolerance", "-1e-9", "positive"),
        ("--tolerance", "nan", "positive"),
        ("--tolerance", "small", "not a number"),
        ("--time-limit", "0", "positive"),
        ("--time-limit", "-1", "positive"),
        ("--min-separation", "-1", "negative"),
        ("--min-separation", "inf", "finite"),
    ] {
        refused(
            &["toc", UNIT_BOX, UNIT_BOX, option, value],
            &[option.trim_start_matches("--motion-b"), word],
        );
    }
}

#[test]
fn inputs_and_read_only_files_are_not_replaced() {
    let folder = Folder::new("protected");
    let trials = folder.file("trials.csv", TRIALS);
    let batch = ["batch", UNIT_BOX, UNIT_BOX, "--trials", &trials, "--out"];
    refused(&[&batch[..], &[&trials]].concat(), &["trials.csv", "input"]);
    let motion = folder.file("motion.json", r#"{"x": [-3, 0, 0]}"#);
    let from_file = format!("@{motion}");
    refused(
        &["toc", UNIT_BOX, UNIT_BOX, "--motion-b", &from_file, "--obj", &motion],
        &["motion.json", "input"],
    );
    refused(&[&batch[..], &[""]].concat(), &["empty"]);
    // Before hours of work, not after them.
    refused(
        &[&batch[..], &["new.csv", "--verify", "2"]].concat(),
        &["--verify: 2 is not a share from 0 to 1"],
    );
    let precious = folder.file("precious.csv", "1,2,3\n");
    let mut permissions = fs::metadata(&precious).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&precious, permissions).unwrap();
    refused(&[&batch[..], &[&precious]].concat(), &["precious.csv", "read-only"]);
    assert_eq!(fs::read_to_string(&precious).unwrap(), "1,2,3\n");
    assert_eq!(fs::read_to_string(&trials).unwrap(), TRIALS);
    // Nor is one of two results lost in the other, or written where its name says another kind of file.
    let (same, mesh) = (folder.path("same.html"), folder.path("mesh.stl"));
    let other = format!("{}/../protected/same.html", folder.path(""));
    refused(&["info", UNIT_BOX, "--obj", "-", "--ply", "-"], &["standard output: two results"]);
    // The answer itself is a result, too.
    for answer in [&[][..], &["--json"]] {
        for mesh in ["--obj", "--ply", "--glb"] {
            refused(&[&["info", UNIT_BOX, mesh, "-"], answer].concat(), &["standard output: two results"]);
        }
        refused(
            &[&["toc", UNIT_BOX, UNIT_BOX, "--obj", "-"], answer].concat(),
            &["standard output: two results"],
        );
    }
    refused(&["view", UNIT_BOX, UNIT_BOX, "--out", &same, "--png", &same], &["same.html", "--png writes"]);
    let same = same.replace("html", "x");
    let other = other.replace("html", "x");
    refused(&["view", UNIT_BOX, UNIT_BOX, "--out", &same, "--png", &other], &["same.x", "two results"]);
    refused(&["info", UNIT_BOX, "--obj", &mesh], &["mesh.stl", "--obj writes", "expected .obj"]);
    refused(&["toc", UNIT_BOX, UNIT_BOX, "--obj", &mesh], &["mesh.stl", "--obj writes"]);
    refused(&["view", UNIT_BOX, UNIT_BOX, "--out", &folder.path("view.png")], &["view.png", "--out writes"]);
    assert_eq!(folder.names(), ["motion.json", "precious.csv", "trials.csv"]);
    // Replacing an old result is what a second run does.
    let out = folder.file("old.csv", "old");
    assert_eq!(d2m(&[&batch[..], &[&out]].concat()).status.code(), Some(0));
    assert!(fs::read_to_string(&out).unwrap().starts_with(HEADER));
    // A link stays a link.
    #[cfg(unix)]
    {
        let target = folder.file("target.csv", "old");
        let link = folder.path("link.csv");
        std::os::unix::fs::symlink("target.csv", &link).unwrap();
        assert_eq!(d2m(&[&batch[..], &[&link]].concat()).status.code(), Some(0));
        assert!(Path::new(&link).is_symlink());
        assert!(fs::read_to_string(&target).unwrap().starts_with(HEADER));
    }
}

#[test]
fn exported_meshes_load_again() {
    let folder = Folder::new("export");
    let obj = folder.path("gear.obj");
    let before = stdout(&d2m(&["info", "shape:gear", "--obj", &obj]));
    let after = stdout(&d2m(&["info", &obj]));
    assert_eq!(before.lines().skip(1).collect::<Vec<_>>(), after.lines().skip(1).collect::<Vec<_>>());
    let scene = folder.path("scene.obj");
    let output = d2m(&["toc", UNIT_BOX, UNIT_BOX, "--motion-a", BOX_AT, "--obj", &scene]);
    assert_eq!(output.status.code(), Some(0));
    let text = fs::read_to_string(&scene).unwrap();
    assert!(text.contains("\no A\n") && text.contains("\no B\n"));
    let text = stdout(&d2m(&["info", &scene]));
    assert!(text.contains("triangles   24") && text.contains("parts       2"), "{text}");
}

/// Cases of features, runs and paths of robots: a list is no object with its values in order.
#[test]
fn keys_of_other_files_are_read_from_objects_too() {
    let folder = Folder::new("lists");
    let place = |x: f64, v: f64| {
        format!(r#"{{"x": [{x}, 0, 0], "q": [1, 0, 0, 0], "v": [{v}, 0, 0], "w": [0, 0, 0]}}"#)
    };
    let case = |b: &str| {
        let [rest, comes] = [place(0.0, 0.0), place(-3.0, 4.0)];
        format!(
            r#"{{"id": "k", "kind": "sphere_sphere", "A": {{"c": [0, 0, 0], "r": 1}}, "B": {b}, "motionA": {rest}, "motionB": {comes}, "t0": 0, "t1": 1}}"#
        )
    };
    let good = folder.file("good.jsonl", &case(r#"{"c": [0, 0, 0], "r": 1}"#));
    let out = folder.path("answers.jsonl");
    assert!(d2m(&["features", &good, "--out", &out]).status.success());
    let bad = folder.file("bad.jsonl", &case("[[0, 0, 0], 1]"));
    refused(&["features", &bad, "--out", &out], &["bad.jsonl, line 1", "an object with keys"]);

    folder.file("scene.json", r#"{"bodies": [{"name": "b", "mesh": "shape:box"}]}"#);
    let header = r#"{"scene": "scene.json", "bodies": [{"name": "b", "center": [0, 0, 0]}]}"#;
    let segment = format!(r#"{{"t0": 0, "t1": 1, "bodies": [{}]}}"#, place(0.0, 1.0));
    let page = folder.path("page.html");
    let view = |lines: [&str; 2], line: Option<u32>| {
        let run = folder.file("run.jsonl", &format!("{}\n{}\n", lines[0], lines[1]));
        let asked = ["view", &run, "--out", &page];
        match line {
            Some(line) => refused(&asked, &[&format!("run.jsonl, line {line}"), "an object with keys"]),
            None => assert!(d2m(&asked).status.success()),
        }
    };
    view([header, &segment], None);
    view([r#"["scene.json", [{"name": "b", "center": [0, 0, 0]}]]"#, &segment], Some(1));
    view([r#"{"scene": "scene.json", "bodies": [["b", [0, 0, 0]]]}"#, &segment], Some(1));
    let state = "[[0, 0, 0], [1, 0, 0, 0], [0, 0, 0], [0, 0, 0]]";
    view([header, &format!("[0, 1, [{}]]", place(0.0, 1.0))], Some(2));
    view([header, &format!(r#"{{"t0": 0, "t1": 1, "bodies": [{state}]}}"#)], Some(2));
    view([header, &format!(r#"{{"t0": 0, "t1": 1, "changed": [[0, {state}]]}}"#)], Some(2));
    let impulse = r#""contacts": [[[0, 0, 0], [0, 1, 0], [0, 1, 0]]]"#;
    view([header, &format!("{}, {impulse}}}", &segment[..segment.len() - 1])], Some(2));

    let robot = r#"<robot name="r"><link name="w"/><link name="m"/><joint name="j" type="continuous"><parent link="w"/><child link="m"/></joint></robot>"#;
    let robot = folder.file("r.urdf", robot);
    let point = r#"{"positions": [0], "time_from_start": 0}"#;
    for path in [
        format!(r#"{{"joint_names": ["j"], "points": [{point}, [[1], [], [], [], 1]]}}"#),
        format!(r#"[["j"], [{point}, {point}]]"#),
    ] {
        let path = folder.file("path.json", &path);
        refused(&["robot", &robot, "--path", &path], &["path.json", "an object with keys"]);
    }
}
