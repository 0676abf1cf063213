//! Bodies and pushes that no simulation can use are refused by name, and change nothing.

use d2m_bvh::{MeshTree, Solid, TriMesh};
use d2m_dynamics::{
    Body, Joint, JointKind, Kind, Mass, MassError, MassProperties, Motor, MotorTarget, Part, Simulation,
    SimulationError, SimulationOptions, Spring, StepError,
};
use d2m_motion::{ConstantTwist, Pose};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

fn cube() -> Body {
    Body::new("cube", Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap())))
}

fn empty() -> Simulation {
    Simulation::new(SimulationOptions::default()).unwrap()
}

/// An open mesh holds nothing: that it is to be filled is refused when it is added, not by the step in which something comes near it.
#[test]
fn an_open_mesh_is_no_solid() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let sheet = Arc::new(MeshTree::new(TriMesh::from_arrays(&corners, &[[0, 1, 2]]).unwrap()));
    let sheet = Body::new("sheet", sheet).with_kind(Kind::Static);
    let refused = empty().add(&sheet.clone().with_solid(Solid::Filled)).unwrap_err();
    assert!(refused.to_string().starts_with("body sheet: solid "), "{refused}");
    empty().add(&sheet.with_solid(Solid::Surface)).unwrap();
}

#[test]
fn an_inertia_that_no_body_has_is_refused() {
    let turns = (0..12).map(|k| DQuat::from_scaled_axis(DVec3::new(0.3, -1.1, 0.7) * f64::from(k)));
    for turn in turns {
        for size in [1e-40, 1e-3, 1.0, 1e40] {
            let turned = |moments: DVec3| {
                let r = DMat3::from_quat(turn);
                let m = r * DMat3::from_diagonal(moments * size) * r.transpose();
                (m + m.transpose()) * 0.5
            };
            let given = |moments| MassProperties::try_new(1.0, DVec3::ZERO, turned(moments));
            // A flat plate is the limit; text of nine digits may be a little beyond.
            for moments in [(1.0, 1.0, 1.0), (1.0, 2.0, 3.0), (1e-6, 1.0, 1.0), (1.0, 2.0, 3.0 + 1e-9)] {
                assert!(given(moments.into()).is_ok(), "{turn} {size:e} {moments:?}");
            }
            for moments in [(1.0, 1.0, 2.1), (1.0, 2.0, 3.000_001), (1e-6, 1e-6, 1.0), (5.0, 1.0, 1.0)] {
                let refused = given(moments.into());
                assert!(
                    matches!(refused, Err(MassError::NoSuchBody { .. } | MassError::Inertia { .. })),
                    "{turn} {size:e} {moments:?}: {refused:?}"
                );
                assert!(refused.unwrap_err().to_string().starts_with("inertia"));
            }
        }
    }
    let mass = MassProperties {
        mass: 1.0,
        center: DVec3::ZERO,
        inertia: DMat3::from_diagonal((1.0, 1.0, 3.0).into()),
    };
    let error = empty().add(&cube().with_mass(Mass::Given(mass))).unwrap_err();
    assert!(error.to_string().starts_with("body cube: inertia"), "{error}");
    assert!(matches!(error, SimulationError::Mass { error: MassError::NoSuchBody { moments, .. }, .. }
        if moments == DVec3::new(1.0, 1.0, 3.0)));
}

