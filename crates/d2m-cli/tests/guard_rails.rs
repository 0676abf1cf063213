//! What catches people's slips: sizes, units, angles, orders of numbers, names of options.

mod shell;

use shell::{Folder, d2m, refused, stderr, stdout};
use std::fs;

const CUBE: &str = "shape:box?x=1&y=1&z=1";

#[test]
fn units_and_scales_are_applied() {
    let folder = Folder::new("units");
    // A cube of 2000 mm as a cube of 2 m.
    let millimeters = folder.path("mm.obj");
    let made = d2m(&["info", "shape:box?x=1000&y=1000&z=1000", "--obj", &millimeters]);
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let toc = |arguments: &[&str]| {
        let all: Vec<&str> = ["toc", &millimeters, CUBE, "--motion-a", "x=-3,0,0;v=4,0,0"]
            .iter()
            .chain(arguments)
            .copied()
            .collect();
        let run = d2m(&all);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        run
    };
    let mixed = toc(&[]);
    assert!(stdout(&mixed).starts_with("CONTACT at t = 0\n"), "{}", stdout(&mixed));
    assert!(
        stderr(&mixed).contains("warning: A is 3464 across and B 3.464: are both in the same unit?"),
        "{}",
        stderr(&mixed)
    );
    for right in [
        &["--unit-a", "mm"][..],
        &["--scale-a", "0.001"],
        &["--scale-a=1e-3,1e-3,1e-3"],
        &["--unit-b", "m", "--unit-a=mm"],
    ] {
        let run = toc(right);
        assert!(stdout(&run).starts_with("CONTACT at t = 0.24999"), "{right:?}: {}", stdout(&run));
        assert!(stderr(&run).is_empty(), "{}", stderr(&run));
        let text = stdout(&run);
        let last = text.lines().last().unwrap();
        assert_eq!(
            last.trim_start(),
            "sizes       A is 3.464 across, moves 4 and turns 0° · B is 3.464 across, moves 0 and turns 0°"
        );
    }
    for size in ["--unit=mm", "--scale=0.001"] {
        let meters = folder.path("m.ply");
        let info = stdout(&d2m(&["info", &millimeters, size, "--ply", &meters]));
        assert!(info.contains("volume      8.000000"), "{info}");
        assert!(stdout(&d2m(&["info", &meters])).contains("volume      8.000000"));
    }
    refused(&["info", CUBE, "--unit", "furlong"], &["--unit: \"furlong\" is not a unit"]);
    let inches = d2m(&["distance", CUBE, CUBE, "--unit-b=in", "--pose-a=x=3,0,0", "--json"]);
    assert!(stdout(&inches).contains("\"distance\":1.9746"), "{}", stdout(&inches));
    let tree = folder.path("mm.d2mtree");
    assert_eq!(d2m(&["tree", &millimeters, "--out", &tree]).status.code(), Some(0));
    let run = d2m(&["collide", &tree, CUBE, "--unit-a=mm", "--pose-a=x=2.5,0,0"]);
    assert!(stdout(&run).starts_with("SEPARATED"), "{}", stdout(&run));
    for (option, value, words) in [
        ("--scale-a", "0", ["--scale-a", "0 has to be finite and not zero"]),
        ("--scale-b", "1,2", ["--scale-b", "2 numbers"]),
        ("--scale-b", "nan", ["--scale-b", "finite"]),
        ("--unit-a", "furlong", ["--unit-a", "\"furlong\" is not a unit of length: mm, cm, m or in"]),
    ] {
        refused(&["toc", CUBE, CUBE, option, value], &words);
        refused(&["distance", CUBE, CUBE, option, value], &words);
    }
}

#[test]
fn angles_in_degrees() {
    let turned = |motion: &str| {
        let run = d2m(&["toc", CUBE, CUBE, "--motion-a", motion, "--json"]);
        assert_eq!(run.status.code(), Some(0), "{motion}: {}", stderr(&run));
        // All but the time that it took.
        let text = stdout(&run);
        let (start, rest) = text.split_once("\"microseconds\":").unwrap();
        format!("{start}{}", rest.split_once(',').unwrap().1)
    };
    assert_eq!(
        turned("x=-3,0.1,0;v=4,0,0;w=0,0,90deg"),
        turned(&format!("x=-3,0.1,0;v=4,0,0;w=0,0,{}", std::f64::consts::FRAC_PI_2))
    );
    assert!(turned("x=0,0,-4;v=0,0,4;rpy=0,0,45deg").contains("\"contact\""));
    refused(&["toc", CUBE, CUBE, "--motion-a", "rpy=0,0,1;q=1,0,0,0"], &["--motion-a", "rpy", "not by both"]);
    refused(&["toc", CUBE, CUBE, "--motion-a", "x=1deg,0,0"], &["x", "\"1deg\" is not a number"]);
    refused(&["toc", CUBE, CUBE, "--motion-a", "rpy=1e300,0,0"], &["rpy", "1e300"]);
}

