//! No result replaces a file that the command reads, whatever names it: an argument, a scene, a robot, a mesh, or another name of the same file.

mod shell;

use shell::{Folder, TRIALS, UNIT_BOX, d2m, refused, stderr, stdout, tetrahedron_in_gltf};
use std::fs;

const SPARED: &str = "is an input and would be overwritten";
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Every file is as it was.
fn unchanged(folder: &Folder, run: impl FnOnce()) {
    let contents = || -> Vec<(String, Vec<u8>)> {
        folder.names().into_iter().map(|name| (name.clone(), fs::read(folder.path(&name)).unwrap())).collect()
    };
    let before = contents();
    run();
    assert_eq!(contents(), before);
}

#[test]
fn meshes_that_scenes_and_robots_name_are_spared() {
    let folder = Folder::new("spared-meshes");
    tetrahedron_in_gltf(&folder, "grain", 1.0);
    let mesh = folder.file("part.obj", CUBE);
    let bodies = r#""bodies": [{"name": "a", "mesh": "part.obj"}, {"name": "b", "mesh": "grain.gltf", "kind": "static", "pose": {"x": [3, 0, 0]}}]"#;
    let falling = folder.file("falling.json", &format!(r#"{{{bodies}, "simulation": {{"end": 0.01}}}}"#));
    let still = r#"{"bodies": [{"name": "a", "mesh": "part.obj"}, {"name": "b", "mesh": "grain.gltf", "motion": {"x": [3, 0, 0]}}]}"#;
    let still = folder.file("still.json", still);
    let robot = r#"<robot name="r"><link name="w"><collision><geometry><mesh filename="grain.gltf"/></geometry></collision></link>
        <link name="m"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
        <joint name="j" type="prismatic"><parent link="w"/><child link="m"/><origin xyz="5 0 0"/></joint></robot>"#;
    let robot = folder.file("r.urdf", robot);
    let path = r#"{"joint_names": ["j"], "points": [{"positions": [0], "time_from_start": 0}, {"positions": [1], "time_from_start": 1}]}"#;
    let path = folder.file("path.json", path);
    let buffer = folder.path("grain.bin");
    unchanged(&folder, || {
        refused(&["simulate", &falling, "--out", &mesh], &["part.obj", SPARED]);
        refused(&["simulate", &falling, "--out", &buffer], &["grain.bin", SPARED]);
        refused(&["view", &still, "--out", &buffer], &["grain.bin", SPARED]);
        // Nor is another result written before that is seen.
        let page = folder.path("page.html");
        refused(&["view", &still, "--out", &page, "--png", &buffer], &["grain.bin", SPARED]);
        let asked = ["robot", &robot, "--path", &path, "--view", &buffer];
        let output = d2m(&asked);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stdout(&output).is_empty() && stderr(&output).contains(SPARED), "{}", stderr(&output));
    });
}

#[test]
fn files_that_meshes_name_are_spared() {
    let folder = Folder::new("spared-buffers");
    let mesh = tetrahedron_in_gltf(&folder, "grain", 1.0);
    let trials = folder.file("trials.csv", TRIALS);
    let buffer = folder.path("grain.bin");
    unchanged(&folder, || {
        refused(&["info", &mesh, "--obj", &buffer], &["grain.bin", SPARED]);
        let ply = folder.path("grain.ply");
        refused(&["info", &mesh, "--ply", &ply, "--obj", &buffer], &["grain.bin", SPARED]);
        refused(&["batch", &mesh, UNIT_BOX, "--trials", &trials, "--out", &buffer], &["grain.bin", SPARED]);
        refused(&["toc", &mesh, UNIT_BOX, "--obj", &buffer], &["grain.bin", SPARED]);
        refused(&["view", UNIT_BOX, &mesh, "--out", &buffer], &["grain.bin", SPARED]);
    });
}

/// A hard link is the file itself; a run is written into it bit by bit.
#[cfg(unix)]
#[test]
fn other_names_of_inputs_are_spared() {
    let folder = Folder::new("spared-links");
    let scene = folder.file(
        "scene.json",
        &format!(r#"{{"bodies": [{{"name": "a", "mesh": "{UNIT_BOX}"}}], "simulation": {{"end": 0.01}}}}"#),
    );
    let [hard, soft] = ["hard.jsonl", "soft.jsonl"].map(|name| folder.path(name));
    fs::hard_link(&scene, &hard).unwrap();
    std::os::unix::fs::symlink("scene.json", &soft).unwrap();
    unchanged(&folder, || {
        refused(&["simulate", &scene, "--out", &hard], &["hard.jsonl", SPARED]);
        refused(&["simulate", &scene, "--out", &soft], &[SPARED]);
        // The shell may have opened the file.
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_d2m"))
            .args(["simulate", "-", "--out", &hard])
            .stdin(fs::File::open(&scene).unwrap())
            .output()
            .unwrap();
        assert!(output.status.code() == Some(3) && stderr(&output).contains(SPARED), "{}", stderr(&output));
    });
    // What is not read may be replaced.
    let other = folder.file("other.jsonl", "old");
    assert!(d2m(&["simulate", &scene, "--out", &other]).status.success());
}
