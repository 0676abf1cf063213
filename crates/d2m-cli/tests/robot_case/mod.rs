//! A robot of one joint, its path, an obstacle, and what `d2m robot` answers.
#![allow(dead_code)] // not every test needs all of it

use crate::shell::{Folder, d2m, refused, stderr, stdout};
use serde_json::Value;

pub(crate) const CUBE: &str = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";

/// One joint j over one second, from 0.
pub(crate) fn path(end: &str) -> String {
    format!(
        r#"{{"joint_names": ["j"], "points": [{{"positions": [0], "time_from_start": 0}}, {{"positions": [{end}], "time_from_start": 1}}]}}"#
    )
}

/// A box of half the extents (0.5, 5, 5) about this place on the x axis.
pub(crate) fn wall(x: f64) -> String {
    format!(
        r#"{{"bodies": [{{"name": "wall", "mesh": "shape:box?x=0.5&y=5&z=5", "pose": {{"x": [{x}, 0, 0]}}}}]}}"#
    )
}

/// The files of one question.
pub(crate) struct Case {
    pub(crate) folder: Folder,
}

impl Case {
    pub(crate) fn new(name: &str) -> Self {
        Self { folder: Folder::new(name) }
    }

    pub(crate) fn arguments(&self, urdf: &str, path: &str, scene: Option<&str>) -> Vec<String> {
        let [robot, path] =
            [("r.urdf", urdf), ("p.json", path)].map(|(name, text)| self.folder.file(name, text));
        let mut all = vec!["robot".to_owned(), robot, "--path".to_owned(), path, "--json".to_owned()];
        if let Some(scene) = scene {
            all.extend(["--scene".to_owned(), self.folder.file("s.json", scene)]);
        }
        all
    }

    /// The answer, and what was said beside it.
    pub(crate) fn ask(&self, urdf: &str, path: &str, scene: &str) -> (Value, String) {
        let arguments = self.arguments(urdf, path, Some(scene));
        let output = d2m(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0), "{urdf}\n{}", stderr(&output));
        (serde_json::from_str(&stdout(&output)).unwrap(), stderr(&output))
    }

    /// A contact at a time that is known, never after it.
    pub(crate) fn meets(&self, urdf: &str, path: &str, scene: &str, expected: f64) {
        let (found, _) = self.ask(urdf, path, scene);
        assert_eq!(found["status"], "contact", "{urdf}: {found}");
        let time = found["time"][0].as_f64().unwrap();
        assert!(time <= expected + 1e-12 && time > expected - 1e-6, "{urdf}: {found}, not {expected}");
    }

    pub(crate) fn refused(&self, urdf: &str, path: &str, words: &[&str]) {
        let arguments = self.arguments(urdf, path, None);
        refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), words);
    }
}

/// The world, and a link m that the joint j shifts along x.
pub(crate) fn slide(link: &str, inside: &str) -> String {
    format!(
        "<robot name=\"slide\">\n<link name=\"world\"/>\n<link name=\"m\">{link}</link>\n\
         <joint name=\"j\" type=\"prismatic\"><parent link=\"world\"/><child link=\"m\"/>{inside}</joint>\n</robot>"
    )
}
