//! A robot from URDF: is a planned path free of contact, and which edges may a planner take?
//!
//! `cargo run -p d2m --features robot --example robot`

use d2m::QueryOptions;
use d2m::glam::{DQuat, DVec3};
use d2m::robot::{Attached, Obstacle, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
use std::error::Error;
use std::sync::Arc;

/// Two links of 0.5 that turn about z, on a foot.
const ARM: &str = r#"<robot name="two">
  <link name="foot"><collision><origin xyz="0 0 -0.2"/><geometry><cylinder radius="0.1" length="0.3"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.06 0.06"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.25 0 0.07"/><geometry><box size="0.5 0.05 0.05"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
</robot>"#;

fn main() -> Result<(), Box<dyn Error>> {
    let robot = Robot::parse("two.urdf", ARM, &RobotOptions::new())?;
    println!("joints {:?}; {}", robot.joint_names(), robot.remarks().join("; "));
    // A millimeter is kept free.
    let mut scene =
        RobotScene::new(Arc::new(robot), None, QueryOptions::default().with_min_separation(1e-3))?;
    let tree = |shape: &str| d2m::shapes::mesh(shape).map(|mesh| Arc::new(d2m::MeshTree::new(mesh)));
    let post = tree("box?x=0.05&y=0.05&z=0.5")?;
    scene.add_obstacle(Obstacle::at_rest("post", post, DVec3::new(0.3, 0.6, 0.0), DQuat::IDENTITY)?)?;
    let part = tree("icosphere?triangles=200&scale=0.04")?;
    scene.attach(Attached::new("part", "lower", part, DVec3::new(0.56, 0.0, 0.07), DQuat::IDENTITY)?)?;

    // As a ROS controller would be given it: positions and velocities at times.
    let point = |time: f64, at: [f64; 2], rate: [f64; 2]| {
        TrajectoryPoint::new(time, at.to_vec()).with_velocities(rate.to_vec())
    };
    let names = vec!["shoulder".to_owned(), "elbow".to_owned()];
    let path = Trajectory::new(names, vec![point(0.0, [0.0; 2], [0.0; 2]), point(2.0, [2.0, 0.0], [0.0; 2])]);
    let answer = scene.check_path(&path)?;
    let found = answer.contact().ok_or("the stretched arm sweeps into the post")?;
    println!("stretched: {} meets {}; free until {:.9} s", found.a, found.b, answer.free_until());
    assert!(found.b == "post" && answer.free_until() > 0.5 && answer.free_until() < 1.5);

    // A sampling planner: straight edges between configurations, many at once.
    let edges = scene.edges(&["shoulder", "elbow"])?;
    let ways: [[[f64; 2]; 2]; 3] =
        [[[0.0, 0.0], [0.0, -2.6]], [[0.0, -2.6], [2.2, -2.6]], [[2.2, -2.6], [1.0, 0.0]]];
    let answers = edges.check_all(ways.iter().map(|[from, to]| (&from[..], &to[..])))?;
    let valid: Vec<f64> = answers.iter().map(d2m::robot::PathAnswer::free_until).collect();
    println!("edges: valid up to {valid:?}");
    assert!(answers[0].is_free() && answers[1].is_free() && !answers[2].is_free());
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
