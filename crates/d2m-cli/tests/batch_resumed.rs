//! `d2m batch --resume`: what an ended run left is proven as well, and never mixed with answers of other meshes.

mod shell;

use shell::{Folder, HEADER, d2m, refused, stderr, tetrahedron_in_gltf};
use std::fs;

const CUBE: &str = "shape:box?x=1&y=1&z=1";

/// A run that ended once it had answered `count` trials: it cannot write its results, as no name of a file is longer than 255 bytes and
/// that of its temporary file would be. Its answers are kept beside `results.csv`.
fn ended(folder: &Folder, asked: &[&str], count: usize) -> Vec<String> {
    let long = folder.path(&"r".repeat(250));
    let run = d2m(&[asked, &["--resume", "--out", &long]].concat());
    assert_eq!(run.status.code(), Some(3), "{}", stderr(&run));
    let part = format!("{long}.part");
    let text = fs::read_to_string(&part).unwrap();
    fs::remove_file(part).unwrap();
    let lines: Vec<String> = text.lines().take(1 + count).map(str::to_owned).collect();
    assert_eq!(lines.len(), 1 + count);
    folder.file("results.csv.part", &(lines.join("\n") + "\n"));
    lines
}

/// The lines of results without the times that they took.
fn answers(text: &str) -> Vec<String> {
    let without = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        [&fields[..5], &fields[6..]].concat().join(",")
    };
    text.lines().map(without).collect()
}

#[test]
fn what_an_ended_run_left_is_proven_as_well() {
    let folder = Folder::new("resume-verify");
    let line = |k: usize| format!("1,0,0,0,-3,0,{},4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n", k as f64 * 1e-3);
    let trials = folder.file("t.csv", &(0..300).map(line).collect::<String>());
    let asked = ["batch", CUBE, CUBE, "--trials", &trials];
    let out = folder.path("results.csv");
    let resumed = |verify: &[&str]| d2m(&[&asked[..], &["--resume", "--out", &out], verify].concat());
    let plain = folder.path("plain.csv");
    assert!(d2m(&[&asked[..], &["--out", &plain]].concat()).status.success());
    let plain = answers(&fs::read_to_string(plain).unwrap());
    for (share, again, proven) in [("1", 200, 300), ("0.25", 50, 75)] {
        let mut lines = ended(&folder, &asked, 200);
        // An answer of the ended run that is false, where the proof looks: trials are chosen evenly, the fourth and the eighth at a quarter.
        lines[1 + 7] = "7,separated,inf,inf,,1.000,,,,,,,,,,,".to_owned();
        folder.file("results.csv.part", &(lines.join("\n") + "\n"));
        let run = resumed(&["--verify", share]);
        let said = stderr(&run);
        assert_eq!(run.status.code(), Some(0), "{said}");
        assert!(said.contains(&format!("answered before; {again} of them are asked again")), "{said}");
        assert!(said.contains(&format!("{proven} of {proven} answers verified")), "{said}");
        assert_eq!(answers(&fs::read_to_string(&out).unwrap()), plain);
    }
    // Without a proof no trial is queried again.
    ended(&folder, &asked, 200);
    let said = stderr(&resumed(&[]));
    assert!(
        said.contains("200 of 300 trials were answered before\n") && said.contains("100 trials:"),
        "{said}"
    );
    assert_eq!(answers(&fs::read_to_string(&out).unwrap()), plain);
    assert!(plain[0] == answers(HEADER)[0] && !folder.names().contains(&"results.csv.part".to_owned()));
}

/// The file of the mesh stays as it is, and the one with its numbers becomes another one.
#[test]
fn answers_of_two_meshes_are_not_mixed() {
    let folder = Folder::new("resume-meshes");
    let mesh = tetrahedron_in_gltf(&folder, "grain", 1.0);
    let named = fs::read(&mesh).unwrap();
    let line = "1,0,0,0,-3,0.1,0.1,4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n";
    let trials = folder.file("t.csv", &line.repeat(300));
    let asked = ["batch", &mesh, CUBE, "--trials", &trials];
    ended(&folder, &asked, 256);
    let out = folder.path("results.csv");
    let resumed = [&asked[..], &["--resume", "--out", &out]].concat();
    let part = fs::read(folder.path("results.csv.part")).unwrap();
    tetrahedron_in_gltf(&folder, "grain", 0.5);
    fs::write(&mesh, &named).unwrap();
    refused(&resumed, &["results.csv.part", "other inputs"]);
    assert_eq!(fs::read(folder.path("results.csv.part")).unwrap(), part);
    tetrahedron_in_gltf(&folder, "grain", 1.0);
    let run = d2m(&resumed);
    assert!(run.status.success() && stderr(&run).contains("256 of 300"), "{}", stderr(&run));
}

/// A line that is damaged, gone or there twice would put the answer to one trial in the place of another.
#[test]
fn what_is_not_the_answer_to_its_trial_is_refused() {
    let folder = Folder::new("resume-damaged");
    let line = |k: usize| format!("1,0,0,0,-3,0,{},4,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n", k as f64 * 1e-3);
    let trials = folder.file("t.csv", &(0..300).map(line).collect::<String>());
    let asked = ["batch", CUBE, CUBE, "--trials", &trials];
    let out = folder.path("results.csv");
    let resumed = [&asked[..], &["--resume", "--out", &out]].concat();
    let lines = ended(&folder, &asked, 256);
    let refused_after = |edit: &dyn Fn(&mut Vec<String>), line: usize, trial: usize| {
        let mut lines = lines.clone();
        edit(&mut lines);
        folder.file("results.csv.part", &(lines.join("\n") + "\n"));
        let place = format!("results.csv.part, line {line}: is not the answer to trial {trial}");
        refused(&resumed, &[&place]);
        assert!(!folder.names().contains(&"results.csv".to_owned()));
    };
    refused_after(&|lines| drop(lines.remove(3)), 4, 2);
    refused_after(&|lines| lines.insert(3, lines[2].clone()), 4, 2);
    refused_after(&|lines| lines.insert(3, String::new()), 4, 2);
    refused_after(&|lines| lines[3].truncate(20), 4, 2);
    refused_after(&|lines| lines[3].push('\r'), 4, 2);
    refused_after(&|lines| lines[3] = lines[3].replace("contact", "touched"), 4, 2);
    // More answers than trials.
    let all = |lines: &mut Vec<String>| {
        let of = |trial: usize| format!("{trial},separated,inf,inf,,1.000,,,,,,,,,,,");
        lines.extend((256..301).map(of));
    };
    refused_after(&all, 302, 300);
    ended(&folder, &asked, 256);
    let run = d2m(&resumed);
    assert!(run.status.success() && stderr(&run).contains("256 of 300"), "{}", stderr(&run));
}
