//! Bodies that follow their motions: within a hundredth of the gap, however fast, or the step says that it cannot be.

mod ground;

use d2m_bvh::{MeshTree, TriMesh};
use d2m_dynamics::{Body, BodyId, Kind, Segment, Simulation, SimulationError, SimulationOptions, StepError};
use d2m_motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Keyframes, OutsideDomain, Pose, RigidMotion, Span,
};
use glam::{DQuat, DVec3};
use ground::tree;
use std::collections::HashMap;
use std::sync::Arc;

const GAP: f64 = 1e-3;

/// A blade from −1 to 1 along x, alone.
fn simulation(motion: Arc<dyn RigidMotion + Send + Sync>) -> Simulation {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(0.01).with_gap(GAP);
    let mut simulation = Simulation::new(options).unwrap();
    let blade = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=0.05&z=0.05").unwrap()));
    simulation.add(&Body::new("blade", blade).with_kind(Kind::Kinematic(motion))).unwrap();
    simulation
}

/// All segments of some steps.
fn run(simulation: &mut Simulation, steps: u32) -> Vec<Segment> {
    let mut segments = Vec::new();
    for _ in 0..steps {
        segments.extend(simulation.step().unwrap().segments);
    }
    segments.extend(simulation.finish());
    segments
}

/// The tips are where the motion has them, at many times of each segment; how far the body has turned in all.
fn turned(segments: &[Segment], motion: &dyn RigidMotion) -> f64 {
    let mut flight = ConstantTwist::REST;
    let mut turned = 0.0;
    for segment in segments {
        if let [(_, changed)] = segment.changed[..] {
            flight = changed;
        }
        turned += flight.angular_velocity().length() * (segment.end - segment.start);
        for part in 0..=16 {
            let time = segment.start + f64::from(part) / 16.0 * (segment.end - segment.start);
            let [flown, wanted] = [&flight as &dyn RigidMotion, motion].map(|m| m.pose_and_twist(time).0);
            for tip in [-DVec3::X, DVec3::X] {
                let off = flown.transform_point(tip).distance(wanted.transform_point(tip));
                assert!(off <= 0.01 * GAP + 1e-12, "{off:e} at {time}");
            }
        }
    }
    turned
}

/// How far bodies are at most from where their flights before had them when the next ones begin.
fn widest_join(segments: &[Segment]) -> f64 {
    let mut flights: HashMap<BodyId, ConstantTwist> = HashMap::new();
    let mut widest = 0.0f64;
    for segment in segments {
        for &(id, flight) in &segment.changed {
            if let Some(last) = flights.insert(id, flight) {
                let [last, next] = [last, flight].map(|flight| flight.pose_and_twist(segment.start).0);
                let turned = last.rotation.dot(next.rotation).abs();
                assert!(turned > 1.0 - 1e-14, "{turned}");
                widest = widest.max(last.translation.distance(next.translation));
            }
        }
    }
    widest
}

/// An error ends the flight of a press, which is a chord of its motion: it goes on from there.
#[test]
fn what_an_error_ends_goes_on_from_where_it_is() {
    let options = SimulationOptions::default().with_gap(1e-2);
    let mut simulation = Simulation::new(options).unwrap();
    let floor = Body::new("floor", ground::cube()).with_kind(Kind::Static);
    simulation.add(&floor.with_position(DVec3::Y * -0.5)).unwrap();
    let stone = Body::new("stone", tree("box?x=0.1&y=0.1&z=0.1")).with_position(DVec3::Y * 0.11);
    let stone = simulation.add(&stone).unwrap();
    let value = JointValue::try_polynomial(vec![0.9, 0.0, -40.0]).unwrap();
    let kind = JointKind::Prismatic { axis: DVec3::Y, value };
    let motion = Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap();
    let press = Body::new("press", ground::cube()).with_kind(Kind::Kinematic(Arc::new(motion)));
    simulation.add(&press).unwrap();
    let mut segments = Vec::new();
    let error = (0..20).find_map(|_| match simulation.step() {
        Ok(report) => {
            segments.extend(report.segments);
            None
        }
        Err(error) => Some(error),
    });
    let error = error.expect("the stone is crushed");
    segments.extend(simulation.finish());
    assert!(matches!(error, StepError::Crushed { .. } | StepError::Cornered { .. }), "{error}");
    assert!(simulation.remove(stone));
    segments.extend(run(&mut simulation, 5));
    assert!(widest_join(&segments) < 1e-14, "{:e}", widest_join(&segments));
}