/// What is wrong is named, as it is written in files and no longer than that.
#[test]
fn messages_name_what_was_given() {
    let refused = |body: &Body| empty().add(body).unwrap_err().to_string();
    for (mass, wanted) in [
        (Mass::Density(1e308), "body cube: density 1e308: with the volume of 1.0 "),
        (Mass::Total(1e308), "body cube: mass 1e308: with the volume of 1.0 "),
        (Mass::Total(-1.0), "body cube: mass -1.0 must be"),
    ] {
        let said = refused(&cube().with_mass(mass));
        assert!(said.starts_with(wanted), "{said}");
    }
    // Rows, as in a file.
    let skew = DMat3::from_cols_array(&[1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]).transpose();
    let said = MassProperties::try_new(1.0, DVec3::ZERO, skew).unwrap_err().to_string();
    assert!(said.contains("[[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]"), "{said}");
    let lively = refused(&cube().with_restitution(1e300));
    assert_eq!(lively, "body cube: restitution 1e300 must be in [0, 1]");
    let fast = refused(&cube().with_linear_velocity(DVec3::X * 1e300));
    assert!(fast.contains("velocity [1e300, 0.0, 0.0] is too large"), "{fast}");
    let mut simulation = empty();
    let id = simulation.add(&cube().with_kind(Kind::Static)).unwrap();
    let nothing = Joint::new(JointKind::Fixed, id, None, DVec3::ZERO);
    let said = simulation.add_joint(&nothing).unwrap_err().to_string();
    assert!(said.contains("pair without a dynamic body, or of a body with itself, cannot be used"), "{said}");
    // What it has to be is said, where one sentence can say it.
    assert_eq!(
        refused(&cube().with_friction(-1.0)),
        "body cube: friction -1.0 must be finite and not negative"
    );
    let still = refused(&cube().with_linear_velocity(DVec3::new(f64::INFINITY, 0.0, 0.0)));
    assert_eq!(still, "body cube: velocity [inf, 0.0, 0.0] must be finite");
    let id = simulation.add(&cube().with_position(DVec3::X * 9.0)).unwrap();
    let hinge = Joint::new(JointKind::Revolute, id, None, DVec3::ZERO);
    for (joint, wanted) in [
        (hinge.clone().with_axis(DVec3::ZERO), "axis [0.0, 0.0, 0.0] has no direction"),
        (hinge.clone().with_limits([1.0, -1.0]), "limits [1.0, -1.0] must be finite, the lower one first"),
        (hinge.clone().with_friction(-1.0), "friction -1.0 must be finite and not negative"),
    ] {
        let said = simulation.add_joint(&joint).unwrap_err().to_string();
        assert!(said.ends_with(wanted), "{said}");
    }
}

#[test]
fn pushes_beyond_all_numbers_are_refused_and_change_nothing() {
    let mut simulation = empty();
    let id = simulation.add(&cube()).unwrap();
    let before = simulation.snapshot();
    for size in [1e308, 1e101, f64::INFINITY, f64::NAN] {
        for (k, [first, second]) in
            [[DVec3::X * size, DVec3::ZERO], [DVec3::ZERO, DVec3::Y * size]].into_iter().enumerate()
        {
            let named = |result: Result<(), SimulationError>, names: [&str; 2]| match result {
                Err(SimulationError::TooLarge { body, name, .. }) => {
                    assert_eq!((body.as_str(), name), ("cube", names[k]));
                }
                other => panic!("{size} {other:?}"),
            };
            named(simulation.apply_impulse(id, first, second), ["impulse", "angular impulse"]);
            named(simulation.set_force(id, first, second), ["force", "torque"]);
            assert_eq!(simulation.snapshot(), before);
        }
    }
    // Many that are allowed do not add up to one that is not.
    let most = (0..3).filter(|_| simulation.apply_impulse(id, DVec3::X * 9e99, DVec3::ZERO).is_ok()).count();
    assert_eq!(most, 1);
    let fast = DVec3::X * 1e200;
    for error in [
        empty().add(&cube().with_linear_velocity(fast)),
        simulation.set_velocity(id, fast, DVec3::ZERO).map(|()| id),
    ] {
        let error = error.unwrap_err();
        assert!(
            matches!(error, SimulationError::TooLarge { name: "velocity", value, .. } if value == fast),
            "{error}"
        );
    }
}

