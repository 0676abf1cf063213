//! Joints that close chains: where these have no way to move they stand, where they have one they go it.

mod ground;

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, BodyId, Joint, JointKind, Mass, Motor, MotorTarget, Simulation, SimulationOptions};
use glam::{DQuat, DVec3};
use ground::{floor, tree};
use std::sync::Arc;

/// Bars of one kilogram from each of these points to the next one, on pins along z; the first and the last end on pins of the world, unless that is one
/// point, which is a joint of both then.
fn chain(simulation: &mut Simulation, points: &[DVec3], moving: impl Fn(usize, Body) -> Body) -> Vec<BodyId> {
    let mut add = |k: usize, pair: &[DVec3]| {
        let way = pair[1] - pair[0];
        let query = format!("box?x={}&y=0.02&z=0.2", 0.5 * way.length());
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh(&query).unwrap()));
        let body = Body::new(format!("{k}"), tree).with_mass(Mass::Total(1.0));
        let body = body.with_position((pair[0] + pair[1]) * 0.5);
        let body = body.with_orientation(DQuat::from_rotation_arc(DVec3::X, way.normalize()));
        simulation.add(&moving(k, body)).unwrap()
    };
    let ids: Vec<BodyId> = points.windows(2).enumerate().map(|(k, pair)| add(k, pair)).collect();
    let mut pin = |a: BodyId, b: Option<BodyId>, point: DVec3| {
        simulation.add_joint(&Joint::new(JointKind::Revolute, a, b, point).with_axis(DVec3::Z)).unwrap();
    };
    let (first, last) = (points[0], points[points.len() - 1]);
    let is_ring = first == last;
    pin(ids[0], is_ring.then(|| ids[ids.len() - 1]), first);
    for (pair, &point) in ids.windows(2).zip(&points[1..]) {
        pin(pair[0], Some(pair[1]), point);
    }
    if !is_ring {
        pin(ids[ids.len() - 1], None, last);
    }
    for (k, &a) in ids.iter().enumerate() {
        ids[k + 1..].iter().for_each(|&b| simulation.ignore(a, b));
    }
    ids
}

/// Ten planks that are pinned at both ends without slack, under a box of ten times the mass of one, hold it: in flights as long as steps, and less
/// than a hundredth of their length lower. The box lands, and is not thrown up.
#[test]
fn a_bridge_without_slack_holds() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let points: Vec<DVec3> = (0..=10).map(|k| DVec3::X * (0.2 * f64::from(k))).collect();
    let ids = chain(&mut simulation, &points, |_, body| body);
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.15&y=0.15&z=0.15").unwrap()));
    let load = Body::new("load", cube).with_mass(Mass::Total(10.0)).with_position(DVec3::new(1.0, 0.2, 0.0));
    let load = simulation.add(&load).unwrap();
    let (mut flights, mut top) = (0, 0.0f64);
    while simulation.time() < 0.6 {
        let report = simulation.step().unwrap();
        flights += report.segments.len();
        assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
        assert!(flights <= 200, "{flights} until {}", simulation.time());
        let rate = simulation.linear_velocity(load).y;
        top = top.max(rate);
    }
    assert!(top < 1e-3, "{top}");
    for &id in &ids {
        let (height, speed) = (simulation.position(id).y, simulation.linear_velocity(id).length());
        assert!(height.abs() < 0.02 && speed < 1e-6, "{height} {speed}");
    }
    let height = simulation.position(load).y - 0.15;
    assert!((-0.02..0.03).contains(&height), "{height}");
}

/// A chain that hangs straight at rest stays at rest: one of equal bars in long steps, and one under a load of ten thousand times the mass of a bar. In both
/// bars oscillate at a higher rate than steps resolve, and an error of rounding grew until the whole chain swung.
#[test]
fn chains_that_hang_straight_stay_so() {
    for (bars, step, load) in [(60, 1.0 / 30.0, None), (30, 0.01, Some(1e4))] {
        let mut simulation = Simulation::new(SimulationOptions::default().with_step(step)).unwrap();
        let bar = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.02&y=0.08&z=0.02").unwrap()));
        let mut last = None;
        let mut ids = Vec::new();
        let masses = (0..bars).map(|_| 0.4).chain(load.map(|ratio| 0.4 * ratio));
        for (k, mass) in masses.enumerate() {
            let top = DVec3::NEG_Y * (0.2 * f64::from(k as u32));
            let body = Body::new("", Arc::clone(&bar)).with_mass(Mass::Total(mass));
            // As much as rounding might.
            let moved = if k == 3 { DVec3::X * 1e-12 } else { DVec3::ZERO };
            let body = body.with_position(top - DVec3::Y * 0.1).with_linear_velocity(moved);
            let id = simulation.add(&body).unwrap();
            let pin = Joint::new(JointKind::Revolute, id, last, top).with_axis(DVec3::Z);
            simulation.add_joint(&pin).unwrap();
            last = Some(id);
            ids.push(id);
        }
        let mut flights = 0;
        while simulation.time() < 1.0 {
            flights += simulation.step().unwrap().segments.len();
        }
        assert!(f64::from(flights as u32) <= 1.1 / step, "{flights}");
        for id in ids {
            let (v, w) = (simulation.linear_velocity(id), simulation.angular_velocity(id));
            assert!(v.length() < 1e-5 && w.length() < 1e-4, "{load:?}: {v} {w}");
        }
    }
}

