//! Robots and paths that make no sense are refused with file, line, name and value.

use d2m_bvh::QueryOptions;
use d2m_robot::{Robot, RobotOptions, RobotScene, Srdf, Trajectory, TrajectoryPoint};
use std::sync::Arc;

const BOX: &str = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";

fn read(text: &str) -> Result<Robot, String> {
    Robot::parse("arm.urdf", text, &RobotOptions::new()).map_err(|error| error.to_string())
}

/// A robot of the links a and b, with this inside of b and these joints.
fn robot(link: &str, joints: &str) -> String {
    format!(
        "<robot name=\"r\">\n<link name=\"a\">{BOX}</link>\n<link name=\"b\">{link}</link>\n{joints}\n</robot>"
    )
}

const JOINT: &str = "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/>\
    <limit lower=\"-1\" upper=\"1\" velocity=\"2\"/></joint>";

#[test]
fn urdf_faults_name_line_and_value() {
    let joint = |inside: &str| format!("<joint name=\"j\" {inside}</joint>");
    let ends = "<parent link=\"a\"/><child link=\"b\"/>";
    let cases = [
        (String::from("<robot"), "arm.urdf, line 1"),
        (String::from("<sdf/>"), "arm.urdf, line 1: <sdf> where <robot> is expected"),
        (String::from("<robot name=\"r\"/>"), "arm.urdf: the robot has no link"),
        (
            String::from("<robot><link name=\"a\"><visual/></link></robot>"),
            "arm.urdf: none of the 1 links has collision geometry",
        ),
        (robot(BOX, ""), "arm.urdf: 2 links are carried by no joint, \"a\" and \"b\""),
        (
            robot(BOX, &joint(&format!("type=\"floating\">{ends}<mimic joint=\"j\"/>"))),
            "arm.urdf, line 4: joint \"j\": a joint of more than one number mimics no other",
        ),
        (robot(BOX, &joint(&format!("type=\"ball\">{ends}"))), "joint \"j\" has the unknown type \"ball\""),
        (robot(BOX, &joint(&format!(">{ends}"))), "line 4: <joint> has no type"),
        (robot(BOX, &joint("type=\"fixed\"><parent link=\"a\"/>")), "joint \"j\" has no <child>"),
        (
            robot(BOX, &joint("type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/>")),
            "joint \"j\": the child \"c\" is no link",
        ),
        (
            robot(BOX, &joint(&format!("type=\"revolute\">{ends}<axis xyz=\"0 0 0\"/>"))),
            "joint \"j\": the axis 0 0 0 has no direction",
        ),
        (
            robot(BOX, &joint(&format!("type=\"revolute\">{ends}<axis xyz=\"0 nan 0\"/>"))),
            "the xyz of <axis> is \"nan\", not a finite number",
        ),
        (
            robot(BOX, &joint(&format!("type=\"fixed\">{ends}<origin xyz=\"0 1\"/>"))),
            "the xyz of <origin> is \"0 1\", not three numbers",
        ),
        (
            robot(BOX, &joint(&format!("type=\"prismatic\">{ends}<limit lower=\"2\" upper=\"1\"/>"))),
            "joint \"j\": the lower limit 2.0 is above the upper one, 1.0",
        ),
        (
            robot(BOX, &joint(&format!("type=\"prismatic\">{ends}<mimic joint=\"k\"/>"))),
            "joint \"j\" mimics \"k\", which is no joint",
        ),
        (
            robot(BOX, &joint(&format!("type=\"prismatic\">{ends}<mimic joint=\"j\"/>"))),
            "joint \"j\" mimics itself in the end",
        ),
        (robot(BOX, &format!("{JOINT}\n{JOINT}")), "line 5: a second joint has the name \"j\""),
        (
            robot("<collision><geometry><box size=\"1 0 1\"/></geometry></collision>", JOINT),
            "line 3: the size of <box> is [1.0, 0.0, 1.0]",
        ),
        (
            robot("<collision><geometry><sphere radius=\"-1\"/></geometry></collision>", JOINT),
            "the radius of <sphere> is -1.0",
        ),
        (
            robot("<collision><geometry><cone radius=\"1\"/></geometry></collision>", JOINT),
            "<cone> is no shape",
        ),
        (robot("<collision><geometry/></collision>", JOINT), "<geometry> of <collision> is empty"),
        (robot("<collision/>", JOINT), "<collision> has no <geometry>"),
        (
            robot(
                "<collision><geometry><mesh filename=\"package://nowhere/x.stl\"/></geometry></collision>",
                JOINT,
            ),
            "arm.urdf, line 3: link \"b\": \"package://nowhere/x.stl\": the package \"nowhere\" is unknown",
        ),
        (
            robot("<collision><geometry><mesh filename=\"no/such.stl\"/></geometry></collision>", JOINT),
            "arm.urdf, line 3: link \"b\": no/such.stl",
        ),
        (
            robot(
                "<collision><geometry><mesh filename=\"x.stl\" scale=\"1 0 1\"/></geometry></collision>",
                JOINT,
            ),
            "the scale of <mesh> is [1.0, 0.0, 1.0]",
        ),
        (
            robot(
                BOX,
                &JOINT.replace("link=\"a\"", "link=\"b\"").replacen(
                    "link=\"b\"/><child link=\"b\"",
                    "link=\"b\"/><child link=\"a\"",
                    1,
                ),
            )
            .replace(
                "</robot>",
                "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>",
            ),
            "there is no root",
        ),
        (
            String::from(
                "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:include filename=\"x\"/></robot>",
            ),
            "this is a xacro file",
        ),
    ];
    for (text, expected) in cases {
        let message = read(&text).unwrap_err();
        assert!(message.contains(expected) && !message.contains('\n'), "{text}\n{message}\n{expected}");
    }
    assert!(
        Srdf::parse("a.srdf", "<robot><disable_collisions link1=\"a\"/></robot>")
            .unwrap_err()
            .to_string()
            .contains("a.srdf, line 1: <disable_collisions> has no link2")
    );
}