#[test]
fn velocities_that_would_be_ignored_are_refused() {
    let kinds = [Kind::Static, Kind::Kinematic(Arc::new(ConstantTwist::REST))];
    for kind in kinds {
        let body = cube().with_kind(kind);
        assert!(empty().add(&body).is_ok());
        for (moving, wanted) in [
            (body.clone().with_linear_velocity(DVec3::X), "velocity"),
            (body.with_angular_velocity(DVec3::Z), "angular velocity"),
        ] {
            let error = empty().add(&moving).unwrap_err();
            assert!(
                matches!(&error, SimulationError::VelocityWithoutMotion { body, name, .. }
                    if body == "cube" && *name == wanted),
                "{error}"
            );
        }
    }
}

/// A snapshot that was written and read puts a kinematic body far from the motion that it has by now: no step leads there. It was a panic.
#[test]
fn no_flight_leads_to_a_motion_beyond_all_numbers() {
    for far in [1e101, 1.5e307, 1e308] {
        let mut simulation = empty();
        let rest = Kind::Kinematic(Arc::new(ConstantTwist::REST));
        let body = simulation.add(&cube().with_kind(rest)).unwrap();
        simulation.step().unwrap();
        let written = serde_json::to_string(&simulation.snapshot()).unwrap();
        simulation.set_motion(body, Arc::new(ConstantTwist::REST.with_position(DVec3::X * far))).unwrap();
        simulation.restore(&serde_json::from_str(&written).unwrap()).unwrap();
        let before = simulation.snapshot();
        for _ in 0..2 {
            let time = simulation.time();
            assert_eq!(simulation.step(), Err(StepError::TooFast { body: "cube".to_owned(), time }));
            assert_eq!(simulation.snapshot(), before);
        }
    }
}

/// What falls so fast that no state could say it ends the step by name, and leaves a state that can be gone back to.
#[test]
fn what_is_faster_than_any_state_ends_the_step() {
    for gravity in [1e99, 1e110, 1e160, 1e308] {
        let mut simulation = empty();
        simulation.add(&cube()).unwrap();
        simulation.step().unwrap();
        simulation.set_gravity(DVec3::Y * -gravity).unwrap();
        let before = simulation.snapshot();
        assert_eq!(simulation.step(), Err(StepError::TooFast { body: "cube".to_owned(), time: 0.01 }));
        assert_eq!(simulation.snapshot(), before);
        simulation.restore(&before).unwrap();
        simulation.set_gravity(DVec3::ZERO).unwrap();
        simulation.step().unwrap();
    }
    // Momenta that grow from step to step end where states do.
    let mut simulation = empty();
    let body = simulation.add(&cube()).unwrap();
    simulation.set_velocity(body, DVec3::Y * -9.99e96, DVec3::ZERO).unwrap();
    simulation.set_gravity(DVec3::Y * -1e96).unwrap();
    let steps = (0..5).take_while(|_| simulation.step().is_ok()).count();
    assert_eq!(steps, 1);
    let last = simulation.snapshot();
    simulation.restore(&last).unwrap();
}

/// Springs and soft motors of hardly any force, or in steps of hardly any length, do nothing: velocities were no numbers after them.
#[test]
fn the_weakest_springs_pull_nothing() {
    let slide = |stiffness: f64, damping: f64, is_motor: bool| {
        let mut simulation = empty();
        let load = simulation.add(&cube()).unwrap();
        let slide = Joint::new(JointKind::Prismatic, load, None, DVec3::ZERO).with_axis(DVec3::Y);
        let mut motor = Motor::new(MotorTarget::Position(0.1));
        (motor.stiffness, motor.damping) = (stiffness, damping);
        let spring = Spring::new(stiffness, damping, 0.1);
        let slide = if is_motor { slide.with_motor(motor) } else { slide.with_spring(spring) };
        simulation.add_joint(&slide).unwrap();
        (simulation, load)
    };
    for is_motor in [false, true] {
        for weak in [5e-324, 1e-310, 1e-305, 1e-304, 1e-300, 1e-30] {
            for damping in [0.0, weak] {
                let (mut simulation, load) = slide(weak, damping, is_motor);
                for _ in 0..3 {
                    simulation.step().unwrap();
                }
                let fallen = simulation.linear_velocity(load).y;
                assert!((fallen + 9.81 * 0.025).abs() < 1e-12, "{weak:e} {fallen}");
                let snapshot = simulation.snapshot();
                simulation.restore(&snapshot).unwrap();
            }
        }
        for short in [1e-300, 1e-160, 1e-155, 1e-150] {
            let (mut simulation, load) = slide(100.0, 0.0, is_motor);
            simulation.step_to(short).unwrap();
            assert!(simulation.linear_velocity(load).length() < 1e-140, "{short:e}");
            simulation.step().unwrap();
            assert!(simulation.linear_velocity(load).is_finite());
        }
    }
}

