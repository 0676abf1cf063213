//! Files of robots that are made to hang, exhaust or break what reads them: one line each, or an answer.

mod shell;

use shell::{Folder, d2m, refused, stderr, stdout};
use std::fmt::Write;

const CUBE: &str = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";
const PATH: &str = r#"{"joint_names": ["j"], "points": [{"positions": [0], "time_from_start": 0}, {"positions": [1], "time_from_start": 1}]}"#;

fn slide(before: &str, inside: &str, after: &str) -> String {
    format!(
        "{before}<robot name=\"slide\"><link name=\"world\"/><link name=\"m\">{inside}</link>\
         <joint name=\"j\" type=\"prismatic\"><parent link=\"world\"/><child link=\"m\"/></joint>{after}</robot>"
    )
}

/// The arguments of a question about files of these texts.
fn arguments(folder: &Folder, urdf: &str, path: &str, more: &[(&str, &str, &str)]) -> Vec<String> {
    let [robot, path] = [("r.urdf", urdf), ("p.json", path)].map(|(name, text)| folder.file(name, text));
    let mut all = vec!["robot".to_owned(), robot, "--path".to_owned(), path, "--json".to_owned()];
    for (option, name, text) in more {
        all.extend([(*option).to_owned(), folder.file(name, text)]);
    }
    all
}

fn words(all: &[String]) -> Vec<&str> {
    all.iter().map(String::as_str).collect()
}

/// Answered: its status.
fn status(all: &[String]) -> String {
    let output = d2m(&words(all));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    found["status"].as_str().unwrap().to_owned()
}

#[test]
fn entities_that_multiply_are_refused_and_others_are_read() {
    let folder = Folder::new("robot-hostile-entities");
    let mut bomb = String::from("<!DOCTYPE robot [<!ENTITY e0 \"1 1 1\">");
    for k in 1..40 {
        let _ = write!(bomb, "<!ENTITY e{k} \"&e{};&e{};\">", k - 1, k - 1);
    }
    let size = "<collision><geometry><box size=\"&e39;\"/></geometry></collision>";
    refused(
        &words(&arguments(&folder, &slide(&format!("{bomb}]>"), size, ""), PATH, &[])),
        &["r.urdf, line 1"],
    );
    let circle = "<!DOCTYPE robot [<!ENTITY a \"&b;\"><!ENTITY b \"&a;\">]>";
    let size = size.replace("e39", "a");
    refused(&words(&arguments(&folder, &slide(circle, &size, ""), PATH, &[])), &["r.urdf, line 1"]);
    let outside = "<!DOCTYPE robot [<!ENTITY a SYSTEM \"file:///etc/hostname\">]>";
    refused(&words(&arguments(&folder, &slide(outside, &size, ""), PATH, &[])), &["r.urdf, line 1"]);
    let plain = "<!DOCTYPE robot [<!ENTITY a \"1 1 1\">]>";
    assert_eq!(status(&arguments(&folder, &slide(plain, &size, ""), PATH, &[])), "free");
}

#[test]
fn depths_end_in_a_line() {
    let folder = Folder::new("robot-hostile-depth");
    let deep = |open: &str, close: &str| format!("{}{}", open.repeat(200_000), close.repeat(200_000));
    let plain = slide("", CUBE, "");
    // Inside of a link nothing but its collisions is read.
    let nested = slide("", &format!("{CUBE}{}", deep("<visual>", "</visual>")), "");
    let answer = d2m(&words(&arguments(&folder, &nested, PATH, &[])));
    assert!(matches!(answer.status.code(), Some(0 | 3)), "{}", stderr(&answer));
    refused(&words(&arguments(&folder, &plain, &deep("[", "]"), &[])), &["p.json"]);
    let scene = format!("{{\"bodies\": {}}}", deep("[", "]"));
    refused(&words(&arguments(&folder, &plain, PATH, &[("--scene", "s.json", &scene)])), &["s.json"]);
    let srdf = format!("<robot>{}</robot>", deep("<group>", "</group>"));
    let answer = d2m(&words(&arguments(&folder, &plain, PATH, &[("--srdf", "r.srdf", &srdf)])));
    assert!(matches!(answer.status.code(), Some(0 | 3)), "{}", stderr(&answer));
}

