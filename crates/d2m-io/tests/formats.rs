//! The same body in every format, in place; and what is named when something is wrong.

mod samples;

use d2m_bvh::{Topology, TriMesh, Validation};
use d2m_io::{Merging, MeshFormat, ReadOptions, Unit, UpAxis, parse_mesh, read_mesh};
use glam::DVec3;
use samples::{DAE_NODES, MODEL, OFF, archive, dae, gltf, tetrahedron, three_mf};

fn read(format: MeshFormat, bytes: impl AsRef<[u8]>) -> TriMesh {
    parse_mesh(bytes.as_ref(), format, &ReadOptions::new()).unwrap().mesh
}

fn fault(format: MeshFormat, bytes: impl AsRef<[u8]>) -> String {
    parse_mesh(bytes.as_ref(), format, &ReadOptions::new()).unwrap_err().to_string()
}

#[test]
fn every_format_holds_the_same_body() {
    let mesh = tetrahedron();
    for (format, bytes) in samples::all() {
        let found = read(format, bytes);
        assert!(Topology::new(&found).is_watertight(), "{format:?}");
        for triangle in 0..4 {
            let expected = match format {
                MeshFormat::Gltf | MeshFormat::Glb => {
                    mesh.corners(triangle).map(|corner| corner.as_vec3().as_dvec3())
                }
                _ => mesh.corners(triangle),
            };
            assert_eq!(found.corners(triangle), expected, "{format:?}");
        }
    }
}

#[test]
fn nodes_of_collada_are_applied_in_doubles() {
    let nodes = r##"<node><translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>
        <instance_geometry url="#g"/><node><matrix>1 0 0 0  0 1 0 0  0 0 -1 7  0 0 0 1</matrix><instance_node url="#sub"/></node></node>
        <node><rotate>1 0 0 30</rotate><instance_geometry url="#g"/></node>"##;
    let mesh = read(MeshFormat::Dae, dae(nodes));
    assert_eq!(mesh.triangle_count(), 12);
    // Point (0.1, 0, 0): twice as far along x, turned to y, shifted. Quarter turns are exact.
    assert_eq!(mesh.vertices()[1], DVec3::new(1.0, 0.2, 0.0));
    assert_eq!(mesh.vertices()[2], DVec3::new(0.8, 0.0, 0.0));
    // Mirrored in z, shifted by 1 before and by 7 after.
    assert_eq!(mesh.vertices()[7], DVec3::new(1.0, 0.0, 7.0 - 1.3));
    assert!(Validation::new(&mesh).signed_volume > 0.0 && Topology::new(&mesh).is_watertight());
    let tip = mesh.vertices()[11];
    assert!((tip - DVec3::new(0.0, -0.15, 0.3 * 0.75_f64.sqrt())).length() < 1e-16, "{tip}");
}

