//! Scenes that need too much: each step ends, says what it skipped, and nothing panics.

mod ground;

use d2m_bvh::{MeshTree, Posed, Solid, StartState, TriMesh, distance};
use d2m_dynamics::{Body, Kind, Mass, MassProperties, Simulation, SimulationOptions, StepError};
use glam::{DMat3, DQuat, DVec3};
use ground::{run, slab, tree};
use std::sync::Arc;

#[test]
fn restitution_one_at_rest_on_the_floor() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_restitution(1.0)).unwrap();
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    for k in 0..3 {
        let body = Body::new(format!("{k}"), Arc::clone(&cube)).with_restitution(1.0).with_friction(2.0);
        simulation.add(&body.with_position(DVec3::Y * (0.501 + 1.001 * f64::from(k)))).unwrap();
    }
    assert_eq!(run(&mut simulation, 1.0), 0.0);
    assert!(simulation.linear_velocity(simulation.ids().last().unwrap()).length() < 0.1);
}

/// A thousand turns a step.
#[test]
fn a_spin_of_a_hundred_thousand_turns_a_second() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_max_events(16)).unwrap();
    simulation.add(&slab(1.0).with_friction(0.5)).unwrap();
    let brick = Body::new("brick", tree("box?x=0.5&y=0.2&z=0.1")).with_position(DVec3::Y * 0.7);
    let id = simulation.add(&brick.with_angular_velocity(DVec3::new(1e3, 6e5, 2e5))).unwrap();
    run(&mut simulation, 0.05);
    assert!(simulation.position(id).is_finite() && simulation.position(id).y > 0.0);
}

#[test]
fn tiny_and_huge_units() {
    for scale in [1e-4, 1e4] {
        let options =
            SimulationOptions::default().with_gap(1e-3 * scale).with_gravity(DVec3::Y * (-10.0 * scale));
        let mut simulation = Simulation::new(options).unwrap();
        simulation.add(&slab(scale).with_friction(0.5)).unwrap();
        let half = 0.5 * scale;
        let cube = tree(&format!("box?x={half}&y={half}&z={half}"));
        let body = Body::new("cube", cube).with_position(DVec3::Y * scale).with_friction(0.5);
        let id = simulation.add(&body.with_orientation(DQuat::from_rotation_z(0.3))).unwrap();
        assert_eq!(run(&mut simulation, 2.0), 0.0, "{scale}");
        let height = simulation.position(id).y / scale;
        assert!((height - 0.5).abs() < 0.01, "{scale}: {height}");
    }
}

/// Masses a billion times apart press on each other.
#[test]
fn a_feather_under_a_mountain() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_friction(0.5)).unwrap();
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    for (k, mass) in [1e-3, 1e6].into_iter().enumerate() {
        let body = Body::new(format!("{mass}"), Arc::clone(&cube)).with_mass(Mass::Total(mass));
        let height = 0.501 + 1.01 * k as f64;
        simulation.add(&body.with_position(DVec3::Y * height).with_friction(0.5)).unwrap();
    }
    run(&mut simulation, 0.5);
    for id in simulation.ids() {
        assert!(simulation.position(id).is_finite());
    }
}

/// More bounces in a step than it may have, 256 for each event: what is left of it is given up, and said to be.
#[test]
fn events_run_out_and_the_report_says_so() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(1.0).with_max_events(8);
    let mut simulation = Simulation::new(options).unwrap();
    let wall = tree("box?x=0.5&y=2&z=2");
    for (name, x) in [("left", -1.0), ("right", 1.0)] {
        let body = Body::new(name, Arc::clone(&wall)).with_kind(Kind::Static);
        simulation.add(&body.with_position(DVec3::X * x).with_restitution(1.0)).unwrap();
    }
    let cube = Body::new("cube", tree("box?x=0.1&y=0.1&z=0.1")).with_restitution(1.0);
    let id = simulation.add(&cube.with_linear_velocity(DVec3::X * 1e4)).unwrap();
    let skipped = run(&mut simulation, 1.0);
    assert!(skipped > 0.5 && skipped < 1.0, "{skipped}");
    assert!(simulation.position(id).x.abs() < 0.4);
}