/// A parallelogram whose bars all lie on one line twice a turn goes through it, although corrections of joints diverge there: nothing pulls its bars
/// to and fro.
#[test]
fn a_parallelogram_goes_through_its_dead_points() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
    let mut simulation = Simulation::new(options).unwrap();
    let up = DVec3::Y * 0.3;
    let points = [DVec3::ZERO, up, up + DVec3::X, DVec3::X];
    let spin = DVec3::Z * 20.0;
    let ids = chain(&mut simulation, &points, |k, body| match k {
        1 => body.with_linear_velocity(spin.cross(up)),
        _ => body.with_linear_velocity(spin.cross(up * 0.5)).with_angular_velocity(spin),
    });
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
    }
    for id in [ids[0], ids[2]] {
        let rate = simulation.angular_velocity(id).z;
        assert!((rate - 20.0).abs() < 0.1, "{rate}");
    }
}

/// Of motion and height, where the middle of the last flight was.
fn energy(simulation: &Simulation) -> f64 {
    let of = |id: BodyId| {
        let properties = simulation.mass_properties(id).unwrap();
        let velocity = simulation.linear_velocity(id);
        let spin = simulation.orientation(id).conjugate() * simulation.angular_velocity(id);
        let height = simulation.position(id).y - velocity.y * (0.5 * simulation.options().step);
        let motion = properties.mass * velocity.length_squared() + spin.dot(properties.inertia * spin);
        0.5 * motion + properties.mass * 9.81 * height
    };
    simulation.ids().map(of).sum()
}

/// A ring of 24 bars that hangs by one of its pins and falls whips round at fifty radians a second. Flights as long as steps gained a fifth of
/// what it fell for.
#[test]
fn a_ring_that_whips_round_gains_no_energy() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let point = |k: i32| {
        let (sin, cos) = (f64::from(k % 24) * core::f64::consts::TAU / 24.0).sin_cos();
        DVec3::new(0.5 * cos, 0.5 * sin, 0.0)
    };
    let points: Vec<DVec3> = (0..=24).map(point).collect();
    let ids = chain(&mut simulation, &points, |_, body| body);
    let top = Joint::new(JointKind::Revolute, ids[6], None, points[6]).with_axis(DVec3::Z);
    simulation.add_joint(&top).unwrap();
    let first = energy(&simulation);
    let (mut most, mut motion) = (0.0f64, 0.0f64);
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
        most = most.max(energy(&simulation) - first);
        let kinetic = |id: BodyId| 0.5 * simulation.linear_velocity(id).length_squared();
        motion = motion.max(ids.iter().map(|&id| kinetic(id)).sum());
    }
    assert!(motion > 30.0, "{motion}");
    assert!(most < 0.03 * motion, "{most} of {motion}");
}

/// A crank, a rod and a rocker beside each other, so that their hinges bear moments across the axis; the rocker is a thousand times as heavy. A motor turns
/// the crank from rest to its speed within a step, and as exactly as in one plane.
#[test]
fn linkages_beside_each_other_follow_their_motor() {
    for beside in [0.0, 0.05] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let (crank, ground) = (DVec3::new(0.7_f64.cos(), 0.7_f64.sin(), 0.0) * 0.2, DVec3::X * 0.9);
        // Where the rod of 0.8 and the rocker of 0.6 meet.
        let way = ground - crank;
        let along = (0.8 * 0.8 - 0.6 * 0.6 + way.length_squared()) / (2.0 * way.length());
        let unit = way.normalize();
        let meet = crank + unit * along + DVec3::new(-unit.y, unit.x, 0.0) * (0.64 - along * along).sqrt();
        let mut part = |from: DVec3, to: DVec3, z: f64, density: f64| {
            let shape = format!("box?x={}&y=0.02&z=0.02", 0.45 * (to - from).length());
            let tree = Arc::new(MeshTree::new(d2m_shapes::mesh(&shape).unwrap()));
            let body = Body::new("", tree).with_mass(Mass::Density(density));
            let body = body.with_position((from + to) * 0.5 + DVec3::Z * z);
            let turn = DQuat::from_rotation_arc(DVec3::X, (to - from).normalize());
            simulation.add(&body.with_orientation(turn)).unwrap()
        };
        let first = part(DVec3::ZERO, crank, 0.0, 1e3);
        let rod = part(crank, meet, beside, 1e3);
        let rocker = part(meet, ground, 2.0 * beside, 1e6);
        let hinge = |a: BodyId, b: Option<BodyId>, at: DVec3| {
            Joint::new(JointKind::Revolute, a, b, at).with_axis(DVec3::Z)
        };
        let mut motor = Motor::new(MotorTarget::Velocity(-50.0));
        motor.most = 1e9;
        let driven = simulation.add_joint(&hinge(first, None, DVec3::ZERO).with_motor(motor)).unwrap();
        for joint in
            [hinge(first, Some(rod), crank), hinge(rod, Some(rocker), meet), hinge(rocker, None, ground)]
        {
            simulation.add_joint(&joint).unwrap();
        }
        simulation.ignore(first, rocker);
        while simulation.time() < 0.1 {
            simulation.step().unwrap();
        }
        let off = simulation.joint_value(driven) + 50.0 * simulation.time();
        assert!(off.abs() < 1e-5, "{beside}: {off}");
    }
}