#[test]
fn units_that_files_state() {
    let inch = dae(DAE_NODES).replace(r#"meter="1""#, r#"meter="0.0254""#).replace("Z_UP", "Y_UP");
    let found = parse_mesh(inch.as_bytes(), MeshFormat::Dae, &ReadOptions::new()).unwrap();
    assert_eq!(found.report.meters_per_unit, Some(0.0254));
    assert_eq!(found.report.up_axis, Some(UpAxis::Y));
    assert_eq!(found.mesh.vertices()[1], DVec3::X * (0.1 * 0.0254), "nothing is turned for the axis");
    for (unit, meters) in
        [("micron", 0.1 / 1e6), ("millimeter", 0.1 / 1e3), ("foot", 0.1 * 0.3048), ("meter", 0.1)]
    {
        let model = MODEL.replace(r#"unit="meter""#, &format!(r#"unit="{unit}""#));
        assert_eq!(read(MeshFormat::ThreeMf, three_mf(&model)).vertices()[1].x, meters, "{unit}");
    }
    let silent = three_mf(&MODEL.replace(r#"unit="meter""#, ""));
    assert_eq!(read(MeshFormat::ThreeMf, &silent).vertices()[2].y, 0.0002, "millimeters");
    // What the caller says counts instead of what the file says.
    let options = ReadOptions::new().with_unit(Unit::Centimeter);
    assert_eq!(parse_mesh(&silent, MeshFormat::ThreeMf, &options).unwrap().mesh.vertices()[2].y, 0.002);
}

#[test]
fn components_of_3mf_are_placed() {
    let model = MODEL
        .replace(
            "</resources>",
            r#"<object id="2"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/><component objectid="1"/></components></object></resources>"#,
        )
        .replace(r#"<item objectid="1"/>"#, r#"<item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 9"/>"#);
    let mesh = read(MeshFormat::ThreeMf, three_mf(&model));
    // Rows in front of the matrix: (x, y, z) becomes (−y, x, z + 9), after the shift by 5.
    assert_eq!(mesh.vertices()[1], DVec3::new(0.0, 5.1, 9.0));
    assert_eq!(mesh.vertices()[6], DVec3::new(-0.2, 0.0, 9.0));
    assert!(Validation::new(&mesh).signed_volume > 0.0);
    // Parts of the production extension.
    let main = r#"<model unit="meter" xmlns="c" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" requiredextensions="p"><resources><object id="1"><components><component p:path="/3D/b.model" objectid="1"/></components></object></resources><build><item objectid="1"/></build></model>"#;
    let bytes = archive(&[("3D/3dmodel.model", main), ("3D/b.model", MODEL)]);
    assert_eq!(read(MeshFormat::ThreeMf, bytes), tetrahedron());
}

#[test]
fn nodes_of_gltf_are_applied_in_doubles() {
    let nodes = r#"{"mesh":0,"children":[1,2],"translation":[1,0,0]},{"mesh":0,"scale":[-1,1,1]},
        {"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 0.1,0,0,1]}"#;
    let text = gltf(nodes);
    let options = ReadOptions::new().with_merging(Merging::Never);
    let mesh = parse_mesh(text.as_bytes(), MeshFormat::Gltf, &options).unwrap().mesh;
    let x = f64::from(0.1_f32);
    assert_eq!(mesh.vertices()[1], DVec3::new(1.0 + x, 0.0, 0.0));
    assert_eq!(mesh.vertices()[5], DVec3::new(1.0 - x, 0.0, 0.0));
    assert_eq!(mesh.vertices()[9], DVec3::new(1.1, x, 0.0), "1.1 and not the nearest float");
    assert!(Validation::new(&mesh).signed_volume > 0.0);
    let turned = gltf(r#"{"mesh":0,"rotation":[0,0,0.70710677,0.70710677]}"#);
    let corner = read(MeshFormat::Gltf, turned).vertices()[1];
    assert!((corner - DVec3::Y * x).length() < 1e-16, "a rotation is normalized: {corner}");
}

#[test]
fn buffers_beside_a_gltf_file() {
    let folder = std::env::temp_dir().join(format!("d2m-io-gltf-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let text = gltf(r#"{"mesh":0}"#);
    let (start, rest) = text.split_once("data:").unwrap();
    let (_, end) = rest.split_once('"').unwrap();
    let with = |uri: &str| std::fs::write(folder.join("a.gltf"), format!("{start}{uri}\"{end}")).unwrap();
    let positions = tetrahedron().vertices().iter().flat_map(|p: &DVec3| p.to_array()).collect::<Vec<f64>>();
    let mut bytes: Vec<u8> = positions.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect();
    bytes.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    std::fs::write(folder.join("my mesh.bin"), &bytes).unwrap();
    with("my%20mesh.bin");
    assert_eq!(read_mesh(folder.join("a.gltf")).unwrap().mesh.triangle_count(), 4);
    for (uri, expected) in [
        ("none.bin", "none.bin"),
        ("/etc/hosts", "is not a file beside this one"),
        ("http://example.org/a.bin", "is not a file beside this one"),
        ("data:x;base64,AAAA", "60 bytes are stated, 3 are there"),
        ("data:x,AAAA", "not base64"),
    ] {
        with(uri);
        let fault = read_mesh(folder.join("a.gltf")).unwrap_err().to_string();
        assert!(
            fault.contains("a.gltf: mesh 0, primitive 0: buffer 0: ") && fault.contains(expected),
            "{fault}"
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn off_dialects() {
    assert_eq!(read(MeshFormat::Off, OFF.replace("OFF # a comment\n", "")), tetrahedron());
    assert_eq!(read(MeshFormat::Off, OFF.replace(" # a comment\n", " ")), tetrahedron());
    let colored = OFF.replace("OFF", "COFF").replace("0 0 0.3", "0 0 0.3 1 1 1 1");
    assert_eq!(read(MeshFormat::Off, colored), tetrahedron());
    for (text, expected) in [
        (OFF.replace("0 0.2 0", "0 nan 0"), "line 5: vertex 2: y is nan, not a finite number"),
        (
            OFF.replace("3 0 3 2", "3 0 3 4"),
            "line 9: face 2: vertex index 4 is out of range, the file has 4 vertices",
        ),
        (OFF.replace("3 1 2 3\n", ""), "face: the file ends after 3 of 4"),
        (OFF.replace("4 4 6", "4 99999999999999 6"), "face: the file ends after 4 of"),
        (OFF.replace("4 4 6", "4 x 6"), "line 2: \"x\" is not a number of faces"),
        (OFF.replace("OFF ", "4OFF "), "more than three dimensions"),
        (format!("{OFF}1 2 3\n"), "line 11: \"1 2 3\" is left after"),
    ] {
        let found = fault(MeshFormat::Off, &text);
        assert!(found.contains(expected), "{found}\n{expected}");
    }
}

#[test]
fn faults_of_placed_formats_name_place_and_value() {
    let good = dae(DAE_NODES);
    for (from, to, expected) in [
        ("0 0 0.3<", "0 0 1e999<", "line 6: <float_array>: \"1e999\" is not a finite number"),
        ("0 0 0.3<", "0 0 x<", "line 6: <float_array>: \"x\" is not a number"),
        ("0 0 0.3<", "0 0 1e70<", "<float_array>: position 3: z is 1e70, larger than the limit of 1e60"),
        (
            "count=\"4\" stride",
            "count=\"5\" stride",
            "line 7: <accessor>: 5 positions of stride 3 from 0 do not fit into 12 numbers",
        ),
        ("count=\"4\" stride", "count=\"18446744073709551615\" stride", "do not fit"),
        ("1 2 3</p>", "1 2 4</p>", "line 11: <p>: vertex index 4 is out of range, the mesh has 4 vertices"),
        ("1 2 3</p>", "1 2</p>", "<p>: 5 corners are no whole triangles"),
        ("<vcount>3 3<", "<vcount>3 4<", "vcount states more corners than the 6 of <p>"),
        ("<vcount>3 3<", "<vcount>3<", "3 corners of <p> are left after vcount"),
        (
            "url=\"#g\"/></node></visual",
            "url=\"#h\"/></node></visual",
            "<instance_geometry>: url \"#h\" is the id of no <geometry>",
        ),
        ("meter=\"1\"", "meter=\"0\"", "<unit>: meter is 0, not positive"),
        ("<node id=\"n\">", "<node id=\"n\"><skew>1</skew>", "the transform skew is not supported"),
        ("<node id=\"n\">", "<node id=\"n\"><rotate>0 0 0 90</rotate>", "has no direction"),
        (
            "<node id=\"n\">",
            "<node id=\"n\"><scale>0 0 1e200</scale><scale>1 1 1e200</scale>",
            "not a finite number",
        ),
        ("</COLLADA>", "", "line 1"),
        ("<asset>", "<asset2>", "line 3"),
    ] {
        assert!(good.contains(from), "{from}");
        let found = fault(MeshFormat::Dae, good.replace(from, to));
        assert!(found.contains(expected), "{found}\n{expected}");
    }
    for (from, to, expected) in [
        (r#"x="0.1""#, r#"x="nan""#, "3D/a.model, line 4: <vertex>: \"nan\" is not a finite number"),
        (r#"x="0.1""#, r#"q="0.1""#, "<vertex>: the attribute x is missing"),
        (
            r#"v2="2" v3="3""#,
            r#"v2="2" v3="7""#,
            "<triangle>: v3 is 7, out of range: the mesh has 4 vertices",
        ),
        (r#"<item objectid="1"/>"#, r#"<item objectid="8"/>"#, "object \"8\" is referred to and not defined"),
        (r#"<item objectid="1"/>"#, "", "its build of 0 items holds no mesh"),
        (
            r#"<item objectid="1"/>"#,
            r#"<item objectid="1" transform="1 2"/>"#,
            "<item>: 2 numbers instead of 12",
        ),
        (r#"unit="meter""#, r#"unit="ell""#, "\"ell\" is not a unit of 3MF"),
        (
            "<model ",
            r#"<model requiredextensions="b" xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" "#,
            "is required and not supported",
        ),
    ] {
        assert!(MODEL.contains(from), "{from}");
        let found = fault(MeshFormat::ThreeMf, three_mf(&MODEL.replace(from, to)));
        assert!(found.contains(expected), "{found}\n{expected}");
    }
    let good = gltf(r#"{"mesh":0}"#);
    for (from, to, expected) in [
        (r#""version":"2.0""#, r#""version":"1.0""#, "only glTF 2"),
        (r#"{"mesh":0}"#, r#"{"mesh":4}"#, "node 0: mesh 4 of 1 does not exist"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"children":[0]}"#, "node 0: it hangs in two places, or from itself"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"skin":0}"#, "node 0: meshes with skins are not supported"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"rotation":[0,0,0,0]}"#, "node 0: its rotation is zero"),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e999,0,0]}"#, "number out of range at line 1"),
        (
            r#""count":4"#,
            r#""count":5"#,
            "accessor 0: 5 elements of 12 bytes, 12 apart, do not fit into the 48 bytes of bufferView 0",
        ),
        (r#""count":4"#, r#""count":18446744073709551615"#, "do not fit"),
        (r#""count":12"#, r#""count":12,"sparse":{}"#, "accessor 1: sparse accessors are not supported"),
        (
            r#""byteLength":48"#,
            r#""byteLength":4800"#,
            "bufferView 0: 4800 bytes from byte 0 go beyond the 60 bytes of its buffer",
        ),
        (r#""byteLength":60"#, r#""byteLength":61"#, "buffer 0: 61 bytes are stated, 60 are there"),
        (r#""componentType":5121"#, r#""componentType":5126"#, "accessor 1: 5126 is no type of indices"),
        (r#""mode":4"#, r#""mode":9"#, "mesh 0, primitive 0: 9 is no mode"),
        (
            r#""scene":0"#,
            r#""extensionsRequired":["KHR_draco_mesh_compression"]"#,
            "KHR_draco_mesh_compression is required",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        let found = fault(MeshFormat::Gltf, good.replace(from, to));
        assert!(found.contains(expected), "{found}\n{expected}");
    }
}