#[test]
fn what_real_files_hold_is_read() {
    let text = robot(
        &format!("{BOX}<visual><geometry><mesh filename=\"package://none/x.dae\"/></geometry></visual>{BOX}"),
        "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>\
         <transmission name=\"t\"><joint name=\"j\"><hardwareInterface>x</hardwareInterface></joint></transmission>\
         <link name=\"c\"/><joint name=\"f\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/><axis xyz=\"0 0 0\"/></joint>\
         <gazebo reference=\"a\"><joint name=\"x\"/></gazebo>",
    );
    let robot = read(&format!("\u{feff}<?xml version=\"1.0\"?>\n<!-- made by xacro -->\n{text}")).unwrap();
    assert_eq!(robot.joint_names(), ["j"]);
    let scene = RobotScene::new(Arc::new(robot), None, QueryOptions::default()).unwrap();
    let point = |time: f64| TrajectoryPoint::new(time, vec![time]);
    let path = Trajectory::new(vec!["j".into()], vec![point(0.0), point(1.0)]);
    let bodies = scene.bodies_along(&path).unwrap();
    assert_eq!((0..bodies.len()).map(|body| bodies.name(body)).collect::<Vec<_>>(), ["a", "b", "b"]);
    // Files of packages are looked for beside the robot.
    let folder = std::env::temp_dir().join(format!("d2m-robot-files-{}", std::process::id()));
    let meshes = folder.join("my_arm").join("meshes");
    std::fs::create_dir_all(&meshes).unwrap();
    std::fs::create_dir_all(folder.join("my_arm").join("urdf")).unwrap();
    let ascii = "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1000 0\nvertex 1000 0 0\nendloop\nendfacet\n\
        facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1000 0 0\nvertex 0 0 1000\nendloop\nendfacet\n\
        facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1000\nvertex 0 1000 0\nendloop\nendfacet\n\
        facet normal 0 0 0\nouter loop\nvertex 1000 0 0\nvertex 0 1000 0\nvertex 0 0 1000\nendloop\nendfacet\nendsolid t\n";
    std::fs::write(meshes.join("tetra.stl"), ascii).unwrap();
    let urdf = folder.join("my_arm").join("urdf").join("arm.urdf");
    let mesh = |name: &str| {
        format!(
            "<robot><link name=\"a\"><collision><geometry><mesh filename=\"{name}\" scale=\"0.001 0.001 0.002\"/></geometry></collision></link></robot>"
        )
    };
    for name in ["package://my_arm/meshes/tetra.stl", "../meshes/tetra.stl"] {
        std::fs::write(&urdf, mesh(name)).unwrap();
        assert!(Robot::read(&urdf, &RobotOptions::new()).is_ok(), "{name}");
    }
    std::fs::write(&urdf, mesh("package://other/tetra.stl")).unwrap();
    let message = Robot::read(&urdf, &RobotOptions::new()).unwrap_err().to_string();
    assert!(message.contains("--package other=DIR"), "{message}");
    assert!(Robot::read(&urdf, &RobotOptions::new().with_package("other", &meshes)).is_ok());
    std::fs::remove_dir_all(&folder).unwrap();
}

fn scene() -> RobotScene {
    RobotScene::new(Arc::new(read(&robot(BOX, JOINT)).unwrap()), None, QueryOptions::default()).unwrap()
}