#[test]
fn doubtful_turns_are_warned_of() {
    let folder = Folder::new("turns");
    let file = folder.file(
        "m.json",
        r#"{"times": [0, 1], "poses": [{"q": [0, 0, 0, 1]}, {"x": [1, 0, 0], "q": [0, 0, 0, 2]}]}"#,
    );
    for (motion, expected) in [
        ("q=0,0,0,1", "--motion-a: q = 0,0,0,1 is half a turn about z: w comes first"),
        ("q=0.9,0,0,0", "--motion-a: q = [0.9, 0.0, 0.0, 0.0] has the length 0.9, not 1; it is normalized"),
        ("rpy=0,90,45deg", "--motion-a: rpy = 0,90,45deg is in radians, and more than a whole turn"),
        ("w=0,0,90", "--motion-a: the body turns 14.32 times in the window"),
        (&format!("@{file}"), "m.json: q = [0.0, 0.0, 0.0, 2.0] has the length 2"),
        (&format!("@{file}"), "m.json: q = 0,0,0,1 is half a turn"),
    ] {
        let run = d2m(&["toc", CUBE, CUBE, "--motion-a", motion, "--motion-b", "x=9,0,0"]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        assert!(
            stderr(&run).contains(&format!("warning: {expected}")) || stderr(&run).contains(expected),
            "{}",
            stderr(&run)
        );
    }
    for quiet in ["q=0.70710678,0,0,0.70710678", "w=0,0,6.28", "rpy=0,0,180deg", "rpy=0,6.28,-3", ""] {
        let run = d2m(&["toc", CUBE, CUBE, "--motion-a", quiet]);
        assert!(stderr(&run).is_empty(), "{quiet}: {}", stderr(&run));
    }
    let list =
        r#"{"times": [0, 1, 2], "poses": [{"q": [2, 0, 0, 0]}, {"q": [3, 0, 0, 0]}, {"q": [4, 0, 0, 0]}]}"#;
    let list = folder.file("list.json", list);
    let run = d2m(&["toc", CUBE, CUBE, "--motion-a", &format!("@{list}"), "--motion-b", "x=9,0,0"]);
    let all = stderr(&run);
    assert!(all.contains("has the length 2, not 1; it is normalized (2 more like it)"), "{all}");
    assert_eq!(all.matches("warning").count(), 1, "{all}");
    let trials = folder.file("t.csv", "2,0,0,0,-3,0,0,4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n");
    let run = d2m(&["batch", CUBE, CUBE, "--trials", &trials, "--out", "-"]);
    assert!(
        stderr(&run).contains(
            "1 trials have a quaternion that is not of length 1, which is normalized, the first in line 1"
        ),
        "{}",
        stderr(&run)
    );
}

#[test]
fn scenes_of_simulations_are_warned_of_as_others_are() {
    let folder = Folder::new("sizes-simulated");
    let text = r#"{"bodies": [
        {"name": "large", "mesh": "shape:box", "kind": "kinematic", "motion": {"x": [9, 0, 0], "w": [0, 0, 90]}},
        {"name": "small", "mesh": "shape:box", "scale": 0.001, "pose": {"q": [0, 0, 0, 1]}},
        {"name": "other", "mesh": "shape:box", "pose": {"x": [0, 9, 0], "q": [0.5, 0, 0, 0]}}
    ], "simulation": {"end": 1, "step": 0.5, "gravity": [0, 0, 0]}}"#;
    let scene = folder.file("s.json", text);
    let run = d2m(&["simulate", &scene, "--out", &folder.path("s.jsonl")]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    for expected in [
        "s.json: small is 0.002 across and other 2: are both in the same unit? (\"scale\")",
        "body 0 (\"large\"), motion: the body turns 14.32 times in the window",
        "s.json: q = 0,0,0,1 is half a turn about z",
        "s.json: q = [0.5, 0.0, 0.0, 0.0] has the length 0.5",
    ] {
        assert!(stderr(&run).contains(expected), "{expected}: {}", stderr(&run));
    }
}

