//! What files of real robots hold, through `d2m robot`: answers that are known.

mod robot_case;
mod shell;

use robot_case::{CUBE, Case, path, slide, wall};

/// Three links carried by the joints j, k and l along x; the last one has a cube.
fn telescope(k: &str, l: &str) -> String {
    let joint = |name: &str, parent: &str, child: &str, inside: &str| {
        format!(
            "<joint name=\"{name}\" type=\"prismatic\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>"
        )
    };
    format!(
        "<robot name=\"t\">\n<link name=\"w\"/><link name=\"a\"/><link name=\"b\"/><link name=\"c\">{CUBE}</link>\n{}\n{}\n{}\n</robot>",
        joint("j", "w", "a", ""),
        joint("k", "a", "b", k),
        joint("l", "b", "c", l)
    )
}

#[test]
fn collisions_have_origins_and_links_have_several_or_none() {
    let case = Case::new("robot-files-collisions");
    let at = |x: f64| {
        CUBE.replace("<geometry>", &format!("<origin xyz=\"{x} 0 0\" rpy=\"0 0 1.57079632679\"/><geometry>"))
    };
    // The front is at 0.5, then at 1.5 with a second cube one further.
    case.meets(&slide(CUBE, ""), &path("4"), &wall(3.0), 0.5);
    case.meets(&slide(&format!("{CUBE}{}", at(1.0)), ""), &path("4"), &wall(3.0), 0.25);
    case.meets(&slide(&format!("{}{CUBE}{}", at(-3.0), at(1.0)), ""), &path("4"), &wall(3.0), 0.25);
    // Links without any carry others; the joints of transmissions and of Gazebo are others.
    let others = "<transmission name=\"t\"><type>x</type><joint name=\"j\"><hardwareInterface>e</hardwareInterface></joint>\
        <actuator name=\"m\"/></transmission><gazebo reference=\"w\"><joint name=\"j\"/><link name=\"m\"/></gazebo></robot>";
    case.meets(&telescope("", "").replace("</robot>", others), &path("5"), &wall(4.0), 0.6);
    // What only has visual elements has no body.
    let seen = "<visual><geometry><mesh filename=\"package://none/x.dae\"/></geometry></visual>";
    case.meets(&slide(&format!("{seen}{CUBE}"), ""), &path("4"), &wall(3.0), 0.5);
}

#[test]
fn axes_are_normalised_and_need_not_be_there() {
    let case = Case::new("robot-files-axes");
    let long = "<axis xyz=\"250 0 0\"/>";
    for (inside, expected) in [("", 0.5), (long, 0.5), ("<axis/>", 0.5), ("<axis xyz=\"1e-200 0 0\"/>", 0.5)]
    {
        case.meets(&slide(CUBE, inside), &path("4"), &wall(3.0), expected);
    }
    // (3, 4, 0)/5: x grows at 0.6 of the value.
    case.meets(&slide(CUBE, "<axis xyz=\"3 4 0\"/>"), &path("5"), &wall(3.0), 2.0 / 3.0);
    // On a fixed joint any axis is none. The root joint has a pose: x of the base is y of the world.
    let posed = format!(
        "<robot name=\"r\"><link name=\"world\"/><link name=\"base\">{CUBE}</link><link name=\"m\">{CUBE}</link>\
         <joint name=\"f\" type=\"fixed\"><parent link=\"world\"/><child link=\"base\"/>\
         <origin xyz=\"0 10 0\" rpy=\"0 0 1.57079632679489661923\"/><axis xyz=\"0 0 0\"/></joint>\
         <joint name=\"j\" type=\"prismatic\"><parent link=\"base\"/><child link=\"m\"/><origin xyz=\"2 0 0\"/></joint></robot>"
    );
    let above =
        r#"{"bodies": [{"name": "wall", "mesh": "shape:box?x=5&y=0.5&z=5", "pose": {"x": [0, 15, 0]}}]}"#;
    case.meets(&posed, &path("4"), above, 0.5);
    case.refused(
        &slide(CUBE, "<axis xyz=\"0 0 0\"/>"),
        &path("1"),
        &["r.urdf, line 4", "joint \"j\": the axis 0 0 0"],
    );
}