#[test]
fn path_faults_name_point_and_joint() {
    let point = |time: f64, at: &[f64]| TrajectoryPoint::new(time, at.to_vec());
    let path = |names: &[&str], points: &[TrajectoryPoint]| {
        Trajectory::new(names.iter().map(|&name| name.to_owned()).collect(), points.to_vec())
    };
    let cases = [
        (path(&["j"], &[point(0.0, &[0.0])]), "points: 1 of them: a path needs two or more"),
        (path(&[], &[point(0.0, &[]), point(1.0, &[])]), "joint_names: it is empty"),
        (
            path(&["k"], &[point(0.0, &[0.0]), point(1.0, &[0.0])]),
            "joint_names[0]: \"k\" is no joint of the robot (j)",
        ),
        (
            path(&["j", "j"], &[point(0.0, &[0.0, 0.0]), point(1.0, &[0.0, 0.0])]),
            "joint_names[1]: \"j\" is named twice",
        ),
        (
            path(&["j"], &[point(1.0, &[0.0]), point(1.0, &[0.0])]),
            "points[1], time_from_start: 1.0 does not come after 1.0",
        ),
        (
            path(&["j"], &[point(0.0, &[0.0]), point(1.0, &[f64::NAN])]),
            "points[1], positions[0]: NaN is not finite (joint \"j\")",
        ),
        (
            path(&["j"], &[point(0.0, &[0.0, 1.0]), point(1.0, &[0.0])]),
            "points[0], positions: 2 numbers for 1 joints",
        ),
        (
            path(&["j"], &[point(0.0, &[0.0]).with_velocities(vec![0.0]), point(1.0, &[0.0])]),
            "points[1], velocities: 0 numbers for 1 joints",
        ),
    ];
    for (path, expected) in cases {
        let message = scene().check_path(&path).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\n{expected}");
    }
    let text = r#"{"joint_names": ["j"], "points": [{"positions": [0], "time_from_start": 0}], "speed": 2}"#;
    assert!(
        serde_json::from_str::<Trajectory>(text).unwrap_err().to_string().contains("unknown field `speed`")
    );
    let scene = scene();
    let edges = scene.edges(&["j"]).unwrap();
    let message = |result: Result<_, d2m_robot::RobotError>| {
        result.map(|_: d2m_robot::PathAnswer| ()).unwrap_err().to_string()
    };
    assert_eq!(message(edges.check(&[0.0, 1.0], &[0.0])), "from: 2 numbers for 1 joints");
    assert_eq!(message(edges.check(&[0.0], &[f64::INFINITY])), "to[0]: inf is not finite");
    assert!(scene.edges(&["k"]).is_err() && scene.edges(&["j", "j"]).is_err());
}

#[test]
fn paths_beyond_limits_are_warned_of() {
    let point =
        |time: f64, at: f64, speed: f64| TrajectoryPoint::new(time, vec![at]).with_velocities(vec![speed]);
    let path = |points: Vec<TrajectoryPoint>| Trajectory::new(vec!["j".into()], points);
    let warnings = |path: &Trajectory| scene().limit_warnings(path).unwrap();
    // Up to 1 and back in a parabola: at the limit, not beyond.
    let touching = path(vec![point(0.0, 0.0, 2.0), point(1.0, 1.0, 0.0), point(2.0, 0.0, -2.0)]);
    assert_eq!(warnings(&touching), []);
    // 4t(1 − t)·1.01 is above 1 from 0.45 on.
    let higher = path(vec![point(0.0, 0.0, 4.04), point(1.0, 0.0, -4.04)]);
    let found = warnings(&higher);
    let expected = 0.5 - (0.25 - 1.0 / 4.04_f64).sqrt();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].time - expected).abs() < 1e-5 && found[0].limit == 1.0 && found[0].value > 1.0);
    assert!(found[0].to_string().contains("joint \"j\": the position 1.0"), "{}", found[0]);
    assert!(found[1].time == 0.0 && found[1].limit == 2.0 && found[1].value > 4.0);
}

/// Bodies that are far apart are never queried: what a query would refuse is refused before.
#[test]
fn options_that_make_no_sense_are_refused_whatever_the_path() {
    use d2m_bvh::QueryOptions;
    let robot = || std::sync::Arc::new(Robot::parse("bare.urdf", BARE, &RobotOptions::new()).unwrap());
    const BARE: &str = "<robot name=\"bare\"><link name=\"a\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link></robot>";
    let message =
        |options: QueryOptions| RobotScene::new(robot(), None, options).err().map(|error| error.to_string());
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        let found = message(QueryOptions::default().with_min_separation(value)).unwrap();
        assert!(found.starts_with(&format!("min_separation: {value:?}")), "{found}");
    }
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = message(QueryOptions::default().with_tolerance(value)).unwrap();
        assert!(found.starts_with(&format!("tolerance: {value:?}")), "{found}");
    }
}
