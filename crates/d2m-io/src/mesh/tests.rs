//! Readers: the same mesh in every format, faults with their places, and arbitrary bytes.

use super::{Fault, Merging, MeshFormat, PolygonCounts, Precision, ReadMesh, ReadOptions, Unit, parse_mesh};
use crate::IoError;
use d2m_bvh::{Topology, TriMesh};
use glam::DVec3;
use proptest::prelude::*;

fn file(bytes: &[u8], format: MeshFormat) -> Result<ReadMesh, Fault> {
    parse_mesh(bytes, format, &ReadOptions::new()).map_err(|error| match error {
        IoError::Content { place, reason } => Fault { line: place.line, reason },
        other => Fault::new(other.to_string()),
    })
}

mod obj {
    pub(super) fn parse(bytes: &[u8]) -> Result<super::TriMesh, super::Fault> {
        super::file(bytes, super::MeshFormat::Obj).map(|file| file.mesh)
    }
}
mod stl {
    pub(super) fn parse(bytes: &[u8]) -> Result<super::TriMesh, super::Fault> {
        super::file(bytes, super::MeshFormat::Stl).map(|file| file.mesh)
    }
}
mod ply {
    pub(super) fn parse(bytes: &[u8]) -> Result<super::TriMesh, super::Fault> {
        super::file(bytes, super::MeshFormat::Ply).map(|file| file.mesh)
    }
}

fn tetrahedron() -> TriMesh {
    d2m_shapes::mesh("tetrahedron").unwrap()
}

fn obj_text(mesh: &TriMesh) -> String {
    let vertices = mesh.vertices().iter().map(|v| format!("v {} {} {}\n", v.x, v.y, v.z));
    let faces = mesh.triangles().iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    vertices.chain(faces).collect()
}

fn stl_text(mesh: &TriMesh) -> String {
    let facets = (0..mesh.triangle_count()).map(|triangle| {
        let corners = mesh.corners(triangle).map(|v| format!("vertex {} {} {}\n", v.x, v.y, v.z));
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", corners.concat())
    });
    format!("solid test\n{}endsolid test\n", facets.collect::<String>())
}