#[test]
fn mimics_follow_through_chains_in_any_order() {
    let case = Case::new("robot-files-mimic");
    let mimic = |of: &str, factor: &str, offset: &str| {
        format!("<mimic joint=\"{of}\" multiplier=\"{factor}\" offset=\"{offset}\"/>")
    };
    // k = 2j + 0.1 and l = 3k − 0.2, or the other way round: the cube is at 9j + 0.2 = 4.
    let (near, far) = (mimic("j", "2", "0.1"), mimic("k", "3", "-0.2"));
    case.meets(&telescope(&near, &far), &path("1"), &wall(5.0), 3.8 / 9.0);
    let (first, last) = (mimic("l", "3", "-0.2"), mimic("j", "2", "0.1"));
    case.meets(&telescope(&first, &last), &path("1"), &wall(5.0), 3.8 / 9.0);
    case.meets(&telescope("<mimic joint=\"j\"/>", ""), &path("4"), &wall(5.0), 0.5);
    // Of one that is named only: the others stay where a path puts them.
    let named = path("1").replace("\"j\"", "\"j\", \"k\"").replace("[0]", "[0, 0]").replace("[1]", "[1, 4]");
    case.meets(&telescope(&near, ""), &named, &wall(5.0), 0.8);
    for (k, l, words) in [
        ("<mimic joint=\"q\"/>", "", "joint \"k\" mimics \"q\", which is no joint"),
        ("<mimic joint=\"l\"/>", "<mimic joint=\"k\"/>", "joint \"k\" mimics itself in the end"),
        ("<mimic joint=\"k\"/>", "", "joint \"k\" mimics itself in the end"),
        ("<mimic/>", "", "<mimic> has no joint"),
        ("<mimic joint=\"j\" multiplier=\"two\"/>", "", "the multiplier of <mimic> is \"two\""),
        ("<mimic joint=\"j\" offset=\"1e999\"/>", "", "the offset of <mimic> is \"1e999\""),
        ("<mimic joint=\"j\"/><mimic joint=\"l\"/>", "", "<joint> has a second <mimic>"),
    ] {
        case.refused(&telescope(k, l), &path("1"), &["r.urdf, line", words]);
    }
    let too_far = telescope("<mimic joint=\"j\" multiplier=\"1e308\"/>", "");
    case.refused(&too_far, &path("1e3"), &["p.json", "joint \"k\"", "not finite"]);
}

/// A corner of a cube with this edge: four triangles, each with its own vertices.
fn corner(edge: f32) -> Vec<[[f32; 3]; 3]> {
    let [o, x, y, z] = [[0.0; 3], [edge, 0.0, 0.0], [0.0, edge, 0.0], [0.0, 0.0, edge]];
    vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]]
}

fn text_stl(triangles: &[[[f32; 3]; 3]]) -> String {
    let vertex = |[x, y, z]: &[f32; 3]| format!("   vertex {x} {y} {z:e}\r\n");
    let facet = |corners: &[[f32; 3]; 3]| {
        let vertices = corners.each_ref().map(vertex).concat();
        format!(" facet normal 0 0 0\r\n  outer loop\r\n{vertices}  endloop\r\n endfacet\r\n")
    };
    let facets: Vec<String> = triangles.iter().map(facet).collect();
    format!("solid corner of a cube\r\n{}endsolid\r\n", facets.concat())
}

fn binary_stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    // Many programs begin this form, too, with the word of the other one.
    let mut bytes = format!("{:80}", "solid made by a program").into_bytes();
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        let numbers = [0.0; 3].iter().chain(corners.iter().flatten()).flat_map(|x| x.to_le_bytes());
        bytes.extend(numbers.chain([0, 0]));
    }
    bytes
}