/// Joints at points further away than any number of a state are refused: a simulation had them, and refused its own snapshot.
#[test]
fn joints_beyond_all_numbers_are_refused() {
    let mut simulation = empty();
    let body = simulation.add(&cube()).unwrap();
    let before = simulation.snapshot();
    for far in [1e101, 1e200, 1e308] {
        let pin = Joint::new(JointKind::Spherical, body, None, DVec3::X * far);
        let said = simulation.add_joint(&pin).unwrap_err().to_string();
        assert!(said.contains("point [") && said.ends_with("cannot be used"), "{said}");
        assert_eq!(simulation.snapshot(), before);
    }
    simulation.add_joint(&Joint::new(JointKind::Spherical, body, None, DVec3::X * 1e100)).unwrap();
    let snapshot = simulation.snapshot();
    simulation.restore(&snapshot).unwrap();
}

/// A floor runs under a cube, which friction speeds up by g/2 at any speed that is accepted; faster ones are refused by name, on a body that is
/// added, in a running simulation and in a snapshot.
#[test]
fn surfaces_are_no_faster_than_contacts_resolve() {
    for speed in [1.0, 1e6, 1e13, 2.8e13] {
        let mut simulation = empty();
        let floor = cube().with_kind(Kind::Static).with_friction(0.5).with_position(DVec3::Y * -0.5);
        let floor = simulation.add(&floor).unwrap();
        let body = simulation.add(&cube().with_friction(0.5).with_position(DVec3::Y * 0.501)).unwrap();
        simulation.set_surface_velocity(floor, DVec3::X * speed).unwrap();
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        let gained = 0.5 * 9.81 * 0.095;
        assert!((simulation.linear_velocity(body).x - gained).abs() < 0.01 * gained, "{speed:e}");
        let before = simulation.snapshot();
        for fast in [3e13, 1e16, 1e101, 1e200, f64::INFINITY] {
            let refused = simulation.set_surface_velocity(floor, DVec3::X * fast).unwrap_err().to_string();
            assert!(refused.contains("surface velocity ["), "{refused}");
            assert!(simulation.add(&cube().with_surface_velocity(DVec3::Y * fast)).is_err());
            assert_eq!(simulation.snapshot(), before);
        }
        simulation.restore(&before).unwrap();
        let written = serde_json::to_string(&before).unwrap();
        let forged = written.replace(&format!("[{speed:?},0.0,0.0]"), "[1e16,0.0,0.0]");
        assert!(forged != written);
        assert!(simulation.restore(&serde_json::from_str(&forged).unwrap()).is_err());
    }
}