fn stl_binary(mesh: &TriMesh, title: &[u8]) -> Vec<u8> {
    let mut bytes = title.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((mesh.triangle_count() as u32).to_le_bytes());
    for triangle in 0..mesh.triangle_count() {
        bytes.extend([0; 12]);
        for corner in mesh.corners(triangle) {
            bytes.extend(corner.to_array().iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ply_header(format: &str, mesh: &TriMesh) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment test\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertex_count(),
        mesh.triangle_count()
    )
}

fn ply_text(mesh: &TriMesh) -> String {
    let vertices = mesh.vertices().iter().map(|v| format!("{} {} {} 7\n", v.x, v.y, v.z));
    let faces = mesh.triangles().iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
    ply_header("ascii", mesh) + &vertices.chain(faces).collect::<String>()
}

fn ply_binary(mesh: &TriMesh, big: bool) -> Vec<u8> {
    let mut bytes =
        ply_header(if big { "binary_big_endian" } else { "binary_little_endian" }, mesh).into_bytes();
    for vertex in mesh.vertices() {
        let number = |x: f64| if big { x.to_be_bytes() } else { x.to_le_bytes() };
        bytes.extend(vertex.to_array().into_iter().flat_map(number));
        bytes.push(7);
    }
    for triangle in mesh.triangles() {
        bytes.push(3);
        let number = |x: u32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
        bytes.extend(triangle.iter().flat_map(|&index| number(index)));
    }
    bytes
}

#[test]
fn every_format_gives_the_same_mesh() {
    let mesh = tetrahedron();
    assert_eq!(obj::parse(obj_text(&mesh).as_bytes()).unwrap(), mesh);
    assert_eq!(ply::parse(ply_text(&mesh).as_bytes()).unwrap(), mesh);
    for big in [false, true] {
        assert_eq!(ply::parse(&ply_binary(&mesh, big)).unwrap(), mesh);
    }
    let single = stl::parse(&stl_binary(&mesh, b"made by hand")).unwrap();
    assert_eq!(stl::parse(&stl_binary(&mesh, b"solid, but binary")).unwrap(), single);
    let double = stl::parse(stl_text(&mesh).as_bytes()).unwrap();
    assert_eq!(stl::parse(stl_text(&mesh).to_ascii_uppercase().as_bytes()).unwrap(), double);
    for loaded in [&single, &double] {
        assert_eq!(loaded.vertex_count(), 4);
        assert!(Topology::new(loaded).is_oriented_manifold());
    }
    for triangle in 0..4 {
        assert_eq!(double.corners(triangle), mesh.corners(triangle));
        let rounded = mesh.corners(triangle).map(|corner| corner.as_vec3().as_dvec3());
        assert_eq!(single.corners(triangle), rounded);
    }
}

/// The digits of a text are the body, in every format and for any number of them; what is stored as single precision says so.
#[test]
fn texts_are_read_as_the_nearest_doubles() {
    // Halfway cases, long mantissas, exponents of all sizes: as the compiler reads them.
    let numbers: [(&str, f64); 9] = [
        ("0.1", 0.1),
        ("-1.00000005960464477539062500000000000000001", -1.000_000_059_604_644_8),
        ("9007199254740993", 9_007_199_254_740_992.0),
        ("9007199254740993.00000000000000000000000000000000000001", 9_007_199_254_740_994.0),
        ("2.2250738585072011e-308", 2.225_073_858_507_201e-308),
        ("4.9406564584124654e-324", 5e-324),
        ("1e-999", 0.0),
        ("+123456789012345678901234567890e-25", 12_345.678_901_234_567),
        (".5E+1", 5.0),
    ];
    for three in numbers.chunks_exact(3) {
        let words: Vec<&str> = three.iter().map(|(word, _)| *word).collect();
        let position = DVec3::new(three[0].1, three[1].1, three[2].1);
        let words = words.join(" ");
        let obj_file = format!("v {words}\nv 7 0 0\nv 0 7 0\nf 1 2 3\n");
        let stl_file = format!(
            "solid\nfacet normal 0 0 nan\nouter loop\nvertex {words}\nvertex 7 0 0\nvertex 0 7 0\nendloop\nendfacet\nendsolid\n"
        );
        let ply_file = |kind: &str| {
            format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty {kind} x\nproperty {kind} y\nproperty {kind} z\n\
                 element face 1\nproperty list uchar int vertex_indices\nend_header\n{words}\n7 0 0\n0 7 0\n3 0 1 2\n"
            )
        };
        for file in [
            file(obj_file.as_bytes(), MeshFormat::Obj),
            file(stl_file.as_bytes(), MeshFormat::Stl),
            file(ply_file("double").as_bytes(), MeshFormat::Ply),
            file(ply_file("float").as_bytes(), MeshFormat::Ply),
        ] {
            let file = file.unwrap();
            assert_eq!(file.mesh.vertices()[0], position, "{words}");
            assert_eq!(file.report.precision, Precision::Double);
        }
    }
    let binary = file(&stl_binary(&tetrahedron(), b""), MeshFormat::Stl).unwrap();
    assert_eq!(binary.report.precision, Precision::Single("binary STL"));
    for big in [false, true] {
        let double = ply_binary(&tetrahedron(), big);
        assert_eq!(file(&double, MeshFormat::Ply).unwrap().report.precision, Precision::Double);
        let header =
            ply_header(if big { "binary_big_endian" } else { "binary_little_endian" }, &tetrahedron());
        let mut single = header.replace("double", "float").into_bytes();
        for vertex in tetrahedron().vertices() {
            let number = |x: f64| if big { (x as f32).to_be_bytes() } else { (x as f32).to_le_bytes() };
            single.extend(vertex.to_array().into_iter().flat_map(number));
            single.push(7);
        }
        single.extend(&double[double.len() - 4 * 13..]);
        let single = file(&single, MeshFormat::Ply).unwrap();
        assert_eq!(single.report.precision, Precision::Single("PLY with float properties"));
        let rounded: Vec<DVec3> = tetrahedron().vertices().iter().map(|v| v.as_vec3().as_dvec3()).collect();
        assert_eq!(single.mesh.vertices(), rounded);
    }
}

#[test]
fn obj_dialects() {
    let text = "# a comment, b\u{e9}b\u{e9}\r\nmtllib none.mtl\no part\nv 0 0 0 # first\r\nv 1 0 0 1.0\nvt 0.5 0.5\nvn 0 0 1\n\
                v 1 1 0\nv 0 1 0\nv 9 9 9\ng side\nusemtl red\nf 1/1/1 2//1 3/1 4 # quad\ns off\nl 1 2\np 1\nf -5 -3 \\\n -2\n\
                f 1 2\n";
    let mesh = obj::parse(text.as_bytes()).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
    assert_eq!(mesh.vertices()[4], DVec3::splat(9.0), "unused vertices keep their numbers");
    // The file may end with a line that promises another.
    let unfinished = format!("{}f 1 2 3 \\", obj_text(&tetrahedron()));
    assert_eq!(obj::parse(unfinished.as_bytes()).unwrap().triangle_count(), 5);
    // Two groups, and two vertices at one place: they keep the numbers of the file.
    let twice = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\ng a\nf 1 2 3\ng b\nf 4 3 2\n";
    assert_eq!(obj::parse(twice.as_bytes()).unwrap().triangles(), [[0, 1, 2], [3, 2, 1]]);
    // Lines may end in carriage returns alone.
    let old = obj_text(&tetrahedron()).replace('\n', "\r");
    assert_eq!(obj::parse(old.as_bytes()).unwrap(), tetrahedron());
}

/// Each line that goes on was once copied with all before it: 2 MB took a minute.
#[test]
fn long_statements_take_linear_time() {
    let start = std::time::Instant::now();
    let mut text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf".to_owned();
    text.push_str(&" \\\n".repeat(700_000));
    text.push_str(" 1 \\\n2 3 \\\n4\n");
    text.push_str("v ");
    text.push_str(&"0".repeat(1_000_000));
    text.push_str(" 1 2 \\\n");
    let mesh = obj::parse(text.as_bytes()).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
    assert!(start.elapsed().as_secs_f64() < 30.0, "{:?}", start.elapsed());
    let fault = obj::parse(b"v 0 0 0\nf 1 1 \\\n 2\n").unwrap_err();
    assert_eq!(fault.line, Some(3), "the line of the word, not of the statement");
}

#[test]
fn concave_faces_are_cut_inside_themselves() {
    // A dart seen from z: the diagonal from its first corner would leave it.
    let text = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\nf 1 2 3 4\nf 2/1 3/2 4/3 1/4\nf -4 -3 -2 -1\n";
    let ReadMesh { mesh, report } = file(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(report.polygons, PolygonCounts { cut: 3, ..Default::default() });
    assert_eq!(mesh.triangle_count(), 6);
    assert!(mesh.triangles().iter().all(|triangle| triangle.contains(&3) && triangle.contains(&1)));
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n2 1 0\n0 2 0\n0.5 1 0\n4 0 1 2 3\n";
    let mesh = ply::parse(ply.as_bytes()).unwrap();
    assert!(mesh.triangles().iter().all(|triangle| triangle.contains(&3) && triangle.contains(&1)));
}

#[test]
fn a_byte_order_mark_hides_no_vertex() {
    let text = format!("\u{feff}{}", obj_text(&tetrahedron()));
    assert_eq!(obj::parse(text.as_bytes()).unwrap(), tetrahedron());
}

#[test]
fn polygons_in_ply_become_fans() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
                element face 3\nproperty list uchar uint vertex_index\nelement edge 1\nproperty int vertex1\nend_header\n\
                0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n2 0 1\n4 4 3 2 1\n0\n";
    let mesh = ply::parse(text.as_bytes()).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [4, 3, 2], [4, 2, 1]]);
}

