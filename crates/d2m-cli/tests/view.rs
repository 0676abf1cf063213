//! `d2m view`: pages that need no network.

mod shell;

use shell::{Folder, d2m, refused, stderr, stdout};
use std::fs;
use std::io::Write;

const UNIT_BOX: &str = "shape:box?x=1&y=1&z=1";

/// What the page shows.
fn data(html: &str) -> serde_json::Value {
    let start = html.split("id=\"data\">").nth(1).unwrap();
    serde_json::from_str(start.split("</script>").next().unwrap()).unwrap()
}

/// The flights of a body: t0, t1, t_ref, at, x, q, v, w.
fn flights(shown: &serde_json::Value, body: usize) -> Vec<Vec<f64>> {
    let text = shown["bodies"][body]["flights"].as_str().unwrap().trim_end_matches('=').as_bytes();
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits = text.iter().map(|c| letters.iter().position(|l| l == c).unwrap() as u32);
    let (mut bytes, mut held, mut count) = (Vec::new(), 0u32, 0);
    for six in bits {
        (held, count) = (held << 6 | six, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((held >> count & 0xff) as u8);
        }
    }
    let numbers: Vec<f64> = bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    numbers.chunks(19).map(<[f64]>::to_vec).collect()
}

#[test]
fn a_page_says_only_what_is_proven() {
    let output = d2m(&["view", UNIT_BOX, UNIT_BOX, "--out", "-", "--motion-a", "x=-3,0,0;v=4,0,0"]);
    let shown = data(&stdout(&output));
    let spans = shown["spans"].as_array().unwrap();
    let status: Vec<&str> = spans.iter().map(|span| span["status"].as_str().unwrap()).collect();
    assert_eq!(status, ["clear", "contact", "unknown"]);
    let time = |k: usize, end: &str| spans[k][end].as_f64().unwrap();
    assert!((time(0, "to") - 0.25).abs() < 1e-8 && time(0, "to") == time(1, "from"));
    assert_eq!((time(0, "from"), time(2, "to")), (0.0, 1.0));
    // The distance over time: 1 - 4t until they meet, enclosed.
    for sample in shown["curve"].as_array().unwrap() {
        let [t, low, high] = [0, 1, 2].map(|k| sample[k].as_f64().unwrap());
        let distance = (1.0 - 4.0 * t).max(0.0);
        if t < 0.99 * 0.25 {
            assert!(low <= distance + 1e-12 && distance <= high + 1e-12, "{t} {low} {high}");
        }
    }
    let mark = &shown["marks"][0];
    assert_eq!(
        (mark["bodies"].as_array().unwrap().len(), mark["triangles"].as_array().unwrap().len()),
        (2, 2)
    );
    let apart = d2m(&["view", UNIT_BOX, UNIT_BOX, "--out", "-", "--motion-a", "x=-3,0,0"]);
    let shown = data(&stdout(&apart));
    assert_eq!(
        (shown["spans"].as_array().unwrap().len(), &shown["spans"][0]["status"]),
        (1, &"clear".into())
    );
}