#[test]
fn counts_beyond_reason_are_refused_with_their_number() {
    let folder = Folder::new("robot-hostile-counts");
    let links: Vec<String> = (0..50_000).map(|k| format!("<link name=\"l{k}\"/>")).collect();
    let joints: Vec<String> = (0..50_000)
        .map(|k| {
            let parent = if k == 0 { "m".to_owned() } else { format!("l{}", k - 1) };
            format!("<joint name=\"j{k}\" type=\"fixed\"><parent link=\"{parent}\"/><child link=\"l{k}\"/></joint>")
        })
        .collect();
    let many = slide("", CUBE, &(links.concat() + &joints.concat()));
    refused(
        &words(&arguments(&folder, &many, PATH, &[])),
        &["r.urdf: 50002 links: a robot has at most 4096"],
    );
    let many = slide("", &CUBE.repeat(50_000), "");
    refused(
        &words(&arguments(&folder, &many, PATH, &[])),
        &["r.urdf: 50000 collision bodies: a robot has at most 4096"],
    );
    // As many as may be, in one chain: read and answered.
    let count = 4000;
    let chain: Vec<String> = (0..count)
        .map(|k| {
            let parent = if k == 0 { "m".to_owned() } else { format!("l{}", k - 1) };
            let mimic = if k == 0 { "j".to_owned() } else { format!("j{}", k - 1) };
            format!(
                "<link name=\"l{k}\"/><joint name=\"j{k}\" type=\"prismatic\"><parent link=\"{parent}\"/><child link=\"l{k}\"/>\
                 <mimic joint=\"{mimic}\"/></joint>"
            )
        })
        .collect();
    assert_eq!(status(&arguments(&folder, &slide("", CUBE, &chain.concat()), PATH, &[])), "free");
    // Pairs of an SRDF: each is found, however many there are.
    let mut srdf = String::from("<robot>");
    for k in 0..100_000 {
        let _ = writeln!(srdf, "<disable_collisions link1=\"m\" link2=\"x{k}\"/>");
    }
    let srdf = srdf + "</robot>";
    assert_eq!(
        status(&arguments(&folder, &slide("", CUBE, ""), PATH, &[("--srdf", "r.srdf", &srdf)])),
        "free"
    );
}

#[test]
fn long_paths_and_long_names_are_answered() {
    let folder = Folder::new("robot-hostile-long");
    let points: Vec<String> = (0..20_000)
        .map(|k| format!("{{\"positions\": [{}], \"time_from_start\": {k}}}", f64::from(k % 2) * 1e-3))
        .collect();
    let path = format!("{{\"joint_names\": [\"j\"], \"points\": [{}]}}", points.join(","));
    let wall =
        r#"{"bodies": [{"name": "wall", "mesh": "shape:box?x=0.5&y=5&z=5", "pose": {"x": [3, 0, 0]}}]}"#;
    assert_eq!(
        status(&arguments(&folder, &slide("", CUBE, ""), &path, &[("--scene", "s.json", wall)])),
        "free"
    );
    let name = "n".repeat(1_000_000);
    let long = slide("", CUBE, "").replace("\"j\"", &format!("\"{name}\""));
    let output = d2m(&words(&arguments(&folder, &long, PATH, &[])));
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(stderr(&output).lines().count(), 1);
    // Numbers at the ends of what doubles are.
    for number in ["1e308", "-1e308", "5e-324", "1e17", "-0.0"] {
        let path = PATH.replace("[1]", &format!("[{number}]"));
        let output =
            d2m(&words(&arguments(&folder, &slide("", CUBE, ""), &path, &[("--scene", "s.json", wall)])));
        assert!(matches!(output.status.code(), Some(0 | 3)), "{number}: {}", stderr(&output));
    }
}