/// Queries that may test little certify short flights: these end at events without an impulse, after which the bodies begin
/// others and are queried again, although their velocities are the same.
#[test]
fn queries_that_may_test_little_let_nothing_through() {
    for node_tests in [10, 30, 60] {
        let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_node_tests(node_tests);
        let mut simulation = Simulation::new(options).unwrap();
        let knot = tree("torus-knot?triangles=5000&scale=0.5");
        let still = Body::new("still", Arc::clone(&knot)).with_kind(Kind::Static).with_restitution(0.5);
        let thrown = Body::new("thrown", Arc::clone(&knot))
            .with_position(DVec3::X * -2.5)
            .with_linear_velocity(DVec3::new(30.0, 0.3, 0.1))
            .with_angular_velocity(DVec3::Y * 20.0);
        let still = simulation.add(&still).unwrap();
        let thrown = simulation.add(&thrown).unwrap();
        while simulation.time() < 0.3 {
            simulation.step().unwrap();
            let posed = [still, thrown].map(|id| Posed::new(&knot, simulation.pose(id)));
            let found = distance(posed[0], posed[1], Solid::Filled).unwrap();
            assert_eq!(found.state, StartState::Apart, "{node_tests}: at {}", simulation.time());
        }
    }
}

/// A stone slides over a floor towards a wall of the same mesh. Flights of few tests are certified for parts of a step; where they end nothing
/// changes the velocity, but the stone must not go on with what was certified no further: the wall comes in the same step.
#[test]
fn a_wall_behind_a_contact_is_met_whatever_queries_may_test() {
    let parts = [("box?x=5&y=0.5&z=5", DVec3::NEG_Y * 0.5), ("box?x=0.1&y=1&z=5", DVec3::new(1.0, 1.1, 0.0))];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (shape, center) in parts {
        let (mesh, first) = (d2m_shapes::mesh(shape).unwrap(), vertices.len() as u32);
        vertices.extend(mesh.vertices().iter().map(|&p| p + center));
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|i| i + first)));
    }
    let ground = Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap()));
    let stone = tree("pebble?triangles=1000&scale=0.2");
    let lowest = stone.mesh().vertices().iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    for node_tests in [16, 32, 48, 64, 96] {
        for speed in [10.0, 30.0] {
            let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_node_tests(node_tests);
            let mut simulation = Simulation::new(options).unwrap();
            let still = Body::new("still", Arc::clone(&ground)).with_kind(Kind::Static);
            let thrown = Body::new("thrown", Arc::clone(&stone))
                .with_position(DVec3::Y * (1.2e-3 - lowest))
                .with_linear_velocity(DVec3::X * speed);
            let [still, thrown] = [still, thrown].map(|body| simulation.add(&body).unwrap());
            while simulation.time() < 0.1 {
                simulation.step().unwrap();
                let posed = [(&ground, still), (&stone, thrown)];
                let [a, b] = posed.map(|(tree, id)| Posed::new(tree, simulation.pose(id)));
                let found = distance(a, b, Solid::Filled).unwrap();
                assert_eq!(found.state, StartState::Apart, "{node_tests}: at {}", simulation.time());
            }
        }
    }
}

/// Where vertices slide over edges, the direction between them is none of a face: its contact must hold, or the pair is
/// hit again and again until it can move no more.
#[test]
fn cubes_that_fall_on_each_others_edges_keep_moving() {
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let options = SimulationOptions::default().with_gravity(DVec3::Y * -9.8);
    let mut simulation = Simulation::new(options).unwrap();
    simulation.add(&slab(1.0)).unwrap();
    simulation.add(&Body::new("first", Arc::clone(&cube)).with_position(DVec3::Y * 2.0)).unwrap();
    for k in 0..4 {
        let x = f64::from(k);
        let body = Body::new(format!("{k}"), Arc::clone(&cube)).with_position(DVec3::Y * (4.0 + 2.0 * x));
        let body = body.with_linear_velocity(DVec3::X * 0.1 * x);
        simulation.add(&body.with_angular_velocity(DVec3::new(0.5 * x, 1.0, 0.3))).unwrap();
    }
    assert_eq!(run(&mut simulation, 3.0), 0.0);
}