/// Also where a quarter of a step is a number of whole turns: samples of the motion alone would show a blade that stands still.
#[test]
fn a_blade_turns_as_far_as_its_motion_at_any_rate() {
    for rate in [1.0, 100.0, 2100.0, 2250.0, 800.0 * core::f64::consts::PI, 2900.0, 4900.0, 40_000.0] {
        let motion = ConstantTwist::REST.with_angular_velocity(DVec3::Z * rate);
        let all = turned(&run(&mut simulation(Arc::new(motion)), 2), &motion);
        assert!((all - 0.02 * rate).abs() < 1e-9 * (1.0 + rate), "{rate}: {all}");
    }
}

/// About a point beside the blade, so that its center goes in circles.
#[test]
fn a_blade_beside_its_axis_goes_round() {
    for rate in [30.0, 300.0, 2513.0] {
        let motion = ConstantTwist::REST
            .with_at(DVec3::new(0.3, 0.4, 0.0))
            .with_position(DVec3::new(0.3, 0.4, 0.0))
            .with_angular_velocity(DVec3::Z * rate);
        let all = turned(&run(&mut simulation(Arc::new(motion)), 1), &motion);
        assert!((all - 0.01 * rate).abs() < 1e-6 * rate, "{rate}: {all}");
    }
}

/// A slide that is back at zero at every quarter of the first step, with a way of half a meter in between.
#[test]
fn a_slide_between_the_quarters_of_a_step_is_seen() {
    let zeros = [0.0, 0.0025, 0.005, 0.0075, 0.01];
    let mut coefficients = vec![1.4e12];
    for zero in zeros {
        // Times (t − zero), lowest power first.
        let shifted: Vec<f64> = [0.0].into_iter().chain(coefficients.iter().copied()).collect();
        let scaled = coefficients.iter().map(|c| -zero * c).chain([0.0]);
        coefficients = shifted.iter().zip(scaled).map(|(a, b)| a + b).collect();
    }
    let value = JointValue::try_pieces(vec![0.0, 0.01, 1.0], vec![coefficients, vec![0.0]]).unwrap();
    let slide = JointKind::Prismatic { axis: DVec3::Y, value };
    let motion = Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, slide).unwrap()]).unwrap();
    let segments = run(&mut simulation(Arc::new(motion.clone())), 1);
    turned(&segments, &motion);
    let highest = segments.iter().flat_map(|s| &s.changed).map(|(_, flight)| flight.position().y.abs());
    assert!(highest.fold(0.0, f64::max) > 0.4);
}

#[test]
fn what_cannot_be_followed_is_named() {
    let motion = ConstantTwist::REST.with_at(DVec3::Y).with_angular_velocity(DVec3::Z * 1e6);
    let error = simulation(Arc::new(motion)).step().unwrap_err();
    assert_eq!(error, StepError::TooFast { body: "blade".into(), time: 0.0 });
    assert!(error.to_string().contains("body blade moves too fast"), "{error}");
}

/// A blade that rests over the times from 0 to 0.025, in steps of 0.01: the third step would go past its motion.
#[test]
fn no_step_goes_past_a_motion() {
    let poses = [(0.0, Pose::IDENTITY), (0.025, Pose::IDENTITY)];
    let mut simulation = simulation(Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap()));
    for _ in 0..2 {
        simulation.step().unwrap();
    }
    let before = simulation.snapshot();
    let error = simulation.step().unwrap_err();
    let (from, to) = (simulation.time(), 0.03);
    let outside = OutsideDomain { start: 0.0, end: 0.025, from, to };
    let refused = SimulationError::OutsideMotion { body: "blade".into(), outside };
    assert_eq!(error, StepError::Setup(refused));
    assert!(
        error.to_string().contains("body blade: the motion covers the times from 0.0 to 0.025"),
        "{error}"
    );
    // Nothing has moved, and what the motion covers can still be done.
    assert_eq!(simulation.snapshot(), before);
    simulation.step_to(0.025).unwrap();
}

#[test]
fn bodies_whose_motion_is_over_are_refused() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.step_to(2.0).unwrap();
    let poses = [(0.0, Pose::IDENTITY), (1.0, Pose::IDENTITY)];
    let motion = Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap());
    let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box").unwrap()));
    let late = Body::new("late", tree).with_kind(Kind::Kinematic(motion));
    let outside = OutsideDomain { start: 0.0, end: 1.0, from: 2.0, to: 2.0 };
    assert_eq!(simulation.add(&late), Err(SimulationError::OutsideMotion { body: "late".into(), outside }));
}