/// An arm of six links, each with a motor that goes to an angle of one radian, and a load 10⁵ times as heavy as a link, needs no more flights than with a light one.
#[test]
fn arms_carry_heavy_loads_in_as_many_flights() {
    let flights = |load: f64| {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.14&y=0.02&z=0.02").unwrap()));
        let mut motor = Motor::new(MotorTarget::Position(1.0));
        motor.most = 1e12;
        let (mut ids, mut joints) = (Vec::<BodyId>::new(), Vec::new());
        for k in 0..6 {
            let at = DVec3::new(0.3, 0.0, 0.05) * f64::from(k);
            let mass = Mass::Total(if k == 5 { load } else { 1.0 });
            let link = Body::new(format!("{k}"), Arc::clone(&tree)).with_mass(mass);
            let link = simulation.add(&link.with_position(at + DVec3::X * 0.15)).unwrap();
            for &other in &ids {
                simulation.ignore(link, other);
            }
            let (a, b) = ids.last().map_or((link, None), |&last| (last, Some(link)));
            let axis = if k % 2 == 0 { DVec3::Z } else { DVec3::Y };
            joints.push(Joint::new(JointKind::Revolute, a, b, at).with_axis(axis).with_motor(motor));
            ids.push(link);
        }
        let joints: Vec<usize> = joints.iter().map(|joint| simulation.add_joint(joint).unwrap()).collect();
        let mut flights = 0;
        while simulation.time() < 0.5 {
            flights += simulation.step().unwrap().segments.len();
        }
        for joint in joints {
            let value = simulation.joint_value(joint);
            assert!((value.abs() - 1.0).abs() < 1e-3, "{load:e}: {value}");
        }
        flights
    };
    let [light, heavy] = [1e2, 1e5].map(flights);
    assert!(heavy <= light + light / 4, "{heavy} {light}");
}

/// An arm whose motors, without a bound on their force, press on boxes and the floor with a link that weighs a billionth of the others: with all that
/// would stop those no velocities are found, and with less of it they stop there as others do.
#[test]
fn motors_of_light_links_stop_at_what_is_in_their_way() {
    let (bar, stone) = (tree("box?x=0.4&y=0.1&z=0.1"), tree("box?x=0.3&y=0.2&z=0.3"));
    let mut simulation = Simulation::new(SimulationOptions::default().with_sleeping(false)).unwrap();
    let floor = floor().with_friction(0.3).with_restitution(1.0);
    simulation.add(&floor).unwrap();
    let body = |shape: &Arc<MeshTree>, mass: f64, x: f64, y: f64| {
        let body = Body::new("body", Arc::clone(shape)).with_friction(0.3).with_restitution(1.0);
        body.with_mass(Mass::Total(mass)).with_position(DVec3::new(x, y, 0.0))
    };
    let mut last = None;
    for (mass, spin, x) in [(2.3, -0.2, 0.0), (9.3e4, -1.0, 0.9), (5.5e-6, -0.2, 1.8)] {
        let link = simulation.add(&body(&bar, mass, x, 1.0)).unwrap();
        let (a, b) = last.map_or((link, None), |last| (last, Some(link)));
        let pin = Joint::new(JointKind::Revolute, a, b, DVec3::new(x - 0.45, 1.0, 0.0));
        simulation.add_joint(&pin.with_motor(Motor::new(MotorTarget::Velocity(spin)))).unwrap();
        last = Some(link);
    }
    for (mass, x) in [(0.17, 0.5), (5e4, 1.5)] {
        simulation.add(&body(&stone, mass, x, 0.202)).unwrap();
    }
    let mut most = 0;
    while simulation.time() < 1.0 {
        let report = simulation.step().unwrap();
        assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
        most = most.max(report.segments.len());
        assert!(most < 16, "{}: {most}", simulation.time());
    }
}
