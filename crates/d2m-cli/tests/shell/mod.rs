//! The command as a shell runs it, with files in a folder of its own.
#![allow(dead_code)] // not every test needs all of it

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub(crate) const BOX_AT: &str = "x=-3,0,0;v=4,0,0";
/// Two boxes of half size 1 that meet at t = 1/4; then the same pair standing still; then one that turns away.
pub(crate) const TRIALS: &str = "\
1,0,0,0,-3,0,0,4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0
1,0,0,0,-3,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0

2,0,0,0,-3,0.1,0.2,-4,0,0,0,0,3,1,0,0,0,0,0,0,0,0,0,0,1,0
1,0,0,0,0.5,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0
";
pub(crate) const UNIT_BOX: &str = "shape:box?x=1&y=1&z=1";
pub(crate) const HEADER: &str = "trial,status,toc,toc_hi,separation,microseconds,normal_x,normal_y,normal_z,point_x,point_y,point_z,feature,triangle_a,triangle_b,evidence,tolerance";

/// Runs the command with something on standard input.
pub(crate) fn d2m_with_input(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_d2m"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that refuses its arguments reads nothing.
    let _ = std::io::Write::write_all(&mut child.stdin.take().unwrap(), input);
    child.wait_with_output().unwrap()
}

pub(crate) fn d2m(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_d2m")).args(arguments).stdin(Stdio::null()).output().unwrap()
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A folder of its own for each test, removed at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    pub(crate) fn file(&self, name: &str, contents: &str) -> String {
        fs::write(self.0.join(name), contents).unwrap();
        self.path(name)
    }

    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(&self.0)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Exit code 3, nothing on standard output, one line on standard error that holds all the words.
pub(crate) fn refused(arguments: &[&str], words: &[&str]) {
    let output = d2m(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}: {}", stdout(&output));
    assert_eq!(message.lines().count(), 1, "{arguments:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{arguments:?}: {message:?} lacks {word:?}");
    }
}

/// A glTF file with the tetrahedron between the origin and the points at this distance on the axes, whose numbers are in a file beside it.
pub(crate) fn tetrahedron_in_gltf(folder: &Folder, name: &str, size: f32) -> String {
    let corners = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
    let faces: [[u16; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(faces.iter().flatten().flat_map(|vertex| vertex.to_le_bytes()));
    fs::write(folder.path(&format!("{name}.bin")), bytes).unwrap();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [{size}, {size}, {size}]}},
            {{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 24}}],
        "buffers": [{{"uri": "{name}.bin", "byteLength": 72}}]}}"#
    );
    folder.file(&format!("{name}.gltf"), &text)
}
