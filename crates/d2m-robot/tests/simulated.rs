//! Robots in simulations: masses, joints, limits and friction of their files.

use d2m_bvh::MeshTree;
use d2m_dynamics::{
    Body, Joint, JointKind, Kind, Mass, MassProperties, Motor, MotorTarget, Simulation, SimulationOptions,
    Spring,
};
use d2m_robot::{Base, Robot, RobotBodies, RobotOptions};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

const ARM: &str = r#"<robot name="arm">
  <link name="world"/>
  <link name="upper"><inertial><origin xyz="0.5 0 0"/><mass value="3"/><inertia ixx="0.01" iyy="0.25" izz="0.25"/></inertial>
    <collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.17" izz="0.17"/></inertial>
    <collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="tool"><inertial><mass value="1"/><inertia ixx="0.002" iyy="0.002" izz="0.002"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="world"/><child link="upper"/><origin xyz="0 0 2"/>
    <axis xyz="0 1 0"/><limit lower="-0.5" upper="1.25" velocity="2"/><dynamics damping="0.5" friction="0.25"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="weld" type="fixed"><parent link="lower"/><child link="tool"/><origin xyz="1 0 0"/></joint>
</robot>"#;

fn robot() -> Robot {
    Robot::parse("arm.urdf", ARM, &RobotOptions::new()).unwrap()
}

fn empty() -> Simulation {
    Simulation::new(SimulationOptions::default().with_gravity(DVec3::Z * -9.81)).unwrap()
}

/// The same arm by hand: the steps have the same bits.
#[test]
fn an_arm_moves_as_one_that_is_built_by_hand() {
    let mut simulation = empty();
    let arm = RobotBodies::new(&robot()).add_to(&mut simulation).unwrap();
    assert_eq!(arm.bodies.iter().flatten().count(), 3);
    assert!(arm.bodies[0].is_none() && arm.bodies[2] == arm.bodies[3] && simulation.len() == 2);
    let mut built = empty();
    let shape = d2m_shapes::mesh("box?x=0.4&y=0.05&z=0.05").unwrap();
    let vertices = shape.vertices().iter().map(|v| *v + DVec3::X * 0.5).collect();
    let shape = d2m_bvh::TriMesh::try_new(vertices, shape.triangles().to_vec()).unwrap();
    let tree = Arc::new(MeshTree::new(shape));
    let diagonal = |x: f64, y: f64| DMat3::from_diagonal(DVec3::new(x, y, y));
    let mass = |mass, x, inertia| Mass::Given(MassProperties::try_new(mass, DVec3::X * x, inertia).unwrap());
    // The forearm with the tool: 2 at 0.5 and 1 at 1.
    let both = diagonal(0.012, 0.17 + 0.002 + 2.0 / 36.0 + 1.0 / 9.0);
    let upper = Body::new("upper", Arc::clone(&tree)).with_position(DVec3::Z * 2.0).with_mass(mass(
        3.0,
        0.5,
        diagonal(0.01, 0.25),
    ));
    let lower = Body::new("lower", tree).with_position(DVec3::new(1.0, 0.0, 2.0)).with_mass(mass(
        3.0,
        2.0 / 3.0,
        both,
    ));
    let (upper, lower) = (built.add(&upper).unwrap(), built.add(&lower).unwrap());
    let shoulder = Joint::new(JointKind::Revolute, upper, None, DVec3::Z * 2.0).with_axis(-DVec3::Y);
    let shoulder =
        shoulder.with_limits([-0.5, 1.25]).with_spring(Spring::new(0.0, 0.5, 0.0)).with_friction(0.25);
    let shoulder = built.add_joint(&shoulder).unwrap();
    let elbow =
        Joint::new(JointKind::Revolute, upper, Some(lower), DVec3::new(1.0, 0.0, 2.0)).with_axis(DVec3::Y);
    built.add_joint(&elbow).unwrap();
    let mut highest = 0.0f64;
    for _ in 0..200 {
        simulation.step().unwrap();
        built.step().unwrap();
        for (one, other) in [(arm.bodies[1], upper), (arm.bodies[2], lower)] {
            let apart = simulation.position(one.unwrap()) - built.position(other);
            assert!(apart.length() < 1e-6, "{apart}");
        }
        let value = simulation.joint_value(arm.joints[0].unwrap());
        assert!((value - built.joint_value(shoulder)).abs() < 1e-6);
        highest = highest.max(value);
    }
    // It has fallen to its limit, and no further.
    assert!(highest > 1.24 && highest < 1.251, "{highest}");
}

