//! What text answers and pages say of pairs that have a separation or a start of their own, and of those that are not decided.

mod shell;

use serde_json::Value;
use shell::{Folder, d2m, stderr, stdout};

/// A cube of length 0.1 that goes along x; another one at the origin.
const SLIDE: &str = r#"<robot name="slide">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="mid"/>
  <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="run" type="prismatic"><parent link="base"/><child link="mid"/><axis xyz="1 0 0"/></joint>
  <joint name="weld" type="fixed"><parent link="mid"/><child link="cart"/></joint></robot>"#;

/// A scene with a cube of length 0.1 at `x`, and whatever else it says.
fn wall(x: f64, terms: &str) -> String {
    format!(
        r#"{{"bodies": [{{"name": "wall", "mesh": "shape:box?x=0.05&y=0.05&z=0.05", "pose": {{"x": [{x}, 0, 0]}}}}]{terms}}}"#
    )
}

/// The cart goes from one place to the next in a unit of time.
fn path(places: &[f64]) -> String {
    let points = places.iter().enumerate();
    let points: Vec<String> =
        points.map(|(t, x)| format!(r#"{{"positions": [{x}], "time_from_start": {t}}}"#)).collect();
    format!(r#"{{"joint_names": ["run"], "points": [{}]}}"#, points.join(", "))
}

fn answered(arguments: &[&str]) -> String {
    let output = d2m(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// What a page shows.
fn shown(html: &str) -> Value {
    let data = html.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next()).unwrap();
    serde_json::from_str(data).unwrap()
}

/// The spans of a page: what holds, from when to when.
fn spans(shown: &Value) -> Vec<(String, f64, f64)> {
    let of = |span: &Value| {
        let time = |key: &str| span[key].as_f64().unwrap();
        (span["status"].as_str().unwrap().to_owned(), time("from"), time("to"))
    };
    shown["spans"].as_array().unwrap().iter().map(of).collect()
}

/// The cart comes within 0.06 of the wall, which a separation of all pairs, 0.1 or 0.2, does not allow: their own is none.
#[test]
fn a_certificate_of_a_path_states_the_separation_of_each_pair() {
    let folder = Folder::new("own-separations");
    let [robot, path] = [("slide.urdf", SLIDE.to_owned()), ("path.json", path(&[0.5, 1.0]))]
        .map(|(name, text)| folder.file(name, &text));
    let ask = |scene: &str, more: &[&str]| {
        let scene = folder.file("scene.json", scene);
        answered(&[&["robot", &robot, "--path", &path, "--scene", &scene], more].concat())
    };
    let own =
        |distance: f64| format!(r#", "pairs": [{{"a": "wall", "b": "cart", "min_separation": {distance}}}]"#);
    let of_scene = |text: String| format!(r#", "min_separation": 0.1{text}"#);
    for (scene, more, most) in [
        (wall(1.16, &of_scene(own(0.0))), &[][..], "0.1"),
        (wall(1.16, &own(0.0)), &["--min-separation", "0.2"][..], "0.2"),
    ] {
        let text = ask(&scene, &[&["--verify"], more].concat());
        assert!(text.starts_with("FREE") && text.contains("  verified    yes"), "{text}");
        assert!(text.contains(&format!("its own minimum separation (from 0 to {most})")), "{text}");
        assert!(!text.contains("all pairs further apart"), "{text}");
    }
    let text = ask(&wall(1.3, &of_scene(String::new())), &[]);
    assert!(text.contains("from 0 to 1, all pairs further apart than 0.1\n"), "{text}");
    // What is near is so by the separation of the pair.
    let text = ask(&wall(1.16, &own(0.3)), &[]);
    assert!(
        text.starts_with("CONTACT") && text.contains("the distance is at most 0.3 + tolerance"),
        "{text}"
    );
    let text = ask(&wall(0.9, &of_scene(own(0.0))), &[]);
    assert!(text.starts_with("CONTACT") && text.contains("the distance is at most the tolerance"), "{text}");
}

/// The cart begins in the wall and leaves it: their distance is 0 until 0.2.
#[test]
fn a_page_calls_nothing_clear_before_it_has_parted() {
    let folder = Folder::new("pages-of-leaving");
    let robot = folder.file("slide.urdf", SLIDE);
    let page = folder.path("page.html");
    let of_path = |places: &[f64]| {
        let path = folder.file("path.json", &path(places));
        let scene = folder.file("scene.json", &wall(0.5, r#", "start": "leave""#));
        answered(&["robot", &robot, "--path", &path, "--scene", &scene, "--view", &page]);
        shown(&std::fs::read_to_string(&page).unwrap())
    };
    let of_scene = |velocity: f64| {
        let cube = r#""mesh": "shape:box?x=0.05&y=0.05&z=0.05""#;
        let scene = format!(
            r#"{{"window": [0, 2], "start": "leave", "bodies": [{{"name": "wall", {cube}}},
                {{"name": "cart", {cube}, "motion": {{"v": [{velocity}, 0, 0]}}}}]}}"#
        );
        let scene = folder.file("two.json", &scene);
        shown(&answered(&["view", &scene, "--out", "-"]))
    };
    for page in [of_path(&[0.5, 1.0, 0.7]), of_scene(0.5)] {
        let found = spans(&page);
        let [(first, from, left), (then, clear_from, until)] = &found[..] else { panic!("{found:?}") };
        assert_eq!((first.as_str(), then.as_str()), ("contact", "clear"), "{found:?}");
        assert!(*from == 0.0 && left == clear_from && *until == 2.0, "{found:?}");
        assert!((0.2..0.201).contains(left), "{found:?}");
        let is_said =
            |fact: &Value| fact[0] == "left" && fact[1].as_str().unwrap().contains("proven apart at");
        assert!(page["facts"].as_array().unwrap().iter().any(is_said), "{}", page["facts"]);
    }
    assert!(of_path(&[0.5, 1.0])["headline"].as_str().unwrap().contains("until it had parted"));
    // Those that never part are never clear, nor are those that come back once they have.
    assert!(spans(&of_scene(0.04)).iter().all(|(holds, ..)| holds != "clear"));
    let back = spans(&of_path(&[0.5, 1.0, 0.5]));
    let clear: Vec<_> = back.iter().filter(|(holds, ..)| holds == "clear").collect();
    assert!(clear.len() == 1 && clear[0].1 > 0.2 && (clear[0].2 - 1.8).abs() < 1e-6, "{back:?}");
}

/// Pairs that a budget leaves undecided are not apart, and are named.
#[test]
fn a_page_of_a_scene_says_which_pairs_are_not_decided() {
    let folder = Folder::new("undecided-pages");
    let scene = r#"{"bodies": [{"name": "knot", "mesh": "shape:torus-knot?triangles=5000"},
        {"name": "gear", "mesh": "shape:gear?triangles=3000", "motion": {"x": [-3, 0, 0], "v": [4, 0, 0], "w": [0, 0, 5]}}]}"#;
    let scene = folder.file("scene.json", scene);
    let page = shown(&answered(&["view", &scene, "--budget", "5", "--out", "-"]));
    let found = spans(&page);
    assert_eq!(found.iter().map(|(holds, ..)| holds.as_str()).collect::<Vec<_>>(), ["clear", "undecided"]);
    assert!(found[0].2 == found[1].1 && found[1].2 == 1.0, "{found:?}");
    for span in page["spans"].as_array().unwrap().iter().skip(1) {
        let text = span["text"].as_str().unwrap();
        assert!(text.contains("not decided") && !text.contains("are apart"), "{text}");
    }
    let is_named = |fact: &Value| fact[1] == "knot and gear (undecided)";
    assert!(page["facts"].as_array().unwrap().iter().any(is_named), "{}", page["facts"]);
}