#[test]
fn faults_name_the_place_and_the_value() {
    let fault = |result: Result<TriMesh, Fault>| {
        let Fault { line, reason } = result.unwrap_err();
        (line, reason)
    };
    let text = |line: usize, reason: &str| (Some(line), reason.to_owned());
    let obj = |text: &str| fault(obj::parse(text.as_bytes()));
    assert_eq!(obj("v 0 0 0\nv 1 0 NaN\n"), text(2, "vertex 2: z is NaN, not a finite number"));
    assert_eq!(obj("v 0 0 0\nv 1 1e999 0\n"), text(2, "vertex 2: y is 1e999, not a finite number"));
    assert_eq!(obj("v 0 zero 0\n"), text(1, "vertex 1: y is \"zero\", not a number"));
    assert_eq!(obj("\nv 0 0\n"), text(2, "vertex 1: z is missing"));
    assert_eq!(obj("v 0 0 0\nf 1 1 4\n"), text(2, "vertex index 4 is out of range, the file has 1 vertices"));
    assert_eq!(
        obj("v 0 0 0\nf 1 0 1\n"),
        text(2, "vertex index 0 is out of range, 1 vertices are given so far")
    );
    assert_eq!(
        obj("v 0 0 0\nf 1 -2 1\n"),
        text(2, "vertex index -2 is out of range, 1 vertices are given so far")
    );
    assert_eq!(obj("v 0 0 0\nf 1 x/1 1\n"), text(2, "face: \"x/1\" is not a vertex index"));
    assert_eq!(obj("v 0 0 0\n"), (None, "the mesh has no triangles".to_owned()));
    assert_eq!(obj("hello"), (None, "the mesh has no triangles".to_owned()));
    assert_eq!(obj("v 0 0 0\nv 1 0 1e70\n"), text(2, "vertex 2: z is 1e70, larger than the limit of 1e60"));

    let stl = |text: &str| fault(stl::parse(text.as_bytes()));
    let good = stl_text(&tetrahedron());
    let lines: Vec<&str> = good.lines().collect();
    let with = |index: usize, line: &str| {
        let mut lines = lines.clone();
        lines[index] = line;
        lines.join("\n")
    };
    assert_eq!(stl(&with(10, "vertex 0 0 x")), text(11, "triangle 1: corner 0: z is \"x\", not a number"));
    assert_eq!(
        stl(&with(10, "vertex 0 0 inf")),
        text(11, "triangle 1: corner 0: z is inf, not a finite number")
    );
    assert_eq!(
        stl(&with(10, "vertex 0 0 -1e99")),
        text(11, "triangle 1: corner 0: z is -1e99, larger than the limit of 1e60")
    );
    assert_eq!(stl(&with(10, "vertex 0 0")), text(12, "triangle 1: corner 0: z is \"vertex\", not a number"));
    assert_eq!(
        stl(&with(13, "vertex 0 0 0")),
        text(14, "triangle 1: \"endloop\" is expected, not \"vertex\"")
    );
    assert_eq!(
        stl(&with(0, "solid\nfacets")),
        text(2, "\"facet\" or \"endsolid\" is expected, not \"facets\"")
    );
    assert_eq!(
        stl(&lines[..lines.len() - 1].join("\n")),
        (None, "the text ends without \"endsolid\"".to_owned())
    );
    assert_eq!(stl("solid\nendsolid\n"), (None, "the mesh has no triangles".to_owned()));
    let mut bytes = stl_binary(&tetrahedron(), b"title");
    bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        fault(stl::parse(&bytes)),
        (None, "triangle 1, corner 0: coordinate NaN is not a finite number".to_owned())
    );
    let (_, reason) = fault(stl::parse(&bytes[..200]));
    assert_eq!(reason, "the header states 4 triangles, 284 bytes, but the file has 200");

    let ply = |text: &str| fault(ply::parse(text.as_bytes()));
    let good = ply_text(&tetrahedron());
    assert_eq!(
        ply(&good.replace("3 1 3 2", "3 1 9 2")).1,
        "face 3: vertex index 9 is out of range, the file has 4 vertices"
    );
    assert_eq!(
        ply(&good.replace("3 1 3 2", "3 1 -3 2")),
        text(19, "face 3: vertex index -3 is out of range, the file has 4 vertices")
    );
    assert_eq!(
        ply(&good.replace("3 1 3 2", "3 1 b 2")),
        text(19, "face 3: vertex index \"b\" is not a number")
    );
    assert_eq!(ply(&good.replace("3 1 3 2\n", "")), (None, "face: the file ends after 3 of 4".to_owned()));
    assert_eq!(ply(&good.replace("property double z\n", "")).0, Some(11));
    assert_eq!(
        ply(&good.replace("3 1 3 2", "3 1 3 2 0")),
        text(19, "face 3: \"0\" is left after its properties")
    );
    assert_eq!(
        ply(&(good.clone() + "\n3 1 3 2\n")),
        text(21, "\"3 1 3 2\" is left after the elements that the header states")
    );
    assert_eq!(
        ply(&good.replace("property uchar red\n", "property uchar red\nproperty int x\n")),
        text(9, "\"x\" is defined for the second time")
    );
    assert_eq!(ply("hello"), text(1, "Expected magic number 'ply' found \"hello\""));
    let far = ply_header("ascii", &tetrahedron()) + "0 0 -1e70 7\n1 0 0 7\n0 1 0 7\n0 0 1 7\n";
    let far = far + "3 0 1 2\n".repeat(4).as_str();
    assert_eq!(ply(&far), text(12, "vertex 0: z is -1e70, larger than the limit of 1e60"));
    let mut bytes = ply_binary(&tetrahedron(), false);
    let payload = bytes.len() - 4 * 13 - 4 * 25;
    bytes[payload + 25 + 8..][..8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    assert_eq!(fault(ply::parse(&bytes)), (None, "vertex 1: y is inf, not a finite number".to_owned()));
    assert!(ply::parse(&bytes[..bytes.len() - 1]).is_err());
    let huge = "ply\nformat binary_little_endian 1.0\nelement nothing 99999999999999\nend_header\n";
    assert_eq!(ply(huge), (None, "element \"nothing\" has no properties".to_owned()));
    let huge = "ply\nformat binary_little_endian 1.0\nelement face 999999999999\n\
                property list uint int vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}";
    assert!(ply::parse(huge.as_bytes()).is_err());
}