#[test]
fn soups_of_triangles_are_solids_in_every_scale() {
    let case = Case::new("robot-files-soups");
    let triangles = corner(1000.0);
    let mut with_slivers = triangles.clone();
    with_slivers.push([[0.0; 3], [0.0; 3], [1000.0, 0.0, 0.0]]);
    case.folder.file("text.stl", &text_stl(&triangles));
    for (name, soup) in
        [("binary.stl", &triangles), ("BINARY.STL", &triangles), ("slivers.stl", &with_slivers)]
    {
        std::fs::write(case.folder.path(name), binary_stl(soup)).unwrap();
    }
    let mesh = |name: &str, scale: &str, x: f64| {
        let body = format!(
            "<collision><origin xyz=\"{x} 0 0\"/><geometry><mesh filename=\"{name}\" scale=\"{scale}\"/></geometry></collision>"
        );
        slide(&body, "")
    };
    let inside = |x: f64| {
        format!(
            r#"{{"bodies": [{{"name": "in", "mesh": "shape:box?x=0.01&y=0.01&z=0.01", "pose": {{"x": [{x}, 0.2, 0.2]}}}}]}}"#
        )
    };
    for name in ["text.stl", "binary.stl", "BINARY.STL", "slivers.stl"] {
        case.meets(&mesh(name, "0.001 0.001 0.001", 0.0), &path("2"), &wall(2.5), 0.5);
        case.meets(&mesh(name, "2e-3 0.001 0.001", 0.0), &path("2"), &wall(3.5), 0.5);
        case.meets(&mesh(name, "-0.001 0.001 0.001", 1.0), &path("2"), &wall(2.5), 0.5);
        // Vertices that are equal are one, so that it bounds a solid, mirrored or not.
        case.meets(&mesh(name, "0.001 0.001 0.001", 0.0), &path("2"), &inside(0.2), 0.0);
        case.meets(&mesh(name, "-0.001 0.001 0.001", 0.0), &path("2"), &inside(-0.2), 0.0);
    }
    let mut cut = binary_stl(&triangles);
    cut.truncate(200);
    std::fs::write(case.folder.path("cut.stl"), cut).unwrap();
    std::fs::write(case.folder.path("nan.stl"), binary_stl(&[[[0.0; 3], [f32::NAN; 3], [1.0, 0.0, 0.0]]]))
        .unwrap();
    std::fs::write(case.folder.path("none.stl"), binary_stl(&[])).unwrap();
    case.folder.file("empty.stl", "");
    for (name, scale, words) in [
        ("cut.stl", "1 1 1", "the header states 4 triangles"),
        ("nan.stl", "1 1 1", "triangle 0, corner 1: coordinate NaN"),
        ("none.stl", "1 1 1", "the mesh has no triangles"),
        ("empty.stl", "1 1 1", "the file is empty"),
        ("missing.stl", "1 1 1", "missing.stl"),
        ("text.stl", "0.001", "the scale of <mesh> is \"0.001\", not three numbers"),
        ("text.stl", "1 0 1", "the scale of <mesh> is [1.0, 0.0, 1.0]"),
        ("text.stl", "1e300 1 1", "1e60"),
        ("package://arm/text.stl", "1 1 1", "--package arm=DIR"),
        ("http://host/text.stl", "1 1 1", "files of \"http\" cannot be read"),
        ("$(find arm)/text.stl", "1 1 1", "$(find arm)/text.stl"),
        ("", "1 1 1", "the filename of <mesh> is empty"),
    ] {
        case.refused(&mesh(name, scale, 0.0), &path("1"), &["r.urdf, line 3", words]);
    }
}