/// Two bodies pass each other at a hundredth of their size, where a search that stops early calls it a contact.
#[test]
fn a_page_calls_no_early_stop_a_contact() {
    let bodies = ["shape:gear?triangles=500", "shape:torus?triangles=600"];
    let page = |mode: &str| {
        let motion = ["--motion-a", "x=-3,2.02,0;v=6,0,0;w=0,0,1", "--mode", mode];
        data(&stdout(&d2m(&[&["view", "--out", "-"], &bodies[..], &motion].concat())))
    };
    let status = |page: &serde_json::Value| {
        let spans = page["spans"].as_array().unwrap().iter();
        spans.map(|span| span["status"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(status(&page("accurate")), ["clear"]);
    let early = page("capoeira");
    assert_eq!(status(&early), ["clear", "undecided"]);
    assert!(early["spans"][1]["text"].as_str().unwrap().contains("there may be no contact"));
}

#[test]
fn stills_are_drawn_without_a_browser() {
    let folder = Folder::new("still");
    let png = folder.path("still.png");
    let motion = ["--motion-a", "x=-3,0,0;v=4,0,0;w=0,0,2"];
    let draw =
        |more: &[&str]| d2m(&[&["view", "shape:gear", UNIT_BOX, "--png", &png], &motion[..], more].concat());
    let output = draw(&["--size", "400x240"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let pixels = |file: &str| {
        let mut reader =
            png::Decoder::new(std::io::BufReader::new(fs::File::open(file).unwrap())).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (400, 240));
        pixels
    };
    let contact = pixels(&png);
    let near = |pixel: &[u8], color: [u8; 3]| pixel.iter().zip(color).all(|(a, b)| a.abs_diff(b) < 12);
    let count = |pixels: &[u8], color| pixels.chunks(3).filter(|pixel| near(pixel, color)).count();
    // The background, and the mark of the contact.
    assert!(count(&contact, [244, 245, 247]) > 2000 && count(&contact, [224, 25, 90]) > 10);
    assert_eq!(draw(&["--size", "400x240", "--at", "0"]).status.code(), Some(0));
    let start = pixels(&png);
    assert!(start != contact && count(&start, [224, 25, 90]) == 0);
    for (more, words) in [
        (["--at", "7"], ["--at", "outside of the window"]),
        (["--at", "x"], ["--at", "not a number"]),
        (["--size", "0x9"], ["--size", "WIDTHxHEIGHT"]),
        (["--size", "99999x9"], ["--size", "8192"]),
    ] {
        refused(&[&["view", "shape:gear", UNIT_BOX, "--png", &png][..], &more].concat(), &words);
    }
}

#[test]
fn a_view_is_one_page_that_fetches_nothing() {
    let folder = Folder::new("view");
    let page = folder.path("view.html");
    let motion = ["--motion-a", "x=-3,0,0;v=4,0,0;w=0,0,2"];
    let output = d2m(&[&["view", "shape:gear", UNIT_BOX, "--out", &page], &motion[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.starts_with("<!DOCTYPE html>") && html.trim_end().ends_with("</html>"));
    assert!(html.contains("CONTACT at t = ") && !html.contains("{{"));
    for word in ["<script src", "<link", "import(", "fetch("] {
        let own = html.split("<script>").next().unwrap().to_owned() + html.rsplit("<script>").next().unwrap();
        assert!(!own.contains(word), "{word}");
    }
    // A name cannot end the script.
    let mesh = folder.file("<script>.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let output = d2m(&["view", &mesh, UNIT_BOX, "--out", "-"]);
    assert!(!stdout(&output).contains("<script>.obj"), "{}", stderr(&output));
    refused(&["view", "shape:gear", "--out", &page], &["B", "missing"]);
}

#[test]
fn scenes_and_simulations_are_viewed() {
    let scene = format!("{}/../../docs/scenes/robot-arm.json", env!("CARGO_MANIFEST_DIR"));
    let output = d2m(&["view", &scene, "--out", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let shown = data(&stdout(&output));
    assert!(shown["bodies"].as_array().unwrap().len() > 2 && !shown["marks"].as_array().unwrap().is_empty());

    let folder = Folder::new("runs");
    let scene = r#"{"bodies": [
        {"name": "ground", "mesh": "shape:box?x=1&y=1&z=1", "scale": [5, 1, 5], "kind": "static", "pose": {"x": [0, -1, 0]}},
        {"name": "falls", "mesh": "shape:box?x=1&y=1&z=1", "scale": 0.25, "pose": {"x": [0, 1, 0]}}],
        "simulation": {"end": 1.0, "step": 0.02}}"#;
    let scene = folder.file("scene.json", scene);
    let run = folder.path("run.jsonl");
    let output = d2m(&["simulate", &scene, "--out", &run]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = d2m(&["view", &run, "--out", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let shown = data(&stdout(&output));
    assert_eq!((shown["window"][1].as_f64(), shown["real_time"].as_bool()), (Some(1.0), Some(true)));
    let flights = |body: usize| flights(&shown, body);
    // A falling body needs a flight a step; one that rests, and one that lies still in the end, a single one.
    assert!((10..50).contains(&flights(1).len()) && flights(0).len() == 1, "{}", flights(1).len());
    assert_eq!((flights(0)[0][0], flights(0)[0][1]), (0.0, 1.0));
    assert_eq!(shown["spans"][0]["status"], "clear");
    // Packed runs are read too.
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(&fs::read(&run).unwrap()).unwrap();
    let gz = folder.path("run.jsonl.gz");
    fs::write(&gz, packed.finish().unwrap()).unwrap();
    assert_eq!(data(&stdout(&d2m(&["view", &gz, "--out", "-"])))["bodies"], shown["bodies"]);
    assert!(!shown["marks"].as_array().unwrap().is_empty());

    let text = fs::read_to_string(&run).unwrap();
    // Nor does a byte order mark matter.
    let marked = folder.file("marked.jsonl", &format!("\u{feff}{text}"));
    assert_eq!(data(&stdout(&d2m(&["view", &marked, "--out", "-"])))["bodies"], shown["bodies"]);
    let lines: Vec<&str> = text.lines().collect();
    for (fault, words) in [
        (lines[1..].join("\n"), "line 1: missing field"),
        (lines[0].to_owned(), "no segments"),
        ([lines[0], lines[1], lines[3], lines[2]].join("\n"), "line 4: t0 0.0 is before 0.04, the end"),
        (format!("{}\n{{\"t0\": 0}}", lines[0]), "line 2: missing field `t1`"),
        (
            format!(
                "{}\n{{\"t0\": 0, \"t1\": 1, \"changed\": [[9, {{\"x\": [0,0,0], \"q\": [1,0,0,0], \"v\": [0,0,0], \"w\": [0,0,0]}}]]}}",
                lines[0]
            ),
            "body 9 is out of range",
        ),
    ] {
        let broken = folder.file("broken.jsonl", &fault);
        refused(&["view", &broken, "--out", "-"], &["broken.jsonl", words]);
    }
    refused(&["view", &run, UNIT_BOX, "--out", "-"], &["alone"]);
}

/// A point with a radius is a ball, and is seen as one: of a pair and of a scene.
#[test]
fn bodies_are_shown_with_their_radius() {
    let folder = Folder::new("view-radius");
    let point = folder.file("point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
    let scene = format!(
        r#"{{"bodies": [{{"name": "ball", "mesh": {point:?}, "radius": 0.5, "motion": {{"x": [0, 2, 0]}}}},
            {{"name": "floor", "mesh": "{UNIT_BOX}"}}]}}"#
    );
    let scene = folder.file("scene.json", &scene);
    let triangles = |shown: &serde_json::Value, mesh: usize| {
        shown["meshes"][mesh]["triangles"].as_str().unwrap().len() / 16
    };
    let of_scene = data(&stdout(&d2m(&["view", &scene, "--out", "-"])));
    assert!(triangles(&of_scene, 0) > 1000 && triangles(&of_scene, 1) == 12);
    let pair =
        ["view", &point, UNIT_BOX, "--surface", "--radius-a", "0.5", "--motion-a", "x=0,2,0", "--out", "-"];
    let of_pair = data(&stdout(&d2m(&pair)));
    assert_eq!(of_pair["meshes"][0], of_scene["meshes"][0]);
}

/// Options that the scene says itself, or that a run knows nothing of, are refused and not ignored.
#[test]
fn options_that_say_nothing_of_what_is_viewed_are_refused() {
    let folder = Folder::new("view-options");
    let scene = |terms: &str| {
        format!(
            r#"{{{terms} "bodies": [{{"name": "a", "mesh": "{UNIT_BOX}"}}, {{"name": "b", "mesh": "{UNIT_BOX}", "motion": {{"x": [5, 0, 0]}}}}]}}"#
        )
    };
    let plain = folder.file("plain.json", &scene(""));
    let own = folder.file("own.json", &scene(r#""tolerance": 1e-6,"#));
    let said = "the scene says this itself, in its file";
    let options = [
        ["--min-separation", "2"],
        ["--window", "0,5"],
        ["--window", "0,1"],
        ["--motion-a", "v=1,0,0"],
        ["--motion-b", "v=1,0,0"],
        ["--scale-a", "2"],
        ["--scale-b", "2"],
        ["--unit-a", "mm"],
        ["--unit-b", "mm"],
        ["--radius-a", "1"],
        ["--radius-b", "1"],
    ];
    let refused = |file: &str, more: &[&str], words: &[&str]| {
        refused(&[&["view", file, "--out", "-"], more].concat(), words);
    };
    for option in options {
        refused(&plain, &option, &[option[0], said]);
        refused("run.jsonl", &option, &[option[0], "a run is shown as its file has it"]);
        refused("run.jsonl.gz", &option, &[option[0]]);
    }
    for option in ["--solid", "--surface"] {
        refused(&plain, &[option], &[option, said]);
        refused("run.jsonl", &[option], &[option]);
    }
    refused(&own, &["--tolerance", "1e-3"], &["--tolerance", said]);
    refused(&plain, &["--mode", "paper"], &["--mode", "reference method"]);
    for option in [["--tolerance", "1e-3"], ["--budget", "7"], ["--mode", "capoeira"]] {
        refused("run.jsonl", &option, &[option[0]]);
    }
    // Options that the search still takes.
    for more in
        [&["--tolerance", "1e-3"][..], &["--budget", "1000", "--time-limit", "9"], &["--mode", "capoeira"]]
    {
        let output = d2m(&[&["view", &plain, "--out", "-"], more].concat());
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", stderr(&output));
    }
    let output = d2m(&["view", &own, "--out", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