#[test]
fn hints_where_people_trip() {
    let folder = Folder::new("hints");
    let motion = folder.file("m1.json", r#"{"x": [1, 0, 0]}"#);
    refused(&["toc", CUBE, CUBE, "--motion-a", &motion], &["--motion-a", &format!("in front: @{motion}")]);
    refused(&["distance", CUBE, CUBE, "--pose-a", "m1.json"], &["--pose-a", "@m1.json"]);
    refused(&["info", "-"], &["a mesh is read from a file"]);
    refused(&["info", "torus-knot"], &["is the built-in shape:torus-knot meant?"]);
    refused(&["toc", "gear?teeth=12", CUBE], &["shape:gear?teeth=12"]);
    let simulation = folder
        .file("s.json", r#"{"bodies": [{"name": "a", "mesh": "shape:box"}], "simulation": {"end": 1}}"#);
    refused(&["scene", &simulation], &["s.json", "unknown field `simulation`", "d2m simulate"]);
    let dynamic =
        folder.file("d.json", r#"{"bodies": [{"name": "a", "mesh": "shape:box", "kind": "static"}]}"#);
    refused(&["scene", &dynamic], &["d.json", "unknown field `kind`", "d2m simulate"]);
    for (command, given, wanted) in
        [("distance", "--motion-a", "--pose-a"), ("toc", "--pose-b=x=1,0,0", "--motion-b")]
    {
        let run = d2m(&[command, CUBE, CUBE, given, "x=1,0,0"]);
        assert_eq!(run.status.code(), Some(2));
        assert!(stderr(&run).contains(&format!("{command} takes {wanted}, not ")), "{}", stderr(&run));
    }
    let path = folder.file("p.json", r#"{"times": [0, 0.5], "poses": [{}, {}]}"#);
    refused(
        &["toc", CUBE, CUBE, "--motion-a", &format!("@{path}")],
        &["--motion-a", "from 0.0 to 0.5, not the whole window"],
    );
}

#[test]
fn batches_go_on_where_they_ended() {
    let folder = Folder::new("resume");
    let line = |k: usize| format!("1,0,0,0,-3,0,{},4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n", k as f64 * 1e-3);
    let trials = folder.file("t.csv", &(0..600).map(line).collect::<String>());
    let run = |out: &str, resume: bool| {
        let mut all = vec!["batch", CUBE, CUBE, "--trials", &trials, "--out", out];
        all.extend(resume.then_some("--resume"));
        let run = d2m(&all);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        stderr(&run)
    };
    let (plain, kept) = (folder.path("plain.csv"), folder.path("kept.csv"));
    run(&plain, false);
    run(&kept, true);
    // All but the times.
    let answers = |path: &str| -> Vec<String> {
        let text = fs::read_to_string(path).unwrap();
        text.lines()
            .map(|line| {
                line.split(',')
                    .enumerate()
                    .filter(|(k, _)| *k != 5)
                    .map(|(_, f)| f)
                    .collect::<Vec<_>>()
                    .join(",")
            })
            .collect()
    };
    assert_eq!(answers(&plain), answers(&kept));
    assert!(!folder.names().contains(&"kept.csv.part".to_owned()));
    // As if the run had ended in the middle of a line.
    let text = fs::read_to_string(&plain).unwrap();
    let part = folder.path("kept.csv.part");
    let limited = ["batch", CUBE, CUBE, "--trials", &trials, "--out", &kept, "--resume"];
    fs::write(&part, "").unwrap();
    assert_eq!(d2m(&limited).status.code(), Some(0));
    fs::write(&part, "# of something else\n0,separated\n").unwrap();
    refused(&limited, &["kept.csv.part", "other inputs"]);
    fs::remove_file(&part).unwrap();
    // Trial 400 cannot be answered: what was answered before it is kept, and not answered again.
    let fast = line(400).replace("0,0,0,0,0,0,0,0,0\n", "0,0,0,0,0,0,1e50,0,0\n");
    folder
        .file("t.csv", &(0..600).map(|k| if k == 400 { fast.clone() } else { line(k) }).collect::<String>());
    let first = d2m(&limited);
    assert_eq!(first.status.code(), Some(3));
    let kept_lines = fs::read_to_string(&part).unwrap();
    assert_eq!(kept_lines.lines().count(), 257, "a part of 256 and the line above");
    assert!(text.contains(kept_lines.lines().nth(1).unwrap().split(',').next().unwrap()));
    fs::write(&part, format!("{kept_lines}256,sep")).unwrap();
    let second = d2m(&limited);
    assert!(stderr(&second).contains("256 of 600 trials were answered before"), "{}", stderr(&second));
    assert_eq!(fs::read_to_string(&part).unwrap(), kept_lines, "half a line is dropped");
    refused(&["batch", CUBE, CUBE, "--trials", "-", "--out", &kept, "--resume"], &["--resume"]);
    refused(
        &["batch", CUBE, CUBE, "--trials", &trials, "--out", "-", "--resume"],
        &["--resume", "name a file"],
    );
}

#[test]
fn shells_and_manuals() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = d2m(&["completions", shell]);
        assert_eq!(run.status.code(), Some(0));
        assert!(stdout(&run).contains("min-separation"), "{shell}");
    }
    assert!(stdout(&d2m(&["man"])).contains(".TH d2m 1"));
    assert!(stdout(&d2m(&["man", "toc"])).contains("motion"));
    refused(&["man", "nothing"], &["there is no subcommand \"nothing\""]);
}

#[test]
fn meshes_of_every_kind_and_back() {
    let folder = Folder::new("kinds");
    let [obj, ply, glb] = ["g.obj", "g.ply", "g.glb"].map(|name| folder.path(name));
    let gear = "shape:gear?triangles=500";
    let run = d2m(&["info", gear, "--obj", &obj, "--ply", &ply, "--glb", &glb]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    for file in [&obj, &ply, &glb] {
        let run = d2m(&["distance", file, gear, "--pose-a=x=0,0,50", "--json"]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        assert!(stdout(&run).contains("\"solid\":true"), "watertight: {}", stdout(&run));
    }
    // A glTF file is in meters: another unit is taken, and said.
    let run = d2m(&["info", &glb, "--unit", "mm"]);
    assert!(
        stderr(&run).contains("g.glb: the file states a unit of 1 m; its numbers are taken as mm"),
        "{}",
        stderr(&run)
    );
    assert!(
        stdout(&run).contains("\n  unit        mm, as the option says: read as meters\n"),
        "{}",
        stdout(&run)
    );
    let run = d2m(&["toc", &glb, &obj, "--unit-a", "m", "--unit-b", "mm"]);
    assert!(!stderr(&run).contains("states a unit"), "{}", stderr(&run));
    let off = folder.file("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    assert!(stdout(&d2m(&["info", &off])).contains("triangles   1\n"));
    let dae = folder
        .file("t.dae", "<COLLADA><asset><unit meter=\"0.01\"/><up_axis>Y_UP</up_axis></asset></COLLADA>");
    refused(&["info", &dae], &["t.dae", "the mesh has no triangles"]);
}

/// A body of a scene that is given in another unit is named, also where it stands beside a robot.
#[test]
fn bodies_of_scenes_in_other_units_are_named() {
    let folder = Folder::new("unlike-sizes");
    let scene = |name: &str, size: &str| {
        let body = |name: &str, mesh: &str, x: f64| {
            format!("{{\"name\": \"{name}\", \"mesh\": \"{mesh}\", \"motion\": {{\"x\": [{x}, 0, 0]}}}}")
        };
        let large = body("plate", &format!("shape:box?x={size}&y={size}&z={size}"), 1e4);
        let bodies = [body("screw", "shape:box?x=0.01&y=0.01&z=0.01", 0.0), body("nut", CUBE, 9.0), large];
        folder.file(name, &format!("{{\"window\": [0, 1], \"bodies\": [{}]}}", bodies.join(", ")))
    };
    let [mixed, alike] = [scene("mixed.json", "300"), scene("alike.json", "0.9")];
    let words = "screw is 0.03464 across and plate 1039: are both in the same unit? (\"scale\")";
    for command in ["scene", "clearance", "spans"] {
        let run = d2m(&[command, &mixed]);
        let message = stderr(&run);
        assert!(run.status.success() && message.contains(words), "{command}: {message}");
        assert_eq!(message.lines().count(), 1, "{command}: {message}");
        assert!(stderr(&d2m(&[command, &alike])).is_empty(), "{command}");
    }
    let robot = folder.file(
        "post.urdf",
        r#"<robot name="post"><link name="base"/><link name="post"><collision><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
           <joint name="turn" type="continuous"><parent link="base"/><child link="post"/><axis xyz="0 0 1"/></joint></robot>"#,
    );
    let path = folder.file(
        "path.json",
        r#"{"joint_names": ["turn"], "points": [{"positions": [0], "time_from_start": 0}, {"positions": [1], "time_from_start": 1}]}"#,
    );
    let around = folder.file(
        "around.json",
        r#"{"bodies": [{"name": "box in mm", "mesh": "shape:box?x=100&y=100&z=100", "pose": {"x": [500, 0, 0]}},
                      {"name": "box in m", "mesh": "shape:box?x=0.1&y=0.1&z=0.1", "pose": {"x": [0.5, 0, 0]}}]}"#,
    );
    let run = d2m(&["robot", &robot, "--path", &path, "--scene", &around]);
    let message = stderr(&run);
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(
        message.contains("box in mm is 346.4 across and post 1.01: are both in the same unit?"),
        "{message}"
    );
}