#[test]
fn a_pi_of_twelve_digits_is_no_breach_of_its_limit() {
    let case = Case::new("robot-files-pi");
    let limits = |lower: &str, upper: &str| {
        let link = format!("{CUBE}</link><link name=\"n\">");
        slide(&link, "").replacen("prismatic", "revolute", 1).replace(
            "</joint>",
            &format!(
                "<limit lower=\"{lower}\" upper=\"{upper}\" effort=\"1\" velocity=\"9\"/></joint>\
                 <joint name=\"f\" type=\"fixed\"><parent link=\"m\"/><child link=\"n\"/></joint>"
            ),
        )
    };
    let far = wall(90.0);
    let breaches = |upper: &str, end: &str| {
        let (found, said) = case.ask(&limits("-3.14159265359", upper), &path(end), &far);
        assert_eq!(found["status"], "free");
        (found["warnings"].as_array().unwrap().len(), said)
    };
    assert_eq!(breaches("3.14159265359", "3.141592653589793").0, 0);
    assert_eq!(breaches("3.14159265359", "3.14159265359").0, 0);
    let (count, said) = breaches("3.14159265358", "3.1416");
    assert_eq!(count, 1);
    for words in [
        "p.json: joint \"j\": the position 3.1415",
        "at the time 0.99999",
        "points[0]",
        "limit 3.14159265358",
    ] {
        assert!(said.contains(words), "{said} lacks {words}");
    }
}

#[test]
fn planar_and_floating_joints_move_by_their_numbers() {
    let case = Case::new("robot-files-planar");
    let kind = |kind: &str, inside: &str| slide(CUBE, inside).replacen("prismatic", kind, 1);
    let planar = kind("planar", "<axis xyz=\"0 -0 0.7123\"/><origin xyz=\"1 0 0\"/>");
    let of = |names: &str, ends: &str| {
        let zeros = vec!["0"; ends.split(',').count()].join(", ");
        path("E")
            .replace("\"j\"", names)
            .replace("[0]", &format!("[{zeros}]"))
            .replace("[E]", &format!("[{ends}]"))
    };
    // The front is at 1.5 + x.
    case.meets(&planar, &of("\"j/x\", \"j/y\"", "4, 2"), &wall(4.0), 0.5);
    // Turned in place the corner reaches 1 + √½: a wall at 1.6 is met where cos a + sin a = 1.2.
    let turned = 0.5 * (1.44_f64 - 1.0).asin();
    case.meets(&planar, &of("\"j/theta\"", "0.5"), &wall(2.1), turned / 0.5);
    // Shifts are before the turn: the direction of x is that of the origin.
    case.meets(&planar, &of("\"j/x\", \"j/theta\"", "4, 0"), &wall(4.0), 0.5);
    let floating = kind("floating", "");
    case.meets(&floating, &of("\"j/trans_x\", \"j/trans_z\"", "4, 1"), &wall(3.0), 0.5);
    // Not named: where it stands.
    let arm = slide(CUBE, "").replace(
        "</robot>",
        "<link name=\"up\"/><joint name=\"base\" type=\"floating\"><parent link=\"up\"/><child link=\"world\"/></joint></robot>",
    );
    case.meets(&arm, &path("4"), &wall(3.0), 0.5);
    assert!(case.ask(&arm, &path("4"), &wall(3.0)).1.contains("joint \"base\" is floating"));
    // About another axis x and y are not known.
    let other = kind("planar", "<axis xyz=\"0 1 0\"/>").replace(
        "</robot>",
        &format!("<link name=\"n\">{CUBE}</link><joint name=\"k\" type=\"prismatic\"><parent link=\"m\"/><child link=\"n\"/></joint></robot>"),
    );
    let (found, said) = case.ask(&other, &of("\"k\"", "4"), &wall(3.0));
    assert!(
        found["status"] == "contact" && said.contains("joint \"j\" is planar and stays at zero"),
        "{said}"
    );
    case.refused(
        &other,
        &of("\"j/x\"", "4"),
        &["p.json: joint_names[0]", "\"j/x\" is no joint of the robot (k)"],
    );
    case.refused(&other, &path("4"), &["p.json: joint_names[0]", "planar"]);
    case.refused(
        &floating,
        &of("\"j/rot_w\"", "1"),
        &["\"j/rot_w\" is no joint", "j/trans_x, j/trans_y, j/trans_z"],
    );
    case.refused(
        &kind("planar", "<mimic joint=\"j\"/>"),
        &path("4"),
        &["joint \"j\"", "more than one number"],
    );
}