/// Nothing panics, hangs or takes memory beyond measure; what is accepted is a checked mesh.
fn survives(bytes: &[u8]) {
    for parse in [obj::parse, stl::parse, ply::parse] {
        if let Ok(mesh) = parse(bytes) {
            assert!(mesh.triangle_count() <= bytes.len());
        }
    }
}

/// Bytes of a good file with some overwritten, cut or doubled.
fn damaged(seed: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let length = seed.len();
    let edits = prop::collection::vec((0..length, any::<u8>(), 0..4_u8), 1..6);
    edits.prop_map(move |edits| {
        let mut bytes = seed.clone();
        for (place, byte, kind) in edits {
            let place = place.min(bytes.len().saturating_sub(1));
            match kind {
                0 if !bytes.is_empty() => bytes[place] = byte,
                1 => bytes.truncate(place),
                2 => bytes.insert(place, byte),
                _ => bytes.extend_from_within(place.min(bytes.len())..),
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        survives(&bytes);
    }

    #[test]
    fn damaged_files(
        obj in damaged(obj_text(&tetrahedron()).into_bytes()),
        stl in damaged(stl_text(&tetrahedron()).into_bytes()),
        stl_binary in damaged(stl_binary(&tetrahedron(), b"title")),
        ply in damaged(ply_text(&tetrahedron()).into_bytes()),
        little in damaged(ply_binary(&tetrahedron(), false)),
        big in damaged(ply_binary(&tetrahedron(), true)),
    ) {
        for bytes in [obj, stl, stl_binary, ply, little, big] {
            survives(&bytes);
        }
    }

    #[test]
    fn obj_words(words in prop::collection::vec(prop::sample::select(vec![
        "v", "f", "vt", "vn", "1", "-1", "0", "1/2/3", "//", "1//9223372036854775807", "-9223372036854775808",
        "18446744073709551616", "nan", "1e308", "#", "\\", "\n", "\n", "\n", "usemtl", "mtllib x", "o", "l", "p",
    ]), 0..60)) {
        survives(words.join(" ").as_bytes());
    }
}

#[test]
fn scale_unit_and_merging() {
    let stl = stl_text(&tetrahedron());
    let read = |options: ReadOptions| parse_mesh(stl.as_bytes(), MeshFormat::Stl, &options).unwrap().mesh;
    let plain = read(ReadOptions::new());
    assert_eq!(read(ReadOptions::new().with_merging(Merging::Never)).vertex_count(), 12);
    let inches = read(ReadOptions::new().with_unit(Unit::Inch));
    for (inch, whole) in inches.vertices().iter().zip(plain.vertices()) {
        assert_eq!(*inch, *whole * 127.0 / 5000.0);
    }
    let mirrored = read(ReadOptions::new().with_scale(DVec3::new(-2.0, 1.0, 1.0)));
    let volume = |mesh: &TriMesh| d2m_bvh::Validation::new(mesh).signed_volume;
    assert!(volume(&mirrored) > 0.0 && (volume(&mirrored) - 2.0 * volume(&plain)).abs() < 1e-12);
    for scale in [DVec3::ZERO, DVec3::new(1.0, f64::NAN, 1.0), DVec3::new(1.0, 1.0, f64::INFINITY)] {
        let options = ReadOptions::new().with_scale(scale);
        let fault = parse_mesh(stl.as_bytes(), MeshFormat::Stl, &options).unwrap_err();
        assert!(matches!(fault, IoError::BadScale { .. }), "{fault}");
    }
    let far = ReadOptions::new().with_scale(DVec3::splat(1e61));
    let fault = parse_mesh(stl.as_bytes(), MeshFormat::Stl, &far).unwrap_err().to_string();
    assert!(fault.contains("larger than the limit"), "{fault}");
    let twice = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nf 1 2 3\nf 4 3 2\n";
    let merged = ReadOptions::new().with_merging(Merging::Always);
    let mesh = parse_mesh(twice.as_bytes(), MeshFormat::Obj, &merged).unwrap().mesh;
    assert_eq!((mesh.vertex_count(), mesh.triangles()), (3, [[0, 1, 2], [0, 2, 1]].as_slice()));
}

/// Line, face of the file and value, also where the faces come before the vertices.
#[test]
fn indices_beyond_the_vertices_of_a_ply_are_named_by_their_line() {
    let (vertices, faces) = ("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n4 0 1 2 3\n");
    let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 2\nproperty list uchar int vertex_indices\n";
    for (text, line) in [
        (format!("ply\nformat ascii 1.0\n{vertex}{face}end_header\n{vertices}{faces}"), 14),
        (format!("ply\nformat ascii 1.0\n{face}{vertex}end_header\n{faces}{vertices}"), 11),
    ] {
        let reason = "face 1: vertex index 3 is out of range, the file has 3 vertices".to_owned();
        assert_eq!(ply::parse(text.as_bytes()), Err(Fault { line: Some(line), reason }));
    }
}
