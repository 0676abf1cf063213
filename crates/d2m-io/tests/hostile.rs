//! Files that were made to harm: nothing panics, hangs or takes memory beyond measure.

mod samples;

use d2m_io::{MeshFormat, ReadOptions, SceneFile, parse_mesh};
use proptest::prelude::*;
use samples::{MODEL, archive, dae, gltf, three_mf};
use std::fmt::Write;

fn fault(format: MeshFormat, bytes: impl AsRef<[u8]>) -> String {
    parse_mesh(bytes.as_ref(), format, &ReadOptions::new()).unwrap_err().to_string()
}

/// Ten levels that name the level below ten times: ten billion copies of a tetrahedron.
#[test]
fn files_that_multiply_themselves_end() {
    let mut library = String::new();
    let mut components = String::new();
    for level in 0..10 {
        let below = if level == 0 { "sub".to_owned() } else { format!("l{}", level - 1) };
        let ten = format!("<instance_node url=\"#{below}\"/>").repeat(10);
        let _ = write!(library, "<node id=\"l{level}\">{ten}</node>");
        let below = if level == 0 { 1 } else { 9 + level };
        let ten = format!("<component objectid=\"{below}\"/>").repeat(10);
        let _ = write!(components, "<object id=\"{}\"><components>{ten}</components></object>", 10 + level);
    }
    let text =
        dae("<instance_node url=\"#l9\"/>").replace("</library_nodes>", &(library + "</library_nodes>"));
    let found = fault(MeshFormat::Dae, text);
    assert!(found.contains("so often"), "{found}");
    let model = MODEL
        .replace("</resources>", &(components + "</resources>"))
        .replace("item objectid=\"1\"", "item objectid=\"19\"");
    let found = fault(MeshFormat::ThreeMf, three_mf(&model));
    assert!(found.contains("too often"), "{found}");
    // The same mesh under many nodes, which may stand many times in a text of this length.
    let nodes: Vec<String> = (1..200).map(|_| r#"{"mesh":0}"#.to_owned()).collect();
    let children: Vec<String> = (1..200).map(|node| node.to_string()).collect();
    let text = gltf(&format!(r#"{{"children":[{}]}},{}"#, children.join(","), nodes.join(",")));
    let mesh = parse_mesh(text.as_bytes(), MeshFormat::Gltf, &ReadOptions::new()).unwrap().mesh;
    assert_eq!(mesh.triangle_count(), 4 * 199);
}

#[test]
fn circles_end() {
    let around =
        "<node id=\"a\"><instance_node url=\"#b\"/></node><node id=\"b\"><instance_node url=\"#a\"/></node>";
    let found = fault(MeshFormat::Dae, dae(around));
    assert!(found.contains("the node instances itself"), "{found}");
    let model = MODEL
        .replace(
            "</resources>",
            r#"<object id="2"><components><component objectid="2"/></components></object></resources>"#,
        )
        .replace("item objectid=\"1\"", "item objectid=\"2\"");
    let found = fault(MeshFormat::ThreeMf, three_mf(&model));
    assert!(found.contains("contain themselves"), "{found}");
    let found = fault(MeshFormat::Gltf, gltf(r#"{"children":[1]},{"children":[0]}"#));
    assert!(found.contains("from itself"), "{found}");
}

#[test]
fn deep_nesting_and_bombs_end() {
    let deep = format!("{}{}", "<node>".repeat(200_000), "</node>".repeat(200_000));
    let _ = parse_mesh(dae(&deep).as_bytes(), MeshFormat::Dae, &ReadOptions::new());
    let unclosed = "<a>".repeat(400_000);
    assert!(!fault(MeshFormat::Dae, unclosed).is_empty());
    let found = fault(MeshFormat::Gltf, "[".repeat(400_000));
    assert!(!found.is_empty());
    let json = format!("{{\"extras\":{}", "[".repeat(400_000));
    assert!(!fault(MeshFormat::Gltf, json).is_empty());
    // Entities that grow.
    let laughs =
        "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><COLLADA>&b;</COLLADA>";
    let found = fault(MeshFormat::Dae, laughs);
    assert!(found.contains("line 1"), "{found}");
    // A part of 300 MB in an archive of 300 KB.
    let blank = " ".repeat(300 << 20);
    let bomb = archive(&[("3D/3dmodel.model", &blank)]);
    assert!(bomb.len() < 1 << 20);
    let found = fault(MeshFormat::ThreeMf, bomb);
    assert!(found.contains("it unpacks to more"), "{found}");
}

/// A glTF file of a few bytes that states billions of elements.
#[test]
fn forged_counts_make_no_room() {
    let text = gltf(r#"{"mesh":0}"#)
        .replace(r#""byteLength":48"#, r#""byteLength":4800000000000,"byteStride":12"#)
        .replace(r#""count":4"#, r#""count":400000000000"#);
    assert!(fault(MeshFormat::Gltf, text).contains("go beyond the 60 bytes"));
    let mut bytes = d2m_io::glb_bytes(&samples::tetrahedron()).unwrap();
    bytes[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(fault(MeshFormat::Glb, bytes).contains("a chunk of 4294967295 bytes at byte 12"));
}

/// Bytes of a good file with some overwritten, cut, doubled, or numbers exchanged.
fn damaged(bytes: &[u8], edits: &[(usize, u8, u8)]) -> Vec<u8> {
    const NUMBERS: [&str; 8] =
        ["-1", "1e308", "nan", "4294967295", "18446744073709551616", "0", "1e-320", ""];
    let mut bytes = bytes.to_vec();
    for &(place, byte, kind) in edits {
        if bytes.is_empty() {
            break;
        }
        let place = place % bytes.len();
        match kind {
            0 => bytes[place] = byte,
            1 => bytes[place] ^= 1 << (byte % 8),
            2 => bytes.truncate(place),
            3 => bytes.insert(place, byte),
            4 => {
                let end = (place + usize::from(byte)).min(bytes.len());
                bytes.extend_from_within(place..end);
            }
            5 => {
                let end = (place + usize::from(byte % 16)).min(bytes.len());
                bytes.drain(place..end);
            }
            _ => {
                let start = (place..bytes.len()).find(|&at| bytes[at].is_ascii_digit()).unwrap_or(place);
                let end = (start..bytes.len()).find(|&at| !bytes[at].is_ascii_digit()).unwrap_or(bytes.len());
                bytes.splice(start..end, NUMBERS[usize::from(byte) % NUMBERS.len()].bytes());
            }
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn damaged_files_are_a_mesh_or_an_error(
        edits in prop::collection::vec((any::<usize>(), any::<u8>(), 0..7_u8), 1..5),
    ) {
        for (format, bytes) in samples::all() {
            let bytes = damaged(&bytes, &edits);
            if let Ok(read) = parse_mesh(&bytes, format, &ReadOptions::new()) {
                prop_assert!(read.mesh.triangle_count() <= bytes.len());
                prop_assert!(read.mesh.vertex_count() <= bytes.len());
            }
        }
        // The model of an archive, so that the checksum does not hide what comes after it.
        let model = damaged(MODEL.as_bytes(), &edits);
        let bytes = three_mf(&String::from_utf8_lossy(&model));
        let _ = parse_mesh(&bytes, MeshFormat::ThreeMf, &ReadOptions::new());
        // Any file under any name.
        for (_, bytes) in samples::all() {
            let bytes = damaged(&bytes, &edits);
            for (format, _) in samples::all() {
                let _ = parse_mesh(&bytes, format, &ReadOptions::new());
            }
        }
    }

    #[test]
    fn damaged_scenes_are_a_scene_or_an_error(
        edits in prop::collection::vec((any::<usize>(), any::<u8>(), 0..7_u8), 1..5),
    ) {
        if let Ok(scene) = SceneFile::parse(&damaged(SCENE, &edits)) {
            prop_assert!(scene.bodies.iter().all(|body| !body.name.is_empty() && body.scale.is_finite()));
        }
        let _ = d2m_io::parse_json::<d2m_motion::AnyMotion>(&damaged(MOTION, &edits));
    }
}

const SCENE: &[u8] = br#"{"window": [0, 2], "min_separation": 0.5, "tolerance": 1e-9, "bodies": [
    {"name": "a", "mesh": "shape:gear", "scale": [1, 2, 3], "motion": {"w": [0, 0, 1]}, "group": "g"},
    {"name": "b", "mesh": "shape:box", "solid": false}], "ignore": [["a", "g"]]}"#;
const MOTION: &[u8] = br#"{"chain": [{"x": [1, 0, 0], "joint": "revolute", "axis": [0, 0, 1], "value": {"times": [0, 1, 2], "positions": [0, 1, 0]}}]}"#;

#[test]
fn scenes_are_refused_with_their_place() {
    let good = String::from_utf8(SCENE.to_vec()).unwrap();
    assert!(SceneFile::parse(SCENE).is_ok());
    for (from, to, expected) in [
        ("[0, 2]", "[2, 0]", "window: time window [2.0, 0.0]"),
        ("0.5,", "-1,", "min_separation: -1.0 is not a finite distance"),
        ("1e-9", "0", "tolerance: 0.0 is not a positive finite distance"),
        ("1e-9", "\"fine\"", "tolerance: invalid type: string \"fine\""),
        ("\"b\"", "\"a\"", "body 1: the name \"a\" is that of body 0 too"),
        ("[1, 2, 3]", "[1, 2]", "body 0 (\"a\"), scale: [1,2] is neither a number nor a list of three"),
        ("\"w\"", "\"z\"", "body 0 (\"a\"), motion: unknown field `z`"),
        (
            "{\"w\": [0, 0, 1]}",
            "[]",
            "body 0 (\"a\"), motion: invalid type: sequence, expected an object with keys",
        ),
        (
            "\"ignore\": [[\"a\", \"g\"]]",
            "\"pairs\": [[\"a\", \"b\"]]",
            "pairs, entry 0: [\"a\",\"b\"] is not an object with keys",
        ),
        (
            "{\"name\": \"b\", \"mesh\": \"shape:box\", \"solid\": false}",
            "[\"b\", \"shape:box\"]",
            "body 1: [\"b\",\"shape:box\"] is not an object",
        ),
        ("[\"a\", \"g\"]", "[\"a\", \"q\"]", "ignore 0: \"q\" is the name of no body and of no group"),
        ("\"solid\"", "\"kind\"", "body 1 (\"b\"): unknown field `kind`"),
    ] {
        assert!(good.contains(from), "{from}");
        let found = SceneFile::parse(good.replace(from, to).as_bytes()).unwrap_err();
        assert!(found.to_string().starts_with(expected), "{found}\n{expected}");
        let named = found.in_file("s.json").to_string();
        assert!(named.starts_with("s.json, "), "{named}");
    }
    let list =
        SceneFile::parse(br#"[[0, 1], [{"name": "a", "mesh": "shape:box"}]]"#).unwrap_err().to_string();
    assert!(list.contains("is not an object with keys"), "{list}");
    let deep = format!("{{\"bodies\": {}", "[".repeat(100_000));
    assert!(SceneFile::parse(deep.as_bytes()).unwrap_err().to_string().contains("recursion limit"));
}