/// A box that turns with a table and that friction holds, with half of what it takes to slide: at the same place of the table all the time. Flights
/// along tangents would lead it outward by 12 millimeters in each of two seconds.
#[test]
fn what_turns_with_a_table_stays_on_it() {
    let rate = 0.5 * (9.81_f64).sqrt();
    let tree = |shape: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()));
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let spin = DVec3::Y * rate;
    let motion = ConstantTwist::REST.with_position(DVec3::NEG_Y * 0.5).with_angular_velocity(spin);
    let table = Body::new("table", tree("box?x=5&y=0.5&z=5")).with_kind(Kind::Kinematic(Arc::new(motion)));
    simulation.add(&table.with_friction(1.0)).unwrap();
    let place = DVec3::new(2.0, 0.1 + GAP, 0.0);
    let body = Body::new("box", tree("box?x=0.2&y=0.1&z=0.2")).with_friction(1.0).with_position(place);
    let body = body.with_linear_velocity(spin.cross(place)).with_angular_velocity(spin);
    let id = simulation.add(&body).unwrap();
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
        let expected = DQuat::from_rotation_y(rate * simulation.time()) * place;
        let off = simulation.position(id).distance(expected);
        assert!(off < 0.1 * GAP, "{off} at {}", simulation.time());
    }
}

/// A plate that starts a part of the gap above a ramp that moves on: of which solutions leave nothing, or some.
#[test]
fn what_starts_close_to_a_ramp_that_moves_stays_on_it() {
    let tree = |shape: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()));
    let turn = DQuat::from_rotation_z(0.3);
    for (velocity, apart) in [DVec3::X, DVec3::Y * 0.5].into_iter().flat_map(|v| [(v, 1e-9), (v, 1e-8)]) {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let motion = ConstantTwist::REST.with_orientation(turn).with_linear_velocity(velocity);
        let ramp = Body::new("ramp", tree("box?x=5&y=0.5&z=5")).with_kind(Kind::Kinematic(Arc::new(motion)));
        simulation.add(&ramp.with_friction(0.35)).unwrap();
        let place = turn * DVec3::Y * (0.52 + apart);
        let plate = Body::new("plate", tree("box?x=0.3&y=0.02&z=0.3")).with_orientation(turn);
        let plate = plate.with_position(place).with_linear_velocity(velocity).with_friction(0.35);
        let id = simulation.add(&plate).unwrap();
        while simulation.time() < 0.3 {
            let report = simulation.step().unwrap();
            assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
        }
        let off = simulation.position(id).distance(place + velocity * simulation.time());
        assert!(off < 0.1 * GAP, "{off} of {apart}");
    }
}

/// A tube along z about this circle, of so many sides.
fn tube(sides: u32, inner: f64, outer: f64, half: f64) -> Arc<MeshTree> {
    let corner = |k: u32, radius: f64, z: f64| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
        DVec3::new(radius * cos, radius * sin, z)
    };
    let section = [(inner, -half), (outer, -half), (outer, half), (inner, half)];
    let vertices = (0..sides).flat_map(|k| section.map(|(radius, z)| corner(k, radius, z))).collect();
    let side = |k: u32, j: u32| {
        let [a, b] = [4 * k + j, 4 * k + (j + 1) % 4];
        let [c, d] = [4 * ((k + 1) % sides) + j, 4 * ((k + 1) % sides) + (j + 1) % 4];
        [[a, b, d], [a, d, c]]
    };
    let triangles = (0..sides).flat_map(|k| (0..4).flat_map(move |j| side(k, j))).collect();
    Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap()))
}

/// A drum carries boxes along, at gaps of a thousandth of what its turning leads into them in a step: they are as far from it as they have to be, and
/// do not meet it again and again.
#[test]
fn what_a_drum_carries_along_has_room_for_its_turning() {
    let options = SimulationOptions::default().with_gap(1e-5);
    let mut simulation = Simulation::new(options).unwrap();
    let motion = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 4.0);
    let drum = Body::new("drum", tube(24, 1.0, 1.1, 0.5)).with_kind(Kind::Kinematic(Arc::new(motion)));
    simulation.add(&drum.with_friction(0.6)).unwrap();
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.1&y=0.1&z=0.1").unwrap()));
    for x in [-0.3, 0.0, 0.3] {
        let place = DVec3::new(x, -0.8, 0.0);
        let body = Body::new(format!("box at {x}"), Arc::clone(&cube)).with_friction(0.6);
        simulation.add(&body.with_position(place)).unwrap();
    }
    let (mut events, mut skipped) = (0, 0.0);
    for _ in 0..60 {
        let report = simulation.step().unwrap();
        events += report.events;
        skipped += report.segments.iter().map(|segment| segment.skipped).sum::<f64>();
    }
    assert_eq!(skipped, 0.0);
    assert!(events < 300, "{events}");
}