/// Positions at the start count: limits are those of the file, values begin at zero.
#[test]
fn an_arm_begins_where_it_is_told_to() {
    let mut simulation = empty();
    let arm =
        RobotBodies::new(&robot()).with_positions(&[("shoulder", 1.0)]).add_to(&mut simulation).unwrap();
    let upper = arm.bodies[1].unwrap();
    let wanted = DVec3::Z * 2.0 + DQuat::from_rotation_y(1.0) * DVec3::X * 0.5;
    assert!((simulation.position(upper) - wanted).length() < 1e-12);
    let shoulder = arm.joints[0].unwrap();
    simulation.set_motor(shoulder, Some(Motor::new(MotorTarget::Velocity(3.0)))).unwrap();
    while simulation.time() < 1.0 {
        simulation.step().unwrap();
    }
    assert!((simulation.joint_value(shoulder) - 0.25).abs() < 1e-3, "{}", simulation.joint_value(shoulder));
    assert!(RobotBodies::new(&robot()).with_positions(&[("knee", 1.0)]).add_to(&mut simulation).is_err());
    assert_eq!(simulation.len(), 2);
}

/// What mimics another joint begins where that has it, with the limits of the file from there.
#[test]
fn what_mimics_another_joint_has_its_own_limits() {
    let mimic = r#"<joint name="elbow" type="revolute"><limit lower="-1.5" upper="-0.5" velocity="1"/>
      <mimic joint="shoulder" multiplier="-1" offset="-0.25"/>"#;
    let text = ARM.replace(r#"<joint name="elbow" type="continuous">"#, mimic);
    let robot = Robot::parse("arm.urdf", &text, &RobotOptions::new()).unwrap();
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let arm = RobotBodies::new(&robot).with_positions(&[("shoulder", 0.5)]).add_to(&mut simulation).unwrap();
    let elbow = arm.joints[1].unwrap();
    // It begins at -0.75, between limits that are 0.75 below and 0.25 above.
    for (speed, wanted) in [(2.0, 0.25), (-2.0, -0.75)] {
        simulation.set_motor(elbow, Some(Motor::new(MotorTarget::Velocity(speed)))).unwrap();
        let end = simulation.time() + 1.0;
        while simulation.time() < end {
            simulation.step().unwrap();
        }
        let value = simulation.joint_value(elbow);
        assert!((value - wanted).abs() < 1e-3, "{value} {wanted}");
    }
}

/// A robot that nothing carries falls as a whole, and lies on the floor.
#[test]
fn a_free_robot_falls() {
    let text = ARM.replace(
        r#"<link name="world"/>"#,
        r#"<link name="world"><inertial><mass value="5"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>
           <collision><geometry><box size="0.3 0.3 0.3"/></geometry></collision></link>"#,
    );
    let robot = Robot::parse("walker.urdf", &text.replace("0 0 2", "0.2 0 0"), &RobotOptions::new()).unwrap();
    let mut simulation = empty();
    let floor = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=9&y=9&z=0.5").unwrap()));
    let floor = Body::new("floor", floor).with_kind(Kind::Static).with_position(DVec3::Z * -2.0);
    simulation.add(&floor.with_friction(0.5)).unwrap();
    let walker = RobotBodies::new(&robot).with_base(Base::Free).with_friction(0.5);
    let walker = walker.add_to(&mut simulation).unwrap();
    while simulation.time() < 1.0 {
        simulation.step().unwrap();
    }
    for body in walker.bodies.iter().flatten() {
        let height = simulation.position(*body).z;
        assert!(height < -0.9 && height > -1.5, "{height}");
    }
}