/// A force acts on the momenta that a body has: where these are given after it what both come to is refused. Such states were refused as
/// snapshots only, those of the simulation itself.
#[test]
fn forces_count_with_what_they_act_on() {
    let near = DVec3::X * 0.9 * Simulation::LARGEST;
    let mut simulation = empty();
    let body = simulation.add(&cube().with_mass(Mass::Total(1.0))).unwrap();
    simulation.set_force(body, near, DVec3::ZERO).unwrap();
    let before = simulation.snapshot();
    let refused = simulation.set_velocity(body, near, DVec3::ZERO).unwrap_err().to_string();
    assert!(refused.starts_with("body cube: velocity ["), "{refused}");
    let refused = simulation.apply_impulse(body, near, DVec3::ZERO).unwrap_err().to_string();
    assert!(refused.starts_with("body cube: impulse ["), "{refused}");
    assert_eq!(simulation.snapshot(), before);
    simulation.set_velocity(body, -near, DVec3::ZERO).unwrap();
    let snapshot = simulation.snapshot();
    simulation.restore(&snapshot).unwrap();
    // As large as its momentum may be, but not for so light a body.
    let mut simulation = empty();
    let light = cube().with_mass(Mass::Total(1e-10)).with_kind(Kind::Static);
    let light = simulation.add(&light).unwrap();
    simulation.set_force(light, near, DVec3::ZERO).unwrap();
    let before = simulation.snapshot();
    let refused = simulation.set_kind(light, Kind::Dynamic).unwrap_err().to_string();
    assert!(refused.starts_with("body cube: force ["), "{refused}");
    assert_eq!(simulation.snapshot(), before);
    // A torque about the axis of a rod does more than one across it.
    let rod = MassProperties {
        mass: 1.0,
        center: DVec3::ZERO,
        inertia: DMat3::from_diagonal((1.0, 1e-3, 1.0).into()),
    };
    let mut simulation = empty();
    let rod = simulation.add(&cube().with_mass(Mass::Given(rod))).unwrap();
    simulation.set_force(rod, DVec3::ZERO, 0.5 * near).unwrap();
    let before = simulation.snapshot();
    let turned = Pose::new(DVec3::ZERO, DQuat::from_rotation_z(core::f64::consts::FRAC_PI_2));
    assert!(matches!(simulation.set_pose(rod, turned), Err(SimulationError::TooLarge { .. })));
    assert_eq!(simulation.snapshot(), before);
}

/// Of quaternions with squares that are no numbers, or have lost digits, a body was turned by one that is not of norm one, which the simulation
/// refused as its own snapshot; others were said to have no direction.
#[test]
fn quaternions_have_any_norm_but_zero() {
    let mesh = d2m_shapes::mesh("box?x=0.5&y=0.4&z=0.3").unwrap();
    for norm in [5e-324, 1e-310, 1e-200, 1e-160, 3e-162, 1.0, 1e154, 1e200, 1.7e308] {
        let turn = DQuat::from_xyzw(norm, 0.0, 0.0, norm);
        let unit = DQuat::from_rotation_x(core::f64::consts::FRAC_PI_2);
        let is_unit = |turned: DQuat| (turned - unit).length() < 1e-15;
        let mut simulation = empty();
        let added = simulation.add(&cube().with_orientation(turn)).unwrap();
        let far = Pose { rotation: turn, ..Pose::new(DVec3::X * 9.0, DQuat::IDENTITY) };
        let put = simulation.add(&cube()).unwrap();
        simulation.set_pose(put, far).unwrap();
        let far = Pose { translation: DVec3::X * -9.0, ..far };
        let sent = simulation.add(&cube().with_kind(Kind::Driven).with_position(far.translation)).unwrap();
        simulation.set_target(sent, far).unwrap();
        let part = Part { orientation: turn, ..Part::new(&mesh) };
        let placed = Body::of_parts("placed", &[part]).unwrap().with_position(DVec3::Y * 9.0);
        let placed = simulation.add(&placed).unwrap();
        assert!((simulation.radius(placed) - 0.5f64.sqrt()).abs() < 1e-12, "{norm:e}");
        let snapshot = simulation.snapshot();
        simulation.restore(&snapshot).unwrap();
        simulation.step().unwrap();
        for body in [added, put, sent] {
            assert!(is_unit(simulation.orientation(body)), "{norm:e} {}", simulation.orientation(body));
        }
    }
    for none in [[0.0; 4], [f64::NAN, 0.0, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0, 1.0]] {
        let turn = DQuat::from_array(none);
        let refused = empty().add(&cube().with_orientation(turn)).unwrap_err().to_string();
        assert!(refused.starts_with("body cube: orientation "), "{refused}");
        let part = Part { orientation: turn, ..Part::new(&mesh) };
        assert!(Body::of_parts("placed", &[part]).is_err());
    }
}