/// A gear bounces on its pin and between the teeth of one that drives it, at 200 rad/s, many times in a step: for each bounce it has all of the gap.
#[test]
fn gears_that_bounce_on_their_pin_have_room() {
    let options = SimulationOptions::default().with_gap(1e-6);
    let mut simulation = Simulation::new(options).unwrap();
    let gear = tree("gear?teeth=16&triangles=5000");
    let body = |name: &str, tree: &Arc<MeshTree>| Body::new(name, Arc::clone(tree)).with_restitution(0.9);
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 200.0);
    simulation
        .add(&body("drive", &gear).with_friction(0.1).with_kind(Kind::Kinematic(Arc::new(turning))))
        .unwrap();
    let pin = body("pin", &tree("shaft?scale=0.58&triangles=2000")).with_kind(Kind::Static);
    simulation.add(&pin.with_position(DVec3::X * 1.88)).unwrap();
    let plate = tree("box?x=0.6&y=0.6&z=0.05");
    for z in [0.3, -0.3] {
        let cap = body("cap", &plate).with_kind(Kind::Static);
        simulation.add(&cap.with_position(DVec3::new(1.88, 0.0, z))).unwrap();
    }
    let driven = body("driven", &gear).with_friction(0.1).with_position(DVec3::X * 1.88);
    let half_a_tooth = DQuat::from_rotation_z(core::f64::consts::PI / 16.0);
    let driven = simulation.add(&driven.with_orientation(half_a_tooth)).unwrap();
    let report = simulation.step().unwrap();
    assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
    assert!(report.events > 10 && simulation.angular_velocity(driven).z < -50.0, "{}", report.events);
}

/// A lift carries a box, wherever it is, also in a step to the next double: it had the velocity by which the rounding of its place differs then,
/// and threw the box up by centimetres.
#[test]
fn the_shortest_steps_throw_nothing_off_a_lift() {
    let plate = tree("box?x=2&y=0.5&z=2");
    for start in (0..30).map(|k| 0.0137 * f64::from(k)) {
        for short in [0.0, 1e-16, 1e-15, 1e-13] {
            let place = DVec3::new(start, 0.1 * start, 0.0);
            let rising = ConstantTwist::REST.with_position(place);
            let rising = rising.with_linear_velocity(DVec3::new(0.1, 0.3, 0.0));
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            let lift = Body::new("lift", Arc::clone(&plate))
                .with_friction(0.5)
                .with_kind(Kind::Kinematic(Arc::new(rising)));
            let lift = simulation.add(&lift).unwrap();
            let load =
                Body::new("load", ground::cube()).with_friction(0.5).with_position(place + DVec3::Y * 1.001);
            let load = simulation.add(&load).unwrap();
            for _ in 0..20 {
                simulation.step().unwrap();
            }
            simulation.step_to((simulation.time() + short).max(simulation.time().next_up())).unwrap();
            for _ in 0..10 {
                simulation.step().unwrap();
                let apart = simulation.position(load).y - simulation.position(lift).y;
                assert!((apart - 1.001).abs() < 2e-4, "{start} {short:e}: {apart}");
            }
        }
    }
}

/// A turntable at the origin turns as its motion does, also in a step to the next double: it was faster by up to 8 rad/s there.
#[test]
fn the_shortest_steps_turn_nothing_faster() {
    for (k, short) in
        [0.0, 1e-16, 1e-15, 1e-14].into_iter().flat_map(|short| (0..16).map(move |k| (k, short)))
    {
        let (spin, angle) = (0.3 + 0.01 * f64::from(k), 0.1 * f64::from(k));
        let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Y * spin);
        let mut simulation = simulation(Arc::new(turning.with_orientation(DQuat::from_rotation_y(angle))));
        let table = simulation.ids().next().unwrap();
        for _ in 0..20 {
            simulation.step().unwrap();
        }
        for short in [short, 0.0, 0.01] {
            simulation.step_to((simulation.time() + short).max(simulation.time().next_up())).unwrap();
            let off = simulation.angular_velocity(table) - DVec3::Y * spin;
            assert!(off.length() * simulation.options().step < 0.01 * GAP, "{spin} {short:e}: {off}");
        }
    }
}