#[test]
fn numbers_that_cannot_be_used_are_refused() {
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let body = || Body::new("cube", Arc::clone(&cube));
    let given = |mass: f64| MassProperties::try_new(mass, DVec3::ZERO, DMat3::IDENTITY);
    assert!(given(0.0).is_err() && given(f64::NAN).is_err() && given(-1.0).is_err());
    for bad in [
        body().with_mass(Mass::Total(0.0)),
        body().with_mass(Mass::Density(f64::INFINITY)),
        body().with_position(DVec3::NAN),
        body().with_linear_velocity(DVec3::X * f64::INFINITY),
        body().with_angular_velocity(DVec3::NAN),
        body().with_orientation(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        body().with_restitution(1.5),
        body().with_friction(-0.1),
        body().with_friction(f64::NAN),
    ] {
        let message =
            Simulation::new(SimulationOptions::default()).unwrap().add(&bad).unwrap_err().to_string();
        assert!(message.contains("cube"), "{message}");
    }
    for options in [
        SimulationOptions::default().with_step(0.0),
        SimulationOptions::default().with_gap(f64::NAN),
        SimulationOptions::default().with_gravity(DVec3::NAN),
    ] {
        assert!(Simulation::new(options).is_err());
    }
}

/// What falls until its velocity is no number ends the run with an error: alone, and where others might be met.
#[test]
fn flights_beyond_the_numbers_end_the_run() {
    for others in 0..2 {
        let options = SimulationOptions::default().with_gravity(DVec3::NEG_X * 1e308).with_step(10.0);
        let mut simulation = Simulation::new(options).unwrap();
        for k in 0..=others {
            let place = DVec3::Z * (4.0 * f64::from(k));
            simulation.add(&Body::new("stone", tree("box")).with_position(place)).unwrap();
        }
        let error = (0..100).find_map(|_| simulation.step().err()).unwrap();
        assert_eq!(error, StepError::TooFast { body: "stone".into(), time: simulation.time() });
    }
}

/// Bodies that are held have no flight that ends: those they touch are solved without, and each step ends.
#[test]
fn bodies_that_are_held_end_no_flights_of_others() {
    let small = tree("box?x=0.1&y=0.08&z=0.06");
    let thick = tree("box?x=5&y=0.5&z=5");
    let one = |name: &str, x: f64, y: f64, v: DVec3, w: DVec3| {
        let body = Body::new(name, Arc::clone(&small)).with_mass(Mass::Total(1.0)).with_restitution(1.0);
        body.with_position(DVec3::new(x, y, 0.0)).with_linear_velocity(v).with_angular_velocity(w)
    };
    let still = |name: &str, y: f64| {
        Body::new(name, Arc::clone(&thick)).with_kind(Kind::Static).with_position(DVec3::Y * y)
    };
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(0.01).with_gap(0.03);
    let slow = [
        still("floor", -0.5),
        one("a", 0.0, 0.15, DVec3::NEG_Y * 9.0, DVec3::new(30.0, 20.0, 10.0)),
        one("c", 0.23, 0.2, DVec3::NEG_X * 2.0, DVec3::new(40.0, -20.0, 30.0)),
    ];
    let fast = [
        still("floor", -0.5),
        still("ceiling", 0.9),
        one("a", 0.0, 0.2, DVec3::NEG_Y * 60_000.0, DVec3::new(20.0, 50.0, 40.0)),
        one("c", 0.25, 0.22, DVec3::ZERO, DVec3::new(-40.0, 40.0, -50.0)),
    ];
    let scenes: [(&[Body], SimulationOptions); 2] = [(&slow, options.with_max_events(0)), (&fast, options)];
    for (bodies, options) in scenes {
        let mut simulation = Simulation::new(options).unwrap();
        for body in bodies {
            simulation.add(body).unwrap();
        }
        let skipped = run(&mut simulation, 0.05);
        assert!(skipped > 0.0 || options.max_events > 0);
    }
}
